#pragma once
#include <span>
#include <vector>

#include "offline/profile/smoothing.h"
#include "offline/section/outline.h"

namespace railstep {

/// An arc of a railhead. Angles are those of its outward normal from the upright, rad, positive
/// towards +y.
struct HeadArc {
  Point centre;     // m
  double radius;    // m
  double from, to;  // rad
};

/// A railhead by tangent arcs between two straight sides, in the order of y.
struct RailHead {
  std::vector<HeadArc> arcs;
  double side_length;  // m, of the sides below the arcs
};

/// The railhead of a symmetric outline. Outlines hold the rounded end points of a drawing, through
/// which arcs are tangent within some 0.02 degrees only. The arcs here have the outline's radii,
/// its crown and its sides, and are tangent: from the crown each begins at the lateral place that
/// the outline has, and the last one where it meets the straight side. Throws Refused where the
/// head is not made of a crown, convex arcs and a straight side, or where a joint lies over 0.1 mm
/// from that of the outline.
RailHead tangent_head(const Outline& outline);

/// How a right rail lies in the track.
struct RailPlace {
  double inclination;  // tangent of the angle by which the rail leans inwards
  double gauge;        // m
};

/// The right rail's running surface: y from the middle of the track outwards, heights from the top
/// of rail. The innermost point within 14 mm of the top is at half the gauge.
RunningSurface placed(const RailHead& head, const RailPlace& place);

/// The same of a measured head without noise. Its surface is through() the points about the top
/// whose chords are not steeper than 80 degrees.
/// @param head  (y, z) of a right rail that stands upright, m: y outwards, in the order of y about
///              the top, at least down to 14 mm below it on the inner side
/// Throws Refused as through() does, and where no point lies 14 mm below the top on the inner side.
RunningSurface placed(std::span<const Point> head, const RailPlace& place);

}  // namespace railstep
