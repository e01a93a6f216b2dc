#include "hil/hil_response.h"

#include <fmt/core.h>

#include <algorithm>

#include "online/step/step.h"

namespace railstep {
namespace {

constexpr const char kAxes[] = {'x', 'y', 'z'};

/// The names of the external wheels.
std::vector<std::string> wheels_of(const Simulation& run) {
  std::vector<std::string> names;
  for (std::int32_t n = 0; n < run.model().external_wheels; ++n) {
    const auto at = static_cast<std::size_t>(run.model().external_wheel[n].input) + kExternalX;
    const std::string& place = run.inputs()[at];  // NAME.x_m
    names.push_back(place.substr(0, place.rfind('.')));
  }
  return names;
}

}  // namespace

Response::Response(const Simulation& run)
    : wheels_(static_cast<std::size_t>(run.model().external_wheels)),
      places_(kExternalPlaces * wheels_, 0.),
      inputs_(static_cast<std::size_t>(run.model().inputs)),
      compliance_(9 * wheels_ * wheels_) {}

void Response::add_names(const Simulation& run, std::vector<std::string>& inputs,
                         std::vector<std::string>& outputs) {
  const std::vector<std::string> wheels = wheels_of(run);
  for (const std::string& wheel : wheels)
    for (const char axis : {'x', 'y'})
      for (std::vector<std::string>* const names : {&inputs, &outputs})
        names->push_back(fmt::format("{}.next_{}_m", wheel, axis));
  for (const std::string& wheel : wheels)
    for (const char axis : kAxes) outputs.push_back(fmt::format("{}.free_d{}_m", wheel, axis));
  for (std::size_t i = 0; i < 3 * wheels.size(); ++i)
    for (std::size_t j = 0; j <= i; ++j)
      outputs.push_back(fmt::format("{}.d{}_per_{}.force_{}_m_per_n", wheels[i / 3], kAxes[i % 3],
                                    wheels[j / 3], kAxes[j % 3]));
}

void Response::ask(const double* places) noexcept {
  std::copy_n(places, places_.size(), places_.begin());
}

Status Response::answer(Simulation& run, const double* given, double* values) noexcept {
  const Model& model = run.model();
  std::copy_n(given, inputs_.size(), inputs_.begin());
  for (std::size_t n = 0; n < wheels_; ++n)
    std::copy_n(places_.begin() + static_cast<std::ptrdiff_t>(kExternalPlaces * n), kExternalPlaces,
                inputs_.begin() + model.external_wheel[n].input);
  double* const free = std::copy(places_.begin(), places_.end(), values);
  const Status met =
      external_response(model, inputs_.data(), run.state, run.workspace, free, compliance_.data());
  const std::size_t rows = 3 * wheels_;
  double* to = free + rows;
  for (std::size_t i = 0; i < rows; ++i)
    to = std::copy_n(compliance_.begin() + static_cast<std::ptrdiff_t>(i * rows), i + 1, to);
  return met;
}

}  // namespace railstep
