#pragma once
#include <span>
#include <vector>

#include "offline/section/outline.h"

namespace railstep {

// Checks of an outline. Each throws Refused and names the rows.

/// At least `fewest` points, all finite, no two neighbours in the same place.
void check_rows(std::span<const OutlineRow> rows, std::size_t fewest);

/// Half an outline starts and ends on the axis and stays on its right.
void check_half(std::span<const OutlineRow> half);

/// The side that closes a list of points is no longer than three times its longest other side.
void check_closing(std::span<const OutlineRow> points);

/// An arc's radius is at least half its chord and at most 10 m.
void check_segment(const Segment& segment);

/// At most 1 m, and the height at least 1 mm; otherwise the unit is wrong.
void check_size(double width, double height);

/// No two segments cross or touch, save neighbours at the point they share. Arcs are tested as
/// chords that leave them by no more than 1 um.
void check_crossing(const std::vector<Segment>& segments);

}  // namespace railstep
