#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "hard/growth.h"
#include "hard/hard_run.h"

namespace railstep {
namespace {

constexpr const char* kDeflection = "axle.deflection_z_m";

std::string support(int seat) { return fmt::format("support_{}.force_z_n", seat); }

/// The static state at t = 0: one frame with the load at x.
HardRun standing(const std::filesystem::path& scene, double x, std::vector<std::string> overrides) {
  for (const char* still : {"load[0].speed_m_per_s=0.0", "step.duration_s=2e-4"})
    overrides.emplace_back(still);
  overrides.push_back(fmt::format("load[0].start_m={}", x));
  return HardRun(scene, overrides);
}

// H7 -------------------------------------------------------------------------------------------

const std::string kHealthy = "support_change=[]",
                  kTwo = "support_change=[{seats=[20,21],missing=\"pad\"}]",
                  kGap = "support_change=[{seats=[20],support.gap_m=0.5e-3}]";

/// Statics over missing seats and a gap, as R6 has them.
std::vector<HardCheck> hanging_statics(const std::filesystem::path& scene) {
  const HardRun healthy = standing(scene, 12., {kHealthy}), one = standing(scene, 12., {});
  const HardRun middle = standing(scene, 12.3, {kHealthy}), two = standing(scene, 12.3, {kTwo});
  const HardRun gap = standing(scene, 12., {kGap});
  const double still = healthy.first(kDeflection);
  const auto closing = [&](double force) {
    const std::string load = fmt::format("load[0].force_z_n={}", -force);
    return standing(scene, 12., {kGap, load}).first(support(20));
  };
  const double seat = std::abs(gap.first(support(20)));
  return {
      off_by("healthy seats: deflection per 50 kN", -still, 5.763979e-4, 1e-3),
      off_by("one missing: deflection over the healthy one", one.first(kDeflection) / still,
             1.528675, 1e-3),
      off_by("two missing: deflection over the healthy one at mid-bay",
             two.first(kDeflection) / middle.first(kDeflection), 2.299580, 1e-3),
      off_by("one missing: force of the next seat over the healthy one",
             one.first(support(21)) / healthy.first(support(21)), 1.52867, 1e-3),
      holds("gap of 0.5 mm: open under 0.999 of 28372.82 N", closing(.999 * 28372.82) == 0.),
      holds("gap of 0.5 mm: closed under 1.001 of 28372.82 N", closing(1.001 * 28372.82) != 0.),
      off_by("gap of 0.5 mm: deflection under 50 kN", -gap.first(kDeflection), 7.493172e-4, 1e-3),
      off_by("gap of 0.5 mm: force of its seat", seat, 7479.5, 1e-3)};
}

HardResult hanging_sleepers(const std::filesystem::path& scene) {
  HardResult result;
  result.checks = hanging_statics(scene);
  const HardRun one(scene), healthy(scene, {kHealthy}), gap(scene, {kGap});
  const auto deepest = [](const HardRun& run) {  // beyond the first 3 m, which are start-up
    const std::vector<double> z = run.column(kDeflection);
    return -*std::min_element(z.begin() + 500, z.end());
  };
  result.checks.push_back(
      off_by("one missing, 30 m/s: largest deflection", deepest(one), 8.824e-4, 1e-3));
  result.checks.push_back(off_by("one missing, 30 m/s: over the healthy largest one",
                                 deepest(one) / deepest(healthy), 1.5014, 1e-3));
  result.checks.push_back(holds("no status bit", (one.status() + gap.status()).empty()));
  result.picture = {
      "time, s",
      "deflection under the load, mm",
      {healthy.curve(kDeflection, "healthy", 1e3), gap.curve(kDeflection, "gap of 0.5 mm", 1e3),
       one.curve(kDeflection, "one missing", 1e3)}};
  result.frame_us = gap.frame_us();
  return result;
}

// H8 -------------------------------------------------------------------------------------------

HardResult light_sleeper(const std::filesystem::path& scene) {
  const double still = -50e3 / (2. * 9.090909e7), series = 1e9 * 1e8 / 1.1e9;
  const HardRun stands(scene), struck(scene, {"step.start=\"released\"", "step.duration_s=1.0"});
  double moved = 0., most = 0.;
  for (const double z : stands.column("seat.dz_m"))
    moved = std::max(moved, std::abs(z / still - 1.));
  for (const double z : struck.column("seat.dz_m")) most = std::max(most, std::abs(z / still));
  Simulation start(read_scene(scene));
  HardResult result;
  result.checks = {
      off_by("pad and ballast in series, N/m", 50e3 / (-2. * stands.first("seat.dz_m")), series,
             1e-6),
      {"ten thousand steps in equilibrium: off the printed 9.090909e7 N/m", moved, 1e-6},
      off_by("sleeper's part of the deflection, to the printed digits",
             stands.first("sleeper.dz_m") / stands.first("seat.dz_m"), 10. / 11., 1e-7),
      {"growth of a step of 1 ms, 33 rad of the sleeper, over 1", growth_of(start) - 1., 1e-9},
      {"struck at once: largest deflection over the static one (2 of one mass without dampers)",
       most, 2.},
      holds("no status bit", (stands.status() + struck.status()).empty())};
  result.picture = {
      "time, s",
      "displacement, mm",
      {struck.curve("seat.dz_m", "rail", 1e3), struck.curve("sleeper.dz_m", "sleeper", 1e3)}};
  result.frame_us = stands.frame_us();
  return result;
}

// H9 -------------------------------------------------------------------------------------------

HardResult no_mass(const std::filesystem::path& scene) {
  const HardRun none(scene), little(scene, {"sleeper.mass_kg=1e-6"});
  // Springs of 2e8 and 5e7 N/m in series are 4e7 N/m, and so is this one on 1e13 N/m.
  const HardRun springs(scene, {"support.stiffness_z_n_per_m=40000160.00064",
                                "ballast.stiffness_z_n_per_m=1e13", "step.duration_s=1e-3"});
  const std::vector<double> a = none.column("seat.dz_m"), b = little.column("seat.dz_m");
  double apart = 0.;
  for (std::size_t i = 0; i < a.size(); ++i) apart = std::max(apart, std::abs(a[i] - b[i]));
  HardResult result;
  result.checks = {off_by("deflection against springs of the same sum in series",
                          none.first(kDeflection), springs.first(kDeflection), 1e-12),
                   {"motion against sleepers of 1e-6 kg, over the peak",
                    apart / std::abs(none.smallest("seat.dz_m")), 1e-6},
                   holds("no status bit", none.status().empty())};
  result.picture = {"time, s", "rail over a seat, mm", {none.curve("seat.dz_m", "0 kg", 1e3)}};
  result.frame_us = none.frame_us();
  return result;
}

// H31 ------------------------------------------------------------------------------------------

HardResult missing_springs(const std::filesystem::path& scene) {
  const HardRun zero(scene), missing(scene, {"support_change=[{seats=[20],missing=\"pad\"}]"});
  const HardRun healthy(scene, {kHealthy});
  const std::string said = refusal(
      scene,
      {"support_change=[{support.stiffness_z_n_per_m=0.0,support.damping_z_n_s_per_m=0.0}]"});
  HardResult result;
  result.checks = {
      off_by("one seat of 0: deflection over the healthy one",
             zero.first(kDeflection) / healthy.first(kDeflection), 1.528675, 1e-3),
      off_by("one seat of 0: deflection against a missing seat", zero.last(kDeflection),
             missing.last(kDeflection), 1e-12),
      holds("its force is 0", zero.largest(support(20)) == 0. && zero.smallest(support(20)) == 0.),
      holds("all seats of 0 are refused, the free motion named",
            said.find("E-TRACK-35") != std::string::npos)};
  HardCurve seats{"one seat of 0", {}, {}, true}, whole{"healthy", {}, {}, true};
  for (int seat = 10; seat <= 30; ++seat) {
    for (HardCurve* curve : {&seats, &whole}) curve->x.push_back(seat);
    seats.y.push_back(1e-3 * zero.first(support(seat)));
    whole.y.push_back(1e-3 * healthy.first(support(seat)));
  }
  result.picture = {"seat", "force on the rail, kN", {seats, whole}};
  result.frame_us = zero.frame_us();
  return result;
}

// H32 ------------------------------------------------------------------------------------------

double sum_of_seats(const HardRun& run) {
  double sum = 0.;
  for (const char* side : {"", "right_"})
    for (int seat = 0; seat <= 40; ++seat)
      sum += run.first(fmt::format("support_{}{}.force_z_n", side, seat));
  return sum;
}

HardResult two_stiffnesses(const std::filesystem::path& scene) {
  const HardRun both(scene), meshed(scene, {"condense.residual_flexibility=false"});
  HardResult result;
  result.checks = {
      off_by("sum of all seats' forces, as the mesh has them", sum_of_seats(meshed), 100e3, 1e-12),
      off_by("the same with residual flexibility, whose tables end at 1e-8 of their most",
             sum_of_seats(both), 100e3, 1e-8)};
  for (const auto& [side, stiffness] : {std::pair("left", "3e7"), std::pair("right", "1e8")}) {
    const HardRun alone(scene, {"track.rails=1", "support_change=[]",
                                fmt::format("support.stiffness_z_n_per_m={}", stiffness),
                                "load=[{name=\"axle\",start_m=12.2,force_z_n=-50e3}]"});
    const std::string deflection = std::string(side) + ".deflection_z_m";
    result.checks.push_back(off_by(std::string(side) + " rail against it alone, at the start",
                                   both.first(deflection), alone.first(kDeflection), 1e-12));
    result.checks.push_back(off_by(std::string(side) + " rail against it alone, after 100 steps",
                                   both.last(deflection), alone.last(kDeflection), 1e-12));
  }
  result.checks.push_back(holds("no status bit", both.status().empty()));
  HardCurve left{"left, 3e7 N/m", {}, {}, true}, right{"right, 1e8 N/m", {}, {}, true};
  for (int seat = 14; seat <= 27; ++seat) {
    for (HardCurve* curve : {&left, &right}) curve->x.push_back(seat);
    left.y.push_back(1e-3 * both.first(fmt::format("support_{}.force_z_n", seat)));
    right.y.push_back(1e-3 * both.first(fmt::format("support_right_{}.force_z_n", seat)));
  }
  result.picture = {"seat", "force on the rail, kN", {left, right}};
  result.frame_us = both.frame_us();
  return result;
}

}  // namespace

std::vector<HardCase> support_cases() {
  return {
      {"H7", "h07_hanging_sleepers", "Hanging sleepers and a gap",
       "Springs that are not there, or press and do not pull: the load closes them as it comes.",
       "R6 of the reference solutions, by Timoshenko elements, to 2e-4 or better.",
       hanging_sleepers},
      {"H8", "h08_light_sleeper", "A sleeper of 1 kg between stiff springs",
       "5278.6 Hz by steps of 1 ms: 33 rad a step.",
       "Springs in series; 33 rad a step must not grow.", light_sleeper},
      {"H9", "h09_no_mass", "Sleepers without mass", "Their mass matrix is singular.",
       "No reference: springs in series, and sleepers of 1e-6 kg.", no_mass},
      {"H31", "h31_missing_springs", "A seat of 0, and all of them",
       "The stiffness is singular where nothing holds the rail.",
       "R6 of one missing seat; all of them are refused.", missing_springs},
      {"H32", "h32_two_stiffnesses", "Left and right differ",
       "Mirror coordinates, which step like rails apart, do not hold here.",
       "No reference: each rail as it is alone, and the sum of forces.", two_stiffnesses}};
}

}  // namespace railstep
