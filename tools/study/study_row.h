#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "study/frame_cost.h"
#include "study/outputs.h"
#include "study/setting.h"

namespace railstep {

/// An error, told apart: of the setting against the reference, and on the way there
///   setting - its model by small steps - the same without the setting's changes of the scene -
///   full order on its mesh by small steps - reference.
struct ErrorParts {
  double step = 0., changes = 0., condensation = 0., mesh = 0.;
  [[nodiscard]] double sum() const { return step + changes + condensation + mesh; }
};

/// One setting of a study with its error and its cost.
struct SettingRow {
  Setting setting;
  std::string failure;  // why there is no result; empty where there is one
  int kept_unknowns = 0;
  TraceErrors errors;
  ErrorParts parts;
  FrameCost cost;
  std::vector<std::string> status;  // status_names()
  bool on_front = false;            // none is both cheaper and better
};

nlohmann::ordered_json to_json(const SettingRow& row);
/// Throws nlohmann's exceptions on what to_json() did not write.
SettingRow row_from_json(const nlohmann::ordered_json& json);

/// Marks the front: by cost rising, all whose error is below that of every cheaper one.
/// @param floor  errors below are not told apart
void mark_front(std::vector<SettingRow>& rows, double floor);

/// The cheapest with a sum of parts, and an error, of at most this; none: null.
const SettingRow* cheapest(const std::vector<SettingRow>& rows, double error);

}  // namespace railstep
