#include "offline/pack/accuracy.h"

#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <memory>
#include <optional>

#include "offline/analysis/krylov.h"
#include "offline/analysis/statics.h"
#include "offline/beam/linearise.h"
#include "offline/math/band_search.h"
#include "offline/math/complex.h"
#include "offline/math/larger.h"
#include "offline/pack/port_statics.h"
#include "offline/track/squeeze.h"
#include "online/track/residual.h"

namespace railstep {

namespace {

constexpr double kPi = 3.14159265358979323846;

/// Vertical receptances of points of the rails by one line, m/N: the displacement of a point under
/// a unit force e^(i omega t) on it. The matrix is ordered once for all frequencies.
class LineReceptances {
 public:
  LineReceptances(const Track& track, const Line& line, const std::vector<RailPoint>& points)
      : line_(line), rows_(line.unknowns(), static_cast<Eigen::Index>(points.size())) {
    for (std::size_t i = 0; i < points.size(); ++i)
      rows_.col(static_cast<Eigen::Index>(i)) = Eigen::VectorXd(point_row(track, line, points[i]));
    if (moved()) factor_.analyzePattern(dynamic_stiffness(line_, 1.));
  }

  void add(double omega, Eigen::VectorXcd& sums) {
    if (!moved()) return;
    factor_.factorize(dynamic_stiffness(line_, ComplexNumber(0., omega)));
    if (factor_.info() != Eigen::Success) {
      sums.setConstant(std::numeric_limits<double>::infinity());
      return;
    }
    const Eigen::MatrixXcd forces = rows_.cast<ComplexNumber>(), answer = factor_.solve(forces);
    sums += answer.cwiseProduct(forces).colwise().sum().transpose();
  }

 private:
  bool moved() const { return !rows_.isZero(0.); }

  const Line& line_;
  Eigen::MatrixXd rows_;  // [unknowns][points]
  Eigen::SparseLU<Eigen::SparseMatrix<ComplexNumber>> factor_;
};

/// The same for a condensed line: the sum of its modes.
class ModalReceptances {
 public:
  ModalReceptances(const Track& track, const PackedLine& own, const std::vector<RailPoint>& points)
      : rate_(own.modes.rate()), squares_(rate_.size(), static_cast<Eigen::Index>(points.size())) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      // Ports leave out the section's own strain.
      const Eigen::VectorXd row(point_row(track, own.line, points[i], false));
      squares_.col(static_cast<Eigen::Index>(i)) =
          own.modes.project(own.basis.shapes.project(row)).array().square();
    }
  }

  void add(double omega, Eigen::VectorXcd& sums) const {
    const ComplexNumber rate(0., omega);
    const Eigen::VectorXcd along = .5 * (rate - rate_.array()).inverse(),
                           back = .5 * (rate - rate_.conjugate().array()).inverse();
    sums += squares_.transpose() * along + squares_.adjoint() * back;
  }

 private:
  Eigen::VectorXcd rate_;
  Eigen::MatrixXcd squares_;  // [modes][points] of the modes there
};

/// The line with rails that have no inertia along x. A vertical track has no dampers along x, and
/// the strain of the section would make the rails ring there.
void drop_inertia_along(const Track& track, Line& line) {
  std::vector<bool> along(static_cast<std::size_t>(line.unknowns()), false);
  for (int rail = 0; rail < track.rails; ++rail)
    for (int node = 0; node < track.nodes(); ++node)
      for (const int at : {line.unknown(rail, node, 0), line.unknown_ahead(rail, node, 0)})
        if (at >= 0) along[static_cast<std::size_t>(at)] = true;
  line.mass.prune([&](Eigen::Index row, Eigen::Index column, double) {
    return !along[static_cast<std::size_t>(row)] && !along[static_cast<std::size_t>(column)];
  });
}

/// Receptances of all lines of a track together.
class TrackReceptances {
 public:
  TrackReceptances(const Track& track, const std::vector<RailPoint>& points)
      : lines_(assemble(track)), points_(static_cast<Eigen::Index>(points.size())) {
    if (track.unknowns == Unknowns::in_plane)
      for (Line& line : lines_) drop_inertia_along(track, line);
    for (const Line& line : lines_)
      each_.push_back(std::make_unique<LineReceptances>(track, line, points));
  }

  Eigen::VectorXcd at(double omega) {
    Eigen::VectorXcd sums = Eigen::VectorXcd::Zero(points_);
    for (const auto& line : each_) line->add(omega, sums);
    return sums;
  }

 private:
  std::vector<Line> lines_;
  Eigen::Index points_;
  std::vector<std::unique_ptr<LineReceptances>> each_;
};

/// The reference of a model: a finer mesh, linear about rest, with the section's strain.
Track refined(const Track& of, int times) {
  Track track = with_strain(linear_about_rest(of));
  track.elements_per_bay *= times;
  return track.state ? linearised_under_weight(track, track.state->gravity) : track;
}

/// Every load point at every place.
struct Asked {
  std::vector<RailPoint> points;
  std::vector<std::int32_t> load_points;

  Asked(const PackedModel& packed, const std::vector<double>& places) {
    for (std::size_t i = 0; i < packed.load_points().size(); ++i)
      for (const double x : places) {
        const LoadPoint& at = packed.load_points()[i];
        points.push_back({at.rail, x, at.y, at.z, 2});
        load_points.push_back(static_cast<std::int32_t>(i));
      }
  }
};

/// Largest error over the largest deflection; 0 without points.
double largest_error(const Eigen::VectorXd& got, const Eigen::VectorXd& want) {
  double largest = 0., error = 0.;
  for (Eigen::Index i = 0; i < want.size(); ++i) {
    largest = std::max(largest, want[i]);
    error = larger(error, std::abs(got[i] - want[i]));
  }
  return largest > 0. ? error / largest : 0.;
}

/// Receptances of the model as it is stepped: lines and residual flexibility.
class ModelReceptances {
 public:
  ModelReceptances(const Track& track, const PackedModel& packed, const Asked& asked)
      : residual_(static_cast<Eigen::Index>(asked.points.size())) {
    for (std::size_t i = 0; i < asked.points.size(); ++i)
      residual_[static_cast<Eigen::Index>(i)] = residual_under(
          packed.model(), rail_force(packed.model(), asked.load_points[i], asked.points[i].x, 1.));
    if (packed.model().form == Form::condensed) {
      for (const PackedLine& own : packed.lines()) modal_.emplace_back(track, own, asked.points);
      closed_.emplace(track, packed, asked.points);
      return;
    }
    const Track at_rest = linear_about_rest(track);
    lines_ = assemble(at_rest);
    for (const PackedLine& own : packed.lines())
      full_.push_back(std::make_unique<LineReceptances>(at_rest, lines_[own.index], asked.points));
  }

  Eigen::VectorXcd at(double omega) {
    Eigen::VectorXcd sums = residual_.cast<ComplexNumber>();
    for (const ModalReceptances& line : modal_) line.add(omega, sums);
    for (const auto& line : full_) line->add(omega, sums);
    if (closed_) closed_->subtract(omega, sums);
    return sums;
  }

 private:
  Eigen::VectorXd residual_;
  std::vector<ModalReceptances> modal_;
  std::optional<ClosedPorts> closed_;  // of a condensed model
  std::vector<Line> lines_;            // of a model in full order, at rest
  std::vector<std::unique_ptr<LineReceptances>> full_;
};

/// A model and its reference, at the middle of the middle bay and over its seat.
class Compared {
 public:
  Compared(const Track& track, const PackedModel& packed)
      : asked_(packed, receptance_places(track)),
        model_(track, packed, asked_),
        reference_(refined(track, receptance_refinement(track)), asked_.points) {}

  bool empty() const { return asked_.points.empty(); }
  /// [points][2] the error of the model, and the reference
  Eigen::MatrixXcd at(double hz) {
    const double omega = 2. * kPi * hz;
    Eigen::MatrixXcd both(static_cast<Eigen::Index>(asked_.points.size()), 2);
    both.col(1) = reference_.at(omega);
    both.col(0) = model_.at(omega) - both.col(1);
    return both;
  }

 private:
  Asked asked_;
  ModelReceptances model_;
  TrackReceptances reference_;
};

}  // namespace

double static_error(const Track& track, const PackedModel& packed) {
  const int points = packed.model().residual.points > 0 ? packed.model().residual.points : 16;
  // Exact at its end nodes, which lie half-way between the places of the tables.
  const Statics exact(refined(track, 2 * points));
  std::vector<double> places;
  const int intervals = track.elements() * points, count = std::min(kStaticPlaces, intervals);
  for (int i = 0; i < count; ++i) {
    const auto interval = static_cast<std::int64_t>(2 * i + 1) * intervals / (2 * count);
    places.push_back((static_cast<double>(interval) + .5) / points * track.element_length());
  }
  // Near an end the section is squeezed most.
  for (int i = 0; i <= points && !track.ring; ++i) {
    const double away = std::max(0., i - .5) / points * track.element_length();
    places.insert(places.end(), {away, track.length() - away});
  }
  const Asked asked(packed, places);
  const Eigen::VectorXd got = ModelReceptances(track, packed, asked).at(0.).real();
  Eigen::VectorXd want(got.size());
  for (std::size_t i = 0; i < asked.points.size(); ++i)
    want[static_cast<Eigen::Index>(i)] = exact.flexibility(asked.points[i], asked.points[i]);
  const double error = largest_error(got, want);
  if (packed.model().fixed.count == 0) return error;
  const std::vector<FixedPort> ports = fixed_ports(track);
  return std::max(
      error, largest_error(
                 deflection_under(ports, port_statics(track, packed, asked.points), got),
                 deflection_under(ports, port_statics(track, exact.track(), asked.points), want)));
}

std::vector<double> receptance_frequencies(const std::array<double, 2>& band) {
  std::vector<double> hz;
  hz.reserve(kReceptancePoints);
  for (int i = 0; i < kReceptancePoints; ++i)
    hz.push_back(band[0] * std::pow(band[1] / band[0], i / (kReceptancePoints - 1.)));
  return hz;
}

std::vector<double> receptance_places(const Track& track) {
  const int bay = track.bays / 2;
  return {(bay + .5) * track.bay_length, bay * track.bay_length};
}

int receptance_refinement(const Track& track) {
  return std::max(2, (kReceptanceElements + track.elements_per_bay - 1) / track.elements_per_bay);
}

std::vector<double> receptance_errors(const Track& track, const PackedModel& packed,
                                      const std::vector<double>& hz) {
  Compared compared(track, packed);
  double largest = 0.;
  std::vector<double> errors;
  for (const double frequency : hz) {
    const Eigen::MatrixXcd both = compared.at(frequency);
    largest = std::max(largest, both.col(1).cwiseAbs().maxCoeff<Eigen::PropagateNaN>());
    errors.push_back(both.col(0).cwiseAbs().maxCoeff<Eigen::PropagateNaN>());
  }
  for (double& error : errors) error = largest > 0. ? error / largest : 0.;
  return errors;
}

ReceptanceError receptance_error(const Track& track, const PackedModel& packed,
                                 const std::array<double, 2>& band) {
  Compared compared(track, packed);
  ReceptanceError error;
  if (compared.empty()) return error;
  const BandSearch found = largest_over([&](double hz) { return compared.at(hz); }, band);
  error.solves = found.solves;
  error.unresolved = found.unresolved;
  error.undamped_hz = found.undamped_hz;
  if (found.undamped_hz) return error;
  error.largest = found.largest[0].size / found.largest[1].size;
  error.hz = found.largest[0].hz;
  return error;
}

}  // namespace railstep
