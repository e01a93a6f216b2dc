#include "build/build_unstepped.h"

#include <fmt/core.h>

#include "text/read.h"

namespace railstep {

void refuse_unstepped(const Scene& scene) {
  const auto refuse = [&](bool wanted, const char* what) {
    if (wanted)
      throw InputError("E-BUILD-09", fmt::format("{}: run {}", scene.file.string(), what));
  };
  refuse(scene.loads.empty() && scene.wheelsets.empty() && scene.vehicles.empty() &&
             scene.external_wheels.empty(),
         "needs a [[load]], a [[wheelset]], a [[vehicle]] or an [[external_wheel]] and the scene "
         "has none");
  refuse(!scene.step, "and condense need a [step] and the scene has none");
  refuse(scene.track.model != RailModel::linearised,
         "and condense step the linearised rail; accepted is track.model = \"linearised\"");
  refuse(scene.track.reference_line != ReferenceLine::centroid,
         "and condense have the nodes on the centroid; accepted is track.reference_line = "
         "\"centroid\"");
  refuse(scene.step->steps % scene.step->steps_per_frame != 0,
         "writes whole frames; accepted is a step.duration_s that is a multiple of step.frame_s");
}

}  // namespace railstep
