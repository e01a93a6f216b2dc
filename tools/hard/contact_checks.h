#pragma once
#include <string>
#include <vector>

#include "hard/hard_run.h"

namespace railstep {

/// Two checks on the energies of a run, both over the largest energy turned over: what the scheme
/// makes, and what the balance leaves beyond the scheme's own loss.
/// @param at    what stands before their names
/// @param made  bound of the first
/// @param left  bound of the second
void check_energy(HardResult& result, const HardRun& run, const std::string& at, double made,
                  double left);

/// Largest |a - b| over the rows; NaN where one of them is.
double largest_gap(const std::vector<double>& a, const std::vector<double>& b);
/// Largest |value| over the rows; NaN where one is.
double largest_size(const std::vector<double>& values);
/// Whether all numbers of the trace are.
bool all_finite(const HardRun& run);
/// The trace's time of the first row where a column is over a value; the last row's if none is.
double first_over(const HardRun& run, const std::string& column, double value);

}  // namespace railstep
