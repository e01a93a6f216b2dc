#pragma once
#include <cstdint>

#include "online/model/force_element.h"
#include "online/model/suspended_model.h"
#include "online/patch/creep_law.h"
#include "online/patch/kalker.h"
#include "online/patch/wheel_zones.h"

namespace railstep {

/// The six coordinates of a body in a frame that follows the track: displacements of its centre
/// along x, y and z, m, then rotations about these axes, rad. The `pitch` of a wheelset is its
/// spin beyond speed / radius, and its axle is turned by yaw and then by roll.
enum class BodyMotion { x, y, z, roll, pitch, yaw };
inline constexpr int kMotions = 6;
constexpr int index_of(BodyMotion motion) noexcept { return static_cast<int>(motion); }

/// A patch under a wheel as creep sees it. It grows as the root of the penetration; if coefficients
/// of creep are given instead, they hold for every force, as if the patch kept its size.
struct RollingPatch {
  double half_length, half_width;  // along the rail and across, m; if it grows, m^0.5 of root depth
  double shear;                    // modulus, N/m2
  double exponent;  // power of the normal force by which it grows: 1/3 by Hertz, 0: it keeps its
                    // size; of profiles any above 0, as it follows from the patch
  Kalker kalker;
};

/// Coulomb friction between wheels and rails. With the slip of the wheel its coefficient falls from
/// that of a wheel that rolls to the part `kinetic` of it; half of this fall is at the slip `half`.
struct RollingFriction {
  double rail[2];                 // of the left and of the right rail where they have most of it
  double kinetic = 1.;            // above 0; 1: it does not depend on the slip
  double half = 1.;               // m/s
  std::int32_t places = 0;        // 0: the same everywhere
  const double* parts = nullptr;  // [places][3] x along the track, m, and the parts of `rail` there
};
inline constexpr int kMostFrictionPlaces = 10'000;
inline bool falls(const RollingFriction& f) noexcept { return f.kinetic < 1.; }

/// Creep of wheels on rails.
struct RollingCreep {
  CreepLaw law;
  std::int32_t strips;  // of FASTSIM
  RollingFriction friction;
  RollingPatch patch;  // of profiles: only if its size is given
};

/// Profiles of both wheels of a wheelset and of both rails, alike.
struct ProfileContact {
  ProfilePair pair;  // its wheel has no points where treads are cones
  double height;     // of a centred wheelset's middle over the top of rail as it just touches, m
  /// The point from which a rail is placed, the highest one of its crown's circle: outwards from
  /// the middle of the track and over the top of rail, m.
  double point_y, point_z;
  double poisson;  // of both bodies
};

/// Wheels on straight rails: the law along the normal, and a law of creep. Without profiles treads
/// are cones on circular crowns.
struct RollingContact {
  double slope;          // of the treads, tangent of the cone's half angle; 0 with profiles
  double half_distance;  // between the contacts of a centred wheelset, m
  double crown_radius;   // m; 0 with profiles
  double hertz;          // N/m^1.5; with profiles that of the static load, to start from
  RollingCreep creep;
  double relaxation;  // length in which creep follows slip at a standstill, m; of free runners
  ProfileContact profiles;
};
inline bool has_profiles(const RollingContact& c) noexcept {
  return c.profiles.pair.wheel.points > 0;
}

inline constexpr int kWheelsetRank = 6;  // scalars of a wheelset: three forces of each wheel
inline constexpr int kMaxRunners = 8;
inline constexpr int kMaxForceElements = 32;                                     // of one runner
inline constexpr int kMaxRunnerForceElements = kMaxRunners * kMaxForceElements;  // of all runners
inline constexpr int kMaxTracedElements = 64;  // displacements of one runner's linear elements
inline constexpr int kMaxRunnerTraced = 128;   // of all runners
inline constexpr int kMaxRodsOfRunner = 8;
inline constexpr int kMaxRunnerRods = 16;  // of all runners
inline constexpr int kMaxWheelsetsOfRunner = 8;
inline constexpr int kMaxRunnerWheelsets = 16;  // of all runners
inline constexpr int kMaxSeatedWheelsets = 8;   // of all on rails that give way
inline constexpr int kMaxRunnerUnknowns = 256;  // of one runner
inline constexpr int kMaxFramePairs = 64;       // of one runner
inline constexpr int kMaxFrameElements = 1024;  // of one runner

/// A wheelset of a runner.
struct RunnerWheelset {
  std::int32_t first;   // of its six motions among the runner's coordinates
  double place;         // along x from the runner's origin, m
  double radius;        // m
  double spin_inertia;  // kg m2
};

/// An element between two bodies: `arm` from the centre of each body to its end at rest. Along a
/// line only the first entries of the others count.
struct FrameElement {
  double along_line;  // its length at rest, m; 0: springs along and about the axes halfway between
                      // both bodies
  double arm[2][3];   // m
  double stiffness[6], damping[6];  // N/m and N m/rad; N s/m and N m s/rad
  double preload[6];  // on the first body at rest, N and N m; along a line its tension
};
/// Two bodies that elements join, whether each is a wheelset, whose boxes leave its spin alone, and
/// how many elements they are.
struct FramePair {
  std::int32_t body[2], boxes[2], elements;
};
/// The frames of a runner's bodies on a design line. Each is at its body's own place, so that in
/// curves those of a pair stand turned and aside of each other. A pose is that of the second one's
/// frame in the first one's. Null without a design line.
struct RunnerFrames {
  const double* centre;  // [bodies][3] of each body at rest: x from the runner's origin, y, z, m
  double gravity;        // m/s2
  std::int32_t pairs;
  FramePair pair[kMaxFramePairs];
  std::int32_t elements;  // of all pairs, in their order
  const FrameElement* element;
  const double* stiffness;  // [pairs][12][12] of a pair's elements over its motions
  const double* preload;    // [pairs][12] of its elements on both bodies, N and N m
  const double* series;  // [size][6 pairs] forces against poses by springs in series with dampers
  const double* elements_moved;  // [element_coordinates][6 pairs] displacement of each
  const double* traced_moved;    // [traced_elements][6 pairs] displacement of each
  const double* rods;            // [rods][6 pairs] elongation of each
  const double* rod_moved;     // [size][6 pairs] displacements by which the rods keep their length
  const double* rod_reaction;  // [1 + rods][6 pairs] as `reaction`
};

/// A displacement z of a linear element that is published with its force, `preload` - `stiffness` z
/// - `series` (z - d) - `damping` z'. It is the force on the first body, N or N m. Along a line z
/// is the elongation and the force is the tension: the coefficients are then 0 or less.
struct TracedElement {
  double stiffness, damping;  // N/m, N s/m; N m/rad, N m s/rad
  double series;              // of a spring in series with a damper, N/m; else 0
  double preload;             // N, N m
  std::int32_t deflection;    // the coordinate d of that damper; 0 without
  std::int32_t axis;          // along x, y, z, about them, or kTracedLine
};
inline constexpr int kTracedLine = kMotions;

/// A vehicle in space on both rails. q are the six motions of each body, then the deflection of
/// each damper that is in series with a spring; such a coordinate has no mass. Constraints hold the
/// first body's x at its place along the track, by the force of the drive, and the lengths of rigid
/// rods. `inverse` is that of the motions that they leave free, so that they hold to rounding. A
/// vehicle that rolls freely goes as forces drive it: nothing holds its x, and its frame stays
/// where it starts, so that x is the way.
struct RunnerModel : SuspendedModel {
  std::int32_t rolls_freely;  // 0 or 1
  double start_speed;         // m/s, of one that rolls freely; else 0
  const double* by_way;       // [size] of one that rolls freely: stiffness over the x of all bodies
  std::int32_t bodies, first_wheelset, wheelsets;  // the first one among those of all runners
  RunnerWheelset wheelset[kMaxWheelsetsOfRunner];
  RollingContact contact;
  std::int32_t load_point[2];  // on left and right rail: height at which its wheels press
  std::int32_t first_force_element, force_elements;  // the first one among those of all runners
  ForceElement force_element[kMaxForceElements];
  /// The displacements of the force elements, each followed by that of its load, if it has one.
  std::int32_t first_element_coordinate, element_coordinates;
  /// [element_coordinates][size] over its coordinates; `inverse` times it.
  const double *element_row, *element_moved;
  std::int32_t first_traced, traced_elements;  // the first one among those of all runners
  const TracedElement* traced;                 // [traced_elements]
  const double* traced_row;                    // [traced_elements][size] over its coordinates
  std::int32_t first_rod, rods;                // the first one among those of all runners
  const double* rod_row;                       // [rods][size] elongation of each
  const double* reaction;  // [1 + rods][size] force ahead of the drive, then the tension of
                           // each rod, by a unit force along each coordinate
  /// Compliance of each displacement of a force element by its own force, which its law meets by
  /// itself; 0 of loads.
  const double* element_compliance;
  /// [interface_size()][interface_size()] theta times the part of the inverse for the wheelsets'
  /// motions, then for the displacements of force elements without `element_compliance`.
  const double* compliance;
  RunnerFrames frames;
};

/// A wheel among those of all runners: its number counts left and right of each wheelset in turn.
struct WheelId {
  std::int32_t wheelset, side;  // side: 0 left, 1 right
  constexpr std::int32_t number() const noexcept { return 2 * wheelset + side; }
};
constexpr WheelId wheel_of(std::int32_t number) noexcept { return {number / 2, number % 2}; }

/// How many coordinates of a runner meet forces that are not linear: the motions of its wheelsets,
/// then the displacements of its force elements.
inline std::int32_t interface_size(const RunnerModel& runner) noexcept {
  return kMotions * runner.wheelsets + runner.element_coordinates;
}

/// How far a runner is ahead of its frame by its first body, m. @param u  [size] of the runner
inline double ahead_of(const RunnerModel& runner, const double* u) noexcept {
  return runner.rolls_freely != 0 ? u[0] : 0.;
}

/// Number of rows of `reaction`: the drive, then the rods. The row of the drive is 0 if the runner
/// rolls freely.
inline std::int32_t constraint_count(const RunnerModel& runner) noexcept { return 1 + runner.rods; }

}  // namespace railstep
