#pragma once
#include <string>
#include <vector>

#include "hard/hard_case.h"

namespace railstep {

/// A case and what came of it.
struct HardOutcome {
  HardCase of;
  HardResult result;
  [[nodiscard]] bool passed() const;
};

/// A page: a table of all cases by figure, bound and margin, then each with its picture.
std::string hard_report(const std::vector<HardOutcome>& outcomes);

/// A margin in words: by how much the figure stays under its bound.
std::string margin_text(const HardCheck& check);

}  // namespace railstep
