#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "hard/contact_checks.h"

namespace railstep {
namespace {

/// Steps of 50 us or less must be right to 1 %, those of 10 us to the bound that a case states.
bool coarse(double dt) { return dt > 2e-5; }

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
  return {*peak, time[row(peak)], time[last], run.column("centre.vz_m_per_s")[last]};
}

/// Results of a drop that are found in another way.
struct KnownDrop {
  const char* name;
  std::vector<std::string> overrides;
  Impact impact;
  double bound;  // at 10 us
};

/// Over a rail of 24 bays, as a user would type it.
std::vector<std::string> on_supported_rail() {
  std::string section = "rail.constants={area_m2=8.7e-3,inertia_y_m4=39e-6,inertia_z_m4=6e-6,";
  section += "torsion_m4=1.9514e-6,shear_factor_y=0.4796,shear_factor_z=0.472,";
  section += "centroid_height_m=0.085,shear_centre_height_m=0.0459,height_m=0.1857375}";
  return {"track.bays=24",
          "track.bay_m=0.6",
          "track.elements_per_bay=4",
          "rail.density_kg_per_m3=7850.0",
          section,
          "support.stiffness_z_n_per_m=3e7",
          "support.damping_z_n_s_per_m=3e4",
          "condense.residual_flexibility=true",
          "vehicle[0].start_m=7.2",
          "sensor[1].position_m=7.2",
          "step.duration_s=12e-3"};
}

std::vector<KnownDrop> known_drops() {
  const std::vector<std::string> rigid = {"support.stiffness_z_n_per_m=1e13"};
  std::vector<std::string> floating = rigid;
  floating.emplace_back("vehicle[0].gravity=false");
  return {{"R1 without weight", floating, {82.13323e3, .5 * 2.687653e-3, 2.687653e-3, .1}, 1e-3},
          {"R1", rigid, {91.27067e3, .5 * 2.773441e-3, 2.773441e-3, .1}, 1e-3},
          {"R2", {}, {33.747495e3, .7328714e-3, 1.5365055e-3, -.0692294}, 1e-3},
          {"R3", on_supported_rail(), {21.62e3, 4.285e-3, 11.295e-3, .0525}, 5e-3}};
}

void check_drop(HardResult& result, const KnownDrop& known, const HardRun& run, double dt) {
  const Impact found = impact_of(run);
  const double bound = coarse(dt) ? 1e-2 : known.bound;
  const std::string at = fmt::format("{}, {:.0f} us: ", known.name, 1e6 * dt);
  result.checks.push_back(off_by(at + "peak force", found.peak, known.impact.peak, bound));
  result.checks.push_back(
      apart_by(at + "time of the end, steps", found.leaves / dt, known.impact.leaves / dt, 1.));
  result.checks.push_back(
      off_by(at + "speed of the wheel then", found.wheel, known.impact.wheel, bound));
  result.checks.push_back(
      holds(at + "it says that the wheel was free, and no more", run.status() == "contact_lost"));
  // Generalised-alpha is not a discrete gradient: its rebound is printed as 1.0000 at 100 steps a
  // contact, half a digit of which is 1e-4 of the energy; ten times that for 50 us.
  check_energy(result, run, at, coarse(dt) ? 1e-3 : 1e-4, 1e-6);
}

HardResult drop(const std::filesystem::path& scene) {
  HardResult result;
  result.picture = {"time, s", "wheel-rail force, kN", {}};
  for (const KnownDrop& known : known_drops()) {
    for (const double dt : {5e-5, 1e-5}) {
      std::vector<std::string> overrides = known.overrides;
      overrides.push_back(fmt::format("step.dt_s={}", dt));
      const HardRun run(scene, overrides);
      check_drop(result, known, run, dt);
      if (coarse(dt)) continue;
      result.picture.curves.push_back(run.curve("wheel.wheel_1.force_z_n", known.name, 1e-3));
      result.picture.curves.push_back({known.name + std::string(", known"),
                                       {known.impact.peak_time},
                                       {1e-3 * known.impact.peak},
                                       true});
      result.frame_us = run.frame_us();
    }
  }
  return result;
}

// H5, H6 ---------------------------------------------------------------------------------------

/// A blow to a wheel that runs, known by another way.
struct KnownBlow {
  double speed;       // m/s
  double duration;    // s
  double peak, time;  // N; s, of the run; 0: not known
  bool free;          // the wheel leaves the rail
};

/// Both wheels of the scene at its speed.
std::vector<std::string> run_as(const KnownBlow& known, double dt) {
  return {fmt::format("vehicle[0].speed_m_per_s={}", known.speed),
          fmt::format("vehicle[1].speed_m_per_s={}", -known.speed),
          fmt::format("step.duration_s={}", known.duration), fmt::format("step.dt_s={}", dt)};
}

void check_blow(HardResult& result, const KnownBlow& known, const HardRun& run, double dt) {
  const std::string at = fmt::format("{} m/s, {:.0f} us: ", known.speed, 1e6 * dt);
  const std::vector<double> force = run.column("wheel.wheel_1.force_z_n"),
                            mirrored = run.column("mirror.wheel_1.force_z_n");
  const auto peak = std::max_element(force.begin(), force.end());
  if (known.peak > 0.)
    result.checks.push_back(off_by(at + "peak force", *peak, known.peak, coarse(dt) ? 1e-2 : 1e-3));
  if (known.time > 0.)
    result.checks.push_back(apart_by(
        at + "its time, steps", run.time()[static_cast<std::size_t>(peak - force.begin())] / dt,
        known.time / dt, 1.));
  result.checks.push_back(
      holds(at + (known.free ? "the wheel leaves" : "the wheel never leaves"),
            (*std::min_element(force.begin(), force.end()) == 0.) == known.free));
  // The rail does not pitch: what a wheel's force has of rounding, over the peak.
  result.checks.push_back({at + "force less its mirror image's, over the peak",
                           largest_gap(force, mirrored) / *peak, 1e-9});
  // A Hertz spring's energy goes with its force (to the power of 5/3): the bound of the force.
  check_energy(result, run, at, coarse(dt) ? 1e-2 : 1e-3, 1e-6);
}

/// All speeds at 50 and 10 us; the picture has those of 10 us.
HardResult blows(const std::filesystem::path& scene, const std::vector<KnownBlow>& all) {
  HardResult result;
  result.picture = {"time, s", "wheel-rail force, kN", {}};
  for (const KnownBlow& known : all)
    for (const double dt : {5e-5, 1e-5}) {
      const HardRun run(scene, run_as(known, dt));
      check_blow(result, known, run, dt);
      if (coarse(dt)) continue;
      const std::string name = fmt::format("{} m/s", known.speed);
      result.picture.curves.push_back(run.curve("wheel.wheel_1.force_z_n", name, 1e-3));
      if (known.time > 0.)
        result.picture.curves.push_back(
            {name + ", known", {known.time}, {1e-3 * known.peak}, true});
      result.frame_us = run.frame_us();
    }
  return result;
}

HardResult flat(const std::filesystem::path& scene) {
  constexpr double kBegins = .01;  // m: where the flat begins, from which R5 counts its times
  return blows(scene, {{10., 8e-3, 121.273e3, 0., false},
                       {20., 8e-3, 451.527e3, kBegins / 20. + 1.88605e-3, true}});
}

HardResult dip(const std::filesystem::path& scene) {
  constexpr double kJoint = 1.05;  // m from the start
  HardResult result = blows(
      scene, {{10., .109, 146.965e3, kJoint / 10. + .4745e-3, false}, {30., .04, 0., 0., true}});
  const HardRun fast(scene, run_as({30., .04, 0., 0., true}, 1e-5));
  const std::vector<double> force = fast.column("wheel.wheel_1.force_z_n");
  const auto joint = force.begin() + std::lround(kJoint / 30. / 1e-5);
  result.checks.push_back(
      {"30 m/s: least force before the joint, N", *std::min_element(force.begin(), joint), 0.});
  result.checks.push_back(
      {"30 m/s: least force behind it, N", *std::min_element(joint, force.end()), 0.});
  // Jenkins, Stephenson, Clayton, Morland and Lyon (1974): 2 alpha = 0.02, contact linear at P0.
  const double rail = 150., wheel = 600., contact = 1.2151e9;
  const double p1 = 60e3 + .02 * 10. * std::sqrt(contact * rail / (1. + rail / wheel));
  const HardRun run(scene, {"step.dt_s=1e-5"});
  result.checks.push_back(off_by("10 m/s, 10 us: peak force against Jenkins' P1",
                                 run.largest("wheel.wheel_1.force_z_n"), p1, .25));
  return result;
}

// H10 ------------------------------------------------------------------------------------------

HardResult light_body(const std::filesystem::path& scene) {
  const HardRun run(scene);
  const double dt = 3.3e-7, peak = 111.5907, end = 3.296951e-5, light = -.1999998;
  const std::vector<double> force = run.column("heavy.wheel_1.force_z_n");
  const auto left = std::find(std::max_element(force.begin(), force.end()), force.end(), 0.);
  HardResult result;
  // 100 steps a contact: the peak good to 1e-3, the rebound to half a unit of a printed 1.0000.
  result.checks = {
      off_by("peak force", run.largest("heavy.wheel_1.force_z_n"), peak, 1e-3),
      apart_by("time of the end, steps", static_cast<double>(left - force.begin()), end / dt, 2.),
      off_by("speed of the light body", run.last("light.vz_m_per_s"), light, 5e-5),
      off_by("speed of the heavy one", run.last("centre.vz_m_per_s"), -.0999998, 1e-9),
      holds("it says that the wheel was free, and no more", run.status() == "contact_lost")};
  check_energy(result, run, "", 1e-4, 1e-6);
  result.picture = {"time, us", "force, N", {run.curve("heavy.wheel_1.force_z_n", "railstep")}};
  for (double& t : result.picture.curves[0].x) t *= 1e6;
  result.picture.curves.push_back({"known", {.5e6 * end}, {peak}, true});
  result.frame_us = run.frame_us();
  return result;
}

}  // namespace

std::vector<HardCase> contact_cases() {
  return {
      {"H4", "h04_drop", "A wheel falls on a rail: rigid, one mass, on seats",
       "A contact is stiff and short: 1.5 to 11 ms from touch to leave, no force before or after.",
       "R1 to R3 of the reference solutions: quadrature of the energy (1e-8), two masses by DOP853 "
       "(1e-8), a rail on springs (3e-4).",
       drop},
      {"H5", "h05_flat", "A wheel flat of 50 mm on a rail of one mass",
       "The rail falls away from the wheel faster than it can follow; at 20 m/s the wheel is free "
       "and strikes.",
       "R5 of the reference solutions: two masses by DOP853 (1e-6).", flat},
      {"H6", "h06_dip", "A joint dipped by 10 mm on a rail of one mass",
       "The wheel's path has a kink: a blow within 0.5 ms.",
       "R5 of the reference solutions: two masses by DOP853 (1e-6); Jenkins and others (1974), P1, "
       "as a band of 25 %.",
       dip},
      {"H10", "h10_light_rail", "Ten tonnes strike ten grams", "Masses 1e6 apart in one contact.",
       "Two masses on a Hertz spring in closed form: 111.5907 N, 32.96951 us, 0.1999998 m/s.",
       light_body}};
}

}  // namespace railstep
