#include "offline/pack/port_statics.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/SparseCholesky>
#include <cmath>

#include "offline/analysis/statics.h"
#include "offline/pack/static_ports.h"

namespace railstep {

ClosedPorts::ClosedPorts(const Track& track, const PackedModel& packed,
                         const std::vector<RailPoint>& points) {
  std::vector<Eigen::Index> closed;
  const std::vector<FixedPort> all = fixed_ports(track);
  for (std::size_t j = 0; j < all.size(); ++j) {
    if (!is_closed_at_rest(all[j])) continue;
    closed.push_back(static_cast<Eigen::Index>(j));
    ports_.push_back(all[j]);
  }
  if (ports_.empty()) return;
  Eigen::Index modes = 0;
  for (const PackedLine& own : packed.lines()) modes += own.modes.rate().size();
  rate_.resize(modes);
  points_.resize(modes, static_cast<Eigen::Index>(points.size()));
  rows_.resize(modes, static_cast<Eigen::Index>(closed.size()));
  modes = 0;
  for (const PackedLine& own : packed.lines()) {
    const Eigen::Index n = own.modes.rate().size();
    const auto modal = [&](const Eigen::VectorXd& row) {
      return own.modes.project(own.basis.shapes.project(row));
    };
    rate_.segment(modes, n) = own.modes.rate();
    for (std::size_t i = 0; i < points.size(); ++i)
      points_.col(static_cast<Eigen::Index>(i)).segment(modes, n) =
          modal(Eigen::VectorXd(point_row(track, own.line, points[i], false)));
    for (std::size_t j = 0; j < closed.size(); ++j)
      rows_.col(static_cast<Eigen::Index>(j)).segment(modes, n) =
          modal(Eigen::VectorXd(own.closing.col(closed[j])));
    modes += n;
  }
}

void ClosedPorts::subtract(double omega, Eigen::VectorXcd& receptances) const {
  if (ports_.empty()) return;
  const std::complex<double> rate(0., omega);
  const Eigen::VectorXcd along = .5 * (rate - rate_.array()).inverse(),
                         back = .5 * (rate - rate_.conjugate().array()).inverse();
  const Eigen::MatrixXcd moved = along.asDiagonal() * rows_,
                         moved_back = back.asDiagonal() * rows_.conjugate();
  const Eigen::MatrixXcd to_points =
      moved.transpose() * points_ + moved_back.transpose() * points_.conjugate();
  Eigen::MatrixXcd ports = moved.transpose() * rows_ + moved_back.transpose() * rows_.conjugate();
  for (std::size_t j = 0; j < ports_.size(); ++j) {
    const auto at = static_cast<Eigen::Index>(j);
    ports(at, at) += 1. / (ports_[j].stiffness + rate * ports_[j].damping);
  }
  receptances -=
      to_points.cwiseProduct(ports.partialPivLu().solve(to_points)).colwise().sum().transpose();
}

namespace {

/// Adds the part of one line.
/// @param rows   of the points, in the line's coordinates or unknowns
/// @param solve  displacements under forces on these
template <typename Rows, typename Solve>
void add_line(const Rows& points, const Eigen::MatrixXd& ports, const Solve& solve,
              PortStatics& sum) {
  if (ports.isZero(0.)) return;
  const Eigen::MatrixXd moved = solve(ports);
  sum.points += moved.transpose() * points;
  sum.ports += moved.transpose() * ports;
}

PortStatics nothing(std::size_t ports, std::size_t points) {
  const auto n = static_cast<Eigen::Index>(ports);
  return {Eigen::MatrixXd::Zero(n, static_cast<Eigen::Index>(points)), Eigen::MatrixXd::Zero(n, n)};
}

/// Rows of the points and of the closings of the track's ports, over a line's unknowns.
struct Rows {
  Eigen::SparseMatrix<double> points;
  Eigen::MatrixXd ports;

  Rows(const Track& at_rest, const Line& line, const std::vector<FixedPort>& all,
       const std::vector<RailPoint>& at, bool strains)
      : points(line.unknowns(), static_cast<Eigen::Index>(at.size())),
        ports(line.unknowns(), static_cast<Eigen::Index>(all.size())) {
    for (std::size_t i = 0; i < at.size(); ++i)
      points.col(static_cast<Eigen::Index>(i)) = point_row(at_rest, line, at[i], strains);
    for (std::size_t j = 0; j < all.size(); ++j)
      ports.col(static_cast<Eigen::Index>(j)) = Eigen::VectorXd(closing_row(at_rest, line, all[j]));
  }
};

void add_line(const Track& at_rest, const Line& line, const std::vector<FixedPort>& ports,
              const std::vector<RailPoint>& points, PortStatics& sum) {
  const Rows rows(at_rest, line, ports, points, true);
  add_line(
      rows.points, rows.ports,
      [&line](const Eigen::MatrixXd& forces) -> Eigen::MatrixXd {
        return Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(line.stiffness).solve(forces);
      },
      sum);
}

}  // namespace

PortStatics port_statics(const Track& track, const PackedModel& packed,
                         const std::vector<RailPoint>& points) {
  const std::vector<FixedPort> ports = fixed_ports(track);
  const Track at_rest = linear_about_rest(track);
  const std::vector<Line> lines = assemble(at_rest);
  PortStatics sum = nothing(ports.size(), points.size());
  for (const PackedLine& own : packed.lines()) {
    const Line& line = lines[own.index];
    if (packed.model().form == Form::banded) {
      add_line(at_rest, line, ports, points, sum);
      continue;
    }
    const Basis basis = with_springs(own.basis, line.stiffness - own.line.stiffness);
    const Eigen::MatrixXd shapes = basis.shapes.dense();
    const Rows rows(track, own.line, ports, points, false);
    add_line(
        Eigen::MatrixXd(shapes.transpose() * rows.points),
        Eigen::MatrixXd(shapes.transpose() * rows.ports),
        [&basis](const Eigen::MatrixXd& forces) { return basis.static_response(forces); }, sum);
  }
  return sum;
}

PortStatics port_statics(const Track& track, const Track& at_rest,
                         const std::vector<RailPoint>& points) {
  const std::vector<FixedPort> ports = fixed_ports(track);
  PortStatics sum = nothing(ports.size(), points.size());
  for (const Line& line : assemble(at_rest)) add_line(at_rest, line, ports, points, sum);
  return sum;
}

namespace {

/// Share of a spring, closed at rest, that remains when all ports are open, so that a track that
/// nothing else holds is held. Model and reference have the same share.
constexpr double kStays = 1e-5;

/// Adds the deflection due to opening all but kStays of the springs that are closed at rest:
///   G + G_p s (1 - s G_pp s)^-1 s G_p',   s^2 = (1 - kStays) k.
void open(const std::vector<FixedPort>& ports, PortStatics& statics, Eigen::VectorXd& under) {
  const auto n = static_cast<Eigen::Index>(ports.size());
  Eigen::VectorXd s(n);
  for (Eigen::Index j = 0; j < n; ++j) {
    const FixedPort& port = ports[static_cast<std::size_t>(j)];
    s[j] = is_closed_at_rest(port) ? std::sqrt((1. - kStays) * port.stiffness) : 0.;
  }
  const Eigen::MatrixXd held =
      Eigen::MatrixXd::Identity(n, n) - s.asDiagonal() * statics.ports * s.asDiagonal();
  const Eigen::LLT<Eigen::MatrixXd> factor(held);
  const Eigen::MatrixXd to_points = factor.matrixL().solve(s.asDiagonal() * statics.points),
                        to_ports = factor.matrixL().solve(s.asDiagonal() * statics.ports);
  under += to_points.colwise().squaredNorm().transpose();
  statics.points += to_ports.transpose() * to_points;
  statics.ports += to_ports.transpose() * to_ports;
}

}  // namespace

Eigen::VectorXd deflection_under(const std::vector<FixedPort>& ports, const PortStatics& statics,
                                 const Eigen::VectorXd& under) {
  constexpr double kForce = 1e5;  // N
  PortStatics opened = statics;
  Eigen::VectorXd result = under;
  open(ports, opened, result);
  Eigen::VectorXd stiffness(opened.ports.rows());
  for (std::size_t j = 0; j < ports.size(); ++j)
    stiffness[static_cast<Eigen::Index>(j)] =
        (is_closed_at_rest(ports[j]) ? 1. - kStays : 1.) * ports[j].stiffness;
  for (Eigen::Index i = 0; i < under.size(); ++i) {
    const Eigen::VectorXd closing = opened.points.col(i);
    const Eigen::VectorXd force = static_port_forces(opened.ports, stiffness, -kForce * closing);
    // Downwards under a force downwards: G F, less the lift by the closed ports.
    result[i] += closing.dot(force) / kForce;
  }
  return result;
}

}  // namespace railstep
