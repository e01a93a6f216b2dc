#include <algorithm>
#include <cmath>

#include "hard/contact_checks.h"
#include "offline/math/constants.h"

namespace railstep {
namespace {

/// Largest value of a column over that of a run with half the step, less 1.
HardCheck peak_at_half(const HardRun& run, const HardRun& fine, const std::string& column,
                       double bound) {
  return off_by(column + ": largest, at half the step", fine.largest(column), run.largest(column),
                bound);
}

// H60 ------------------------------------------------------------------------------------------

HardResult damper_corner(const std::filesystem::path& scene) {
  const HardRun run(scene), fine(scene, {"step.dt_s=1.25e-4"}), finer(scene, {"step.dt_s=6.25e-5"});
  const char *const y = "v.probe.y_m", *const force = "v.damper.force_n";
  const double gap = largest_gap(fine.column(y), finer.column(y));
  HardResult result;
  result.checks = {holds("no status bit", run.status().empty()),
                   off_by("the damper's largest force", run.largest(force), 12e3, 1e-12),
                   {"motion at half the step, over the largest",
                    largest_gap(run.column(y), fine.column(y)) / run.largest(y), 5e-3},
                   {"change at a quarter of it, over that at a half",
                    gap / largest_gap(run.column(y), fine.column(y)), .6}};
  check_energy(result, run, "", 1e-3, 1e-9);
  result.picture = {"time, s", "force of the damper, kN", {run.curve(force, "damper", 1e-3)}};
  result.frame_us = run.frame_us();
  return result;
}

// H61 ------------------------------------------------------------------------------------------

HardResult sticks(const std::filesystem::path& scene) {
  const HardRun run(scene);
  HardResult result;
  result.checks = {holds("no status bit", run.status().empty())};
  for (const char* law : {"slider", "exponential", "berg"}) {
    const std::string name = law, y = "v." + name + ".y_m";
    result.checks.push_back({name + ": moved from 100 to 1000 s, over its deflection",
                             std::fabs(run.last(y) - run.at(100., y)) / run.largest(y), 1e-9});
    result.checks.push_back(
        off_by(name + ": force", -run.last("v." + name + "_friction.force_n"), 900., 1e-5));
    result.picture.curves.push_back(run.curve(y, name, 1e3));
  }
  result.picture.x_label = "time, s";
  result.picture.y_label = "displacement, mm";
  result.frame_us = run.frame_us();
  return result;
}

// H62 ------------------------------------------------------------------------------------------

HardResult bump_stops(const std::filesystem::path& scene) {
  const HardRun run(scene), fine(scene, {"step.dt_s=1e-5", "step.frame_s=1e-4"});
  const char* const y = "v.probe.y_m";
  HardResult result;
  result.checks = {
      holds("no status bit", run.status().empty()),
      holds("both stops press",
            run.smallest("v.hard.force_n") < -1e4 && run.largest("v.soft.force_n") > 1e3),
      off_by("place of rest at half the step", fine.last(y), run.last(y), .02),
      {"force of friction over its limit", run.largest("v.friction.force_n") / 200. - 1., 1e-12}};
  check_energy(result, run, "", 1e-5, 1e-5);
  result.picture = {"time, s", "displacement, mm", {run.curve(y, "body", 1e3)}};
  result.frame_us = run.frame_us();
  return result;
}

// H63 ------------------------------------------------------------------------------------------

HardResult links(const std::filesystem::path& scene) {
  const HardRun run(scene), fine(scene, {"step.dt_s=2.5e-4", "step.frame_s=1e-3"});
  const char *const load = "wagon.leading_left.q_n", *const rubbed =
                                                         "wagon.leading_links_y_left.force_n";
  HardResult result;
  result.checks = {
      holds("no status bit", run.status().empty()),
      holds("links slide to either side", run.largest(rubbed) > 3e3 && run.smallest(rubbed) < -3e3),
      {"wheel load at half the step, over the weight",
       largest_gap(run.column(load), fine.column(load)) / 110e3, .03},
      {"the car's motion at half the step, over the largest",
       largest_gap(run.column("wagon.car.y_m"), fine.column("wagon.car.y_m")) /
           largest_size(run.column("wagon.car.y_m")),
       .03}};
  check_energy(result, run, "", 1e-3, 1e-3);
  result.picture = {"time, s", "friction of links along y, kN", {run.curve(rubbed, "link", 1e-3)}};
  result.frame_us = run.frame_us();
  return result;
}

// H64 ------------------------------------------------------------------------------------------

HardResult joint_in_curve(const std::filesystem::path& scene) {
  const HardRun run(scene), fine(scene, {"step.dt_s=5e-5"});
  const char *const outer = "car.leading_1_right.q_n", *const aside = "car.leading_1_right.y_n";
  HardResult result;
  result.checks = {
      holds("no solve ends at its cap", run.status().find("cap_reached") == std::string::npos),
      holds("the joint unloads the wheel", run.smallest(outer) < .5 * run.first(outer)),
      peak_at_half(run, fine, outer, .02),
      peak_at_half(run, fine, aside, .05),
      {"shift of the wheelset 1 s later, over that at the start, less 1",
       std::fabs(run.last("car.leading_1.y_m") / run.first("car.leading_1.y_m") - 1.), .01}};
  check_energy(result, run, "", 1e-3, 1e-3);
  result.picture = {"time, s",
                    "leading outer wheel, kN",
                    {run.curve(outer, "Q", 1e-3), run.curve(aside, "Y", 1e-3)}};
  result.frame_us = run.frame_us();
  return result;
}

// H65 ------------------------------------------------------------------------------------------

HardResult stand_in_curve(const std::filesystem::path& scene) {
  const HardRun run(scene);
  HardResult result;
  result.checks = {holds("no status bit", run.status().empty())};
  for (const char* column : {"car.x_m", "car.leading_1.y_m", "car.car.y_m", "car.car.roll_rad"})
    result.checks.push_back({std::string(column) + ": moved from 10 to 60 s",
                             std::fabs(run.last(column) - run.at(10., column)), 1e-8});
  result.checks.push_back(off_by("load of the inner wheels at the end, over that at the start",
                                 run.last("car.leading_1_left.q_n"),
                                 run.first("car.leading_1_left.q_n"), 1e-6));
  result.picture = {"time, s",
                    "shift of the leading wheelset, mm",
                    {run.curve("car.leading_1.y_m", "wheelset", 1e3)}};
  result.frame_us = run.frame_us();
  return result;
}

}  // namespace

std::vector<HardCase> suspension_cases() {
  return {{"H60", "h60_damper_corner", "A damper that saturates behind a spring on a body of 5 kg",
           "On the steep side of its corner a step of Newton's method is 400 times too short.",
           "The limit to the last bit; half the step and a quarter; energy.", damper_corner},
          {"H61", "h61_stick", "Friction holds 90 % of its limit for a million steps",
           "What a step forgets of a memory adds up.", "No drift; the force.", sticks},
          {"H62", "h62_bump_stops", "A body between bump stops of 1 GN/m and 1 MN/m, with friction",
           "Stiffness that leaps a thousandfold, and a place of rest that friction chooses.",
           "Half the step; the limit; energy.", bump_stops},
          {"H63", "h63_links", "A wagon with leaf springs and links on rough rails",
           "Twelve joints stick and slide under loads that change, and eight guards press.",
           "Half the step, energy.", links},
          {"H64", "h64_joint_in_curve", "A dipped joint in a curve, on its outer rail",
           "The flange and the tread share a blow while the vehicle leans on the flange.",
           "Half the step; the steady shift comes back; energy.", joint_in_curve},
          {"H65", "h65_stand_in_curve", "A braked vehicle stands in a canted curve",
           "Friction under eight wheels holds it on the lean.", "No drift.", stand_in_curve}};
}

}  // namespace railstep
