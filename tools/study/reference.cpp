#include "study/reference.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "build/build_endless.h"
#include "build/build_unstepped.h"

namespace railstep {
namespace {

/// The order seen over three levels, of 1 to 2.
double order_of(double coarse, double fine) {
  return fine > 0. ? std::clamp(std::log2(coarse / fine), 1., 2.) : 2.;
}

Scene scene_of(const Studied& study) { return read_scene(study.file, study.overrides); }

double target_of(const Studied& study, const Refinement& refinement, const TraceTable& reference) {
  if (refinement.judged_run == nullptr) return refinement.target;
  return .1 * errors_of(*refinement.judged_run, reference, study.judged).judged;
}

}  // namespace

Studied study_of(const std::filesystem::path& file, const std::vector<std::string>& overrides,
                 const Judged& judged) {
  const AnyScene any = read_any_scene(file, overrides);
  const Scene* const scene = std::get_if<Scene>(&any);
  if (scene == nullptr)
    throw InputError(
        "E-STUDY-06",
        fmt::format("{}: this is a system of bodies and beams; expected a scene of a track",
                    file.string()));
  refuse_unstepped(*scene);
  if (!scene->external_wheels.empty())
    throw InputError("E-STUDY-07",
                     fmt::format("{}: the scene has an [[external_wheel]], whose forces another "
                                 "program makes; expected a scene without one",
                                 file.string()));
  const StepScene& step = *scene->step;
  Studied study{file, overrides, step.dt * static_cast<double>(step.steps_per_frame), judged};
  if (judged.from == 0. && step.start == Start::released)
    study.judged.from = .2 * scene->duration();
  if (study.judged.from >= scene->duration())
    throw InputError("E-STUDY-08",
                     fmt::format("{}: nothing is left to compare from {:g} s on; expected a time "
                                 "before the end of the run at {:g} s",
                                 file.string(), judged.from, scene->duration()));
  return study;
}

std::vector<std::string> overrides_of(const Studied& study, const Setting& setting) {
  std::vector<std::string> all = study.overrides;
  all.push_back(fmt::format("step.frame_s={:.17g}", study.frame));
  for (std::string& own : overrides_of(setting)) all.push_back(std::move(own));
  if (is_condensed(setting.model)) return all;
  for (std::string& own : longer_window(scene_of(study))) all.push_back(std::move(own));
  return all;
}

Scene scene_with(const Studied& study, const Setting& setting) {
  return read_scene(study.file, overrides_of(study, setting));
}

TraceTable run_of(const Studied& study, const Setting& setting) {
  Simulation run(scene_with(study, setting));
  const Model& model = run.model();
  const std::int64_t frames = study.frames > 0 ? study.frames : model.steps / model.steps_per_frame;
  return compared(run.columns(), simulate(run, frames, {}, true));
}

Reference refine(const Studied& study, const Refinement& refinement,
                 const std::function<void(int)>& after) {
  Setting setting{"full", refinement.elements_per_bay, plain_scheme("full", *scene_of(study).step),
                  refinement.step};
  Reference found;
  double change = 0.;
  for (int level = 0; level < refinement.most_levels; ++level) {
    TraceTable trace = run_of(study, setting);
    if (level > 0) {
      const double before = change;
      change = errors_of(found.trace, trace, study.judged).judged;
      const double order = level > 1 ? order_of(before, change) : 1.;
      found.error = change / (std::exp2(order) - 1.);
    }
    found.trace = std::move(trace);
    found.how =
        fmt::format("full order, {} elements a bay, {}, {:.6g} us; {} level{} of mesh and step",
                    setting.elements_per_bay, setting.scheme, 1e6 * setting.step, level + 1,
                    level == 0 ? "" : "s");
    if (after) after(level + 1);
    if (level > 0 && found.error <= target_of(study, refinement, found.trace)) break;
    setting.elements_per_bay *= 2;
    setting.step /= 2.;
  }
  return found;
}

Reference named_reference(const std::filesystem::path& trace, double error) {
  return {TraceTable::read(trace), fmt::format("{}, as named", trace.filename().string()), error};
}

}  // namespace railstep
