#pragma once
#include <vector>

#include "offline/system/pack_parts.h"
#include "offline/system/rest.h"
#include "online/model/state.h"

namespace railstep {

struct SystemStartState {
  std::vector<double> state;     // [state_doubles]
  std::vector<double> mobility;  // [joint rows] g M^-1 g' of each row, 1/kg
};

/// Start of the parts: velocities without the part that joints do not allow, which is removed in
/// the metric of the mass; accelerations and joint forces in balance. Joints that depend on each
/// other share their force by least squares.
/// @param model  with the system in it, without a start
/// @param rest   positions in balance with row forces; null: as given, unloaded. Given velocities
///               are added, with the accelerations and joint forces that they cause
SystemStartState start_system(const System& system, const SystemParts& parts, const Model& model,
                              const Rest* rest);

}  // namespace railstep
