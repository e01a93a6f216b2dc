#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "offline/system/pack_system.h"
#include "scene/scene.h"

namespace railstep {

/// Section, material and reference line of a system's beam.
struct BeamBar {
  BarScene bar;
  ReferenceLine line;
};

/// Names of a system's parts, in its order. The name of a spring may be empty.
struct SystemNames {
  std::vector<std::string> bodies, beams, joints, springs, sensors;
};

/// One scene of bodies, beams and joints, alone or beside a track, every number checked and in SI.
/// config/README.md, "Systems", has it key by key.
struct SystemScene {
  std::filesystem::path file;
  std::string sum;             // Table::sum() of it
  std::optional<Scene> track;  // with loads, sensors on rails and sleepers, and the step
  System system;               // beams without section, material, rule and axis
  std::vector<BeamBar> bars;   // [beams] their sections and materials
  SystemNames names;
  TracedForces traced;
  std::vector<InputScene> inputs;
  SystemOptions options{};  // without scheme and steps, which `step` has
  StepScene step{};
};

using AnyScene = std::variant<Scene, SystemScene>;

/// Reads and checks a scene of either kind. Throws InputError.
AnyScene read_any_scene(const std::filesystem::path& file,
                        const std::vector<std::string>& overrides = {});

}  // namespace railstep
