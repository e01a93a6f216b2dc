#include "offline/beam/track_structure.h"

#include <utility>

#include "offline/element/shape.h"
#include "offline/math/refuse.h"
#include "offline/track/fixed_port.h"
#include "offline/track/pad.h"

namespace railstep {
namespace {

using SparseRow = Eigen::SparseVector<double>;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

using Entries = std::vector<std::pair<int, double>>;  // unknown, -1 where held; coefficient

/// A row of coefficients; what is held is left out.
SparseRow row_of(int unknowns, const Entries& entries) {
  SparseRow row(unknowns);
  for (const auto& [unknown, factor] : entries)
    if (unknown >= 0 && factor != 0.) row.coeffRef(unknown) += factor;
  return row;
}

}  // namespace

TrackStructure::TrackStructure(const Track& track) : track_(track) {
  if (track.unknowns != Unknowns::full)
    refuse("E-NONLINEAR-03", "a nonlinear rail moves in space; expected track.unknowns = \"full\"");
  if (!track.section.moments || (track.right && !track.right->section.moments))
    refuse("E-NONLINEAR-04",
           "a nonlinear rail needs the moments of its section to degree 4; expected a section with "
           "a shape, not constants");
  if (track.bays < 1 || track.elements_per_bay < 1)
    refuse("E-TRACK-04", "the track has no bay or no element in a bay; expected 1 or more of each");
  if (!fixed_ports(track).empty())
    refuse("E-NONLINEAR-06",
           "a rail that is nonlinear, or linearised under its weight, stands on seats that press "
           "and pull; expected a track without gap_m, unilateral and [[stop]]");
  if (!track.joints.empty())
    refuse("E-NONLINEAR-07",
           "a nonlinear rail has no joints; expected track.model = \"linearised\"");
  // A pin off the centroid does not hold the moment of a force through it.
  const auto held = [&](RailEnd end) {
    return end == RailEnd::clamped || (end == RailEnd::pinned && track.axis_z == 0.);
  };
  const bool has_axial_force =
      track.axial_force != 0. || (track.right && track.right->axial_force != 0.);
  if (has_axial_force && !(held(track.ends[0]) && held(track.ends[1])))
    refuse("E-NONLINEAR-08",
           "a nonlinear rail under axial force has an end that is not held; expected both ends "
           "held in track.ends, and clamped where the reference line is off the centroid");
  const int rail_unknowns = 9 * track.nodes() * track.rails;
  const int unknowns = number_sleepers(rail_unknowns);
  structure_.rest = Eigen::VectorXd::Zero(unknowns);
  structure_.held.assign(index(unknowns), false);
  lay_rails();
  for (int seat = 0; seat <= track.bays; ++seat) {
    for (int rail = 0; rail < track.rails; ++rail) add_seat(rail, seat);
    add_ballast(seat);
  }
}

/// Numbers what the sleepers carry, as assemble() does; returns the number of all unknowns.
int TrackStructure::number_sleepers(int count) {
  for (int rail = 0; rail < track_.rails; ++rail)
    sleeper_[index(rail)].assign(index(track_.bays + 1), {-1, -1, -1, -1});
  for (int seat = 0; seat <= track_.bays; ++seat) {
    const std::optional<SleeperBody> body = track_.seat(seat).sleeper;
    if (!body) continue;
    for (const std::size_t shared : {1UL, 3UL}) {
      if (!body->moves[shared == 1 ? 1 : 2]) continue;
      for (int rail = 0; rail < track_.rails; ++rail)
        sleeper_[index(rail)][index(seat)][shared] = count;
      ++count;
    }
    for (int rail = 0; rail < track_.rails; ++rail) {
      if (body->moves[0]) sleeper_[index(rail)][index(seat)][0] = count++;
      sleeper_[index(rail)][index(seat)][2] = count++;
    }
  }
  return count;
}

void TrackStructure::lay_rails() {
  const Vector27 element_rest = straight_nodes(track_.element_length());
  structure_.laws = {beam_element(track_.law(0), element_rest)};
  if (track_.right) structure_.laws.push_back(beam_element(track_.law(1), element_rest));
  for (int rail = 0; rail < track_.rails; ++rail) {
    const double y = track_.rails == 1 ? 0. : (rail == 0 ? .5 : -.5) * track_.rail_spacing;
    for (int node = 0; node < track_.nodes(); ++node) {
      const double at[3] = {.5 * node * track_.element_length(), y, 0.};
      to_rail(track_.lean(rail), at, structure_.rest.data() + place(rail, node, 0));
      structure_.rest[place(rail, node, 4)] = structure_.rest[place(rail, node, 8)] = 1.;
      for (int k = 0; k < 9; ++k)
        structure_.held[index(place(rail, node, k))] = is_held(track_, node, k);
    }
    const int law = track_.right ? rail : 0;
    for (const Structure::Element& element : chain(track_.elements(), rail * track_.nodes(), law))
      structure_.elements.push_back(element);
  }
}

/// The springs of one rail on its seat, along the rail's axes. The top of a rigid sleeper under two
/// rails, y beside the middle of its left or right end, moves along d = x or z of the track by
/// u_end + y (u_left - u_right)/g.
void TrackStructure::add_seat(int rail, int seat) {
  const Seat there = track_.seat(seat);
  const Support& support = there.pad[index(rail)];
  const bool rotates = there.sleeper && track_.rails == 2;
  const double g = track_.rail_spacing;
  const std::array<int, 4>& sleeper = sleeper_[index(rail)][index(seat)];
  const Cant cant = track_.lean(rail);
  // The parts along d of the rail of the sleeper's motions along x, y, z.
  const double along[3][3] = {
      {1., 0., 0.}, {0., cant.cosine, cant.sine}, {0., -cant.sine, cant.cosine}};
  const auto end = [&](int side, int d) {
    return rotates ? sleeper_[index(side)][index(seat)][index(d)] : -1;
  };
  const auto add = [&](double stiffness, const Entries& entries) {
    if (stiffness > 0.)
      structure_.springs.push_back({row_of(structure_.unknowns(), entries), stiffness});
  };
  for (const PadPoint& at : pad_points(track_, seat, support.length)) {
    const auto n = shape(at.xi);
    const auto rail_moves = [&](int k, double factor, Entries& to) {
      for (int i = 0; i < 3; ++i)
        to.emplace_back(place(rail, 2 * at.element + i, k), factor * n[index(i)]);
    };
    for (const double side : {-1., 1.}) {
      const double y = side * support.half_spread;
      const double aside = cant.cosine * y - cant.sine * support.height_z;
      for (int d = 0; d < 3; ++d) {
        Entries gap;
        for (int own = 0; own < 3; ++own) gap.emplace_back(sleeper[index(own)], -along[d][own]);
        rail_moves(d, 1., gap);
        rail_moves(3 + d, y, gap);
        rail_moves(6 + d, support.height_z, gap);
        for (const int own : {0, 2})
          gap.insert(gap.end(), {{end(0, own), -along[d][own] * aside / g},
                                 {end(1, own), along[d][own] * aside / g}});
        gap.emplace_back(sleeper[3], along[d][2] * at.offset);
        add(at.part * support.stiffness[index(d)] / 2., gap);
      }
    }
    Entries roll = {{end(0, 2), -1. / g}, {end(1, 2), 1. / g}};
    rail_moves(5, .5, roll);
    rail_moves(7, -.5, roll);
    add(at.part * support.roll_stiffness, roll);
  }
}

void TrackStructure::add_ballast(int seat) {
  const Seat there = track_.seat(seat);
  for (int rail = 0; rail < track_.rails; ++rail)
    for (std::size_t d = 0; d < 4; ++d) {
      const Ballast& ballast = there.ballast[index(rail)];
      const int unknown = sleeper_[index(rail)][index(seat)][d];
      const double stiffness = d < 3 ? ballast.stiffness[d]
                                     : ballast.stiffness[2] * ballast.length * ballast.length / 12.;
      if (unknown >= 0 && stiffness > 0.)
        structure_.springs.push_back({row_of(structure_.unknowns(), {{unknown, 1.}}), stiffness});
    }
}

SparseRow TrackStructure::row(const RailPoint& point) const {
  const auto [element, xi] = place_on(track_, point.x);
  const Vector27 local = rail_row(track_.lean(point.rail), xi, point.y, point.z, point.direction);
  SparseRow row(structure_.unknowns());
  for (int i = 0; i < 27; ++i)
    if (local[i] != 0.) row.coeffRef(place(point.rail, 2 * element + i / 9, i % 9)) += local[i];
  return row;
}

SparseRow TrackStructure::row(const Functional& functional) const {
  SparseRow sum(structure_.unknowns());
  for (const Functional::OnRail& term : functional.rail) sum += term.factor * row(term.at);
  for (const Functional::OnSleeper& term : functional.sleeper) {
    const int unknown = sleeper_[index(term.rail)][index(term.seat)][index(term.direction)];
    if (unknown >= 0) sum.coeffRef(unknown) += term.factor;
  }
  return sum;
}

TrackState TrackStructure::state(const Eigen::VectorXd& q) const {
  const Eigen::VectorXd change = q - structure_.rest;
  const bool symmetric = is_symmetric(track_);
  TrackState state;
  for (int rail = 0; rail < track_.rails; ++rail) {
    const int own_rail = symmetric ? 0 : rail;
    Eigen::VectorXd& own = state.rail[index(rail)];
    own = change.segment(place(own_rail, 0, 0), 9 * track_.nodes());
    const double mirrored = track_.cant == 0. ? 0. : rail == 0 ? 1. : -1.;
    for (int node = 0; node < track_.nodes() && symmetric; ++node)
      for (const int sideways : {1, 3, 5, 7}) own[9 * node + sideways] *= mirrored;
    Eigen::VectorXd& ends = state.sleeper[index(rail)];
    ends = Eigen::VectorXd::Zero(4 * (track_.bays + 1));
    Eigen::Index i = 0;
    for (const auto& unknowns : sleeper_[index(own_rail)])
      for (const std::size_t d : {0UL, 1UL, 2UL, 3UL}) {
        if (unknowns[d] >= 0 && !(symmetric && d == 1)) ends[i] = change[unknowns[d]];
        ++i;
      }
  }
  return state;
}

Eigen::VectorXd TrackStructure::weight(double gravity) const {
  Eigen::VectorXd force = Eigen::VectorXd::Zero(structure_.unknowns());
  for (int rail = 0; rail < track_.rails; ++rail) {
    const RailBar bar = track_.bar(rail);
    const Vector27 load = line_load(track_, rail);
    const double line_weight = bar.material.density * bar.section.area * gravity;
    for (int e = 0; e < track_.elements(); ++e)
      for (int i = 0; i < 27; ++i)
        force[place(rail, 2 * e + i / 9, i % 9)] -= line_weight * load[i];
    for (int seat = 0; seat <= track_.bays; ++seat)
      if (const int height = sleeper_[index(rail)][index(seat)][2]; height >= 0)
        force[height] -= track_.seat(seat).sleeper->mass / 2. * gravity;
  }
  return force;
}

}  // namespace railstep
