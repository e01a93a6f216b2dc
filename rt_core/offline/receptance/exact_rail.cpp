#include "offline/receptance/exact_rail.h"

#include <Eigen/LU>
#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>

#include "offline/math/complex.h"
#include "offline/math/refuse.h"
#include "offline/track/pad.h"

namespace railstep {

namespace {

using Entries = std::vector<Eigen::Triplet<ComplexNumber>>;
constexpr int kBayDoublings = 40;
constexpr double kSameNode = 1e-9;  // m

void add(Entries& entries, std::size_t node, const Eigen::MatrixXcd& block) {
  const int first = 2 * static_cast<int>(node);
  for (int j = 0; j < block.cols(); ++j)
    for (int i = 0; i < block.rows(); ++i) entries.emplace_back(first + i, first + j, block(i, j));
}

}  // namespace

Eigen::Matrix2cd endless_stiffness(const Eigen::Matrix4cd& bay, const Eigen::Matrix2cd& seat) {
  Eigen::Matrix2cd near = bay.topLeftCorner<2, 2>(), far = bay.bottomRightCorner<2, 2>(),
                   across = bay.topRightCorner<2, 2>();
  for (int i = 0; i < kBayDoublings; ++i) {
    const Eigen::Matrix2cd inverse = (far + seat + near).inverse();
    const Eigen::Matrix2cd change = across * inverse * across.transpose();
    far -= (across.transpose() * inverse * across).eval();
    near -= change;
    across = (-across * inverse * across).eval();
    if (change.norm() < 1e-14 * near.norm()) return near;
  }
  fail("E-RECEPTANCE-02",
       "waves run without damping along a track without end; expected damping in its pads or "
       "ballast, or other frequencies");
}

ExactRailReceptance::ExactRailReceptance(const Track& track, const Transfer& transfer,
                                         BeamTheory theory, bool endless)
    : track_(track), transfer_(transfer), beam_(bending_beam(track, theory)), endless_(endless) {
  if (track.cant != 0.)
    refuse("E-RECEPTANCE-08", "the exact beam stands upright; expected no cant");
  if (track.axial_force != 0. || track.axis_z != 0.)
    refuse("E-RECEPTANCE-09",
           "the exact beam has no axial force and its nodes are on the centroid; expected no "
           "rail.axial_force_n and no heat, and track.reference_line = \"centroid\"");
  if (!track.changed_seats.empty() || track.right || has_long_pads(track) || !track.joints.empty())
    refuse("E-RECEPTANCE-10",
           "the exact beam stands on equal point seats; expected equal seats and rails, "
           "support.length_m = 0, and no joints");
  for (int i = 0; i <= track.bays; ++i) x_.push_back(i * track.bay_length);
  take_places(transfer.force);
  for (const Functional& read : transfer.reads) take_places(read);
  std::sort(x_.begin(), x_.end());
  const auto same = [](double a, double b) { return b - a < kSameNode; };
  x_.erase(std::unique(x_.begin(), x_.end(), same), x_.end());
  const double half = std::sqrt(.5), g = track.rail_spacing;
  const double mass = track.sleeper ? track.sleeper->mass / 2. : 0.;
  if (track.rails == 2 && track.sleeper)  // both rails down, and one down as the other goes up
    parts_ = {{{half, half}, mass}, {{half, -half}, 2. * track.sleeper->roll_inertia / (g * g)}};
  else
    parts_ = {{{1., 0.}, mass}, {{0., 1.}, mass}};
}

void ExactRailReceptance::take_places(const Functional& functional) {
  const auto check = [](int direction) {
    if (direction != 2)
      refuse("E-RECEPTANCE-11",
             "the exact beam moves vertically only; expected force and sensor along z");
  };
  for (const Functional::OnRail& point : functional.rail) {
    check(point.at.direction);
    (void)place_on(track_, point.at.x);
    x_.push_back(point.at.x);
  }
  for (const Functional::OnSleeper& end : functional.sleeper) {
    check(end.direction);
    if (!track_.sleeper || end.seat < 0 || end.seat > track_.bays)
      refuse("E-RECEPTANCE-12",
             "the force or the sensor is on a sleeper that the track does not have");
  }
}

std::size_t ExactRailReceptance::node_at(double x) const {
  const auto node = std::lower_bound(x_.begin(), x_.end(), x - kSameNode);
  return static_cast<std::size_t>(node - x_.begin());
}

Eigen::Matrix2cd ExactRailReceptance::Seat::on_rail() const {
  Eigen::Matrix2cd stiffness = Eigen::Matrix2cd::Zero();
  stiffness(0, 0) = has_sleeper ? pad * sleeper / (pad + sleeper) : pad;
  stiffness(1, 1) = rotation;
  return stiffness;
}

ExactRailReceptance::Seat ExactRailReceptance::seat(const Part& part, double omega) const {
  const ComplexNumber pad(track_.support.stiffness[2], omega * track_.support.damping[2]);
  const ComplexNumber along(track_.support.stiffness[0], omega * track_.support.damping[0]);
  const ComplexNumber rotation = along * std::pow(track_.support.height_z, 2);
  if (!track_.sleeper) return {pad, 0., rotation, false};
  ComplexNumber ballast(track_.sleeper->ballast_stiffness[2],
                        omega * track_.sleeper->ballast_damping[2]);
  if (const Relaxing& own = track_.sleeper->relaxing; own.damping > 0.) {
    const ComplexNumber damper(0., omega * own.damping);
    ballast -= damper * damper / (own.stiffness + damper);
  }
  return {pad, ballast - omega * omega * part.sleeper_mass, rotation, true};
}

/// The rails' coefficients; a sleeper counts with the part of its motion that its rail follows.
Eigen::VectorXcd ExactRailReceptance::row(const Functional& functional, const Part& part,
                                          const Seat& seat) const {
  Eigen::VectorXcd row = Eigen::VectorXcd::Zero(2 * static_cast<Eigen::Index>(x_.size()));
  const auto at = [&](double x) -> ComplexNumber& {
    return row[2 * static_cast<Eigen::Index>(node_at(x))];
  };
  for (const Functional::OnRail& p : functional.rail)
    at(p.at.x) += p.factor * part.rail_factor[static_cast<std::size_t>(p.at.rail)];
  for (const Functional::OnSleeper& s : functional.sleeper)
    at(s.seat * track_.bay_length) +=
        s.factor * part.rail_factor[static_cast<std::size_t>(s.rail)] * seat.follows();
  return row;
}

/// Displacement of sleepers under forces on them with the rails held, m/N.
ComplexNumber ExactRailReceptance::held_rail(const Functional& a, const Functional& b,
                                             const Part& part, const Seat& seat) const {
  ComplexNumber sum = 0.;
  for (const Functional::OnSleeper& s : a.sleeper)
    for (const Functional::OnSleeper& t : b.sleeper)
      if (s.seat == t.seat)
        sum += s.factor * part.rail_factor[static_cast<std::size_t>(s.rail)] * t.factor *
               part.rail_factor[static_cast<std::size_t>(t.rail)] / (seat.pad + seat.sleeper);
  return sum;
}

void ExactRailReceptance::add_ends(const Eigen::Matrix2cd& seat, double omega, Entries& to) const {
  for (const std::size_t end : {std::size_t{0}, std::size_t{1}}) {
    const RailEnd kind = endless_ ? RailEnd::non_reflecting : track_.ends[end];
    Eigen::Matrix2cd beyond = Eigen::Matrix2cd::Zero();
    if (kind == RailEnd::non_reflecting) {
      beyond = endless_stiffness(beam_dynamic_stiffness(beam_, track_.bay_length, omega), seat);
      if (end == 0) {  // seen along -x slopes change sign
        beyond(0, 1) = -beyond(0, 1);
        beyond(1, 0) = -beyond(1, 0);
      }
    } else {  // held unknowns: a spring far stiffer than all else
      if (kind != RailEnd::free) beyond(0, 0) = 1e20;
      if (kind == RailEnd::clamped) beyond(1, 1) = 1e20;
    }
    add(to, end == 0 ? 0 : x_.size() - 1, beyond);
  }
}

Eigen::SparseMatrix<ComplexNumber> ExactRailReceptance::stiffness(const Eigen::Matrix2cd& seat,
                                                                  double omega) const {
  Entries entries;
  for (std::size_t i = 0; i + 1 < x_.size(); ++i)
    add(entries, i, beam_dynamic_stiffness(beam_, x_[i + 1] - x_[i], omega));
  for (int i = 0; i <= track_.bays; ++i) add(entries, node_at(i * track_.bay_length), seat);
  add_ends(seat, omega, entries);
  const auto n = 2 * static_cast<int>(x_.size());
  Eigen::SparseMatrix<ComplexNumber> result(n, n);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

Eigen::VectorXcd ExactRailReceptance::at(double hz) {
  const double omega = 2. * M_PI * hz;
  Eigen::VectorXcd sum = Eigen::VectorXcd::Zero(static_cast<Eigen::Index>(transfer_.reads.size()));
  for (const Part& part : parts_) {
    const Seat under = seat(part, omega);
    const Eigen::VectorXcd force = row(transfer_.force, part, under);
    const Eigen::SparseLU<Eigen::SparseMatrix<ComplexNumber>> factor(
        stiffness(under.on_rail(), omega));
    const Eigen::VectorXcd moved = factor.solve(force);
    for (std::size_t i = 0; i < transfer_.reads.size(); ++i) {
      const Functional& read = transfer_.reads[i];
      sum[static_cast<Eigen::Index>(i)] += (row(read, part, under).transpose() * moved)(0, 0) +
                                           held_rail(transfer_.force, read, part, under);
    }
  }
  return sum;
}

}  // namespace railstep
