#include "build/about.h"

#include <fmt/core.h>

#include "build/step_scheme.h"
#include "build/version.h"

namespace railstep {
namespace {

std::string name_of(const StepScene& step, bool held) {
  return held ? held_scheme_text(step) : scheme_text(step);
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
  return lines(scene.file, scene.sum, scene.step,
               scene.track && scene.track->condense.kind.has_value());
}

}  // namespace railstep
