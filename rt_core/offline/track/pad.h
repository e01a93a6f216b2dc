#pragma once
#include <vector>

#include "offline/track/track.h"

namespace railstep {

inline constexpr double kBehind = 1e-9;  // of an element: where the rail behind a joint ends

/// A point of a pad that is spread along the rail, and the part of the pad at that point.
struct PadPoint {
  int element;
  double xi;      // in it
  double x;       // along the rail, m
  double offset;  // of it from the seat, m
  double part;    // of the whole pad; all sum to 1
};

/// Points by which int k(x) N' N dx of an evenly spread pad is exact: three Gauss points in every
/// element under it, k = 1/length. Points off an end of the rail are moved under it. A pad of
/// length 0 is one point at the seat, or half of it stands under either end of a rail that is cut
/// there.
std::vector<PadPoint> pad_points(const Track& track, int border, double length);

/// Whether any pad is longer than a point.
bool has_long_pads(const Track& track);

}  // namespace railstep
