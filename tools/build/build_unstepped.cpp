#include "build/build_unstepped.h"

#include <fmt/core.h>

#include "text/read.h"

namespace railstep {

void refuse_unstepped(const Scene& scene) {
  const auto refuse = [&](bool unstepped, MessageId id, const char* sentence) {
    if (unstepped) throw InputError(id, fmt::format("{}: {}", scene.file.string(), sentence));
  };
  refuse(scene.loads.empty() && !has_wheels(scene) && scene.external_wheels.empty(), "E-SCENE-38",
         "nothing runs on the track; expected a [[load]], a [[wheelset]], a [[vehicle]] or an "
         "[[external_wheel]]");
  refuse(!scene.step, "E-STEP-11", "the scene has no [step]; expected one to run or condense it");
  refuse(scene.track.model != RailModel::linearised, "E-SCENE-39",
         "a run steps the linearised rail; expected track.model = \"linearised\"");
  refuse(scene.track.reference_line != ReferenceLine::centroid, "E-SCENE-40",
         "a run has the nodes on the centroid; expected track.reference_line = \"centroid\"");
  refuse(scene.step->steps % scene.step->steps_per_frame != 0, "E-STEP-09",
         "step.duration_s is not a multiple of step.frame_s, but a run is written in whole frames; "
         "expected a multiple of step.frame_s");
}

}  // namespace railstep
