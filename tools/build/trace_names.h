#pragma once
#include <string>
#include <vector>

#include "online/model/model.h"

namespace railstep {

/// Names that the columns of a trace begin with, each list in the model's order.
struct TraceNames {
  std::vector<std::string> loads, wheels;
  std::vector<std::string> flanges;  // names of the wheels that have one
  std::vector<std::string> runner_wheels, runner_wheelsets, runners, rods, force_elements,
      traced;  // of vehicles in space
  std::vector<std::string> external_wheels;
  std::vector<std::string> track_sensors;    // whole names of columns
  std::vector<std::string> sensors;          // of a system
  std::vector<std::string> joints, springs;  // of a system: those traced
};

/// Names of all columns of a model's trace: time_s, then those of online/step/trace_columns.h.
std::vector<std::string> columns_of(const Model& model, const TraceNames& names);

}  // namespace railstep
