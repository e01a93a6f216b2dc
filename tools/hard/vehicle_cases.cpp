#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include "hard/contact_checks.h"
#include "offline/math/constants.h"

namespace railstep {
namespace {

/// Values of a column between two times, s.
std::vector<double> between_times(const HardRun& run, const std::string& name, double from,
                                  double to) {
  const std::vector<double> all = run.column(name), times = run.time();
  std::vector<double> part;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (times[i] >= from && times[i] <= to) part.push_back(all[i]);
  return part;
}
double mean_between(const HardRun& run, const std::string& name, double from, double to) {
  const std::vector<double> part = between_times(run, name, from, to);
  double sum = 0.;
  for (const double value : part) sum += value;
  return sum / static_cast<double>(part.size());
}

// H66 ------------------------------------------------------------------------------------------

HardResult hunting(const std::filesystem::path& scene) {
  const std::string shift = "car.leading_1.y_m";
  const HardRun run(scene), fine(scene, {"step.dt_s=2.5e-4", "step.duration_s=8.0"}),
      strong(scene, {"vehicle[0].force[0].table=[[0.0, 0.0], [0.05, 4.0e4], [0.15, 4.0e4], "
                     "[0.2, 0.0]]"}),
      slow(scene, {"vehicle[0].speed_m_per_s=65.0", "step.duration_s=8.0"});
  const auto size = [&](const HardRun& of, double until) {
    return largest_size(between_times(of, shift, until - 1., until));
  };
  HardResult result;
  result.checks = {
      holds("full slip is the one status bit", run.status() == "full_slip"),
      holds("the cycle is wider than 5 mm", size(run, 15.) > 5e-3),
      off_by("size of the cycle after a push of 40 kN", size(strong, 15.), size(run, 15.), 5e-3),
      off_by("size of the cycle at half the step", size(fine, 8.), size(run, 8.), .01),
      {"shift at 65 m/s, below the critical speed, over that of the cycle",
       size(slow, 8.) / size(run, 8.), 1e-3}};
  check_energy(result, run, "", 1e-4, 1e-4);
  result.picture = {"time, s",
                    "shift of the leading wheelset, mm",
                    {run.curve(shift, "80 m/s", 1e3), slow.curve(shift, "65 m/s", 1e3)}};
  result.frame_us = run.frame_us();
  return result;
}

// H67 ------------------------------------------------------------------------------------------

/// The largest Y/Q of the left wheel, of means over 0.1 s before the shift passes 9 mm, over
/// Nadal's limit; NaN if it does not pass.
double climbs_at(const HardRun& run, double friction) {
  constexpr std::ptrdiff_t kRows = 100;
  const std::vector<double> shift = run.column("wheelset.axle.y_m"),
                            y = run.column("wheelset.axle_left.y_n"),
                            q = run.column("wheelset.axle_left.q_n");
  const auto over = std::find_if(shift.begin(), shift.end(), [](double own) { return own > 9e-3; });
  if (over == shift.end()) return kNan;
  double most = 0.;
  for (std::ptrdiff_t end = kRows; end < over - shift.begin(); ++end)
    most = std::max(most, std::accumulate(y.begin() + (end - kRows), y.begin() + end, 0.) /
                              std::accumulate(q.begin() + (end - kRows), q.begin() + end, 0.));
  const double flank = std::tan(70. * std::numbers::pi / 180.);
  return most * (1. + friction * flank) / (flank - friction);
}

HardResult flange_climb(const std::filesystem::path& scene) {
  const HardRun run(scene), slippery(scene, {"contact.friction=0.1"}),
      less(scene, {"contact.friction=0.4", "step.duration_s=16.0"});
  const std::string shift = "wheelset.axle.y_m";
  HardResult result;
  result.checks = {holds("all finite", all_finite(run)),
                   holds("beyond_profile names the derailment",
                         run.status().find("beyond_profile") != std::string::npos),
                   holds("under the same force, a wheel with a friction of 0.1 stays on its rail",
                         slippery.status().find("beyond_profile") == std::string::npos &&
                             slippery.largest(shift) < 8e-3),
                   off_by("Y/Q over Nadal's limit, friction 0.5", climbs_at(run, .5), 1., .02),
                   off_by("Y/Q over Nadal's limit, friction 0.4", climbs_at(less, .4), 1., .02)};
  check_energy(result, slippery, "", 1e-3, 1e-3);
  HardCurve y_over_q = run.curve("wheelset.axle_left.y_over_q", "Y/Q");
  result.picture = {"time, s", "Y/Q of the left wheel", {std::move(y_over_q)}};
  result.frame_us = run.frame_us();
  return result;
}

// H68 ------------------------------------------------------------------------------------------

HardResult twist(const std::filesystem::path& scene) {
  const HardRun run(scene), fine(scene, {"step.dt_s=1e-3", "step.frame_s=2e-3"}),
      sudden(scene, {"line.transition=\"linear\""});
  HardResult result;
  result.checks = {holds("no status bit", run.status().empty()),
                   holds("no solve fails where the twist begins at once",
                         sudden.status().find("contact_ill_posed") == std::string::npos)};
  double most = 0.;
  for (const char* wheel : {"car.leading_1_left", "car.leading_1_right", "car.trailing_2_left"}) {
    const std::string load = std::string(wheel) + ".q_n";
    most = std::max(most, 1. - run.smallest(load) / run.first(load));
    result.checks.push_back({load + " at half the step, over its weight",
                             largest_gap(run.column(load), fine.column(load)) / run.first(load),
                             1e-3});
    result.checks.push_back(off_by(load + " on level track after it, over that before",
                                   run.last(load), run.first(load), 1e-3));
    result.picture.curves.push_back(run.curve(load, wheel, 1e-3));
  }
  result.checks.push_back(holds("a wheel loses a tenth of its load", most > .1));
  check_energy(result, run, "", 1e-3, 1e-3);
  result.picture.x_label = "time, s";
  result.picture.y_label = "wheel load, kN";
  result.frame_us = run.frame_us();
  return result;
}

// H69 ------------------------------------------------------------------------------------------

HardResult narrow_curve(const std::filesystem::path& scene) {
  const HardRun run(scene), fine(scene, {"step.dt_s=2.5e-4"});
  const std::string load = "car.leading_1_right.q_n", aside = "car.leading_1_right.y_n";
  HardResult result;
  result.checks = {
      holds("no solve ends at its cap", run.status().find("cap_reached") == std::string::npos),
      off_by(load + ": largest, at half the step", fine.largest(load), run.largest(load), .03)};
  for (const std::string& column : {load, aside})
    result.checks.push_back(off_by(column + " in the curve at half the step",
                                   mean_between(fine, column, 9., 11.),
                                   mean_between(run, column, 9., 11.), 1e-3));
  double sum = 0.;
  for (const char* wheel :
       {"leading_1_left", "leading_1_right", "trailing_1_left", "trailing_1_right",
        "leading_2_left", "leading_2_right", "trailing_2_left", "trailing_2_right"})
    sum += mean_between(run, fmt::format("car.{}.q_n", wheel), 9., 11.);
  constexpr double kMass = 32000. + 2. * 2615. + 4. * 1813.;
  const double roll = std::asin(.06 / 1.5),
               down = kGravity * std::cos(roll) + 64. * .01 * std::sin(roll);
  result.checks.push_back(
      off_by("sum of Q over the weight down on the lean, with the part of the "
             "acceleration to the middle",
             sum, kMass * down, 5e-4));
  check_energy(result, run, "", 1e-2, 1e-2);
  result.picture = {"time, s",
                    "leading outer wheel, kN",
                    {run.curve(load, "Q", 1e-3), run.curve(aside, "Y", 1e-3)}};
  result.frame_us = run.frame_us();
  return result;
}

// H70 ------------------------------------------------------------------------------------------

HardResult an_hour(const std::filesystem::path& scene) {
  const HardRun run(scene);
  HardResult result;
  result.checks = {holds("no status bit", run.status().empty())};
  for (const char* column : {"wagon.x_m", "wagon.leading.y_m", "wagon.car.roll_rad"})
    result.checks.push_back({std::string(column) + ": moved in the second half of the hour",
                             std::fabs(run.last(column) - run.at(1800., column)), 1e-8});
  for (const char* force : {"wagon.leading_left.q_n", "wagon.leading_links_y_left.force_n"})
    result.checks.push_back(off_by(std::string(force) + ": after the hour, over that after a half",
                                   run.last(force), run.at(1800., force), 1e-5));
  result.picture = {"time, s", "way, mm", {run.curve("wagon.x_m", "wagon", 1e3)}};
  result.frame_us = run.frame_us();
  return result;
}

// H72 ------------------------------------------------------------------------------------------

HardResult gauge_corner(const std::filesystem::path& scene) {
  const HardRun run(scene), fine(scene, {"step.dt_s=1.25e-4"});
  HardResult result;
  result.checks = {holds("full slip is the one status bit", run.status() == "full_slip")};
  for (const char* name : {"car.leading_1_right.q_n", "car.leading_1_right.y_n"}) {
    const std::vector<double> own = run.column(name), other = fine.column(name);
    double off = 0., size = 0.;
    for (std::size_t i = 0; i < own.size(); ++i) {
      off += (own[i] - other[i]) * (own[i] - other[i]);
      size += other[i] * other[i];
    }
    result.checks.push_back(
        {fmt::format("{} at an eighth of the step, rms", name), std::sqrt(off / size), .03});
  }
  check_energy(result, run, "", 1e-2, 1e-2);
  result.picture = {"time, s",
                    "Y of the leading outer wheel, kN",
                    {run.curve("car.leading_1_right.y_n", "1 ms", 1e-3),
                     fine.curve("car.leading_1_right.y_n", "0.125 ms", 1e-3)}};
  result.frame_us = run.frame_us();
  return result;
}

}  // namespace

std::vector<HardCase> vehicle_cases() {
  return {{"H66", "h66_hunting", "A vehicle hunts above its critical speed",
           "Motion that grows until flanges and friction stop it: errors of phase grow with it.",
           "One cycle whatever the push; none below the critical speed; half the step; energy.",
           hunting},
          {"H67", "h67_flange_climb", "A wheel climbs over its rail",
           "The contact leaves the flank of 70 degrees under friction that holds it back.",
           "Nadal's limit; the status bit; none with little friction.", flange_climb},
          {"H68", "h68_twist", "A vehicle on track that twists by 1:255",
           "Wheels pass from one patch to three as the axle rolls, and springs unload them.",
           "Half the step; loads come back; energy.", twist},
          {"H69", "h69_r_100_m", "A vehicle in a curve of 100 m",
           "Flanges under 19 mrad, saturated creep, bodies that stand turned by 0.1 rad.",
           "Half the step; sum of Q; energy.", narrow_curve},
          {"H70", "h70_an_hour", "A braked wagon stands for an hour on a lean and a slope",
           "Friction in leaves, links and contacts adds up what each step forgets.", "No drift.",
           an_hour},
          {"H72", "h72_gauge_corner", "Throats on gauge corners of rails that give way",
           "The plane of contact turns by more than the forces of the step before allow for.",
           "An eighth of the step; energy.", gauge_corner}};
}

}  // namespace railstep
