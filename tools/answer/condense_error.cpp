#include "answer/condense_error.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "build/build_endless.h"
#include "study/reference.h"

namespace railstep {
namespace {

/// The ringing at the start of a released scene is not judged, for at most this time, s.
constexpr double kRinging = .02;

/// Most work of a level of refinement: steps of elements, as many times as those of vertical
/// unknowns. Some seconds.
constexpr double kMostWork = 4e7;

/// Work of a level with `finer` times the elements and the steps, for a second.
double work_of(const Scene& scene, double finer) {
  const std::int64_t meshed = scene.track.bays * mesh_of(scene) * scene.track.rails;
  const double elements = meshed > 0 ? static_cast<double>(meshed) : 1.;  // rigid rails have none
  // Unknowns and the width of their bands.
  const double each = scene.track.unknowns == Unknowns::vertical ? 1. : 12.;
  return each * elements * finer * finer / scene.step->dt;
}

/// Frames of the window: the second level, four times as fine, has to fit where nothing is asked.
std::int64_t frames_of(const Scene& scene, double frame, std::optional<double> asked) {
  const double window = std::min(scene.duration(), asked ? *asked : kMostWork / work_of(scene, 4.));
  return std::max<std::int64_t>(1, std::llround(std::floor(window / frame + 1e-9)));
}

TraceTable run_of(const Scene& scene, std::int64_t frames) {
  Simulation run(scene);
  return compared(run.columns(), simulate(run, frames, {}, true));
}

/// Whether the vehicle's contact replaces Hertz's law by a bond or by a linear spring. The spring
/// of a single mass is not a contact: it is the vehicle's own.
bool stands_for_hertz(const VehicleScene& v) {
  return v.contact == WheelContactKind::bonded ||
         (v.contact == WheelContactKind::linear && v.vehicle.bodies.size() > 1);
}

/// The scene with Hertz's law there; nothing where no wheel has another law.
std::optional<Scene> with_hertz(Scene scene) {
  bool changed = false;
  for (VehicleScene& v : scene.vehicles) {
    if (!stands_for_hertz(v)) continue;
    v.contact = WheelContactKind::hertz;
    changed = true;
  }
  return changed ? std::optional(std::move(scene)) : std::nullopt;
}

}  // namespace

TransientError transient_error(const Scene& scene, const std::vector<std::string>& overrides,
                               std::optional<double> asked) {
  const StepScene& step = *scene.step;  // there, or no model would be
  const double frame = step.dt * static_cast<double>(step.steps_per_frame);
  const std::int64_t frames = frames_of(scene, frame, asked);
  const double window = static_cast<double>(frames) * frame;
  Studied study{scene.file, overrides, frame, {}, frames};
  if (step.start == Start::released) study.judged.from = std::min(.2 * window, kRinging);
  const auto with_small_steps = [&](bool in_full) {
    std::vector<std::string> own = overrides;
    if (in_full) {
      own.insert(own.end(), {"condense.kind=\"full\"", "step.contact=\"penetration\""});
      for (std::string& longer : longer_window(scene)) own.push_back(std::move(longer));
    }
    own.push_back(fmt::format("step.frame_s={:.17g}", frame));
    own.push_back(fmt::format("step.dt_s={:.17g}", .25 * step.dt));
    return read_scene(scene.file, own);
  };
  const TraceTable got = run_of(scene, frames);
  const Reference reference =
      refine(study, {.elements_per_bay = 2 * mesh_of(scene),
                     .step = .5 * step.dt,
                     .target = 0.,
                     .most_levels = window * work_of(scene, 8.) < kMostWork ? 3 : 2,
                     .judged_run = &got});
  const Scene fine = with_small_steps(true);
  const TraceTable full = run_of(fine, frames);
  const TraceTable model = scene.condense.kind ? run_of(with_small_steps(false), frames) : full;
  const auto off = [&](const TraceTable& a, const TraceTable& b) {
    return errors_of(a, b, study.judged).judged;
  };
  const std::optional<Scene> hertz = with_hertz(fine);
  return {study.judged.from,
          window,
          off(got, reference.trace),
          reference.error,
          {.step = off(got, model),
           .condensation = off(model, full),
           .mesh = off(full, reference.trace)},
          hertz ? std::optional(off(full, run_of(*hertz, frames))) : std::nullopt};
}

}  // namespace railstep
