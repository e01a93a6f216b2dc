#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "hard/hard_run.h"

namespace railstep {
namespace {

// H4 -------------------------------------------------------------------------------------------

/// A drop as the trace has it, row by row.
struct Impact {
  double peak, peak_time;  // N, s
  double leaves;           // s: the first row without force after the peak
  double wheel;            // m/s then, up
};

Impact impact_of(const HardRun& run) {
  const std::vector<double> force = run.column("wheel.wheel_1.force_z_n"), time = run.time();
  const auto peak = std::max_element(force.begin(), force.end());
  const auto left = std::find_if(peak, force.end(), [](double f) { return f <= 0.; });
  const auto row = [&](auto at) { return static_cast<std::size_t>(at - force.begin()); };
  const std::size_t last = std::min(row(left), force.size() - 1);
  return {*peak, time[row(peak)], time[last], run.column("wheel.vz_m_per_s")[last]};
}

/// What is known of a drop by another way.
struct KnownDrop {
  const char* name;
  std::vector<std::string> overrides;
  Impact impact;
  double bound;  // at 10 us
};

/// Over a rail of 24 bays without weight, as a user would type it.
std::vector<std::string> on_supported_rail() {
  return {"track.bays=24",
          "track.bay_m=0.6",
          "track.elements_per_bay=2",
          "rail.density_kg_per_m3=1.0",
          "rail.constants={area_m2=8.7e-3,inertia_y_m4=39e-6,inertia_z_m4=6e-6,"
          "torsion_m4=1.9514e-6,shear_factor_y=0.4796,shear_factor_z=0.472,"
          "centroid_height_m=0.085,shear_centre_height_m=0.0459,height_m=0.1857375}",
          "support.stiffness_z_n_per_m=3e7",
          "support.damping_z_n_s_per_m=3e4",
          "vehicle[0].start_m=7.2",
          "sensor[1].position_m=7.2",
          "step.duration_s=12e-3"};
}

HardResult drop(const std::filesystem::path& scene) {
  const std::vector<std::string> rigid = {"support.stiffness_z_n_per_m=1e13"};
  std::vector<std::string> floating = rigid;
  floating.emplace_back("vehicle[0].gravity=false");
  const KnownDrop known[] = {
      {"R1 without weight", floating, {82.13323e3, .5 * 2.687653e-3, 2.687653e-3, .1}, 1e-3},
      {"R1", rigid, {91.27067e3, .5 * 2.773441e-3, 2.773441e-3, .1}, 1e-3},
      {"R2", {}, {33.747495e3, .7328714e-3, 1.5365055e-3, -.0692294}, 1e-3},
      {"R3", on_supported_rail(), {21.62e3, 4.285e-3, 11.295e-3, .0525}, 5e-3}};
  HardResult result;
  result.picture = {"time, s", "wheel-rail force, kN", {}};
  for (const KnownDrop& own : known) {
    for (const double dt : {5e-5, 1e-5}) {
      std::vector<std::string> overrides = own.overrides;
      overrides.push_back(fmt::format("step.dt_s={}", dt));
      const HardRun run(scene, overrides);
      const Impact found = impact_of(run);
      const double bound = dt > 2e-5 ? 1e-2 : own.bound;
      const std::string at = fmt::format("{}, {:.0f} us: ", own.name, 1e6 * dt);
      result.checks.push_back(off_by(at + "peak force", found.peak, own.impact.peak, bound));
      result.checks.push_back(
          apart_by(at + "time of the end, steps", found.leaves / dt, own.impact.leaves / dt, 1.));
      result.checks.push_back(
          off_by(at + "speed of the wheel then", found.wheel, own.impact.wheel, bound));
      result.checks.push_back(holds(at + "no status bit", run.status().empty()));
      if (dt > 2e-5) continue;
      result.picture.curves.push_back(run.curve("wheel.wheel_1.force_z_n", own.name, 1e-3));
      result.picture.curves.push_back({own.name + std::string(", known"),
                                       {own.impact.peak_time},
                                       {1e-3 * own.impact.peak},
                                       true});
      result.frame_us = run.frame_us();
    }
  }
  return result;
}

}  // namespace

std::vector<HardCase> contact_cases() {
  return {{"H4", "h04_drop", "A wheel falls on a rail: rigid, one mass, on seats",
           "A contact is stiff and short: 1.5 to 11 ms from touch to leave, no force before or "
           "after.",
           "R1 to R3 of the reference solutions: quadrature of the energy (1e-8), two masses by "
           "DOP853 (1e-8), a rail without mass on springs (3e-4).",
           drop}};
}

}  // namespace railstep
