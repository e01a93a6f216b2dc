#pragma once
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "offline/pack/artefact.h"
#include "scene/scene_system.h"

namespace railstep {

/// The system of a scene, its beams with their sections. Throws InputError.
System system_of(const SystemScene& scene);

/// What a trace has of a traced joint: what it does to its part B at its point, ground axes.
inline constexpr const char* kJointQuantities[] = {"force_x_n",    "force_y_n",    "force_z_n",
                                                   "moment_x_n_m", "moment_y_n_m", "moment_z_n_m"};

/// A system's model, and the columns of its trace: time_s, those of its track (build.h), then those
/// of every sensor on a body or a beam, of every traced joint and of every traced spring. Throws
/// InputError, in one sentence, for what makes no model.
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
