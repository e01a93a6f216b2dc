#include <algorithm>
#include <cmath>

#include "hard/contact_checks.h"
#include "offline/math/constants.h"

namespace railstep {
namespace {

const char* const kShift = "wheelset.axle.y_m";
const char* const kLoads[2] = {"wheelset.axle_left.q_n", "wheelset.axle_right.q_n"};

/// Largest change of a column from one row to the next.
double largest_step(const std::vector<double>& values) {
  double most = 0.;
  for (std::size_t i = 1; i < values.size(); ++i)
    most = std::max(most, std::fabs(values[i] - values[i - 1]));
  return most;
}

// H52 ------------------------------------------------------------------------------------------

HardResult contact_jumps(const std::filesystem::path& scene) {
  const HardRun run(scene), fine(scene, {"step.dt_s=5e-4", "step.frame_s=1e-3"});
  HardResult result;
  result.checks = {
      holds("full slip is the one status bit", run.status() == "full_slip"),
      holds("the shift passes 6 mm", run.last(kShift) > 6e-3),
      {"shift at half the step, over the largest",
       largest_gap(run.column(kShift), fine.column(kShift)) / run.largest(kShift), 1e-3}};
  for (const char* load : kLoads)
    result.checks.push_back({std::string(load) + ": largest change within a step, over 60 kN",
                             largest_step(run.column(load)) / 6e4, 2e-3});
  check_energy(result, run, "", 1e-4, 1e-4);
  HardCurve left = run.curve(kLoads[0], "left", 1e-3), right = run.curve(kLoads[1], "right", 1e-3);
  result.picture = {"time, s", "wheel load, kN", {std::move(left), std::move(right)}};
  result.frame_us = run.frame_us();
  return result;
}

// H53 ------------------------------------------------------------------------------------------

HardResult flange_entry(const std::filesystem::path& scene) {
  const HardRun run(scene), fine(scene, {"step.dt_s=5e-5"});
  HardResult result;
  result.checks = {
      holds("full slip is the one status bit", run.status() == "full_slip"),
      holds("the wheelset is thrown back", run.smallest(kShift) < -4e-3),
      {"shift at half the step, over the largest",
       largest_gap(run.column(kShift), fine.column(kShift)) / run.largest(kShift), .01}};
  for (const char* load : kLoads)
    result.checks.push_back(off_by(std::string(load) + ": largest, at half the step",
                                   fine.largest(load), run.largest(load), .03));
  check_energy(result, run, "", 1e-4, 1e-4);
  result.picture = {"time, s",
                    "wheel load, kN",
                    {run.curve(kLoads[0], "left", 1e-3), run.curve(kLoads[1], "right", 1e-3)}};
  result.frame_us = run.frame_us();
  return result;
}

// H54 ------------------------------------------------------------------------------------------

HardResult off_the_rails(const std::filesystem::path& scene) {
  const HardRun run(scene);
  const std::string met = run.status();
  HardResult result;
  result.checks = {holds("all finite", all_finite(run)),
                   holds("beyond_profile and contact_lost are among the status bits",
                         met.find("beyond_profile") != std::string::npos &&
                             met.find("contact_lost") != std::string::npos),
                   holds("no solve ends at its cap", met.find("cap_reached") == std::string::npos),
                   holds("wheels beside their rails have no load at the end",
                         run.last(kLoads[0]) == 0. && run.last(kLoads[1]) == 0.)};
  result.picture = {"time, s", "shift, m", {run.curve(kShift, "wheelset")}};
  result.frame_us = run.frame_us();
  return result;
}

// H55 ------------------------------------------------------------------------------------------

/// A column at the row nearest to a time.
double at_time(const HardRun& run, const std::vector<double>& column, double time) {
  const std::vector<double>& times = run.column("time_s");
  const auto row = std::lower_bound(times.begin(), times.end(), time - 1e-9) - times.begin();
  return column[static_cast<std::size_t>(row)];
}

HardResult stop_on_slope(const std::filesystem::path& scene) {
  constexpr double kSteel = 12e3, kTurning = 100. / (.46 * .46), kPush = 3531.6;  // kg, kg, N
  const HardRun run(scene);
  const std::vector<double>& x = run.column("wheelset.x_m");
  HardResult result;
  result.checks = {holds("full slip is the one status bit", run.status() == "full_slip"),
                   off_by("it slides to a stand with mu g: way over that", at_time(run, x, 4.95),
                          100. / (2. * .3 * kGravity), .02),
                   {"moved from 10 to 604 s, over 1 um",
                    std::fabs(at_time(run, x, 604.) - at_time(run, x, 10.)) / 1e-6, 2e-3},
                   off_by("speed 5 s after the brake opens", run.last("wheelset.speed_m_per_s"),
                          kPush * 4.99 / (kSteel + kTurning), 2e-3)};
  check_energy(result, run, "", 1e-4, 1e-4);
  result.picture = {"time, s", "way, m", {run.curve("wheelset.x_m", "wheelset")}};
  result.frame_us = run.frame_us();
  return result;
}

// H56 ------------------------------------------------------------------------------------------

HardResult wheelspin(const std::filesystem::path& scene) {
  const HardRun run(scene), fine(scene, {"step.dt_s=5e-4", "step.frame_s=1e-3"});
  const char* const speed = "wheelset.speed_m_per_s";
  HardResult result;
  result.checks = {holds("full slip is the one status bit", run.status() == "full_slip"),
                   off_by("speed at 2 s over mu g t", at_time(run, run.column(speed), 2.),
                          .3 * kGravity * 2., .01),
                   {"way at half the step, over all of it",
                    largest_gap(run.column("wheelset.x_m"), fine.column("wheelset.x_m")) /
                        run.largest("wheelset.x_m"),
                    1e-3},
                   {"speed at the end, over 1 m/s", std::fabs(run.last(speed)), 1e-6}};
  check_energy(result, run, "", 1e-4, 1e-4);
  result.picture = {"time, s", "speed, m/s", {run.curve(speed, "wheelset")}};
  result.frame_us = run.frame_us();
  return result;
}

// H57 ------------------------------------------------------------------------------------------

HardResult bad_profiles(const std::filesystem::path& scene) {
  const auto said_of = [&](const char* file) {
    return refusal(scene, {std::string("contact.wheel_profile=\"profiles/") + file + "\""});
  };
  const HardRun run(scene);
  HardResult result;
  result.checks = {holds("a kink is refused, with its place",
                         said_of("kink.toml").find("kink at -24.8305 mm") != std::string::npos),
                   holds("metres under keys of millimetres are refused",
                         said_of("metres.toml").find("flange_back_mm = -0.07 is out of range") !=
                             std::string::npos),
                   holds("the wheel as it is runs", run.status().empty())};
  result.picture = {"time, s", "wheel load, kN", {run.curve(kLoads[0], "left", 1e-3)}};
  result.frame_us = run.frame_us();
  return result;
}

// H58 ------------------------------------------------------------------------------------------

/// Force across on a wheel over friction times its normal force, from Q and Y on a cone's plane.
double force_of_spin(const HardRun& run, double slope, double friction) {
  const double q = run.last(kLoads[0]), y = run.last("wheelset.axle_left.y_n");
  return (q * slope - y) / (friction * (q + y * slope));
}

HardResult spin_alone(const std::filesystem::path& scene) {
  constexpr double kSlope = .4743416, kFriction = .3;
  constexpr double kHalfSpace = .5827;  // of CONTACT, for a circle and a normalised spin of 1.5
  struct Law {
    const char* name;
    std::vector<std::string> words;
    double force, error;  // by the law alone; its own error against the half-space
  };
  HardResult result;
  result.picture = {"time, s", "wheel load, kN", {}};
  const Law laws[] = {{"she", {}, .752, .2},
                      {"fastsim", {"contact.creep=\"fastsim\"", "contact.strips=20"}, .658, .1}};
  for (const Law& law : laws) {
    const HardRun run(scene, law.words);
    const std::string at = law.name + std::string(": ");
    const double force = force_of_spin(run, kSlope, kFriction);
    result.checks.push_back(
        off_by(at + "force of the spin, over the law's", force, law.force, 2e-3));
    result.checks.push_back({at + "off the half-space's, over friction times normal force",
                             std::fabs(force - kHalfSpace), law.error});
    result.checks.push_back(
        {at + "shift of the wheelset, over 1 um", run.largest(kShift) / 1e-6, 1e-6});
    check_energy(result, run, at, 1e-9, 1e-9);
    result.picture.curves.push_back(run.curve(kLoads[0], law.name, 1e-3));
    result.frame_us = run.frame_us();
  }
  return result;
}

// H59 ------------------------------------------------------------------------------------------

HardResult conformal(const std::filesystem::path& scene) {
  HardResult result = contact_jumps(scene);
  const HardRun run(scene);
  result.checks.push_back(
      holds("the shift passes 7.5 mm, onto the flange", run.last(kShift) > 7.5e-3));
  return result;
}

}  // namespace

std::vector<HardCase> profile_cases() {
  return {
      {"H52", "h52_contact_jumps", "A wheelset passes every jump of its profiles' contacts",
       "Contacts leap from the tread to the throat and to the flange, by up to 11 mm.",
       "Half the step; loads that do not leap; energy.", contact_jumps},
      {"H53", "h53_flange_entry", "A wheelset runs into its flange at 0.4 m/s",
       "Two patches of one wheel share a blow, and the contact goes to a plane of 70 degrees.",
       "Half the step, energy.", flange_entry},
      {"H54", "h54_off_the_rails", "A wheelset is pushed off its rails",
       "Wheels beside their rails have neither force nor geometry.", "Status bits, finite numbers.",
       off_the_rails},
      {"H55", "h55_stop_on_slope", "A wheelset locks, slides, stops, stands on 3 % and rolls away",
       "At a standstill creep over the speed has no meaning, and what is left of it adds up.",
       "mu g, no drift in ten minutes, the push over the mass; energy.", stop_on_slope},
      {"H56", "h56_wheelspin", "Wheels spin at a standstill and are caught by a brake",
       "Full slip along the rail at creepages far beyond 1, from and to a standstill.",
       "mu g t; half the step; energy.", wheelspin},
      {"H57", "h57_bad_profiles", "Profiles with a kink and in the wrong unit",
       "A kink has no patch, and numbers in another unit look like numbers.",
       "Refused, with the place.", bad_profiles},
      {"H58", "h58_spin_alone", "Wheels that only spin on their contacts",
       "No slip but a spin that saturates friction, where laws of creep err most.",
       "The laws' own forces; their error against the half-space; energy.", spin_alone},
      {"H59", "h59_conformal", "A wheelset with wheels that are worn to their rails",
       "Patches of 25 mm, along which a contact runs 20 mm within 2 mm of shift.",
       "Half the step; loads that do not leap; energy.", conformal}};
}

}  // namespace railstep
