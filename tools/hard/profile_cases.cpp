#include <algorithm>
#include <cmath>

#include "hard/contact_checks.h"

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
                             largest_step(run.column(load)) / 6e4, .01});
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

}  // namespace

std::vector<HardCase> profile_cases() {
  return {{"H52", "h52_contact_jumps", "A wheelset passes every jump of its profiles' contacts",
           "Contacts leap from the tread to the throat and to the flange, by up to 11 mm.",
           "Half the step; loads that do not leap; energy.", contact_jumps},
          {"H53", "h53_flange_entry", "A wheelset runs into its flange at 0.4 m/s",
           "Two patches of one wheel share a blow, and the contact goes to a plane of 70 degrees.",
           "Half the step, energy.", flange_entry},
          {"H54", "h54_off_the_rails", "A wheelset is pushed off its rails",
           "Wheels beside their rails have neither force nor geometry.",
           "Status bits, finite numbers.", off_the_rails}};
}

}  // namespace railstep
