#pragma once
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "offline/pack/artefact.h"
#include "scene/scene_system.h"

namespace railstep {

/// The system of a scene; its beams have their sections. Throws InputError.
System system_of(const SystemScene& scene);

/// A system's model, and the columns of its trace. Throws InputError where no model can be made.
struct BuiltSystem {
  explicit BuiltSystem(const SystemScene& scene);
  SystemNames names;
  System system;
  std::vector<std::string> columns;
  std::vector<std::string> inputs;  // NAME.force_n or NAME.moment_n_m of each
  std::string about;                // about.h
  std::unique_ptr<PackedSystem> packed;
};

/// The model and its columns in one block. @param notes  about is the scene's
std::vector<std::byte> block_of(const BuiltSystem& built, BlockNotes notes = {});

}  // namespace railstep
