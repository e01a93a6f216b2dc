#pragma once
#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "study/study.h"

namespace railstep {

/// The request to `railstep pareto`.
struct ParetoRequest {
  std::filesystem::path scene;
  std::vector<std::string> overrides;
  Choices choices;  // lists that are empty are default_choices()
  Judged judged;
  double reference_error = 1e-5;    // refined until its own error is below,
  int reference_levels = 3;         // or so often
  std::filesystem::path reference;  // a trace that replaces it; empty: made here
  double reference_own_error = 0.;  // of that trace
  std::filesystem::path resume;     // empty: nothing is kept
};

/// The error of a model's receptance at the frequencies.
struct ReceptanceErrors {
  std::string model;
  int elements_per_bay;
  std::vector<double> error;  // of the largest receptance
};

struct ParetoResult {
  Reference reference;
  Judged judged;
  double frame = 0.;  // s
  std::vector<SettingRow> rows;
  std::vector<double> hz;
  std::vector<ReceptanceErrors> receptances;  // of each model on the front
};

/// Runs all settings. Rows that `resume` has of the same program, scene and question are kept;
/// each row that is made goes there at once.
/// @param after  called with the settings that are done and all of them
ParetoResult pareto(const ParetoRequest& request,
                    const std::function<void(std::int64_t, std::int64_t)>& after);

}  // namespace railstep
