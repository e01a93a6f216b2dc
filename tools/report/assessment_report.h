#pragma once
#include <string>
#include <vector>

#include "answer/assessment.h"

namespace railstep {

/// The running behaviour of vehicles as a part of a page: the answer in words, the largest value of
/// each quantity beside its limit and where that is from, plots over the way, sections, and ride.
/// Empty without vehicles. Throws Failed where gnuplot fails.
std::string behaviour_html(const std::vector<AssessedVehicle>& vehicles);

/// The largest values and the ride as lines of text.
std::string behaviour_text(const std::vector<AssessedVehicle>& vehicles);

}  // namespace railstep
