#pragma once
#include <cstdint>

#include "online/patch/strip_patch.h"

namespace railstep {

inline constexpr int kMostProfilePoints = 20000;

/// A profile as a table over equally spaced points: in the interval from point i on it is
///   c0 + x (c1 + x (c2 + x c3)),  x = (place - first) per_step - i.
struct ProfileTable {
  std::int32_t points;        // 2 to kMostProfilePoints
  double first, per_step;     // m; points a metre
  const double* coefficient;  // [points][4] m; only c0 of the last point is used
};

/// A wheel and its rail, both seen as the right ones: y outwards, z up.
struct ProfilePair {
  ProfileTable wheel;  // growth of the radius over s, outwards from the tread datum
  // The same at places that are equally spaced along the profile, from end to end.
  const double *search_place, *search_growth, *search_slope;  // [kSearchStrips] m, m, 1
  ProfileTable rail;     // height over y outwards from the middle of the track
  double half_distance;  // from the wheelset's middle to the tread datum, m
  double radius;         // at the tread datum, m
  double modulus;        // E / (1 - nu^2) of two like bodies, N/m2
  std::int32_t patches;  // at most so many least gaps are looked at, 1 to kMostLeast
};

/// Where a wheelset is over a rail, both in the frame of the rail's profile.
struct WheelsetPlace {
  double outwards, up;  // of its middle, m
  double roll;          // rad, positive where it lifts this wheel; less the roll of the rail
  double yaw;           // rad, positive where it moves this wheel back
};

inline constexpr int kSearchStrips = 128;  // at which a wheel is looked at
inline constexpr int kZoneStrips = 25;     // of one zone
inline constexpr int kMostLeast = 3;       // least gaps of a wheel: tread, throat and flange
/// A zone has one of the least gaps, or two or three neighbours as one.
inline constexpr int kMostZones = kMostLeast * (kMostLeast + 1) / 2;

/// Where a wheel and its rail overlap, or nearly do so.
struct WheelZone {
  double depth;            // at the deepest point, along the normal, m; negative: free
  double s;                // of the deepest point on the wheel, m
  double cosine;           // of the angle between the contact plane and the rail's level
  double cosine_of_wheel;  // of the angle between the wheel's profile there and its axle
  bool at_edge;            // the overlap reaches the end of a profile
  double share;            // part of its force that acts on the wheel, above 0, at most 1
  double gap[kZoneStrips];
  StripPatch patch;  // without its gaps; see patch_of()
};
/// Valid as long as the zone lives.
StripPatch patch_of(WheelZone&&) = delete;
inline StripPatch patch_of(const WheelZone& zone) noexcept {
  StripPatch patch = zone.patch;
  patch.gap = zone.gap;
  return patch;
}

/// Finds the zones of a wheel about its least gaps, the deepest ones, in the order of s. A yawed
/// wheel touches where its normal has no component along the rail: ahead of the axle by r (roll -
/// F') yaw, F' the slope of the wheel's growth. Gaps have the yaw to second order, slopes to first
/// order. Two least gaps are one zone where the deeper one's overlap, by the law of patches, goes
/// beyond the ridge between them. Where it nearly does so, or the ridge is hardly above the higher
/// one, the wheel has shares of both of them and of them as one, so that its force does not leap.
/// @param least_depth  vertical, m: zones of less depth count as if they had this depth
/// @param zone  [kMostZones] out
/// @returns how many zones there are: one at least where the wheel is above its rail, 0 beside it
int find_zones(const ProfilePair& pair, const WheelsetPlace& at, double least_depth,
               WheelZone* zone) noexcept;

/// A point at which a wheel is pressed, in the rail's frame.
struct PressedPoint {
  double ahead, y, z;  // m, as WheelZone's
  double slope;        // mean of the wheel's and of the rail's there, dz/dy
  double curvature;    // of the wheel across, 1/m: positive where it bends up
};
/// The wheel's point at s, as far ahead of the axle as a point that touches.
/// @param half  to both sides of s, m, above 0: over which the curvature is a mean
PressedPoint pressed_point(const ProfilePair& pair, const WheelsetPlace& at, double s,
                           double half) noexcept;

}  // namespace railstep
