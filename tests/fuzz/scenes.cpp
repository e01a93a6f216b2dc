#include "scenes.h"

#include <cstring>
#include <optional>
#include <vector>

#include "oracle.h"
#include "run/simulation.h"
#include "stepping.h"

namespace railstep::fuzz {
namespace {

constexpr double kMostUnknowns = 1500.;  // of a track
constexpr int kMostElements = 40;        // of all beams of a system

bool is_small(const Scene& scene) {
  const TrackScene& track = scene.track;
  constexpr double kPerNode[] = {9., 6., 2.};  // full, rigid section, vertical
  const double nodes = 2. * track.rails * static_cast<double>(track.bays) * track.elements_per_bay;
  if (nodes * kPerNode[static_cast<int>(track.unknowns)] > kMostUnknowns) return false;
  if (scene.step && scene.step->steps_per_frame > 50) return false;
  if (scene.irregularity && scene.irregularity->file.empty()) {
    const GenerateOptions& o = scene.irregularity->options;
    if (!(o.length <= 2e3 * o.shortest)) return false;
  }
  return scene.condense.modes_per_bay.value_or(1.) <= 50.;
}

bool is_small(const SystemScene& scene) {
  int elements = 0;
  for (const FlexibleBeam& beam : scene.system.beams) elements += beam.elements;
  return elements <= kMostElements && scene.step.steps_per_frame <= 20 &&
         scene.system.bodies.size() <= 12 && (!scene.track || is_small(*scene.track));
}

/// The block of a scene, or nothing if its building is refused.
std::optional<std::vector<std::byte>> block_of(const AnyScene& scene) {
  std::optional<std::vector<std::byte>> block;
  accepts([&] { block = simulation_of(scene)->block(); });
  return block;
}

/// Bytes after the header, which holds the file's name.
std::vector<std::byte> payload_of(const std::vector<std::byte>& block) {
  std::uint32_t from = 0;
  std::memcpy(&from, block.data() + 20, sizeof from);
  return {block.begin() + from, block.end()};
}

/// Checks that a scene written again is the same scene and is then written to the same bytes.
void check_rewritten(const std::filesystem::path& file, const std::vector<std::byte>& block) {
  const std::filesystem::path place = folder() / "again.toml";
  const std::string text = rewritten(file, {}, place);
  written("again.toml", text);
  check(rewritten(place, {}, place) == text, "a scene is not written as it was read");
  const auto again = block_of(read_any_scene(place));
  check(again && payload_of(*again) == payload_of(block), "a scene written again is another one");
}

}  // namespace

bool is_small(const AnyScene& scene) {
  return std::visit([](const auto& kind) { return is_small(kind); }, scene);
}

void run_scene(const std::filesystem::path& file) {
  accepts([&] {
    const AnyScene scene = read_any_scene(file);
    if (!is_small(scene)) return;
    const auto block = block_of(scene);
    if (!block) return;
    check(step_block(*block, true), "a model of this program is refused");
    check_rewritten(file, *block);
  });
}

}  // namespace railstep::fuzz
