#include "hard/step_stability.h"

#include <fmt/core.h>

#include "hard/growth.h"

namespace railstep {

namespace {

constexpr double kDamps = 1e-9;
constexpr double kKeeps =
    1e-6;  // roots of modulus 1 may be double: rounding moves them by its root

}  // namespace

const std::vector<SteppedWay>& stepped_ways() {
  static const std::vector<SteppedWay> ways = {
      {"generalised-alpha 0.6", {}, kDamps},
      {"generalised-alpha 0", {"step.rho_inf=0.0"}, kDamps},
      {"generalised-alpha 1", {"step.rho_inf=1.0"}, kKeeps},
      {"backward Euler", {"step.scheme=\"backward-euler\""}, kDamps},
      {"Newmark", {"step.scheme=\"newmark\""}, kKeeps},
      {"HHT", {"step.scheme=\"hht\""}, kDamps},
      {"TR-BDF2", {"step.scheme=\"tr-bdf2\""}, kDamps},
      {"condensed, 0.6", {"condense.kind=\"modal\""}, kDamps},
      {"condensed, 0", {"condense.kind=\"modal\"", "step.rho_inf=0.0"}, kDamps},
      {"condensed, 1", {"condense.kind=\"modal\"", "step.rho_inf=1.0"}, kKeeps},
      {"condensed, discrete gradient",
       {"condense.kind=\"modal\"", "step.contact=\"discrete-gradient\"",
        "vehicle[0]={name=\"wheel\", type=\"mass\", contact=\"hertz\", start_m=0.8, "
        "speed_m_per_s=0.0, mass_kg=1.0}"},
       kKeeps}};
  return ways;
}

std::vector<Growth> stability_map(const std::filesystem::path& scene, const SteppedWay& way) {
  std::vector<Growth> map;
  for (const double step : {1e-5, 2e-5, 5e-5, 1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3, 1e-2, 2e-2})
    for (const double pad : {1e6, 1e7, 1e8, 1e9, 1e10})
      for (const double mass : {1., 600., 2e4}) {
        std::vector<std::string> overrides = way.overrides;
        overrides.push_back(fmt::format("step.dt_s={}", step));
        overrides.push_back(fmt::format("support.stiffness_z_n_per_m={}", pad));
        overrides.push_back(fmt::format("vehicle[0].mass_kg={}", mass));
        Simulation run(read_scene(scene, overrides));
        map.push_back({&way, step, pad, mass, growth_of(run)});
      }
  return map;
}

}  // namespace railstep
