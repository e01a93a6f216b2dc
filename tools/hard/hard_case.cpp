#include "hard/hard_case.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>

namespace railstep {
namespace {

/// The figure of a check over its bound; above 1 it is beyond the bound.
double way(const HardCheck& check) {
  constexpr double kWorst = std::numeric_limits<double>::infinity();
  if (!check.passed()) return std::isnan(check.figure) ? kWorst : 1. + std::abs(check.figure);
  return check.bound == 0. ? 0. : check.figure / check.bound;
}

}  // namespace

std::vector<HardCase> hard_cases() {
  std::vector<HardCase> all;
  for (const auto& part :
       {contact_cases(), element_cases(), input_cases(), joint_cases(), model_cases(),
        profile_cases(), stability_cases(), step_cases(), support_cases(), suspension_cases(),
        track_cases(), traffic_cases(), vehicle_cases(), wheel_cases()})
    all.insert(all.end(), part.begin(), part.end());
  const auto number = [](const HardCase& own) { return std::atoi(own.id + 1); };
  std::sort(all.begin(), all.end(),
            [&](const HardCase& a, const HardCase& b) { return number(a) < number(b); });
  return all;
}

const HardCheck& tightest(const HardResult& result) {
  return *std::max_element(result.checks.begin(), result.checks.end(),
                           [](const HardCheck& a, const HardCheck& b) { return way(a) < way(b); });
}

HardCheck off_by(std::string what, double value, double expected, double bound) {
  return {std::move(what), std::abs(value - expected) / std::abs(expected), bound};
}

HardCheck apart_by(std::string what, double value, double expected, double bound) {
  return {std::move(what), std::abs(value - expected), bound};
}

HardCheck holds(std::string what, bool is_true) { return {std::move(what), is_true ? 0. : 1., 0.}; }

}  // namespace railstep
