#pragma once
#include <memory>
#include <string>
#include <vector>

#include "scene_system.h"

namespace railstep {

/// The system of a scene, its beams with their sections. Throws InputError.
System system_of(const SystemScene& scene);

/// A system's model, and the columns of its trace: time_s, then those of every sensor. Throws
/// InputError, in one sentence, for what makes no model.
struct BuiltSystem {
  explicit BuiltSystem(const SystemScene& scene);
  SystemNames names;
  System system;
  std::vector<std::string> columns;
  std::unique_ptr<PackedSystem> packed;
};

}  // namespace railstep
