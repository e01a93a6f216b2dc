#pragma once
#include <filesystem>

#include "offline/irregularity/rails.h"

namespace railstep {

/// Reads irregularities from a text file: a first line of column names, then rows at equal
/// distances. `distance_m`, and at least one of vertical, alignment, cross_level, gauge (of the
/// track), or of left_z, right_z, left_y, right_y (of the rails), each with its unit: `_m` or
/// `_mm`. Throws InputError with the line for anything else: both kinds together, fewer than four
/// rows, distances that do not rise by the same step within 1e-3 of it, a step below 1e-6 m, places
/// beyond 1e9 m, or heights beyond 10 m.
RailSignals read_irregularities(const std::filesystem::path& file);

}  // namespace railstep
