// A record of irregularities (CSV), and a scene whose wheel runs over it.
#include <cmath>

#include "mutate.h"
#include "online/model/signal.h"
#include "oracle.h"
#include "scene/irregularity_file.h"
#include "scenes.h"

using namespace railstep;
using namespace railstep::fuzz;

namespace {

constexpr std::string_view kScene = R"(schema = 1
[track]
unknowns = "vertical"
rails = 2
bays = 4
bay_m = 0.6
elements_per_bay = 1
[rail.rectangle]
height_m = 0.17
width_m = 0.05
[support]
stiffness_z_n_per_m = 1e8
damping_z_n_s_per_m = 1e4
[[vehicle]]
name = "mass"
rail = "left"
type = "mass"
mass_kg = 500
start_m = 1
speed_m_per_s = 20
contact = "hertz"
[irregularity]
file = "input.csv"
[step]
dt_s = 1e-4
duration_s = 0.01
)";

void check_signal(const Signal& signal) {
  if (signal.coefficient.empty()) return;
  check(signal.step > 0. && signal.coefficient.size() > 3, "a signal without a step");
  for (const double c : signal.coefficient) check(std::isfinite(c), "a signal that is not finite");
  for (const double place : {-1e30, signal.start, signal.start + signal.step, 1e30}) {
    const SignalValue found = signal_at(signal.model(), place);
    check(std::isfinite(found.value), "a rail that is nowhere");
  }
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed) {
  return mutate_text(data, size, most, seed);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = written("input.csv", text_of(data, size));
  const bool taken = accepts([&] {
    const RailSignals rails = read_irregularities(file);
    for (const auto& side : {rails.y, rails.z})
      for (const Signal& signal : side) check_signal(signal);
  });
  if (taken) run_scene(written("scene.toml", kScene));
  return 0;
}
