#pragma once
#include <Eigen/SparseCore>
#include <array>
#include <optional>
#include <vector>

#include "offline/element/matrices.h"

namespace railstep {

/// Which unknowns a node carries: all nine, or [r_z, b_x] for vertical bending alone.
enum class Unknowns { full, vertical };

/// What holds a rail's end node. Pinned: its position (all three), so that the rail carries axial
/// force, and its roll (a_z and b_y); the slopes a_x and b_x of bending stay free. Clamped: all
/// nine.
enum class RailEnd { free, pinned, clamped };

/// The ends of every rail, at x = 0 and at x = length.
using RailEnds = std::array<RailEnd, 2>;

/// Spring-dampers between one rail and what carries it, at each bay border.
struct Support {
  std::array<double, 3> stiffness{};  // x, y, z, N/m
  std::array<double, 3> damping{};    // x, y, z, N s/m
  double roll_stiffness = 0.;         // N m/rad
  double roll_damping = 0.;           // N m s/rad
  double height_z = 0.;               // of the seat above the axis, m
  double half_spread = 0.;            // a pair of half springs at y = +- this, m
};

/// Rigid sleeper under both rails on ballast; it moves vertically and rolls, and moves along x or
/// y only where its ballast has stiffness in that direction (else it is held there).
struct Sleeper {
  double mass = 0.;                           // whole, kg
  double roll_inertia = 0.;                   // about x, also used about z, kg m2
  std::array<double, 3> ballast_stiffness{};  // x, y, z per end, N/m
  std::array<double, 3> ballast_damping{};    // x, y, z per end, N s/m
};

/// Where a track stands under its own weight; all of its rails alike, and none moves sideways.
struct TrackState {
  Eigen::VectorXd rail;     // [9 nodes] change of a rail's unknowns from rest
  Eigen::VectorXd sleeper;  // [3 seats] displacement of the sleepers' ends, m; empty without
  double gravity = 0.;      // of that weight, m/s2
};

/// A straight track of one rail, or of two alike ones, with uniform supports.
struct Track {
  BeamSection section;
  Material material;
  ElementRule rule;
  double axis_z = 0.;       // of the reference line, where the nodes are, above the centroid, m
  double axial_force = 0.;  // of the rails at rest, N, tension positive
  Unknowns unknowns = Unknowns::full;
  int rails = 2;
  int bays = 1;
  double bay_length = .6;  // m
  int elements_per_bay = 2;
  double rail_spacing = 1.5;  // m
  RailEnds ends = {RailEnd::free, RailEnd::free};
  Support support;
  std::optional<Sleeper> sleeper;
  /// Where the stiffness is taken (q_s of Eq. 24); none: at rest. linearised_under_weight() makes
  /// one.
  std::optional<TrackState> state;

  int elements() const { return bays * elements_per_bay; }
  int nodes() const { return 2 * elements() + 1; }
  double element_length() const { return bay_length / elements_per_bay; }
  double length() const { return bays * bay_length; }
  BeamLaw law() const { return beam_law(section, material, rule, axis_z, axial_force); }
};

/// Whether the ends of a rail hold unknown k = 0..8 of its node.
bool holds(const Track& track, int node, int k);

/// An element and the natural coordinate in it.
struct ElementPlace {
  int element;
  double xi;
};

/// Where a place along the rail lies, x in m. Round-off of bay lengths (1e-12) beyond the far end
/// is forgiven. Throws std::out_of_range off the rail.
ElementPlace place_on(const Track& track, double x);

/// A material point of one rail.
struct RailPoint {
  int rail;       // 0 left (+y), 1 right
  double x;       // along the undeformed rail, m
  double y, z;    // over the section, from the axis, m
  int direction;  // 0 x, 1 y, 2 z
};

/// One independent part of the track: M a + C v + K u = f with banded matrices.
///
/// Two rails that share sleepers are taken in mirror coordinates (left +- mirrored right)/sqrt 2;
/// rails that share nothing stand for themselves. Whatever then does not couple (vertical and
/// lateral motion of a section symmetric in y, say) becomes a line of its own.
struct Line {
  Eigen::SparseMatrix<double> mass, damping, stiffness;  // symmetric, both triangles stored
  std::vector<std::array<int, 9>> unknown_of;            // [nodes]; -1 where not carried
  std::vector<std::array<int, 3>> sleeper_unknown_of;    // [seats] x, y, z; -1 where held
  std::array<double, 2> rail_factor;                     // weight of the line in left, right
  bool mirrored;                                         // right rail: lateral unknowns change sign

  int unknowns() const { return static_cast<int>(stiffness.rows()); }
  /// Number of coordinate k = 0..8 of a node among the line's unknowns, -1 where not carried.
  int unknown(int node, int k) const {
    return unknown_of[static_cast<std::size_t>(node)][static_cast<std::size_t>(k)];
  }
};

/// Assembles the track and splits it into independent lines, each numbered along x.
/// Throws std::invalid_argument on counts or lengths that make no track.
std::vector<Line> assemble(const Track& track);

/// Coefficients of the displacement of a material point over the unknowns of one line. Transposed,
/// it spreads a unit force at that point. Throws std::out_of_range off the rail.
Eigen::SparseVector<double> point_row(const Track& track, const Line& line, const RailPoint& point);

/// Nodal forces of the rails' and sleepers' own weight on one line. @param gravity m/s2, > 0 down.
/// Of a track with a state, which is that under its weight: K_r q_s, the constant part of Eq. 24,
/// f_s of which the weight balances; the linear answer to it is the state.
Eigen::VectorXd weight(const Track& track, const Line& line, double gravity = 9.81);

}  // namespace railstep
