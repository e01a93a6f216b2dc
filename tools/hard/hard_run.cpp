#include "hard/hard_run.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <iterator>
#include <utility>

#include "run/run_energy.h"

namespace railstep {
namespace {

std::int64_t frames_of(const Model& model) { return model.steps / model.steps_per_frame; }

}  // namespace

HardRun::HardRun(const std::filesystem::path& scene, const std::vector<std::string>& overrides,
                 const FrameInputs& inputs)
    : run_(simulation_of(read_any_scene(scene, overrides))),
      record_(simulate(*run_, frames_of(run_->model()), nullptr, true, nullptr, inputs)),
      inputs_(inputs) {}

std::vector<double> HardRun::column(const std::string& name) const {
  const std::vector<std::string>& names = run_->columns();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    throw InputError("E-HARD-02", fmt::format("the trace has no column {}; expected one of {}",
                                              name, fmt::join(names, ", ")));
  std::vector<double> values;
  values.reserve(record_.rows.size() / names.size());
  for (auto i = static_cast<std::size_t>(std::distance(names.begin(), found));
       i < record_.rows.size(); i += names.size())
    values.push_back(record_.rows[i]);
  return values;
}

double HardRun::at(double time_s, const std::string& name) const {
  const double frame = run_->model().scheme.dt * run_->model().steps_per_frame;
  return column(name).at(static_cast<std::size_t>(std::llround(time_s / frame)));
}

double HardRun::largest(const std::string& name) const {
  const std::vector<double> values = column(name);
  return *std::max_element(values.begin(), values.end());
}

double HardRun::smallest(const std::string& name) const {
  const std::vector<double> values = column(name);
  return *std::min_element(values.begin(), values.end());
}

std::string HardRun::status() const {
  return fmt::format("{}", fmt::join(status_names(record_.status), " "));
}

std::optional<EnergyBalance> HardRun::energy() const {
  return balance_of_run(*run_, record_, frames_of(run_->model()), inputs_);
}

HardCurve HardRun::curve(const std::string& name, const std::string& title, double scale) const {
  HardCurve curve{title, time(), column(name)};
  for (double& value : curve.y) value *= scale;
  return curve;
}

std::string condensed_to(const char* kind) { return fmt::format("condense.kind=\"{}\"", kind); }

bool all_finite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), sizeof(double) * a.size()) == 0;
}

std::string refusal(const std::filesystem::path& scene, const std::vector<std::string>& overrides) {
  try {
    simulation_of(read_any_scene(scene, overrides));
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

}  // namespace railstep
