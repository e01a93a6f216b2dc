#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "sweep/sweep_grid.h"
#include "sweep/sweep_row.h"

namespace railstep {

/// Rows as CSV: index and values of the run, what it met, and the summary of each column that a
/// trace of theirs has, in the order in which these first appear; empty where a run has none.
/// @param row  of a run; asked for twice
std::string sweep_table(const Grid& grid, const std::vector<std::int64_t>& runs,
                        const std::function<SweepRow(std::int64_t)>& row);

}  // namespace railstep
