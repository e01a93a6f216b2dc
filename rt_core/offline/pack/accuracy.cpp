#include "offline/pack/accuracy.h"

#include <Eigen/LU>
#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>
#include <complex>

#include "offline/track/statics.h"
#include "online/step/residual.h"

namespace railstep {

namespace {

using Value = std::complex<double>;
constexpr double kPi = 3.14159265358979323846;

/// Vertical receptance of a rail's point, m/N: displacement there under a unit force e^(i omega t).
Value receptance(const Track& track, const Line& line, const RailPoint& at, double omega) {
  const Eigen::SparseVector<double> row = point_row(track, line, at);
  if (row.norm() == 0.) return 0.;
  const Eigen::SparseMatrix<Value> dynamic = line.stiffness.cast<Value>() +
                                             Value(0., omega) * line.damping.cast<Value>() -
                                             Value(omega * omega) * line.mass.cast<Value>();
  const Eigen::SparseLU<Eigen::SparseMatrix<Value>> factor(dynamic);
  const Eigen::VectorXcd load = Eigen::VectorXd(row).cast<Value>();
  return (load.transpose() * factor.solve(load))(0, 0);
}

Value receptance(const PackedLine& own, const Eigen::VectorXd& row, double omega) {
  const Eigen::VectorXcd modal = (own.basis.shapes.transpose() * row).cast<Value>();
  Eigen::MatrixXcd dynamic = Value(0., omega) * own.modes.damping.cast<Value>();
  dynamic.diagonal().array() += (own.basis.omega.array().square() - omega * omega).cast<Value>();
  return (modal.transpose() * dynamic.partialPivLu().solve(modal))(0, 0);
}

/// Of the model as it is stepped: lines and residual flexibility.
Value receptance(const Track& track, const PackedModel& packed, const Port& port, std::int32_t kind,
                 double x, double omega) {
  const bool condensed = packed.model().condensed != 0;
  const RailPoint at{port.rail, x, 0., condensed ? 0. : port.z, 2};
  Value sum = residual_under(packed.model(), rail_force(packed.model(), kind, x, 1.));
  for (const PackedLine& own : packed.lines())
    sum += condensed ? receptance(own, Eigen::VectorXd(point_row(track, own.line, at)), omega)
                     : receptance(track, own.line, at, omega);
  return sum;
}

Track refined(Track track, int times) {
  track.elements_per_bay *= times;
  return track;
}

}  // namespace

double static_error(const Track& track, const PackedModel& packed) {
  const int points = packed.model().residual.points > 0 ? packed.model().residual.points : 16;
  const Statics exact(
      refined(track, 2 * points));  // exact at its end nodes, half-way of the tables
  double largest = 0., error = 0.;
  for (std::size_t kind = 0; kind < packed.kinds().size(); ++kind) {
    const Port& port = packed.kinds()[kind];
    for (int element = 0; element < track.elements(); ++element) {
      const double x = (element + 13. / (2. * points)) * track.element_length();
      const RailPoint at{port.rail, x, 0., port.z, 2};
      const double want = exact.flexibility(at, at);
      const Value got = receptance(track, packed, port, static_cast<std::int32_t>(kind), x, 0.);
      largest = std::max(largest, want);
      error = std::max(error, std::abs(got - want));
    }
  }
  return largest > 0. ? error / largest : 0.;
}

double receptance_error(const Track& track, const PackedModel& packed) {
  const Track fine = refined(track, 2);
  const std::vector<Line> lines = assemble(fine);
  const int bay = track.bays / 2;
  double largest = 0., error = 0.;
  for (std::size_t kind = 0; kind < packed.kinds().size(); ++kind)
    for (const double x : {(bay + .5) * track.bay_length, bay * track.bay_length}) {
      const Port& port = packed.kinds()[kind];
      for (int i = 0; i < kReceptancePoints; ++i) {
        const double part = i / (kReceptancePoints - 1.);
        const double omega =
            2. * kPi * kReceptanceFrom * std::pow(kReceptanceTo / kReceptanceFrom, part);
        Value want = 0.;
        for (const Line& line : lines)
          want += receptance(fine, line, {port.rail, x, 0., port.z, 2}, omega);
        const Value got =
            receptance(track, packed, port, static_cast<std::int32_t>(kind), x, omega);
        largest = std::max(largest, std::abs(want));
        error = std::max(error, std::abs(got - want));
      }
    }
  return largest > 0. ? error / largest : 0.;
}

}  // namespace railstep
