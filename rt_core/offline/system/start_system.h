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

/// Velocities of the parts, what joints do not allow of them taken out in the metric of the mass;
/// accelerations and joint forces in balance. Joints that depend on each other share their force by
/// least squares. @param model  with the system in it, without a start
/// @param rest  where all stands, in balance with its row forces; null: as given, unloaded.
/// Velocities
///              come on top, and with them what they change of accelerations and joint forces
SystemStartState start_system(const System& system, const SystemParts& parts, const Model& model,
                              const Rest* rest);

}  // namespace railstep
