#include "study/study_row.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace railstep {
namespace {

using Json = nlohmann::ordered_json;

/// NaN and infinity are written as null, and read as infinity: no error at all is known then.
double number(const Json& value) {
  return value.is_null() ? std::numeric_limits<double>::infinity() : value.get<double>();
}

OutputKind kind_named(const std::string& name) {
  for (const OutputKind kind : kOutputKinds)
    if (name == name_of(kind)) return kind;
  return OutputKind::deflection;
}

}  // namespace

Json to_json(const SettingRow& row) {
  Json kinds = Json::object();
  for (const KindError& own : row.errors.kinds)
    kinds[name_of(own.kind)] = {{"largest", own.largest}, {"rms", own.rms}};
  return {{"model", row.setting.model},
          {"elements_per_bay", row.setting.elements_per_bay},
          {"kept_unknowns", row.kept_unknowns},
          {"scheme", row.setting.scheme},
          {"step_s", row.setting.step},
          {"changes", row.setting.changes},
          {"error", row.errors.judged},
          {"error_parts",
           {{"mesh", row.parts.mesh},
            {"condensation", row.parts.condensation},
            {"changes", row.parts.changes},
            {"step", row.parts.step},
            {"sum", row.parts.sum()}}},
          {"errors", std::move(kinds)},
          {"frame_us_median", row.cost.us},
          {"frame_us_least", row.cost.least},
          {"frame_us_most", row.cost.most},
          {"flops_per_frame", row.cost.flops},
          {"bytes_per_frame", row.cost.bytes},
          {"status", row.status},
          {"failure", row.failure},
          {"on_front", row.on_front}};
}

SettingRow row_from_json(const Json& json) {
  SettingRow row;
  json.at("model").get_to(row.setting.model);
  json.at("elements_per_bay").get_to(row.setting.elements_per_bay);
  json.at("kept_unknowns").get_to(row.kept_unknowns);
  json.at("scheme").get_to(row.setting.scheme);
  json.at("step_s").get_to(row.setting.step);
  json.at("changes").get_to(row.setting.changes);
  row.errors.judged = number(json.at("error"));
  const Json& parts = json.at("error_parts");
  row.parts = {number(parts.at("step")), number(parts.at("changes")),
               number(parts.at("condensation")), number(parts.at("mesh"))};
  for (const auto& [name, own] : json.at("errors").items())
    row.errors.kinds.push_back(
        {kind_named(name), number(own.at("largest")), number(own.at("rms"))});
  row.cost = {number(json.at("frame_us_median")), number(json.at("frame_us_least")),
              number(json.at("frame_us_most")), json.at("flops_per_frame").get<std::int64_t>(),
              json.at("bytes_per_frame").get<std::int64_t>()};
  json.at("status").get_to(row.status);
  json.at("failure").get_to(row.failure);
  return row;
}

void mark_front(std::vector<SettingRow>& rows, double floor) {
  std::vector<SettingRow*> by_cost;
  for (SettingRow& row : rows) {
    row.on_front = false;
    if (row.failure.empty() && std::isfinite(row.errors.judged)) by_cost.push_back(&row);
  }
  std::stable_sort(by_cost.begin(), by_cost.end(), [](const SettingRow* a, const SettingRow* b) {
    return a->cost.us < b->cost.us;
  });
  double best = std::numeric_limits<double>::infinity();
  for (SettingRow* const row : by_cost) {
    const double error = std::max(row->errors.judged, floor);
    if (!(error < best)) continue;
    best = error;
    row->on_front = true;
  }
}

const SettingRow* cheapest(const std::vector<SettingRow>& rows, double error) {
  const SettingRow* found = nullptr;
  for (const SettingRow& row : rows)
    if (row.failure.empty() && row.errors.judged <= error && row.parts.sum() <= error &&
        (found == nullptr || row.cost.us < found->cost.us))
      found = &row;
  return found;
}

}  // namespace railstep
