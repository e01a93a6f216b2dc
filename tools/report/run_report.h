#pragma once
#include <string>

#include "run/simulate.h"

namespace railstep {

/// One self-contained HTML page: rails under loads and wheels, wheel-rail forces and sensors over
/// time, the deformed rails at a few times, and a histogram of the frames' wall times; of a system
/// the paths of its sensors and the residual of its joints. Needs a record that kept its rows.
/// Throws Failed where gnuplot fails.
/// @param behaviour  behaviour_html() of its vehicles
std::string run_report(const std::string& title, const Simulation& run, const RunRecord& record,
                       const std::string& behaviour = {});

}  // namespace railstep
