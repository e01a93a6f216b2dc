#include "text/range.h"

#include <fmt/core.h>

#include <cmath>

namespace railstep {

bool Range::holds(double value) const {
  const bool below = value < least || (!least_itself && value == least);
  const bool beyond = value > most || (!most_itself && value == most);
  return !std::isnan(value) && !below && !beyond;
}

std::string Range::text() const {
  std::string low, high;
  if (least > -std::numeric_limits<double>::infinity())
    low = fmt::format("{} {:.15g}", least_itself ? "at least" : "above", least);
  if (most < std::numeric_limits<double>::infinity())
    high = fmt::format("{} {:.15g}", most_itself ? "at most" : "below", most);
  if (low.empty() && high.empty()) return "any finite number";
  return low + (low.empty() || high.empty() ? "" : ", ") + high;
}

}  // namespace railstep
