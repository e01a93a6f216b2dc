#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "offline/math/refuse.h"
#include "offline/track/assembly.h"
#include "offline/track/end_zone.h"
#include "offline/track/fixed_port.h"
#include "offline/track/track.h"

namespace railstep {

namespace {

std::vector<int> carried(Unknowns unknowns) {
  if (unknowns == Unknowns::vertical) return {2, 6};
  if (unknowns == Unknowns::in_plane) return {0, 2, 4, 6, 8};
  if (unknowns == Unknowns::rigid_section) return {0, 1, 2, 3, 5, 6};
  return {0, 1, 2, 3, 4, 5, 6, 7, 8};
}

/// Numbers the motions of a seat's sleeper in a part. Mirrored lateral motions cancel in a rigid
/// sleeper: it stands still in the symmetric part; the sleeper of a single rail does not rotate.
void number_sleeper(const Track& track, int border, Assembly& part) {
  const Seat seat = track.seat(border);
  const auto& body = seat.sleeper;
  if (!body) return;
  auto& sleeper = part.line.sleeper_unknown_of[static_cast<std::size_t>(border)];
  const bool space = moves_sideways(track.unknowns);
  const bool along_x = space && body->moves[0], along_y = space && body->moves[1];
  const bool means = part.mirror != Mirror::antisymmetric;
  const bool rotates = part.mirror == Mirror::antisymmetric || part.rails.size() == 2;
  if (along_x && means) sleeper[kAlongX] = part.count++;
  if (along_x && rotates) sleeper[kYaw] = part.count++;
  if (body->moves[2] && means) sleeper[kPitch] = part.count++;
  if (along_y && part.mirror != Mirror::symmetric) sleeper[kAlongY] = part.count++;
  if (means) sleeper[kAlongZ] = part.count++;
  if (rotates) sleeper[kRoll] = part.count++;
  for (const int rail : part.rails) {
    const auto side = static_cast<std::size_t>(rail);
    if (seat.ballast[side].relaxing.damping == 0.) continue;
    sleeper[kRelaxing + side] = part.count++;
    if (sleeper[kPitch] >= 0 && seat.ballast[side].length > 0.)
      sleeper[kRelaxingPitch + side] = part.count++;
  }
}

/// Numbers nodes along x, both rails' in turns, and a seat's sleeper behind its nodes, so that the
/// band stays narrow.
void number(const Track& track, Assembly& part) {
  const int nodes = track.nodes(), per_bay = 2 * track.elements_per_bay;
  for (Line::RailUnknowns& table : part.line.unknown_of)
    table.assign(static_cast<std::size_t>(nodes), {-1, -1, -1, -1, -1, -1, -1, -1, -1});
  part.line.sleeper_unknown_of.assign(static_cast<std::size_t>(track.bays) + 1, kHeldSleeper);
  for (int node = 0; node < nodes - (track.ring ? 1 : 0); ++node) {
    for (const int rail : part.rails) {
      for (const int k : carried(track.unknowns))
        if (!is_held(track, node, k))
          part.line.unknown_of[static_cast<std::size_t>(rail)][static_cast<std::size_t>(node)]
                              [static_cast<std::size_t>(k)] = part.count++;
    }
    if (part.line.rigid_section)
      for (Line::RailUnknowns& table : part.line.unknown_of)
        table[static_cast<std::size_t>(node)][7] = table[static_cast<std::size_t>(node)][5];
    for (const int rail : part.rails) number_cut(track, part, rail, node);
    if (node % per_bay == 0) number_sleeper(track, node / per_bay, part);
  }
  if (!track.ring) return;
  for (Line::RailUnknowns& table : part.line.unknown_of) table.back() = table.front();
  part.line.sleeper_unknown_of.back() = part.line.sleeper_unknown_of.front();
}

/// K_r of Eq. 24 of one element in the track's state.
Matrix27 stiffness_at(const Track& track, const TrackState& state, int rail, int element) {
  const Vector27 rest = straight_nodes(track.element_length());
  const Vector27 q = rest + state.rail[static_cast<std::size_t>(rail)].segment<27>(18 * element);
  Matrix27 K;
  Vector27 force;
  beam_tangent(beam_element(track.law(rail), rest), q.data(), force.data(), K.data());
  return K;
}

void add_elements(const Track& track, int rail, Assembly& part) {
  ElementMatrices element =
      element_matrices(track.bar(rail).section, track.law(rail), track.element_length());
  for (int e = 0; e < track.elements(); ++e) {
    if (track.state) element.stiffness = stiffness_at(track, *track.state, rail, e);
    const double taken = end_damping_rate(track, rail, e);
    std::array<int, 27> place;
    for (int i = 0; i < 27; ++i)
      place[static_cast<std::size_t>(i)] = part.line.element_unknown(rail, e, i / 9, i % 9);
    for (int j = 0; j < 27; ++j)
      for (int i = 0; i < 27; ++i) {
        const int row = place[static_cast<std::size_t>(i)],
                  column = place[static_cast<std::size_t>(j)];
        if (row < 0 || column < 0) continue;
        const double sign = sign_of(part.line, 0, i % 9) * sign_of(part.line, 0, j % 9);
        if (element.mass(i, j) != 0.)
          part.mass.emplace_back(row, column, sign * element.mass(i, j));
        if (element.stiffness(i, j) != 0.)
          part.stiffness.emplace_back(row, column, sign * element.stiffness(i, j));
        if (taken * element.mass(i, j) == 0.) continue;
        part.end_damping.emplace_back(row, column, sign * taken * element.mass(i, j));
        part.damping.push_back(part.end_damping.back());
      }
  }
}

/// Only the first node of each piece between cuts is held. If all were, a rail that a force
/// lengthens would strain these springs, the more the longer it is.
void hold_along(const Track& track, int rail, Assembly& part) {
  for (int node = 0; node < track.nodes(); ++node) {
    const int own = part.line.unknown(rail, node, 0),
              ahead = part.line.unknown_ahead(rail, node, 0);
    if (node == 0 || ahead != own)
      Assembly::add(part.stiffness, {{ahead, 1.}}, ahead < 0 ? 0. : track.hold_along);
  }
}

Assembly assemble_part(const Track& track, Mirror mirror, std::vector<int> rails) {
  Assembly part{mirror, std::move(rails)};
  part.line.rigid_section = track.unknowns == Unknowns::rigid_section;
  number(track, part);
  for (const int rail : part.rails) {
    add_elements(track, rail, part);
    add_joints(track, part, rail);
    hold_along(track, rail, part);
  }
  for (int seat = 0; seat < track.seats(); ++seat) add_seat(track, part, seat);
  if (mirror != Mirror::none) {
    part.line.unknown_of[1] = part.line.unknown_of[0];
    part.line.cuts[1] = part.line.cuts[0];
  }
  return part;
}

int root(std::vector<int>& parent, int i) {
  while (parent[static_cast<std::size_t>(i)] != i) {
    int& up = parent[static_cast<std::size_t>(i)];
    up = parent[static_cast<std::size_t>(up)];
    i = up;
  }
  return i;
}

/// Number of the independent component of each unknown, in order of first appearance.
std::pair<std::vector<int>, int> components(const Assembly& part) {
  std::vector<int> parent(static_cast<std::size_t>(part.count));
  std::iota(parent.begin(), parent.end(), 0);
  for (const auto* entries : {&part.mass, &part.damping, &part.stiffness})
    for (const Eigen::Triplet<double>& t : *entries) {
      const int a = root(parent, t.row()), b = root(parent, t.col());
      parent[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
    }
  std::vector<int> number(parent.size(), -1);
  int count = 0;
  for (int i = 0; i < part.count; ++i) {
    const std::size_t r = static_cast<std::size_t>(root(parent, i));
    if (number[r] < 0) number[r] = count++;
    number[static_cast<std::size_t>(i)] = number[r];
  }
  return {number, count};
}

Eigen::SparseMatrix<double> select(const Assembly::Triplets& entries, const std::vector<int>& place,
                                   int n) {
  Assembly::Triplets chosen;
  for (const Eigen::Triplet<double>& t : entries) {
    const int i = place[static_cast<std::size_t>(t.row())];
    const int j = place[static_cast<std::size_t>(t.col())];
    if (i >= 0 && j >= 0) chosen.emplace_back(i, j, t.value());
  }
  Eigen::SparseMatrix<double> result(n, n);
  result.setFromTriplets(chosen.begin(), chosen.end());
  return result;
}

template <std::size_t N>
void renumber(std::array<int, N>& unknowns, const std::vector<int>& place) {
  for (int& u : unknowns)
    if (u >= 0) u = place[static_cast<std::size_t>(u)];
}

template <std::size_t N>
void renumber(std::vector<std::array<int, N>>& table, const std::vector<int>& place) {
  for (auto& unknowns : table) renumber(unknowns, place);
}

bool carries(const Line::RailUnknowns& table) {
  return std::any_of(table.begin(), table.end(), [](const std::array<int, 9>& node) {
    return std::any_of(node.begin(), node.end(), [](int unknown) { return unknown >= 0; });
  });
}

void split(const Assembly& part, std::array<double, 2> factor, std::vector<Line>& lines) {
  const auto [component, count] = components(part);
  for (int c = 0; c < count; ++c) {
    std::vector<int> place(component.size(), -1);
    int n = 0;
    for (std::size_t i = 0; i < place.size(); ++i)
      if (component[i] == c) place[i] = n++;
    Line line = part.line;
    line.mass = select(part.mass, place, n);
    line.damping = select(part.damping, place, n);
    line.end_damping = select(part.end_damping, place, n);
    line.stiffness = select(part.stiffness, place, n);
    line.mirrored = part.mirror != Mirror::none;
    renumber(line.sleeper_unknown_of, place);
    for (const std::size_t rail : {0u, 1u}) {
      renumber(line.unknown_of[rail], place);
      for (auto& [node, ahead] : line.cuts[rail]) renumber(ahead, place);
      line.rail_factor[rail] = carries(line.unknown_of[rail]) ? factor[rail] : 0.;
    }
    lines.push_back(std::move(line));
  }
}

/// Checks the one-sided pad and ballast on one side of a seat.
void check_one_sided(const Seat& seat, std::size_t side) {
  const Support& pad = seat.pad[side];
  const Ballast& ballast = seat.ballast[side];
  if (!(pad.gap >= 0.) || !(ballast.gap >= 0.))
    refuse("E-TRACK-01", "a gap under a rail is negative; expected 0 m or more");
  if (pad.one_sided() && pad.length > 0.)
    refuse("E-TRACK-14",
           "support.unilateral and support.gap_m need a pad that is a point; expected "
           "support.length_m = 0");
  if (!seat.sleeper || !ballast.one_sided()) return;
  if (ballast.length > 0.)
    refuse("E-TRACK-15",
           "ballast.unilateral and ballast.gap_m need ballast that is a point; expected a length "
           "of 0");
  if (pad.one_sided() && seat.sleeper->mass == 0.)
    refuse("E-TRACK-16",
           "nothing holds a sleeper of 0 kg while both its pad and its ballast are open; expected "
           "sleeper.mass_kg above 0, or a pad or ballast that pulls too");
}

void check_stop(const Track& track, const Stop& stop) {
  if (stop.rail < 0 || stop.rail >= track.rails)
    refuse("E-TRACK-02", "a stop names a rail that the track does not have");
  if (stop.direction != 1 && stop.direction != 2)
    refuse("E-TRACK-17", "a stop does not act along y or z; expected direction 1 or 2");
  if (std::abs(stop.side) != 1. || !(stop.gap >= 0.))
    refuse("E-TRACK-18",
           "the side or the gap of a stop is out of range; expected a side of 1 or -1 and a gap of "
           "0 m or more");
  if (!(stop.stiffness >= 0.) || !(stop.damping >= 0.))
    refuse("E-TRACK-19", "the stiffness or the damping of a stop is negative; expected 0 or more");
}

void check_ring(const Track& track) {
  if (track.bays < 3)
    refuse("E-TRACK-03",
           "the ring of a track without end has fewer than three bays; expected 3 or more");
  if (track.ends != RailEnds{})
    refuse("E-TRACK-20", "a track without end has no ends to hold; leave out the ends");
  if (!track.changed_seats.empty())
    refuse("E-TRACK-21", "the seats of a track without end differ; expected equal seats");
  if (track.support.length != 0.)
    refuse("E-TRACK-22",
           "the pads of a track without end have a length; expected support.length_m = 0");
  if (!track.joints.empty())
    refuse("E-TRACK-23", "the rails of a track without end have joints; expected none");
  if (!fixed_ports(track).empty())
    refuse("E-TRACK-24",
           "a track without end has one-sided supports or stops; expected seats that press and "
           "pull, and no stops");
  if (track.state)
    refuse("E-TRACK-25",
           "a track without end cannot be linearised under its weight; expected it at rest");
}

void check(const Track& track) {
  if (track.bays < 1 || track.elements_per_bay < 1)
    refuse("E-TRACK-04", "the track has no bay or no element in a bay; expected 1 or more of each");
  if (track.rails != 1 && track.rails != 2)
    refuse("E-TRACK-26", "the number of rails is not 1 or 2");
  if (!(track.bay_length > 0.) || !(track.rail_spacing > 0.))
    refuse("E-TRACK-27",
           "the bay length or the rail spacing is not positive; expected both above 0 m");
  if (!(std::abs(track.cant) <= 1.))
    refuse("E-TRACK-28", "the cant of the rails is steeper than 1:1; expected -1 to 1");
  if (track.cant != 0. && !moves_sideways(track.unknowns))
    refuse("E-TRACK-29",
           "a rail with cant moves sideways under a vertical force; expected track.unknowns = "
           "\"full\" or \"rigid-section\"");
  check_joints(track);
  if (end_zones(track) * track.end_zone_bays > track.bays)
    refuse("E-TRACK-30",
           "the zones of the non-reflecting ends do not fit on the track; expected more bays or "
           "shorter zones");
  if (track.ring) check_ring(track);
  for (const auto& [border, seat] : track.changed_seats)
    if (border < 0 || border > track.bays)
      refuse("E-TRACK-31", "a changed seat does not stand at a bay border of the track");
  for (int border = 0; border <= track.bays; ++border)
    for (const Support& pad : track.seat(border).pad)
      if (!(pad.length >= 0.) || pad.length > track.bay_length)
        refuse("E-TRACK-32",
               "the length of a pad is out of range; expected 0 to the length of a bay");
  for (int border = 0; border <= track.bays; ++border)
    for (std::size_t side = 0; side < static_cast<std::size_t>(track.rails); ++side)
      check_one_sided(track.seat(border), side);
  for (const Stop& stop : track.stops) check_stop(track, stop);
}

}  // namespace

Seat Track::seat(int border) const {
  const auto changed = changed_seats.find(border);
  return changed == changed_seats.end() ? seat_of(support, sleeper) : changed->second;
}

bool has_sleepers(const Track& track) {
  for (int border = 0; border <= track.bays; ++border)
    if (track.seat(border).sleeper) return true;
  return false;
}

bool is_symmetric(const Track& track) {
  const auto alike = [](const RailJoint& joint) {
    return joint.rails[0] == joint.rails[1] && joint.gap[0] == joint.gap[1] &&
           joint.end_force[0] == joint.end_force[1];
  };
  return !track.right && std::all_of(track.joints.begin(), track.joints.end(), alike) &&
         std::all_of(track.changed_seats.begin(), track.changed_seats.end(),
                     [](const auto& changed) { return changed.second.symmetric(); });
}

bool is_held(const Track& track, int node, int k) {
  const bool position = k < 3, roll = k == 5 || k == 7;  // a_z, b_y
  const RailEnd end = node == 0                   ? track.ends[0]
                      : node == track.nodes() - 1 ? track.ends[1]
                                                  : RailEnd::free;
  return end == RailEnd::clamped || (end == RailEnd::pinned && (position || roll));
}

ElementPlace place_on(const Track& track, double x) {
  const double place = x / track.element_length();
  if (!(place >= 0.) || !(place <= track.elements() * (1. + 1e-12)))
    refuse("E-TRACK-05", "the point x = " + std::to_string(x) +
                             " m is off the rail; expected 0 to " + std::to_string(track.length()) +
                             " m");
  const int element = std::min(static_cast<int>(place), track.elements() - 1);
  return {element, 2. * (place - element) - 1.};
}

std::vector<Line> assemble(const Track& track) {
  check(track);
  std::vector<Line> lines;
  if (track.rigid) return lines;
  if (track.rails == 1) {
    split(assemble_part(track, Mirror::none, {0}), {1., 0.}, lines);
  } else if (!has_sleepers(track)) {
    split(assemble_part(track, Mirror::none, {0}), {1., 0.}, lines);
    split(assemble_part(track, Mirror::none, {1}), {0., 1.}, lines);
  } else if (track.mirror_coordinates && is_symmetric(track)) {
    const double half = std::sqrt(.5);
    split(assemble_part(track, Mirror::symmetric, {0}), {half, half}, lines);
    split(assemble_part(track, Mirror::antisymmetric, {0}), {half, -half}, lines);
  } else {
    split(assemble_part(track, Mirror::none, {0, 1}), {1., 1.}, lines);
  }
  return lines;
}

}  // namespace railstep
