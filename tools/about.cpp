#include "about.h"

#include <fmt/core.h>

#include "version.h"

namespace railstep {
namespace {

std::string name_of(const StepScene& step, bool held) {
  if (held) return fmt::format("exact under forces held over a step, rho_inf {:g}", step.rho_inf);
  switch (step.scheme) {
    case TimeScheme::backward_euler:
      return "backward Euler";
    case TimeScheme::energy_momentum:
      return "energy-momentum";
    case TimeScheme::generalised_alpha:
      break;
  }
  return fmt::format("generalised-alpha, rho_inf {:g}", step.rho_inf);
}

std::string lines(const std::filesystem::path& file, const std::string& sum, const StepScene& step,
                  bool held) {
  return fmt::format(
      "program: railstep {}\n"
      "scene: {}, sha256 {}\n"
      "units: m, kg, s, N, rad\n"
      "axes: x along the rail, y lateral, z up, right-handed\n"
      "scheme: {}\n"
      "step: {:g} s, {} a frame\n",
      version_text(), file.filename().string(), sum, name_of(step, held), step.dt,
      step.steps_per_frame);
}

}  // namespace

std::string about(const Scene& scene) {
  return lines(scene.file, scene.sum, *scene.step, scene.condense.kind.has_value());
}

std::string about(const SystemScene& scene) {
  return lines(scene.file, scene.sum, scene.step, false);
}

}  // namespace railstep
