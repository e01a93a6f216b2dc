#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include "hard/contact_checks.h"
#include "offline/math/constants.h"

namespace railstep {
namespace {

/// Largest difference of a column between steps and ever finer ones, and the order that it shows.
struct Convergence {
  std::vector<double> dt, error;  // s; of the column, against the finest
  double finest;                  // largest value of the finest run
  [[nodiscard]] double order() const {
    return std::log(error.front() / error.back()) / std::log(dt.front() / dt.back());
  }
};

/// Rows each 40 us, steps of that, a half, a quarter and an eighth against those of 1.25 us.
Convergence converge(const std::filesystem::path& scene, const std::string& column,
                     const std::string& duration) {
  const auto at = [&](double dt) {
    return HardRun(scene, {fmt::format("step.dt_s={}", dt), "step.frame_s=4e-5", duration})
        .column(column);
  };
  const std::vector<double> finest = at(1.25e-6);
  Convergence found{{4e-5, 2e-5, 1e-5, 5e-6}, {}, largest_size(finest)};
  for (const double dt : found.dt) found.error.push_back(largest_gap(at(dt), finest));
  return found;
}

/// @param order  that the steps ought to show; half of one is left to where in a step blows fall
void check_convergence(HardResult& result, const Convergence& found, double order) {
  result.checks.push_back({fmt::format("{} less the order of the force from 40 to 5 us", order),
                           std::max(0., order - found.order()), .5});
  result.checks.push_back({"force at 10 us less that at 1.25 us, over the largest",
                           found.error[2] / found.finest, 1e-2});
}

// H39 ------------------------------------------------------------------------------------------

HardResult drop_10_mm(const std::filesystem::path& scene) {
  const HardRun run(scene);
  const char* const force = "wheel.wheel_1.force_z_n";
  const double dt = 1e-5, height = .01, falls = std::sqrt(2. * height / kGravity);
  const double met = first_over(run, force, 0.), before = met - dt;
  HardResult result;
  result.checks = {
      apart_by("first force, steps after sqrt(2 h / g), less half a step", (met - falls) / dt, .5,
               .5),
      off_by("speed in the row before", run.at(before, "centre.vz_m_per_s"), -kGravity * before,
             1e-9),
      {"height in the row before, over 10 mm",
       std::abs(run.at(before, "centre.z_m") - (height - .5 * kGravity * before * before)) / height,
       1e-9},
      holds("it says that the wheel was free, and no more", run.status() == "contact_lost"),
      {"rebound's speed over the fall's", run.largest("centre.vz_m_per_s") / (kGravity * falls),
       1.}};
  check_energy(result, run, "", 1e-4, 1e-6);
  check_convergence(result, converge(scene, force, "step.duration_s=0.06"), 2.);
  result.picture = {"time, s", "wheel-rail force, kN", {run.curve(force, "railstep", 1e-3)}};
  result.picture.curves.push_back({"sqrt(2 h / g)", {falls}, {0.}, true});
  result.frame_us = run.frame_us();
  return result;
}

// H40 ------------------------------------------------------------------------------------------

/// Error of a wheelset's upright momentum over some rows: the upright parts of all contacts less
/// its weight and what the momentum changed by, N s.
double missed_momentum(const HardRun& run, std::size_t first, std::size_t last) {
  constexpr double kMass = 1200., kTrack = 1.5, kAngle = 70. * std::numbers::pi / 180.;
  const std::vector<double> v = run.column("axle.vz_m_per_s"), time = run.time(),
                            left = run.column("left.impulse_z_n_s"),
                            right = run.column("right.impulse_z_n_s"),
                            left_flange = run.column("left.flange_impulse_n_s"),
                            right_flange = run.column("right.flange_impulse_n_s"),
                            left_gap = run.column("left.gap_m"),
                            right_gap = run.column("right.gap_m");
  double sum = -kMass * kGravity * (time[last] - time[first]) - kMass * (v[last] - v[first]);
  for (std::size_t i = first + 1; i <= last; ++i) {
    // A flange's normal turns with the wheelset.
    const double roll = (right_gap[i] - left_gap[i]) / kTrack;
    sum += left[i] + right[i] + left_flange[i] * (std::cos(kAngle) + roll * std::sin(kAngle)) +
           right_flange[i] * (std::cos(kAngle) - roll * std::sin(kAngle));
  }
  return sum;
}

/// Rows in which a wheel first stands free, the first and the last.
std::pair<std::size_t, std::size_t> first_lift(const std::vector<double>& gap) {
  const auto free = std::find_if(gap.begin(), gap.end(), [](double d) { return d > 1e-4; });
  const auto down = std::find_if(free, gap.end(), [](double d) { return d < 0.; });
  return {static_cast<std::size_t>(free - gap.begin()),
          static_cast<std::size_t>(down - gap.begin()) - 1};
}

HardResult one_wheel_lifts(const std::filesystem::path& scene) {
  const HardRun run(scene), fine(scene, {"step.dt_s=2.5e-5", "step.frame_s=5e-5"});
  const std::vector<double> gap = run.column("right.gap_m"), force = run.column("right.force_z_n");
  const auto [up, down] = first_lift(gap);
  double pressed = 0.;
  for (std::size_t i = 0; i < gap.size(); ++i)
    if (gap[i] > 0.) pressed = std::max(pressed, force[i]);
  const double weight = 1200. * kGravity, lift = run.largest("right.gap_m");
  const std::vector<double> time = run.time();
  HardResult result;
  result.checks = {
      {"1 mm over the lift of the right wheel", 1e-3 / lift, 1.},
      {"force of the right wheel where it stands free, N", pressed, 0.},
      {"upright momentum while the left rail carries all, over the weight's",
       std::abs(missed_momentum(run, up, down)) / (weight * (time[down] - time[up])), 1e-3},
      {"upright momentum of the whole run, over the weight's",
       std::abs(missed_momentum(run, 0, gap.size() - 1)) / (weight * time.back()), 1e-3},
      holds("it comes down again", down + 1 < gap.size()),
      off_by("height of the axle in the end", run.last("axle.dz_m"), run.first("axle.dz_m"), .1),
      off_by("lift at half the step", fine.largest("right.gap_m"), lift, 1e-2),
      holds("it says that a wheel was free, and no more", run.status() == "contact_lost")};
  check_energy(result, run, "", 1e-3, 1e-4);
  result.picture = {
      "time, s",
      "wheel-rail force, kN",
      {run.curve("left.force_z_n", "left", 1e-3), run.curve("right.force_z_n", "right", 1e-3)}};
  HardCurve lifted = run.curve("right.gap_m", "right wheel over its rail, mm", 1e3);
  for (double& d : lifted.y) d = std::max(d, 0.);
  result.picture.curves.push_back(std::move(lifted));
  result.frame_us = run.frame_us();
  return result;
}

// H41 ------------------------------------------------------------------------------------------

HardResult window(const std::filesystem::path& scene) {
  const HardRun endless(scene), moving(scene, {"step.start=\"moving\""});
  // 120 m with ends: 36 m of it behind the last wheel and 65 m ahead of the first one at the end.
  std::string track = "track={unknowns=\"vertical\",rails=1,";
  track += "bays=200,bay_m=0.6,elements_per_bay=2}";
  const HardRun with_ends(scene, {track, "vehicle[0].start_m=42.0", "vehicle[1].start_m=38.0"});
  constexpr std::size_t kBay = 400;  // steps
  HardResult result;
  for (const char* wheel : {"bogie.wheel_1", "bogie.wheel_2", "wheel.wheel_1"}) {
    const std::string force = wheel + std::string(".force_z_n");
    const std::vector<double> f = endless.column(force), steady = moving.column(force);
    result.checks.push_back({std::string(wheel) + ": force less that on 120 m, over the largest",
                             largest_gap(f, with_ends.column(force)) / largest_size(f), 1e-3});
    const std::vector<double> bays(steady.begin(), steady.end() - kBay),
        next(steady.begin() + kBay, steady.end());
    result.checks.push_back({std::string(wheel) + ": steady force a bay later, over the largest",
                             largest_gap(bays, next) / largest_size(steady), 1e-9});
  }
  result.checks.push_back(
      holds("no status bit", endless.status().empty() && moving.status().empty()));
  check_energy(result, endless, "", 1e-3, 1e-5);
  const char* const force = "wheel.wheel_1.force_z_n";
  const HardCurve all = with_ends.curve(force, "on 120 m with ends", 1e-3);
  HardCurve points{all.name, {}, {}, true};
  for (std::size_t i = 0; i < all.x.size(); i += kBay / 4) {
    points.x.push_back(all.x[i]);
    points.y.push_back(all.y[i]);
  }
  result.picture = {"time, s",
                    "force of the last wheel, kN",
                    {endless.curve(force, "on a window of 38.4 m", 1e-3), std::move(points)}};
  result.frame_us = endless.frame_us();
  return result;
}

// H42 ------------------------------------------------------------------------------------------

HardResult stiffness_jump(const std::filesystem::path& scene) {
  const HardRun run(scene), even(scene, {"support_change=[]"});
  const char* const force = "wheel.wheel_1.force_z_n";
  HardResult result;
  result.checks = {holds("all finite", all_finite(run)),
                   {"largest force on even seats over that at the jump",
                    even.largest(force) / run.largest(force), 1.}};
  check_energy(result, run, "", 1e-3, 1e-5);
  // First order: the rail's slope jumps where two elements meet, under the wheel within a step. On
  // even seats it is the same, and 1.8 where the wheel does not run (H39).
  check_convergence(result, converge(scene, force, "step.duration_s=0.2"), 1.);
  result.picture = {"time, s",
                    "wheel-rail force, kN",
                    {run.curve(force, "stiff seats from 9.6 to 14.4 m", 1e-3),
                     even.curve(force, "even seats", 1e-3)}};
  result.frame_us = run.frame_us();
  return result;
}

// H51 ------------------------------------------------------------------------------------------

HardResult full_slip(const std::filesystem::path& scene) {
  const char* const force = "car.drive_n";
  HardResult result;
  result.picture = {"time, s", "force of the drive, kN", {}};
  for (const char* law : {"she", "fastsim", "polach"}) {
    const std::string by = std::string("contact.creep=\"") + law + "\"";
    const HardRun run(scene, {by}), fine(scene, {by, "step.dt_s=5e-4", "step.frame_s=1e-3"});
    const std::string at = law + std::string(": ");
    const std::vector<double> held = run.column(force);
    result.checks.push_back(
        holds(at + "full slip is the one status bit", run.status() == "full_slip"));
    result.checks.push_back({at + "force of the drive at half the step, over the largest",
                             largest_gap(held, fine.column(force)) / largest_size(held), 5e-3});
    check_energy(result, run, at, 1e-4, 1e-4);
    result.picture.curves.push_back(run.curve(force, law, 1e-3));
    result.frame_us = run.frame_us();
  }
  return result;
}

}  // namespace

std::vector<HardCase> traffic_cases() {
  return {{"H39", "h39_drop_10_mm", "A wheel falls by 10 mm on a ballasted track",
           "A thousand diameters of the contact's depth in free flight, then a blow of 2 ms.",
           "Free fall; energy; the same at ever shorter steps.", drop_10_mm},
          {"H40", "h40_one_wheel_lifts", "A wheelset is pushed up on one rail and let go",
           "One contact of two ends and comes back while a flange holds the wheelset.",
           "Momentum, energy, half the step.", one_wheel_lifts},
          {"H41", "h41_window", "Two vehicles on a window of a track without end",
           "At every bay border all that the window holds is passed on to the rear.",
           "The same on 200 bays with ends, and each bay against the one before.", window},
          {"H42", "h42_stiffness_jump", "Seats a thousand times stiffer from one to the next",
           "Stiffness jumps up and down again under a wheel at 60 m/s.",
           "Energy, and the same at ever shorter steps: of first order, as a wheel meets the kinks "
           "between elements within a step, on even seats too.",
           stiffness_jump},
          {"H51", "h51_full_slip", "A wheelset is braked beyond friction, and let go",
           "Creep leaves the range in which it depends on slip, and comes back into it.",
           "Energy, half the step.", full_slip}};
}

}  // namespace railstep
