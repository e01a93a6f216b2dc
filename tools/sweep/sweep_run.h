#pragma once
#include <string>

#include "scene/scene_system.h"
#include "sweep/sweep_row.h"

namespace railstep {

/// The times of a scene that is stepped. Throws InputError for one that is not.
const StepScene& stepped(const AnyScene& scene);

/// Runs a scene and sums up its trace. A scene that makes no model, and a state that stops being
/// finite, is a row with an error; what has to do with the machine is thrown.
/// @param from  s: the first time of the trace that counts
SweepRow row_of_run(const AnyScene& scene, double from);

}  // namespace railstep
