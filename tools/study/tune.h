#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "study/study.h"

namespace railstep {

/// The request to `railstep tune`.
struct TuneRequest {
  std::filesystem::path scene;
  std::vector<std::string> overrides;
  Choices choices;  // lists that are empty are default_choices()
  Judged judged;
  double max_error = 0.;
  std::optional<double> deadline_us;  // of a frame's median
};

/// The same setting on another run of the scene.
struct Verification {
  std::string what;  // "the scene", "nine tenths of the speed"
  double error;
};

/// A setting that was looked at further, and what it did where it had to hold.
struct Candidate {
  SettingRow row;
  std::vector<Verification> verified;
  [[nodiscard]] double verified_error() const;
};

struct TuneResult {
  Reference reference;
  double frame = 0.;  // s
  std::optional<Candidate> choice;
  std::optional<SettingRow> best;  // without a choice: the least error, or the cheapest too slow
  std::string binds;               // why there is no choice, a sentence
  std::int64_t looked_at = 0;      // settings
};

/// Each part of the error may be this part of what is asked: none may hide behind another.
inline constexpr double kShare = 1. / 3.;

/// The cheapest setting whose error's parts are each within kShare of what is asked and whose error
/// is within it on the scene, on the same with other speeds, other loads and from other places of a
/// step, against a reference of each.
/// @param after  called with what is being done
TuneResult tune(const TuneRequest& request, const std::function<void(const std::string&)>& after);

/// "key=value" of runs on which a choice must hold too, with words for each. Empty where nothing
/// runs.
struct Variation {
  std::string what;
  std::vector<std::string> overrides;
};
std::vector<Variation> variations_of(const Scene& scene);

}  // namespace railstep
