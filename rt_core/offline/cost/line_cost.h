#pragma once
#include "offline/cost/cost.h"

namespace railstep {

// Cost of one call of each kernel of the track's lines. Doubles are those of its operands and
// results, each read or written once.

/// Costs of a line, banded or condensed.
struct LineCost {
  Cost value;      // an unknown's displacement
  Cost row;        // the displacement along a row, or a force along it onto the right-hand side
  Cost wheel_row;  // the same of a wheel's row, which the roll over its seats goes into
  Cost shape;      // a wheel's row among the modes
  Cost unit;       // response of the line to a unit force under a wheel, including its row
  Cost located;    // displacement of the line under a wheel as it was located
  Cost read;       // a response read under a wheel; or its motion since it was located
  Cost pair;       // an entry of W
  Cost add;        // a multiple of such a response added to the line
  Cost node_roll;  // the roll of a section
};
LineCost line_cost(const Model& model, const LineModel& line);

/// Most unknowns of a rail's element that a line carries.
std::int64_t carried_by(const Model& model, const LineModel& line);

/// Solve of one right-hand side; solve_band() costs the same for each.
Cost solve_cost(const Band& band);

/// The lines' own part of a step, without forces and responses.
Cost advance_cost(const Model& model, const LineModel& line);

/// Cost of all loads once: their places and forces.
Cost loads_cost(const Model& model);

/// How many rows of the track, of contacts and wheel seats, act on a line.
std::int64_t bases_on(const Model& model, const LineModel& line);

// Tables (math/table.h, model/signal.h), as the tests count them.
inline constexpr Cost kLookUp = branching(32, 5);  // a cubic
inline constexpr Cost kPairLookUp =
    branching(36 + 2 + 67, 20);  // 4 x 4 points, times a force and added; a mean of two forces' own
inline constexpr Cost kSignal = branching(61, 6);   // a spline with its slopes
inline constexpr Cost kPlace = branching(130, 60);  // of a load: table, sine, row

}  // namespace railstep
