#include <fmt/core.h>

#include <algorithm>

#include "hard/growth.h"
#include "hard/hard_run.h"

namespace railstep {
namespace {

/// A way to step: its name and what of the scene says so.
struct Way {
  const char* name;
  std::vector<std::string> overrides;
};

const std::vector<Way> kWays = {
    {"generalised-alpha 0.6", {}},
    {"generalised-alpha 0", {"step.rho_inf=0.0"}},
    {"generalised-alpha 1", {"step.rho_inf=1.0"}},
    {"backward Euler", {"step.scheme=\"backward-euler\""}},
    {"Newmark", {"step.scheme=\"newmark\""}},
    {"HHT", {"step.scheme=\"hht\""}},
    {"TR-BDF2", {"step.scheme=\"tr-bdf2\""}},
    {"condensed", {"condense.kind=\"modal\""}},
    {"condensed 0", {"condense.kind=\"modal\"", "step.rho_inf=0.0"}},
    {"condensed 1", {"condense.kind=\"modal\"", "step.rho_inf=1.0"}},
    {"condensed, discrete gradient",
     {"condense.kind=\"modal\"", "step.contact=\"discrete-gradient\""}}};

double growth_at(const std::filesystem::path& scene, const Way& way, double dt, double pad,
                 double mass) {
  std::vector<std::string> overrides = way.overrides;
  overrides.push_back(fmt::format("step.dt_s={}", dt));
  overrides.push_back(fmt::format("support.stiffness_z_n_per_m={}", pad));
  overrides.push_back(fmt::format("vehicle[0].mass_kg={}", mass));
  overrides.push_back("step.duration_s=0.1");
  Simulation run(read_scene(scene, overrides));
  return growth_of(run);
}

HardResult stability(const std::filesystem::path& scene) {
  HardResult result;
  result.picture = {"step, s", "largest growth of a step, less 1", {}, true, false};
  for (const Way& way : kWays) {
    double worst = -1.;
    std::string where;
    HardCurve curve{way.name, {}, {}};
    for (const double dt : {1e-5, 1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3, 2e-2}) {
      double at_step = -1.;
      for (const double pad : {1e6, 3e7, 1e9, 1e11})
        for (const double mass : {1., 30., 600., 2e4}) {
          const double growth = growth_at(scene, way, dt, pad, mass) - 1.;
          at_step = std::max(at_step, growth);
          if (growth > worst) {
            worst = growth;
            where = fmt::format("{:g} s, {:g} N/m, {:g} kg", dt, pad, mass);
          }
        }
      curve.x.push_back(dt);
      curve.y.push_back(at_step);
    }
    result.checks.push_back(
        {fmt::format("{}: growth of a step, over 1, at most at {}", way.name, where), worst, 1e-9});
    result.picture.curves.push_back(curve);
  }
  return result;
}

}  // namespace

std::vector<HardCase> stability_cases() {
  return {{"H49", "h49_stability", "The coupled step over step, pad stiffness and wheel mass",
           "Contact couples a light or heavy wheel to a soft or stiff track within the step.",
           "No reference: the spectral radius of the step's linear map.", stability}};
}

}  // namespace railstep
