// A section file (TOML), as `railstep fit --out` writes it, and a scene whose rail has it.
#include <cmath>

#include "mutate.h"
#include "oracle.h"
#include "scenes.h"
#include "section/section_file.h"

using namespace railstep;
using namespace railstep::fuzz;

namespace {

constexpr std::string_view kScene = R"(schema = 1
[track]
unknowns = "full"
rails = 1
bays = 3
bay_m = 0.6
elements_per_bay = 1
[rail]
section = "input.toml"
[support]
stiffness_x_n_per_m = 5e7
stiffness_y_n_per_m = 5e7
stiffness_z_n_per_m = 2e8
stiffness_roll_n_m_per_rad = 3e5
[[load]]
name = "load"
at = "head"
start_m = 0.5
speed_m_per_s = 20
force_z_n = -5e4
[step]
dt_s = 1e-4
duration_s = 0.01
)";

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed) {
  return mutate_text(data, size, most, seed);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = written("input.toml", text_of(data, size));
  static_cast<void>(accepts([&] { static_cast<void>(read_dimensions(file)); }));
  const bool taken = accepts([&] {
    const Section found = read_section(file);
    check(found.area.area > 0. && std::isfinite(found.area.area), "a section without an area");
    check(found.area.centroid_height < found.height, "a centroid over the section");
  });
  if (taken) run_scene(written("scene.toml", kScene));
  return 0;
}
