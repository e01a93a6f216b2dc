#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

#include "hard/growth.h"
#include "hard/hard_run.h"

namespace railstep {
namespace {

std::vector<double> sum_of_supports(const HardRun& run, int seats) {
  std::vector<double> sum(run.time().size(), 0.);
  for (int seat = 0; seat < seats; ++seat) {
    const std::vector<double> own = run.column(fmt::format("support_{}.force_z_n", seat));
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += own[i];
  }
  return sum;
}

// H1 -------------------------------------------------------------------------------------------

constexpr double kPushed = 50., kStiff = 1.4e9, kDamper = 29e6, kPush = 1e4;  // kg, N/m, N s/m, N

/// Displacement of the mass after a jump of the force, and what spring and damper hold, N.
std::array<double, 2> pushed(double t) {
  const double half = .5 * kDamper / kPushed;
  const double fast = half + std::sqrt(half * half - kStiff / kPushed);
  const double slow = kStiff / kPushed / fast;
  const double x = 1. - (fast * std::exp(-slow * t) - slow * std::exp(-fast * t)) / (fast - slow);
  const double a =
      fast * slow * (fast * std::exp(-fast * t) - slow * std::exp(-slow * t)) / (fast - slow);
  return {kPush / kStiff * x, kPush - kPush / kStiff * kPushed * a};
}

HardResult stiff_damper(const std::filesystem::path& scene) {
  const HardRun run(scene);
  const std::vector<double> time = run.time(), z = run.column("seat.dz_m");
  const std::vector<double> held = sum_of_supports(run, 2);
  double off = 0., reaction = 0.;
  HardCurve exact{"closed form", {}, {}};
  for (std::size_t i = 1; i < time.size(); ++i) {
    const std::array<double, 2> known = pushed(time[i]);
    off = std::max(off, std::abs(-z[i] - known[0]) / (kPush / kStiff));
    if (i >= 3) reaction = std::max(reaction, std::abs(std::abs(held[i]) - known[1]) / kPush);
    exact.x.push_back(time[i]);
    exact.y.push_back(1e6 * known[0]);
  }
  HardResult result;
  result.checks = {apart_by("closed form at 1 ms against the printed 3.360972e-7 m, um",
                            1e6 * pushed(1e-3)[0], .3360972, 1e-6),
                   apart_by("closed form at 20 ms against the printed 4.422948e-6 m, um",
                            1e6 * pushed(20e-3)[0], 4.422948, 1e-6),
                   {"displacement against the closed form, over F / k", off, 5e-3},
                   {"reaction against the closed form from step 3 on, over F", reaction, 1e-3},
                   holds("no status bit", run.status().empty())};
  result.picture = {
      "time, s", "displacement, um", {run.curve("seat.dz_m", "1 ms steps", -1e6), exact}};
  result.frame_us = run.frame_us();
  return result;
}

// H2 -------------------------------------------------------------------------------------------

/// The largest size from `from` on of what alternates from step to step.
double ringing(const std::vector<double>& values, std::size_t from) {
  double most = 0.;
  for (std::size_t i = from; i + 1 < values.size(); ++i)
    most = std::max(most, .25 * std::abs(values[i - 1] - 2. * values[i] + values[i + 1]));
  return most;
}

HardResult sudden_load(const std::filesystem::path& scene) {
  HardResult result;
  result.picture = {"time, s", "force of all seats, kN", {}};
  for (const char* scheme : {"generalised-alpha", "newmark", "hht", "backward-euler", "tr-bdf2"}) {
    const HardRun run(scene, {fmt::format("step.scheme=\"{}\"", scheme)});
    const std::vector<double> z = run.column("seat.dz_m");
    const std::vector<double> held = sum_of_supports(run, 41);
    const std::string name = std::string(scheme) + ": ";
    const double still = std::abs(z.back());
    if (result.frame_us == 0.) result.frame_us = run.frame_us();
    result.picture.curves.push_back({scheme, run.time(), held});
    for (double& force : result.picture.curves.back().y) force *= 1e-3;
    if (name == "newmark: ") continue;  // the trapezoidal rule damps nothing
    result.checks.push_back(
        {name + "displacement rings after 20 ms, over its end", ringing(z, 21) / still, 1e-3});
    result.checks.push_back({name + "force of all seats rings after 20 ms, over the load",
                             ringing(held, 21) / 50e3, 1e-3});
    result.checks.push_back(
        off_by(name + "seats hold the load at the end", std::abs(held.back()), 50e3, 1e-6));
  }
  return result;
}

// H24 ------------------------------------------------------------------------------------------

HardResult any_step(const std::filesystem::path& scene) {
  HardResult result;
  result.picture = {"time, s", "rail under the load, mm", {}};
  double still = 0.;
  for (const auto& [dt, duration] : {std::pair(1e-6, 2e-3), std::pair(20e-3, 20.)}) {
    const std::vector<std::string> step = {fmt::format("step.dt_s={}", dt),
                                           fmt::format("step.duration_s={}", duration)};
    const HardRun run(scene, step);
    if (still == 0.) still = run.first("axle.deflection_z_m");
    const std::string name = fmt::format("steps of {:g} s: ", dt);
    const std::vector<double> z = run.column("axle.deflection_z_m");
    double moved = 0.;
    for (const double each : z) moved = std::max(moved, std::abs(each / still - 1.));
    result.checks.push_back(
        {name + "what stands in equilibrium moves, of its deflection", moved, 1e-9});
    std::vector<std::string> few = step;
    few.insert(few.end(), {"track.bays=4", "load[0].start_m=1.3", "sensor[0].position_m=1.2"});
    Simulation start(read_scene(scene, few));
    result.checks.push_back(
        {name + "growth of a step on four bays, over 1", growth_of(start) - 1., 1e-9});
  }
  const HardRun dropped(scene, {"step.start=\"released\""});
  result.checks.push_back(
      off_by("load put on at once, 1000 steps of 20 ms: deflection against the static one",
             dropped.last("axle.deflection_z_m"), still, 1e-9));
  result.picture.curves.push_back(
      dropped.curve("axle.deflection_z_m", "put on at once, 20 ms", 1e3));
  result.frame_us = dropped.frame_us();
  return result;
}

// H25 ------------------------------------------------------------------------------------------

HardResult at_rest(const std::filesystem::path& scene) {
  const HardRun run(scene);
  const Model& model = run.simulation().model();
  const State& state = run.simulation().state;
  int subnormal = 0;
  double most = 0.;
  for (std::int32_t i = 0; i < model.unknowns; ++i)
    for (const double value : {state.u[i], state.v[i], state.a[i], state.g[i]}) {
      subnormal += std::fpclassify(value) == FP_SUBNORMAL ? 1 : 0;
      most = std::max(most, std::abs(value));
    }
  const std::vector<double>& us = run.record().frame_us;
  HardCurve cost{"median of 100 frames", {}, {}};
  for (std::size_t i = 0; i + 100 <= us.size(); i += 100) {
    cost.x.push_back(.1 * static_cast<double>(i));
    cost.y.push_back(quantile({us.begin() + static_cast<std::ptrdiff_t>(i),
                               us.begin() + static_cast<std::ptrdiff_t>(i) + 100},
                              .5));
  }
  return {{{"subnormal numbers in the state", static_cast<double>(subnormal), 0.},
           {"largest number in the state", most, 0.},
           holds("no status but that the load is off", run.status() == "off_rail")},
          {"time, s", "wall time of a frame of 100 steps, us", {cost}},
          run.frame_us()};
}

// H27 ------------------------------------------------------------------------------------------

constexpr double kDriven = 2. * M_PI * 1141.44;  // rad/s

/// How fast the swing at mid-span of the pinned rail grows, m/s: F / (2 M omega), with the modal
/// mass of Timoshenko's first mode, in which the section turns by (k^2 - rho omega^2 / (kz G)) / k.
double growth_rate(double force) {
  const double area = 8.7e-3, inertia = 39e-6, density = 7850., shear = .472 * 210e9 / 2.6,
               length = .6;
  const double k = M_PI / length, turn = (k * k - density * kDriven * kDriven / shear) / k;
  const double mass = .5 * length * density * (area + inertia * turn * turn);
  return force / (2. * mass * kDriven);
}

/// Amplitude at the driving frequency over the four periods before `until`.
double swing(const std::vector<double>& time, const std::vector<double>& z, double until) {
  std::complex<double> sum = 0.;
  double count = 0.;
  for (std::size_t i = 0; i < time.size(); ++i) {
    if (time[i] > until || time[i] <= until - 8. * M_PI / kDriven) continue;
    sum += z[i] * std::polar(1., kDriven * time[i]);
    ++count;
  }
  return 2. * std::abs(sum) / count;
}

/// The same for one mass by generalised-alpha, written again: part of the closed form that it
/// reaches.
double reached_by_one_mass(double dt, double until) {
  constexpr double rho = .6, am = (2. * rho - 1.) / (rho + 1.), af = rho / (1. + rho);
  constexpr double gamma = .5 - am + af, beta = .25 * (1. + af - am) * (1. + af - am);
  double u = 0., v = 0., a = 0., g = 0.;
  std::vector<double> time, z;
  for (int n = 1; n * dt < until + .5 * dt; ++n) {
    const double known = (af * g - am * a) / (1. - am), part = (1. - af) / (1. - am);
    const double start = u + dt * v + dt * dt * ((.5 - beta) * a + beta * known);
    g = (std::sin(kDriven * n * dt) - kDriven * kDriven * start) /
        (1. + kDriven * kDriven * dt * dt * beta * part);
    u = start + dt * dt * beta * part * g;
    v += dt * ((1. - gamma) * a + gamma * (known + part * g));
    a = known + part * g;
    time.push_back(n * dt);
    z.push_back(u);
  }
  return swing(time, z, until) / (until / (2. * kDriven));
}

HardResult resonance(const std::filesystem::path& scene) {
  constexpr const char* kMiddle = "shaker.deflection_z_m";
  const double rate = growth_rate(1e3), until = .05;
  HardResult result;
  result.picture = {"time, s", "displacement at mid-span, mm", {}};
  for (const double dt : {1e-4, 5e-5, 2e-5, 1e-5}) {
    const HardRun run(scene, {fmt::format("step.dt_s={}", dt)});
    const double reached = swing(run.time(), run.column(kMiddle), until) / (rate * until);
    result.checks.push_back(off_by(fmt::format("{:.0f} us: part of the closed form at 0.05 s, "
                                               "against one mass by the same rule ({:.3f})",
                                               1e6 * dt, reached_by_one_mass(dt, until)),
                                   reached, reached_by_one_mass(dt, until),
                                   dt == 1e-4 ? .02 : .01));
    if (dt == 1e-5 || dt == 1e-4)
      result.picture.curves.push_back(run.curve(kMiddle, fmt::format("{:.0f} us", 1e6 * dt), 1e3));
    result.frame_us = run.frame_us();
  }
  const HardRun exact(scene,
                      {"condense.kind=\"modal\"", "condense.modes_per_bay=10.0", "step.dt_s=5e-6"});
  const double grown = swing(exact.time(), exact.column(kMiddle), .1) -
                       swing(exact.time(), exact.column(kMiddle), .05);
  result.checks.push_back(
      off_by("condensed, 5 us: growth from 0.05 to 0.1 s against the closed form", grown / .05,
             rate, 1e-3));
  result.checks.push_back(
      holds("steps of 1 ms are refused: too few a period",
            refusal(scene, {"step.dt_s=1e-3"}).find("steps of dt_s") != std::string::npos));
  return result;
}

// H34 ------------------------------------------------------------------------------------------

HardResult ten_million_steps(const std::filesystem::path& scene) {
  const HardRun run(scene);
  const std::vector<double> time = run.time(), x = run.column("axle.x_m");
  double late = 0., away = 0.;
  for (std::size_t i = 0; i < time.size(); ++i) {
    late = std::max(late, std::abs(time[i] - static_cast<double>(i)));
    away = std::max(away, std::abs(x[i] - (7.2 + 30. * static_cast<double>(i))));
  }
  const std::vector<double> z = run.column("axle.deflection_z_m");
  double moved = 0.;
  for (std::size_t i = 1; i < z.size(); ++i) moved = std::max(moved, std::abs(z[i] / z[1] - 1.));
  return {{{"time against whole seconds, s", late, 1e-12 * time.back()},
           {"place against 30 m/s from its start, m", away, 1e-9},
           {"deflection at the same place of a bay, of the first", moved, 1e-9},
           {"calls of new in the frames", static_cast<double>(run.record().allocations), 0.},
           holds("no status bit", run.status().empty())},
          {"time, s",
           "deflection under the load, mm",
           {run.curve("axle.deflection_z_m", "each second", 1e3)}},
          run.frame_us()};
}

}  // namespace

std::vector<HardCase> step_cases() {
  return {
      {"H1", "h01_stiff_damper", "A stiff damper, pushed at once",
       "With the acceleration that belongs to the jump, generalised-alpha is thrown back by "
       "57 % of F / k.",
       "Closed form of one mass on a spring and a damper.", stiff_damper},
      {"H2", "h02_sudden_load", "50 kN at once on a track at rest",
       "The force jumps, the acceleration before it is 0: inconsistent starts ring from step "
       "to step.",
       "No reference: what alternates from step to step after 20 ms, and the sum of forces at "
       "the end; of schemes that damp, as the trapezoidal rule rings by its nature.",
       sudden_load},
      {"H24", "h24_steps", "Steps of 1 us and of 20 ms",
       "Rounding of masses over dt^2 at the one, aliasing of all that swings at the other.",
       "No reference: the same equilibrium, and no growth of a step's linear map.", any_step},
      {"H25", "h25_at_rest", "A million steps after the load has gone",
       "Numbers that decay become subnormal, and steps many times slower.",
       "No reference: the state is 0 and holds no subnormal number; the picture shows what "
       "steps take.",
       at_rest},
      {"H27", "h27_resonance", "Driven at resonance, without dampers",
       "The scheme's own damping holds down what should grow for ever, and its frequency is off.",
       "Closed form F t / (2 M omega); what generalised-alpha makes of one mass.", resonance},
      {"H34", "h34_ten_million_steps", "Ten million steps",
       "A running sum of steps of 1 ms errs by 1.6e-6 s after 1e7, 47 um at 30 m/s.",
       "No reference: t = n dt, x = x0 + v n dt.", ten_million_steps}};
}

}  // namespace railstep
