#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "answer/scene_receptance.h"
#include "answer/static_solution.h"
#include "build/build.h"
#include "hard/growth.h"
#include "hard/hard_run.h"
#include "run/speed_note.h"

namespace railstep {
namespace {

constexpr const char* kAxle = "axle.deflection_z_m";

// H3 -------------------------------------------------------------------------------------------

/// Deflection under the standing load, m, up.
double under(const std::filesystem::path& scene, double x, int elements) {
  return HardRun(scene,
                 {fmt::format("load[0].start_m={}", x), "load[0].speed_m_per_s=0.0",
                  fmt::format("track.elements_per_bay={}", elements), "step.duration_s=2.5e-4"})
      .first(kAxle);
}

/// The same by exact Timoshenko beams, which need a node under the load.
double exact_under(const std::filesystem::path& scene, double x) {
  const StaticSolution found = solve_static(
      read_scene(scene, {fmt::format("load[0].start_m={}", x), "load[0].speed_m_per_s=0.0",
                         "track.elements_per_bay=16", "track.model=\"timoshenko\"",
                         fmt::format("sensor=[{{name=\"under\",on=\"rail\",position_m={}}}]", x)}));
  return found.points.at(0).displacement[2];
}

/// Deflection under the load at 30 m/s, in steps of 25 us.
std::vector<double> moving_over(const std::filesystem::path& scene, int elements) {
  return HardRun(scene, {fmt::format("track.elements_per_bay={}", elements), "step.dt_s=2.5e-5"})
      .column(kAxle);
}

/// Largest error of a mesh under the moving load, over the deflection. The static deflection is
/// exact, but the dampers c of the seats act on rates, v c times slopes along the rail. A load
/// between nodes that are d apart presses a seat by a parabola through the seat's influence line g,
/// whose slope errs by g''' d^2 / 3. On a bed, g''' next to the load is 4 f / lambda^3: f is the
/// flexibility there, lambda^4 = 4 E I bay / k.
double parabola_error(int elements) {
  constexpr double kStiffness = 3e7, kDamperOfSeat = 3e4, kBay = .6, kSpeed = 30.;
  const double flexibility = 5.763979e-4 / 50e3;  // m/N, R6
  const double lambda = std::pow(4. * 210e9 * 39e-6 * kBay / kStiffness, .25);
  const double node = .5 * kBay / elements;
  return kSpeed * kDamperOfSeat * flexibility * 4. / std::pow(lambda, 3) * node * node / 3.;
}

/// Every place of a run against the finest mesh.
HardCheck kinks(const std::filesystem::path& scene, int elements,
                const std::vector<double>& finest) {
  const std::vector<double> found = moving_over(scene, elements);
  double off = 0., most = 0.;
  for (std::size_t i = 0; i < finest.size(); ++i) {
    off = std::max(off, std::abs(found.at(i) - finest[i]));
    most = std::max(most, std::abs(finest[i]));
  }
  return {
      fmt::format("30 m/s, {} elements a bay: deflection against 8, over the largest", elements),
      off / most, parabola_error(elements)};
}

HardResult over_borders(const std::filesystem::path& scene) {
  HardResult result;
  result.picture = {"place in the bay, m", "deflection over the exact one, less 1", {}};
  constexpr int kPlaces = 16;
  std::vector<double> place, exact;
  for (int i = 0; i <= kPlaces; ++i) {
    place.push_back(.6 * i / kPlaces);
    exact.push_back(exact_under(scene, 12. + place.back()));
  }
  for (const int elements : {1, 2, 4, 8}) {
    HardCurve curve{fmt::format("{} a bay", elements), place, {}};
    double off = 0.;
    for (std::size_t i = 0; i < place.size(); ++i) {
      curve.y.push_back(under(scene, 12. + place[i], elements) / exact[i] - 1.);
      off = std::max(off, std::abs(curve.y.back()));
    }
    result.checks.push_back(
        {fmt::format("{} elements a bay: static deflection under the load", elements), off, 1e-8});
    result.picture.curves.push_back(curve);
  }
  const std::vector<double> finest = moving_over(scene, 8);
  for (const int elements : {1, 2, 4}) result.checks.push_back(kinks(scene, elements, finest));
  const HardRun run(scene);
  result.checks.push_back(holds("no status bit at 30 m/s", run.status().empty()));
  result.frame_us = run.frame_us();
  return result;
}

// H14 ------------------------------------------------------------------------------------------

constexpr double kCriticalSpeed = 754.04;  // m/s, R9

/// A force that grows by half a cosine over a time.
std::string soft_table(double time) {
  std::string rows;
  for (int i = 0; i <= 40; ++i)
    rows += fmt::format("{}[{:.17g}, {:.17g}]", i == 0 ? "" : ", ", time * i / 40.,
                        .5 - .5 * std::cos(M_PI * i / 40.));
  return fmt::format("load[0].table=[{}]", rows);
}

HardRun at_speed(const std::filesystem::path& scene, double speed, double way) {
  const double dt = .1 / speed / 3.;
  const auto steps = std::floor(way / speed / dt);
  return HardRun(scene, {fmt::format("load[0].speed_m_per_s={:.17g}", speed),
                         soft_table(.8 * way / speed), fmt::format("step.dt_s={:.17g}", dt),
                         fmt::format("step.duration_s={:.17g}", steps * dt)});
}

bool warns_of_speed(const std::filesystem::path& scene, double speed) {
  const Scene read = read_scene(
      scene, {fmt::format("load[0].speed_m_per_s={:.17g}", speed), "step.duration_s=0.1"});
  return speed_note(read, track_of(read)).has_value();
}

HardResult near_critical(const std::filesystem::path& scene) {
  const HardRun stands(
      scene, {"load[0].speed_m_per_s=0.0", "load[0].start_m=65.05", "load[0].table=[[0.0,1.0]]",
              "step.start=\"equilibrium\"", "step.duration_s=1e-4"});
  const double still = stands.first(kAxle), way = 110.;
  HardResult result;
  result.picture = {"place of the load, m", "deflection over the static one", {}};
  for (const auto& [part, ratio] : {std::pair(.25, 1.0329), std::pair(.5, 1.1553),
                                    std::pair(.75, 1.5138), std::pair(.9, 2.2986)}) {
    const HardRun run = at_speed(scene, part * kCriticalSpeed, way);
    HardCurve curve{fmt::format("{:g} of critical", part), run.column("axle.x_m"),
                    run.column(kAxle)};
    double sum = 0., count = 0.;
    for (std::size_t i = 0; i < curve.y.size(); ++i) {
      curve.y[i] /= still;
      if (curve.x[i] < 10.05 + way - 5.) continue;
      sum += curve.y[i];
      ++count;
    }
    result.checks.push_back(
        off_by(fmt::format("{:g} of critical speed: deflection over the static one", part),
               sum / count, ratio, .01));
    result.picture.curves.push_back(curve);
    result.frame_us = run.frame_us();
  }
  const HardRun critical = at_speed(scene, kCriticalSpeed, way);
  result.checks.push_back(holds("at critical speed: finite", critical.status().empty()));
  result.checks.push_back(
      holds("at critical speed: warned of", warns_of_speed(scene, kCriticalSpeed)));
  result.checks.push_back(
      holds("at half of it: not warned of", !warns_of_speed(scene, .5 * kCriticalSpeed)));
  return result;
}

// H28 ------------------------------------------------------------------------------------------

std::vector<double> receptance(const std::filesystem::path& scene, double from, double to,
                               double step, std::vector<double>& hz) {
  const ReceptanceRequest request{.scene = scene.string(),
                                  .overrides = {},
                                  .at = "mid_bay",
                                  .to = {},
                                  .direction = "z",
                                  .to_direction = {},
                                  .from_hz = from,
                                  .to_hz = to,
                                  .points = 0,
                                  .step_hz = step,
                                  .condensed = false,
                                  .beside = {},
                                  .decay = false,
                                  .reflection = false};
  const ReceptanceAnswer answer = solve_receptance(request);
  hz = answer.hz;
  std::vector<double> size;
  size.reserve(hz.size());
  for (const std::complex<double>& value : answer.curve.value) size.push_back(std::abs(value));
  return size;
}

HardResult many_modes(const std::filesystem::path& scene) {
  std::vector<double> hz, fine;
  const std::vector<double> low = receptance(scene, 50., 200., 150., hz);
  const std::vector<double> peak = receptance(scene, 1100., 1180., .25, fine);
  const auto at = std::max_element(peak.begin(), peak.end()) - peak.begin();
  HardResult result;
  result.checks = {off_by("50 Hz, m/N", low.front(), 1.24851e-8, 5e-4),
                   off_by("200 Hz, m/N", low.back(), 7.732e-9, 5e-4),
                   apart_by("peak, Hz", fine[static_cast<std::size_t>(at)], 1141.5, 1.)};
  std::vector<double> all_hz;
  const std::vector<double> all = receptance(scene, 20., 1500., 5., all_hz);
  result.picture = {
      "frequency, Hz", "displacement over force, m/N", {{"mid-bay", all_hz, all}}, true, true};
  return result;
}

// H29 ------------------------------------------------------------------------------------------

HardResult a_million_bays(const std::filesystem::path& scene) {
  const HardRun run(scene);
  constexpr std::size_t kSettled =
      1000;  // bays: from equilibrium the load must first make its waves
  const std::vector<double> z = run.column(kAxle);  // a row a bay, at the same place of it
  double apart = 0., most = 0.;
  for (std::size_t i = kSettled + 1; i < z.size(); ++i) {
    apart = std::max(apart, std::abs(z[i] / z[i - 1] - 1.));
    most = std::max(most, std::abs(z[i] / z[kSettled] - 1.));
  }
  HardCurve first = run.curve(kAxle, "each bay", 1e3);
  for (std::vector<double>* values : {&first.x, &first.y}) values->resize(kSettled);
  return {
      {{"a bay against the one before", apart, 1e-9},
       {"a bay against the thousandth, up to a million", most, 1e-9},
       {"bays, in a million, that are missing", 1. - static_cast<double>(z.size() - 1) / 1e6, 1e-9},
       {"calls of new in the frames", static_cast<double>(run.record().allocations), 0.},
       holds("no status bit", run.status().empty())},
      {"time, s", "deflection under the load, mm", {first}},
      run.frame_us()};
}

// H30 ------------------------------------------------------------------------------------------

HardResult few_modes(const std::filesystem::path& scene) {
  HardResult result;
  result.picture = {"time, s", "wheel-rail force, kN", {}};
  for (const char* modes : {"0.2", "0.5", "1.0"}) {
    const std::vector<std::string> few = {fmt::format("condense.modes_per_bay={}", modes),
                                          "step.contact=\"discrete-gradient\""};
    Simulation start(read_scene(scene, few));
    const HardRun run(scene, few);
    const std::string name = fmt::format("{} modes a bay: ", modes);
    result.checks.push_back(
        {name + "growth of a step in contact, over 1", growth_of(start) - 1., 1e-9});
    result.checks.push_back(holds(name + "no status bit", run.status().empty()));
    result.picture.curves.push_back(
        run.curve("bogie.wheel_1.force_z_n", fmt::format("{} a bay", modes), 1e-3));
    result.frame_us = run.frame_us();
  }
  return result;
}

}  // namespace

std::vector<HardCase> track_cases() {
  return {
      {"H3", "h03_over_borders", "A load over the borders of elements",
       "The mesh is stiffer inside an element than at its ends: a load would feel a bump at v / l.",
       "Exact Timoshenko beams with a node under the load. At 30 m/s 8 elements a bay; the bound "
       "is the response of the seats' dampers to a parabola in each element.",
       over_borders},
      {"H14", "h14_critical_speed", "A load near critical speed",
       "The waves that it makes run with it: long, and slow to leave.",
       "R9: beam on a continuous bed, waves at the load's speed.", near_critical},
      {"H28", "h28_receptance", "Receptance of 120 bays",
       "Many modes, and a sharp resonance of one bay between its seats.",
       "Galerkin solution of the same beam, to 5e-4; the peak's height depends on the length.",
       many_modes},
      {"H29", "h29_a_million_bays", "A load over a million bays",
       "The error that each bay adds by rounding or by the bays' shift grows.",
       "No reference: each bay is as the one before.", a_million_bays},
      {"H30", "h30_few_modes", "Few modes under a bogie in contact",
       "Modes that condensation leaves out come back through the contact: spillover.",
       "No reference: eigenvalues of the coupled step.", few_modes}};
}

}  // namespace railstep
