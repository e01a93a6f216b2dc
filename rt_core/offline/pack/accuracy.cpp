#include "offline/pack/accuracy.h"

#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>
#include <complex>

#include "offline/beam/linearise.h"
#include "offline/math/larger.h"
#include "offline/pack/port_statics.h"
#include "offline/track/krylov.h"
#include "offline/track/squeeze.h"
#include "offline/track/statics.h"
#include "online/step/residual.h"

namespace railstep {

namespace {

using Value = std::complex<double>;
constexpr double kPi = 3.14159265358979323846;

/// Vertical receptances of rails' points, m/N: displacement there under a unit force e^(i omega t).
void add_receptances(const Track& track, const Line& line, const std::vector<RailPoint>& points,
                     double omega, std::vector<Value>& sums) {
  std::vector<Eigen::SparseVector<double>> rows;
  double moved = 0.;
  for (const RailPoint& at : points) {
    rows.push_back(point_row(track, line, at));
    moved += rows.back().norm();
  }
  if (moved == 0.) return;
  const Eigen::SparseLU<Eigen::SparseMatrix<Value>> factor(
      dynamic_stiffness(line, Value(0., omega)));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::VectorXcd load = Eigen::VectorXd(rows[i]).cast<Value>();
    sums[i] += (load.transpose() * factor.solve(load))(0, 0);
  }
}

void add_receptances(const Track& track, const PackedLine& own,
                     const std::vector<RailPoint>& points, double omega, std::vector<Value>& sums) {
  const Value rate(0., omega);
  const Eigen::ArrayXcd along = .5 * (rate - own.modes.rate().array()).inverse(),
                        back = .5 * (rate - own.modes.rate().conjugate().array()).inverse();
  for (std::size_t i = 0; i < points.size(); ++i) {
    // Ports leave out the section's own strain.
    const Eigen::VectorXd row(point_row(track, own.line, points[i], false));
    const Eigen::ArrayXcd modal = own.modes.project(own.basis.shapes.project(row)).array();
    sums[i] += (modal.square() * along + modal.conjugate().square() * back).sum();
  }
}

/// Of the model as it is stepped, lines and residual flexibility, at points of ports of `kinds`.
std::vector<Value> receptances(const Track& track, const PackedModel& packed,
                               const std::vector<RailPoint>& points,
                               const std::vector<std::int32_t>& kinds, double omega) {
  std::vector<Value> sums;
  for (std::size_t i = 0; i < points.size(); ++i)
    sums.emplace_back(
        residual_under(packed.model(), rail_force(packed.model(), kinds[i], points[i].x, 1.)));
  if (packed.model().condensed == 0) {
    const Track at_rest = linear_about_rest(track);
    const std::vector<Line> lines = assemble(at_rest);
    for (const PackedLine& own : packed.lines())
      add_receptances(at_rest, lines[own.index], points, omega, sums);
    return sums;
  }
  for (const PackedLine& own : packed.lines()) add_receptances(track, own, points, omega, sums);
  const PressedPorts pressed(track, packed, points);
  Eigen::Map<Eigen::VectorXcd> all(sums.data(), static_cast<Eigen::Index>(sums.size()));
  Eigen::VectorXcd less = all;
  pressed.subtract(omega, less);
  all = less;
  return sums;
}

/// What a model is measured against: a finer mesh about rest, with the section's strain.
Track refined(const Track& of, int times) {
  Track track = with_strain(linear_about_rest(of));
  track.elements_per_bay *= times;
  return track.state ? linearised_under_weight(track, track.state->gravity) : track;
}

/// Every kind of port at every place.
struct Asked {
  std::vector<RailPoint> points;
  std::vector<std::int32_t> kinds;

  Asked(const PackedModel& packed, const std::vector<double>& places) {
    for (std::size_t kind = 0; kind < packed.kinds().size(); ++kind)
      for (const double x : places) {
        const Port& port = packed.kinds()[kind];
        points.push_back({port.rail, x, port.y, port.z, 2});
        kinds.push_back(static_cast<std::int32_t>(kind));
      }
  }
};

/// Over the largest deflection, 0 where there is none.
double largest_error(const Eigen::VectorXd& got, const Eigen::VectorXd& want) {
  double largest = 0., error = 0.;
  for (Eigen::Index i = 0; i < want.size(); ++i) {
    largest = std::max(largest, want[i]);
    error = larger(error, std::abs(got[i] - want[i]));
  }
  return largest > 0. ? error / largest : 0.;
}

}  // namespace

double static_error(const Track& track, const PackedModel& packed) {
  const int points = packed.model().residual.points > 0 ? packed.model().residual.points : 16;
  // Exact at its end nodes, half-way of the tables.
  const Statics exact(refined(track, 2 * points));
  std::vector<double> places;
  const int intervals = track.elements() * points, count = std::min(kStaticPlaces, intervals);
  for (int i = 0; i < count; ++i) {
    const auto interval = static_cast<std::int64_t>(2 * i + 1) * intervals / (2 * count);
    places.push_back((static_cast<double>(interval) + .5) / points * track.element_length());
  }
  const Asked asked(packed, places);
  const std::vector<Value> at_rest = receptances(track, packed, asked.points, asked.kinds, 0.);
  Eigen::VectorXd got(static_cast<Eigen::Index>(at_rest.size())), want(got.size());
  for (std::size_t i = 0; i < at_rest.size(); ++i) {
    got[static_cast<Eigen::Index>(i)] = at_rest[i].real();
    want[static_cast<Eigen::Index>(i)] = exact.flexibility(asked.points[i], asked.points[i]);
  }
  const double error = largest_error(got, want);
  if (packed.model().fixed.count == 0) return error;
  const std::vector<FixedPort> ports = fixed_ports(track);
  return std::max(
      error,
      largest_error(pressed_under(ports, port_statics(track, packed, asked.points), got),
                    pressed_under(ports, port_statics(track, exact.track(), asked.points), want)));
}

std::vector<double> receptance_frequencies(const std::array<double, 2>& band) {
  std::vector<double> hz;
  hz.reserve(kReceptancePoints);
  for (int i = 0; i < kReceptancePoints; ++i)
    hz.push_back(band[0] * std::pow(band[1] / band[0], i / (kReceptancePoints - 1.)));
  return hz;
}

std::vector<double> receptance_errors(const Track& track, const PackedModel& packed,
                                      const std::vector<double>& hz) {
  const Track fine = refined(track, 2);
  const std::vector<Line> lines = assemble(fine);
  const int bay = track.bays / 2;
  const Asked asked(packed, {(bay + .5) * track.bay_length, bay * track.bay_length});
  double largest = 0.;
  std::vector<double> errors;
  for (const double frequency : hz) {
    const double omega = 2. * kPi * frequency;
    std::vector<Value> want(asked.points.size(), 0.);
    for (const Line& line : lines) add_receptances(fine, line, asked.points, omega, want);
    const std::vector<Value> got = receptances(track, packed, asked.points, asked.kinds, omega);
    double error = 0.;
    for (std::size_t k = 0; k < want.size(); ++k) {
      largest = std::max(largest, std::abs(want[k]));
      error = larger(error, std::abs(got[k] - want[k]));
    }
    errors.push_back(error);
  }
  for (double& error : errors) error = largest > 0. ? error / largest : 0.;
  return errors;
}

double receptance_error(const Track& track, const PackedModel& packed,
                        const std::array<double, 2>& band) {
  const std::vector<double> errors = receptance_errors(track, packed, receptance_frequencies(band));
  return *std::max_element(errors.begin(), errors.end());
}

}  // namespace railstep
