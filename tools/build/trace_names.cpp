#include "build/trace_names.h"

#include "online/step/trace_columns.h"

namespace railstep {
namespace {

struct ColumnNames {
  const TraceNames& names;
  std::vector<std::string> columns;

  const std::vector<std::string>& of(ColumnOf kind) const {
    switch (kind) {
      case ColumnOf::load:
        return names.loads;
      case ColumnOf::wheel:
        return names.wheels;
      case ColumnOf::flange:
        return names.flanges;
      case ColumnOf::runner_wheel:
        return names.runner_wheels;
      case ColumnOf::runner_wheelset:
        return names.runner_wheelsets;
      case ColumnOf::runner:
        return names.runners;
      case ColumnOf::rod:
        return names.rods;
      case ColumnOf::force_element:
        return names.force_elements;
      case ColumnOf::traced_element:
        return names.traced;
      case ColumnOf::external_wheel:
        return names.external_wheels;
      case ColumnOf::sensor:
        return names.sensors;
      case ColumnOf::joint:
        return names.joints;
      case ColumnOf::spring:
        break;
    }
    return names.springs;
  }
  template <typename Column, std::size_t n>
  void operator()(ColumnOf kind, std::int32_t i, const Column (&own)[n]) {
    const std::string& name = of(kind).at(static_cast<std::size_t>(i));
    for (const Column& column : own) columns.push_back(name + "." + column.name);
  }
  void operator()(const TrackSensorModel&) {
    columns.insert(columns.end(), names.track_sensors.begin(), names.track_sensors.end());
  }
};

}  // namespace

std::vector<std::string> columns_of(const Model& model, const TraceNames& names) {
  ColumnNames all{names, {"time_s"}};
  for_each_column(model, all);
  return all.columns;
}

}  // namespace railstep
