#include <fmt/core.h>

#include "scene/scene_read.h"
#include "scene/scene_system_read.h"

namespace railstep {
namespace {

StepScene read_step(const Table& t) {
  if (t.has("scheme") && t.string("scheme") == "energy-momentum")
    t.refuse("scheme", "E-BODY-06",
             "scheme = \"energy-momentum\" steps bodies and beams without a track; "
             "expected \"generalised-alpha\", \"backward-euler\", \"newmark\" or "
             "\"hht\" beside one");
  if (t.has("scheme") && t.string("scheme") == "tr-bdf2")
    t.refuse("scheme", "E-BODY-07",
             "scheme = \"tr-bdf2\" has two stages, which the step of bodies and beams "
             "does not have; expected \"generalised-alpha\", \"backward-euler\", "
             "\"newmark\" or \"hht\"");
  const StepScene step = read_track_step(t);
  check_frames(t, step);
  return step;
}

void check_model(const Table& t, const TrackScene& track) {
  if (track.endless)
    t.refuse("length", "E-BODY-08",
             "bodies and beams stand still, but a track without end goes on under its "
             "traffic; expected a track with ends beside them");
  if (track.model != RailModel::linearised)
    t.refuse("model", "E-BODY-09",
             fmt::format("model = \"{}\" is not stepped beside bodies and beams; expected "
                         "\"linearised\"",
                         t.string("model")));
  if (track.reference_line != ReferenceLine::centroid)
    t.refuse("reference_line", "E-BODY-10",
             fmt::format("reference_line = \"{}\" is not stepped beside bodies and beams; "
                         "expected \"centroid\"",
                         t.string("reference_line")));
}

void check_system(const Table& root, const SystemScene& scene, const TrackScene& track) {
  if (scene.options.constraint_method == ConstraintMethod::gear_gupta_leimkuhler)
    root.table("joints").refuse("hold", "E-BODY-11",
                                "hold = \"gear-gupta-leimkuhler\" does not hold joints on a track; "
                                "expected \"augmented-lagrangian\", \"baumgarte\" or \"direct\"");
  if (scene.system.planar && track.rails != 1)
    root.table("system").refuse("planar", "E-BODY-12",
                                "planar = true is the plane y = 0, where two rails have no place; "
                                "expected planar = false, or track.rails = 1");
}

}  // namespace

Scene read_track_beside(const Table& root, const SystemScene& scene, NameBook& names,
                        Intact& intact) {
  if (root.has("static"))
    root.attempt({"static"}, [&] {
      root.refuse("static", "E-BODY-05",
                  "[static] belongs to `railstep static`, which takes a track alone; "
                  "expected a scene of a track and bodies without it");
    });
  Scene track;
  const bool is_stepped =
      root.attempt_alone({"step"}, [&] { track.step = read_step(root.table("step")); });
  if (!is_stepped) track.step.reset();
  intact = read_rails(root, track);
  check_model(root.table("track"), track.track);
  check_system(root, scene, track.track);
  read_traffic(root, track, intact);
  root.attempt(
      {}, [&] { read_residual_beside(root, track); }, intact.condensed && intact.traffic);
  claim_names(root, track, names);
  return track;
}

}  // namespace railstep
