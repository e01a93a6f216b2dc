#pragma once
#include <Eigen/SparseCore>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "offline/element/matrices.h"
#include "offline/math/constants.h"
#include "offline/track/joint.h"
#include "offline/track/seat.h"
#include "online/model/cant.h"

namespace railstep {

/// Which unknowns a node carries: all nine; six, for a section that rotates but does not strain
/// (a_y = b_z = 0, roll a_z = -b_y, and no Poisson coupling, which would then stiffen the rail);
/// [r_z, b_x] for vertical bending alone; or [r_x, r_z, a_y, b_x, b_z], those of the nine that a
/// vertical force in the plane y = 0 moves, the reference for `vertical` (squeeze.h).
enum class Unknowns { full, rigid_section, vertical, in_plane };
inline bool strains_section(Unknowns unknowns) {
  return unknowns == Unknowns::full || unknowns == Unknowns::in_plane;
}
inline bool moves_sideways(Unknowns unknowns) {
  return unknowns == Unknowns::full || unknowns == Unknowns::rigid_section;
}

/// Constraint of a rail's end node. Pinned: its position (all three), so that the rail carries
/// axial force, and its roll (a_z and b_y); the slopes a_x and b_x of bending stay free. Clamped:
/// all nine. Non-reflecting: none, but the rail's last bays are damped (end_zone.h) so that waves
/// do not return from the end.
enum class RailEnd { free, pinned, clamped, non_reflecting };

/// The ends of every rail, at x = 0 and at x = length.
using RailEnds = std::array<RailEnd, 2>;

/// Default number of bays of the zone before a non-reflecting end.
inline constexpr int kEndZoneBays = 16;

/// State of a track under its own weight. In a symmetric track both sides are equal, and nothing
/// moves sideways.
struct TrackState {
  std::array<Eigen::VectorXd, 2> rail;     // [9 nodes] change of its unknowns, in its own axes
  std::array<Eigen::VectorXd, 2> sleeper;  // [4 seats] x, y, z of the ends, m, and turn about y
  double gravity = 0.;                     // of that weight, m/s2
};

/// Section and material of a rail, and its axial force.
struct RailBar {
  BeamSection section;
  Material material;
  double axial_force = 0.;  // at rest, N, tension positive
};

/// A spring and damper that a rail's point meets after a displacement of `gap` towards it, and that
/// does not pull.
struct Stop {
  int rail = 0;
  double x = 0., z = 0.;  // of the point, along the rail and above the axis, m
  int direction = 1;      // 1 y, 2 z
  double side = 1.;       // 1: met on the way along +y or +z, -1: along - of it
  double gap = 0.;        // m, of the unloaded straight track
  double stiffness = 0.;  // N/m
  double damping = 0.;    // N s/m
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
  double rail_spacing = 1.5;  // m, between the rails' axes
  /// By how much each rail leans inwards, the tangent of the angle: 1/20, say. Its ends, joints and
  /// pads lie in its own axes: a pad lies on the sleeper's inclined seat.
  double cant = 0.;
  RailEnds ends = {RailEnd::free, RailEnd::free};
  int end_zone_bays = kEndZoneBays;  // damped bays before each non-reflecting end
  /// The last bay border is the first: a track without ends, on which traffic runs round. Its seats
  /// are alike, and its pads are points; x still goes from 0 to length().
  bool ring = false;
  /// The rails do not give way: the track has no lines, and only its lengths, section and cant
  /// count.
  bool rigid = false;
  /// Spring from the first node of a rail, and of each piece of a cut rail, to the ground along x,
  /// N/m. It is so soft that it matters only if nothing else holds the rail.
  double hold_along = 0.;
  std::optional<RailBar> right;  // the right rail, where it differs from section, material, force
  Support support;               // of every seat but those changed
  std::optional<Sleeper> sleeper;
  std::map<int, Seat> changed_seats;  // by bay border; whole, in place of support and sleeper
  std::vector<Stop> stops;
  std::vector<RailJoint> joints;  // where rails are cut
  /// Equal rails that share sleepers are stepped in mirror coordinates. If this is false they make
  /// one line together, as rails that differ do.
  bool mirror_coordinates = true;
  /// State at which the stiffness is taken (q_s of Eq. 24), from linearised_under_weight(); empty:
  /// at rest.
  std::optional<TrackState> state;

  int elements() const { return bays * elements_per_bay; }
  int nodes() const { return 2 * elements() + 1; }
  /// Bay borders with a seat of their own.
  int seats() const { return ring ? bays : bays + 1; }
  double element_length() const { return bay_length / elements_per_bay; }
  double length() const { return bays * bay_length; }
  /// @param rail  0 left (+y), 1 right
  Cant lean(int rail) const {
    const double cosine = 1. / std::sqrt(1. + cant * cant);
    return {cosine, (rail == 0 ? cant : -cant) * cosine};
  }
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

/// Whether rails, their joints and all seats are alike on the left and on the right.
bool is_symmetric(const Track& track);

/// Whether the ends of a rail hold unknown k = 0..8 of its node.
bool is_held(const Track& track, int node, int k);

/// An element and the natural coordinate in it.
struct ElementPlace {
  int element;
  double xi;
};

/// The element at a place x along the rail, m. Round-off of bay lengths (1e-12) beyond the far end
/// is allowed. Throws Refused off the rail.
ElementPlace place_on(const Track& track, double x);

/// A material point of one rail.
struct RailPoint {
  int rail;       // 0 left (+y), 1 right
  double x;       // along the undeformed rail, m
  double y, z;    // over the section, along its own axes from the axis, m
  int direction;  // 0 x, 1 y, 2 z of the track
};

/// Coefficients of a material point's displacement along a direction of the track over the 27
/// unknowns of its element, in the rail's own axes.
Vector27 rail_row(const Cant& cant, double xi, double y, double z, int direction);

/// Motions of a rigid sleeper, in the order of a line's table of unknowns; then, for the ballast
/// under its left and its right end (in mirror coordinates the left one stands for both), the
/// compression along z of the part that relaxes, and its turn about y.
enum SleeperMotion {
  kAlongX,
  kAlongY,
  kAlongZ,
  kRoll,
  kYaw,
  kPitch,
  kRelaxing,
  kRelaxingPitch = kRelaxing + 2,
  kSleeperMotions = kRelaxingPitch + 2
};
inline constexpr std::array<int, kSleeperMotions> kHeldSleeper = {-1, -1, -1, -1, -1,
                                                                  -1, -1, -1, -1, -1};

/// One independent part of the track: M a + C v + K u = f with banded matrices. One-sided springs
/// (fixed_port.h) are not in these matrices, but unknowns that they couple stay in one line.
///
/// Two alike rails that share sleepers are taken in mirror coordinates (left +- mirrored right) /
/// sqrt 2; rails that differ make one line together; rails that share nothing are lines of their
/// own. Motions that then do not couple, such as vertical and lateral motion of a section symmetric
/// in y, become separate lines.
struct Line {
  /// [nodes] unknowns of one rail, along its own axes; -1 where not carried.
  using RailUnknowns = std::vector<std::array<int, 9>>;

  Eigen::SparseMatrix<double> mass, damping, stiffness;  // symmetric, both triangles stored
  Eigen::SparseMatrix<double> end_damping;  // the part of damping in the zones at the ends
  std::array<RailUnknowns, 2> unknown_of;  // of left and right rail; the same in mirror coordinates
  /// Where a rail is cut: the unknowns of the end ahead, which begins the next element, by node and
  /// for each rail. Those of the end behind are the node's own.
  std::array<std::map<int, std::array<int, 9>>, 2> cuts;
  /// [seats] of each SleeperMotion, scaled: the ends' mean displacement, or half their difference,
  /// times sqrt 2 (of one rail, its end's displacement); -1 where held or on another line.
  std::vector<std::array<int, kSleeperMotions>> sleeper_unknown_of;
  std::array<double, 2> rail_factor;  // weight of the line in left, right; 0: not in that rail
  bool mirrored;                      // right rail: lateral unknowns change sign
  bool rigid_section;                 // a_z and b_y are one unknown, the roll a_z

  int unknowns() const { return static_cast<int>(stiffness.rows()); }
  /// Number of coordinate k = 0..8 of a rail's node among the line's unknowns, -1 where not
  /// carried.
  int unknown(int rail, int node, int k) const {
    return unknown_of[static_cast<std::size_t>(rail)][static_cast<std::size_t>(node)]
                     [static_cast<std::size_t>(k)];
  }
  /// The same of the end ahead where the rail is cut.
  int unknown_ahead(int rail, int node, int k) const {
    const auto& cut = cuts[static_cast<std::size_t>(rail)];
    const auto at = cut.empty() ? cut.end() : cut.find(node);
    return at == cut.end() ? unknown(rail, node, k) : at->second[static_cast<std::size_t>(k)];
  }
  /// The same of node i = 0..2 of an element.
  int element_unknown(int rail, int element, int i, int k) const {
    return i == 0 ? unknown_ahead(rail, 2 * element, k) : unknown(rail, 2 * element + i, k);
  }
  /// The rail whose unknowns all others' are, or the first of two.
  int first_rail() const { return rail_factor[0] != 0. ? 0 : 1; }
};

/// Assembles the track and splits it into independent lines, each numbered along x. Throws Refused
/// on counts or lengths that are out of range.
std::vector<Line> assemble(const Track& track);

/// Coefficients of the displacement of a material point over the unknowns of one line. Transposed,
/// it spreads a unit force at that point. Throws Refused off the rail.
/// @param strains  false: without the part of the section's own strain (a_y, b_z)
Eigen::SparseVector<double> point_row(const Track& track, const Line& line, const RailPoint& point,
                                      bool strains = true);

/// Sign of unknown k of a rail's node relative to the line's unknown, without the rail's weight in
/// it: -1 for the y components (r_y, a_x, a_z, b_y) of a mirrored right rail; the other sign for
/// b_y of a section that does not strain; else 1.
double sign_of(const Line& line, int rail, int k);

/// Coefficients of the displacement of a sleeper's end over the unknowns of one line.
/// @param rail  0 left, 1 right: above that end
/// @param direction  0 x, 1 y, 2 z, m; 3 turn about y, rad
Eigen::SparseVector<double> sleeper_row(const Track& track, const Line& line, int rail, int seat,
                                        int direction);

/// Nodal forces of a load of 1 N/m upwards along an element of a rail, in the rail's axes.
Vector27 line_load(const Track& track, int rail);

/// Nodal forces of the rails' and sleepers' own weight on one line. @param gravity m/s2, > 0 down.
/// If the track has a state under its weight: K_r q_s, the constant part of Eq. 24, whose f_s the
/// weight balances. The linear answer to it is the state.
Eigen::VectorXd weight(const Track& track, const Line& line, double gravity = kGravity);

}  // namespace railstep
