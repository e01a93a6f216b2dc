#pragma once
#include <Eigen/SparseCore>
#include <array>
#include <map>
#include <optional>
#include <vector>

#include "offline/element/matrices.h"
#include "offline/track/seat.h"

namespace railstep {

/// Which unknowns a node carries: all nine; six, of a section that turns but does not strain
/// (a_y = b_z = 0, roll a_z = -b_y, and no Poisson coupling, which would then stiffen the rail); or
/// [r_z, b_x] for vertical bending alone.
enum class Unknowns { full, rigid_section, vertical };

/// What holds a rail's end node. Pinned: its position (all three), so that the rail carries axial
/// force, and its roll (a_z and b_y); the slopes a_x and b_x of bending stay free. Clamped: all
/// nine.
enum class RailEnd { free, pinned, clamped };

/// The ends of every rail, at x = 0 and at x = length.
using RailEnds = std::array<RailEnd, 2>;

/// Where a track stands under its own weight. Of one that is symmetric both sides are the same, and
/// nothing moves sideways.
struct TrackState {
  std::array<Eigen::VectorXd, 2> rail;     // [9 nodes] change of its unknowns from rest
  std::array<Eigen::VectorXd, 2> sleeper;  // [4 seats] x, y, z of the ends, m, and turn about y
  double gravity = 0.;                     // of that weight, m/s2
};

/// What a rail is made of, and the axial force in it.
struct RailBar {
  BeamSection section;
  Material material;
  double axial_force = 0.;  // at rest, N, tension positive
};

/// A straight track of one rail or two, on seats at its bay borders.
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
  std::optional<RailBar> right;  // the right rail, where it differs from section, material, force
  Support support;               // of every seat but those changed
  std::optional<Sleeper> sleeper;
  std::map<int, Seat> changed_seats;  // by bay border; whole, in place of support and sleeper
  /// Rails that share sleepers and are alike are stepped in mirror coordinates; without them both
  /// make one line, as those that differ do.
  bool mirror_coordinates = true;
  /// Where the stiffness is taken (q_s of Eq. 24); none: at rest. linearised_under_weight() makes
  /// one.
  std::optional<TrackState> state;

  int elements() const { return bays * elements_per_bay; }
  int nodes() const { return 2 * elements() + 1; }
  double element_length() const { return bay_length / elements_per_bay; }
  double length() const { return bays * bay_length; }
  /// @param rail  0 left (+y), 1 right
  RailBar bar(int rail) const {
    return rail == 1 && right ? *right : RailBar{section, material, axial_force};
  }
  BeamLaw law(int rail = 0) const {
    const RailBar own = bar(rail);
    ElementRule own_rule = rule;
    if (unknowns == Unknowns::rigid_section) own_rule.coupling = Coupling::none;
    return beam_law(own.section, own.material, own_rule, axis_z, own.axial_force);
  }
  Seat seat(int border) const;
};

/// Whether any seat has a sleeper.
bool has_sleepers(const Track& track);

/// Whether rails and all seats are alike on the left and on the right.
bool is_symmetric(const Track& track);

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

/// How a rigid sleeper moves; of the table of a line's unknowns.
enum SleeperMotion { kAlongX, kAlongY, kAlongZ, kRoll, kYaw, kPitch, kSleeperMotions };

/// One independent part of the track: M a + C v + K u = f with banded matrices.
///
/// Two alike rails that share sleepers are taken in mirror coordinates (left +- mirrored right)
/// / sqrt 2; rails that differ make one line together; rails that share nothing stand for
/// themselves. Whatever then does not couple (vertical and lateral motion of a section symmetric
/// in y, say) becomes a line of its own.
struct Line {
  /// [nodes] unknowns of one rail; -1 where not carried.
  using RailUnknowns = std::vector<std::array<int, 9>>;

  Eigen::SparseMatrix<double> mass, damping, stiffness;  // symmetric, both triangles stored
  std::array<RailUnknowns, 2> unknown_of;  // of left and right rail; the same in mirror coordinates
  /// [seats] of each SleeperMotion, scaled: the ends' mean displacement, or half their difference,
  /// times sqrt 2 (of one rail, its end's displacement); -1 where held or on another line.
  std::vector<std::array<int, kSleeperMotions>> sleeper_unknown_of;
  std::array<double, 2> rail_factor;  // weight of the line in left, right; 0: it lacks that rail
  bool mirrored;                      // right rail: lateral unknowns change sign
  bool rigid_section;                 // a_z and b_y are one unknown, the roll a_z

  int unknowns() const { return static_cast<int>(stiffness.rows()); }
  /// Number of coordinate k = 0..8 of a rail's node among the line's unknowns, -1 where not
  /// carried.
  int unknown(int rail, int node, int k) const {
    return unknown_of[static_cast<std::size_t>(rail)][static_cast<std::size_t>(node)]
                     [static_cast<std::size_t>(k)];
  }
  /// The rail whose unknowns all others' are, or the first of two.
  int first_rail() const { return rail_factor[0] != 0. ? 0 : 1; }
};

/// Assembles the track and splits it into independent lines, each numbered along x.
/// Throws std::invalid_argument on counts or lengths that make no track.
std::vector<Line> assemble(const Track& track);

/// Coefficients of the displacement of a material point over the unknowns of one line. Transposed,
/// it spreads a unit force at that point. Throws std::out_of_range off the rail.
Eigen::SparseVector<double> point_row(const Track& track, const Line& line, const RailPoint& point);

/// What unknown k of a rail's node is per unknown of the line, before the rail's weight in it: -1
/// for the y components (r_y, a_x, a_z, b_y) of a mirrored right rail; the other sign for b_y of a
/// section that does not strain; else 1.
double sign_of(const Line& line, int rail, int k);

/// Coefficients of the displacement of a sleeper's end over the unknowns of one line.
/// @param rail  0 left, 1 right: above that end
/// @param direction  0 x, 1 y, 2 z, m; 3 turn about y, rad
Eigen::SparseVector<double> sleeper_row(const Track& track, const Line& line, int rail, int seat,
                                        int direction);

/// Nodal forces of the rails' and sleepers' own weight on one line. @param gravity m/s2, > 0 down.
/// Of a track with a state, which is that under its weight: K_r q_s, the constant part of Eq. 24,
/// f_s of which the weight balances; the linear answer to it is the state.
Eigen::VectorXd weight(const Track& track, const Line& line, double gravity = 9.81);

}  // namespace railstep
