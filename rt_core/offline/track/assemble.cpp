#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "offline/track/track.h"

namespace railstep {

namespace {

using Triplet = Eigen::Triplet<double>;
using Row = std::vector<std::pair<int, double>>;  // unknown, coefficient

/// How a line stands to the rails: itself, or the symmetric or antisymmetric mirror coordinate.
enum class Mirror { none, symmetric, antisymmetric };

/// A part of the track before it is split: numbering and entries.
struct Assembly {
  Mirror mirror;
  Line line;
  int count = 0;
  std::vector<Triplet> mass, damping, stiffness;

  void add(std::vector<Triplet>& to, const Row& row, double factor) {
    if (factor == 0.) return;
    for (const auto& [i, a] : row)
      for (const auto& [j, b] : row)
        if (a * b != 0.) to.emplace_back(i, j, factor * a * b);
  }
};

std::vector<int> carried(Unknowns unknowns) {
  if (unknowns == Unknowns::vertical) return {2, 6};
  return {0, 1, 2, 3, 4, 5, 6, 7, 8};
}

/// Numbers nodes along x; a seat's sleeper follows its node so that the band stays narrow.
void number(const Track& track, Assembly& part) {
  const int nodes = track.nodes(), per_bay = 2 * track.elements_per_bay;
  part.line.unknown_of.assign(static_cast<std::size_t>(nodes),
                              {-1, -1, -1, -1, -1, -1, -1, -1, -1});
  part.line.sleeper_unknown_of.assign(static_cast<std::size_t>(track.bays) + 1, {-1, -1, -1});
  for (int node = 0; node < nodes; ++node) {
    for (const int k : carried(track.unknowns))
      if (!holds(track, node, k))
        part.line.unknown_of[static_cast<std::size_t>(node)][static_cast<std::size_t>(k)] =
            part.count++;
    if (!track.sleeper || node % per_bay != 0) continue;
    auto& sleeper = part.line.sleeper_unknown_of[static_cast<std::size_t>(node / per_bay)];
    const bool full = track.unknowns == Unknowns::full;
    if (full && track.sleeper->ballast_stiffness[0] > 0.) sleeper[0] = part.count++;
    // Mirrored lateral motions cancel in a rigid sleeper: it stands still in the symmetric part.
    if (full && track.sleeper->ballast_stiffness[1] > 0. && part.mirror != Mirror::symmetric)
      sleeper[1] = part.count++;
    sleeper[2] = part.count++;
  }
}

/// K_r of Eq. 24 of one element where the track stands.
Matrix27 stiffness_at(const Track& track, const TrackState& state, int element) {
  const Vector27 rest = straight_nodes(track.element_length());
  const Vector27 q = rest + state.rail.segment<27>(18 * element);
  Matrix27 K;
  Vector27 force;
  beam_tangent(beam_element(track.law(), rest), q.data(), force.data(), K.data());
  return K;
}

void add_elements(const Track& track, Assembly& part) {
  ElementMatrices element = element_matrices(track.section, track.law(), track.element_length());
  for (int e = 0; e < track.elements(); ++e) {
    if (track.state) element.stiffness = stiffness_at(track, *track.state, e);
    std::array<int, 27> place;
    for (int i = 0; i < 27; ++i)
      place[static_cast<std::size_t>(i)] = part.line.unknown(2 * e + i / 9, i % 9);
    for (int j = 0; j < 27; ++j)
      for (int i = 0; i < 27; ++i) {
        const int row = place[static_cast<std::size_t>(i)],
                  column = place[static_cast<std::size_t>(j)];
        if (row < 0 || column < 0) continue;
        if (element.mass(i, j) != 0.) part.mass.emplace_back(row, column, element.mass(i, j));
        if (element.stiffness(i, j) != 0.)
          part.stiffness.emplace_back(row, column, element.stiffness(i, j));
      }
  }
}

void push(Row& row, int unknown, double coefficient) {
  if (unknown >= 0 && coefficient != 0.) row.emplace_back(unknown, coefficient);
}

/// The springs of one rail on its seat, and the sleeper's own mass and ballast. Mirror coordinates
/// s, a = (left +- mirrored right)/sqrt 2 of a rigid sleeper of mass m, roll inertia I and rail
/// spacing g: vertical s with m/2, a = g roll/sqrt 2 with 2I/g^2; lateral a with m/2;
/// along x: s with m/2, a with 2I/g^2.
void add_seat(const Track& track, Assembly& part, int seat) {
  const Support& support = track.support;
  const int border = seat * 2 * track.elements_per_bay;
  const auto& node = part.line.unknown_of[static_cast<std::size_t>(border)];
  const auto& sleeper = part.line.sleeper_unknown_of[static_cast<std::size_t>(seat)];
  const bool antisymmetric = part.mirror == Mirror::antisymmetric;
  const double g = track.rail_spacing, z = support.height_z;
  for (const double side : {-1., 1.}) {
    const double y = side * support.half_spread;
    for (std::size_t d = 0; d < 3; ++d) {
      Row row;
      push(row, node[d], 1.);
      push(row, node[3 + d], y);
      push(row, node[6 + d], z);
      if (d == 2) push(row, sleeper[2], antisymmetric ? -(1. + 2. * y / g) : -1.);
      if (d != 2) push(row, sleeper[d], -1.);
      part.add(part.stiffness, row, support.stiffness[d] / 2.);
      part.add(part.damping, row, support.damping[d] / 2.);
    }
  }
  Row roll;
  push(roll, node[5], .5);
  push(roll, node[7], -.5);
  // Rails without roll unknowns leave the sleeper's roll alone; a rail whose end is held does not.
  if (track.unknowns == Unknowns::full) {
    if (antisymmetric) push(roll, sleeper[2], -2. / g);
    part.add(part.stiffness, roll, support.roll_stiffness);
    part.add(part.damping, roll, support.roll_damping);
  }
  if (!track.sleeper) return;
  for (std::size_t d = 0; d < 3; ++d) {
    if (sleeper[d] < 0) continue;
    const bool turning = antisymmetric && d != 1;
    const Row row = {{sleeper[d], 1.}};
    part.add(part.mass, row,
             turning ? 2. * track.sleeper->roll_inertia / (g * g) : track.sleeper->mass / 2.);
    part.add(part.stiffness, row, track.sleeper->ballast_stiffness[d]);
    part.add(part.damping, row, track.sleeper->ballast_damping[d]);
  }
}

Assembly assemble_part(const Track& track, Mirror mirror) {
  Assembly part{mirror, {}, 0, {}, {}, {}};
  number(track, part);
  add_elements(track, part);
  for (int seat = 0; seat <= track.bays; ++seat) add_seat(track, part, seat);
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
    for (const Triplet& t : *entries) {
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

Eigen::SparseMatrix<double> select(const std::vector<Triplet>& entries,
                                   const std::vector<int>& place, int n) {
  std::vector<Triplet> chosen;
  for (const Triplet& t : entries) {
    const int i = place[static_cast<std::size_t>(t.row())];
    const int j = place[static_cast<std::size_t>(t.col())];
    if (i >= 0 && j >= 0) chosen.emplace_back(i, j, t.value());
  }
  Eigen::SparseMatrix<double> result(n, n);
  result.setFromTriplets(chosen.begin(), chosen.end());
  return result;
}

template <std::size_t N>
void renumber(std::vector<std::array<int, N>>& table, const std::vector<int>& place) {
  for (auto& unknowns : table)
    for (int& u : unknowns)
      if (u >= 0) u = place[static_cast<std::size_t>(u)];
}

void split(const Assembly& part, std::array<double, 2> factor, std::vector<Line>& lines) {
  const auto [component, count] = components(part);
  for (int c = 0; c < count; ++c) {
    std::vector<int> place(component.size(), -1);
    int n = 0;
    for (std::size_t i = 0; i < place.size(); ++i)
      if (component[i] == c) place[i] = n++;
    Line line{select(part.mass, place, n),      select(part.damping, place, n),
              select(part.stiffness, place, n), part.line.unknown_of,
              part.line.sleeper_unknown_of,     factor,
              part.mirror != Mirror::none};
    renumber(line.unknown_of, place);
    renumber(line.sleeper_unknown_of, place);
    lines.push_back(std::move(line));
  }
}

void check(const Track& track) {
  const auto refuse = [](const char* what) { throw std::invalid_argument(what); };
  if (track.bays < 1 || track.elements_per_bay < 1) refuse("a track needs one bay and one element");
  if (track.rails != 1 && track.rails != 2) refuse("a track has one rail or two");
  if (!(track.bay_length > 0.) || !(track.rail_spacing > 0.))
    refuse("bay length and rail spacing are above zero");
}

}  // namespace

bool holds(const Track& track, int node, int k) {
  const bool position = k < 3, roll = k == 5 || k == 7;  // a_z, b_y
  const RailEnd end = node == 0                   ? track.ends[0]
                      : node == track.nodes() - 1 ? track.ends[1]
                                                  : RailEnd::free;
  return end == RailEnd::clamped || (end == RailEnd::pinned && (position || roll));
}

ElementPlace place_on(const Track& track, double x) {
  const double place = x / track.element_length();
  if (!(place >= 0.) || !(place <= track.elements() * (1. + 1e-12)))
    throw std::out_of_range("point off the rail");
  const int element = std::min(static_cast<int>(place), track.elements() - 1);
  return {element, 2. * (place - element) - 1.};
}

std::vector<Line> assemble(const Track& track) {
  check(track);
  std::vector<Line> lines;
  if (track.rails == 2 && track.sleeper) {
    const double half = std::sqrt(.5);
    split(assemble_part(track, Mirror::symmetric), {half, half}, lines);
    split(assemble_part(track, Mirror::antisymmetric), {half, -half}, lines);
  } else {
    const Assembly part = assemble_part(track, Mirror::none);
    split(part, {1., 0.}, lines);
    if (track.rails == 2) split(part, {0., 1.}, lines);
  }
  return lines;
}

Eigen::SparseVector<double> point_row(const Track& track, const Line& line,
                                      const RailPoint& point) {
  const auto [element, xi] = place_on(track, point.x);
  const Vector27 local = point_row(xi, point.y, point.z, point.direction);
  const double factor = line.rail_factor[static_cast<std::size_t>(point.rail)];
  Eigen::SparseVector<double> row(line.unknowns());
  for (int i = 0; i < 27; ++i) {
    const int k = i % 9;
    const int unknown = line.unknown(2 * element + i / 9, k);
    if (unknown < 0 || local[i] == 0. || factor == 0.) continue;
    // The mirrored right rail: its y components (r_y, a_x, a_z, b_y) change sign.
    const bool flips = line.mirrored && point.rail == 1 && (k == 1 || k == 3 || k == 5 || k == 7);
    row.coeffRef(unknown) += factor * (flips ? -local[i] : local[i]);
  }
  return row;
}

namespace {

/// The track's state over the unknowns of one line.
Eigen::VectorXd state_of(const Line& line, const TrackState& state, double both) {
  Eigen::VectorXd u = Eigen::VectorXd::Zero(line.unknowns());
  const auto take = [&](const auto& unknowns, const Eigen::VectorXd& values) {
    Eigen::Index i = 0;
    for (const auto& place : unknowns)
      for (const int unknown : place) {
        if (unknown >= 0) u[unknown] = both * values[i];
        ++i;
      }
  };
  take(line.unknown_of, state.rail);
  if (state.sleeper.size() > 0) take(line.sleeper_unknown_of, state.sleeper);
  return u;
}

}  // namespace

Eigen::VectorXd weight(const Track& track, const Line& line, double gravity) {
  const double both = line.rail_factor[0] + (track.rails == 2 ? line.rail_factor[1] : 0.);
  if (track.state) return line.stiffness * state_of(line, *track.state, both);
  const ElementMatrices element =
      element_matrices(track.section, track.law(), track.element_length());
  const double line_weight = track.material.density * track.section.area * gravity;
  Eigen::VectorXd force = Eigen::VectorXd::Zero(line.unknowns());
  for (int e = 0; e < track.elements(); ++e)
    for (int i = 0; i < 27; ++i) {
      const int unknown = line.unknown(2 * e + i / 9, i % 9);
      if (unknown >= 0) force[unknown] -= both * line_weight * element.line_load[i];
    }
  if (track.sleeper)
    for (const auto& sleeper : line.sleeper_unknown_of)
      if (sleeper[2] >= 0) force[sleeper[2]] -= both * track.sleeper->mass / 2. * gravity;
  return force;
}

}  // namespace railstep
