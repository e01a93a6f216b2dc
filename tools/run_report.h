#pragma once
#include <string>

#include "simulate.h"

namespace railstep {

/// Throws std::runtime_error, in one sentence, where gnuplot cannot be run.
void need_gnuplot();

/// One self-contained HTML page: deflection under every load over time, and a histogram of the
/// frames' wall times, both logarithmic there. Needs a record that kept its rows.
/// Throws std::runtime_error where gnuplot fails.
std::string run_report(const Scene& scene, const std::vector<std::string>& columns,
                       const RunRecord& record);

}  // namespace railstep
