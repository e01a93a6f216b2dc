#include "offline/beam/track_structure.h"

#include <stdexcept>
#include <utility>

namespace railstep {
namespace {

using Sparse = Eigen::SparseVector<double>;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// A row of coefficients; what is held (-1) is left out.
Sparse row_of(int unknowns, const std::vector<std::pair<int, double>>& entries) {
  Sparse row(unknowns);
  for (const auto& [unknown, factor] : entries)
    if (unknown >= 0 && factor != 0.) row.coeffRef(unknown) += factor;
  return row;
}

}  // namespace

TrackStructure::TrackStructure(const Track& track) : track_(track) {
  if (track.unknowns != Unknowns::full)
    throw std::invalid_argument("a nonlinear rail moves in space: it needs all unknowns");
  if (!track.section.moments)
    throw std::invalid_argument("a nonlinear rail wants its section's moments to degree 4");
  if (track.bays < 1 || track.elements_per_bay < 1)
    throw std::invalid_argument("a track needs one bay and one element");
  // A pin off the centroid does not hold the moment of a force through it.
  const auto held = [&](RailEnd end) {
    return end == RailEnd::clamped || (end == RailEnd::pinned && track.axis_z == 0.);
  };
  if (track.axial_force != 0. && !(held(track.ends[0]) && held(track.ends[1])))
    throw std::invalid_argument(
        "a nonlinear rail under axial force wants both ends held, "
        "clamped where the reference line is off the centroid");
  const int rail_unknowns = 9 * track.nodes() * track.rails;
  const int unknowns = track.sleeper ? number_sleepers(rail_unknowns) : rail_unknowns;
  structure_.rest = Eigen::VectorXd::Zero(unknowns);
  structure_.held.assign(index(unknowns), false);
  lay_rails();
  for (int seat = 0; seat <= track.bays; ++seat) {
    for (int rail = 0; rail < track.rails; ++rail) add_seat(rail, seat);
    if (track.sleeper) add_ballast(seat);
  }
}

/// Numbers what the sleepers carry, as assemble() does; returns the number of all unknowns.
int TrackStructure::number_sleepers(int count) {
  const auto& ballast = track_.sleeper->ballast_stiffness;
  for (int rail = 0; rail < track_.rails; ++rail)
    sleeper_[index(rail)].assign(index(track_.bays + 1), {-1, -1, -1});
  for (std::size_t seat = 0; seat < sleeper_[0].size(); ++seat) {
    if (ballast[1] > 0.) {
      for (int rail = 0; rail < track_.rails; ++rail) sleeper_[index(rail)][seat][1] = count;
      ++count;
    }
    for (int rail = 0; rail < track_.rails; ++rail) {
      if (ballast[0] > 0.) sleeper_[index(rail)][seat][0] = count++;
      sleeper_[index(rail)][seat][2] = count++;
    }
  }
  return count;
}

void TrackStructure::lay_rails() {
  structure_.laws = {beam_element(track_.law(), straight_nodes(track_.element_length()))};
  for (int rail = 0; rail < track_.rails; ++rail) {
    const double y = track_.rails == 1 ? 0. : (rail == 0 ? .5 : -.5) * track_.rail_spacing;
    for (int node = 0; node < track_.nodes(); ++node) {
      structure_.rest[place(rail, node, 0)] = .5 * node * track_.element_length();
      structure_.rest[place(rail, node, 1)] = y;
      structure_.rest[place(rail, node, 4)] = structure_.rest[place(rail, node, 8)] = 1.;
      for (int k = 0; k < 9; ++k)
        structure_.held[index(place(rail, node, k))] = holds(track_, node, k);
    }
    for (const Structure::Element& element : chain(track_.elements(), rail * track_.nodes()))
      structure_.elements.push_back(element);
  }
}

/// The springs of one rail on its seat. The top of a rigid sleeper under two rails, y beside the
/// middle of its left or right end, rises by z_end + y (z_left - z_right)/g.
void TrackStructure::add_seat(int rail, int seat) {
  const Support& support = track_.support;
  const int border = seat * 2 * track_.elements_per_bay, n = structure_.unknowns();
  const bool on_sleeper = track_.sleeper.has_value(), rolls = on_sleeper && track_.rails == 2;
  const double g = track_.rail_spacing;
  const std::array<int, 3> none = {-1, -1, -1};
  const std::array<int, 3>& sleeper = on_sleeper ? sleeper_[index(rail)][index(seat)] : none;
  const int left = rolls ? sleeper_[0][index(seat)][2] : -1;
  const int right = rolls ? sleeper_[1][index(seat)][2] : -1;
  const auto add = [&](double stiffness, const std::vector<std::pair<int, double>>& entries) {
    if (stiffness > 0.) structure_.springs.push_back({row_of(n, entries), stiffness});
  };
  for (const double side : {-1., 1.}) {
    const double y = side * support.half_spread;
    for (int d = 0; d < 3; ++d) {
      std::vector<std::pair<int, double>> gap = {{place(rail, border, d), 1.},
                                                 {place(rail, border, 3 + d), y},
                                                 {place(rail, border, 6 + d), support.height_z},
                                                 {sleeper[index(d)], -1.}};
      if (d == 2) gap.insert(gap.end(), {{left, -y / g}, {right, y / g}});
      add(support.stiffness[index(d)] / 2., gap);
    }
  }
  add(support.roll_stiffness, {{place(rail, border, 5), .5},
                               {place(rail, border, 7), -.5},
                               {left, -1. / g},
                               {right, 1. / g}});
}

void TrackStructure::add_ballast(int seat) {
  for (int rail = 0; rail < track_.rails; ++rail)
    for (int d = 0; d < 3; ++d) {
      const int unknown = sleeper_[index(rail)][index(seat)][index(d)];
      const double stiffness = track_.sleeper->ballast_stiffness[index(d)];
      if (unknown >= 0 && stiffness > 0.)
        structure_.springs.push_back({row_of(structure_.unknowns(), {{unknown, 1.}}), stiffness});
    }
}

Sparse TrackStructure::row(const RailPoint& point) const {
  const auto [element, xi] = place_on(track_, point.x);
  const Vector27 local = point_row(xi, point.y, point.z, point.direction);
  Sparse row(structure_.unknowns());
  for (int i = 0; i < 27; ++i)
    if (local[i] != 0.) row.coeffRef(place(point.rail, 2 * element + i / 9, i % 9)) += local[i];
  return row;
}

Sparse TrackStructure::row(const Functional& functional) const {
  Sparse sum(structure_.unknowns());
  for (const Functional::OnRail& term : functional.rail) sum += term.factor * row(term.at);
  for (const Functional::OnSleeper& term : functional.sleeper) {
    const int unknown = sleeper_[index(term.rail)][index(term.seat)][index(term.direction)];
    if (unknown >= 0) sum.coeffRef(unknown) += term.factor;
  }
  return sum;
}

TrackState TrackStructure::state(const Eigen::VectorXd& q) const {
  const Eigen::VectorXd change = q - structure_.rest;
  TrackState state{change.head(9 * track_.nodes()), Eigen::VectorXd(3 * sleeper_[0].size())};
  for (int node = 0; node < track_.nodes(); ++node)
    for (const int sideways : {1, 3, 5, 7}) state.rail[9 * node + sideways] = 0.;
  Eigen::Index i = 0;
  for (const auto& unknowns : sleeper_[0])
    for (const std::size_t d : {0UL, 1UL, 2UL}) {
      state.sleeper[i++] = unknowns[d] >= 0 && d != 1 ? change[unknowns[d]] : 0.;
    }
  return state;
}

Eigen::VectorXd TrackStructure::weight(double gravity) const {
  const ElementMatrices element =
      element_matrices(track_.section, track_.law(), track_.element_length());
  const double line_weight = track_.material.density * track_.section.area * gravity;
  Eigen::VectorXd force = Eigen::VectorXd::Zero(structure_.unknowns());
  for (int rail = 0; rail < track_.rails; ++rail) {
    for (int e = 0; e < track_.elements(); ++e)
      for (int i = 0; i < 27; ++i)
        force[place(rail, 2 * e + i / 9, i % 9)] -= line_weight * element.line_load[i];
    for (const auto& sleeper : sleeper_[index(rail)])
      force[sleeper[2]] -= track_.sleeper->mass / 2. * gravity;
  }
  return force;
}

}  // namespace railstep
