#pragma once
#include <string>

#include "study/pareto.h"

namespace railstep {

inline constexpr double kAsked[] = {1e-2, 1e-3, 1e-4};

/// Sentences, one for each of kAsked: which setting to take for an error of at most that, or that
/// none is known to reach it.
std::vector<std::string> advice(const ParetoResult& result);

/// "deflection", or the outputs that are judged.
std::string judged_text(const ParetoResult& result);

/// 3 digits, or "below F" where it is not told apart from the reference's own error.
std::string error_text(double error, double floor);

}  // namespace railstep
