#include "study/advice.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace railstep {
namespace {

const SettingRow* best_of(const std::vector<SettingRow>& rows) {
  const SettingRow* best = nullptr;
  for (const SettingRow& row : rows)
    if (row.failure.empty() && (best == nullptr || row.errors.judged < best->errors.judged))
      best = &row;
  return best;
}

std::string sentence(const ParetoResult& result, double asked) {
  const double floor = floor_of(result.reference);
  if (const SettingRow* const row = cheapest(result.rows, asked))
    return fmt::format(
        "For {:g}: {}. {:.3g} us a frame ({:.3g} to {:.3g}), at most {} flops; error {}, of which "
        "step {:.1e}, changes {:.1e}, condensation {:.1e}, mesh {:.1e}.{}",
        asked, words_of(row->setting), row->cost.us, row->cost.least, row->cost.most,
        row->cost.flops, error_text(row->errors.judged, floor), row->parts.step, row->parts.changes,
        row->parts.condensation, row->parts.mesh,
        asked < floor
            ? fmt::format(" The reference itself is known to {:.1e} only.", result.reference.error)
            : "");
  const SettingRow* const best = best_of(result.rows);
  if (best == nullptr) return fmt::format("For {:g}: no setting ran.", asked);
  return fmt::format(
      "For {:g}: none of these. The best is {}, with error {} (step {:.1e}, changes {:.1e}, "
      "condensation {:.1e}, mesh {:.1e}).",
      asked, words_of(best->setting), error_text(best->errors.judged, floor), best->parts.step,
      best->parts.changes, best->parts.condensation, best->parts.mesh);
}

}  // namespace

std::vector<std::string> advice(const ParetoResult& result) {
  std::vector<std::string> all;
  for (const double asked : kAsked) all.push_back(sentence(result, asked));
  return all;
}

std::string judged_text(const ParetoResult& result) {
  if (!result.judged.outputs.empty())
    return fmt::format("{}", fmt::join(result.judged.outputs, ", "));
  for (const SettingRow& row : result.rows)
    if (!row.errors.kinds.empty()) return name_of(row.errors.kinds.front().kind);
  return "nothing";
}

std::string error_text(double error, double floor) {
  return error < floor ? fmt::format("below {:.1e}", floor) : fmt::format("{:.2e}", error);
}

}  // namespace railstep
