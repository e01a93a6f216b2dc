// Oscillating forces that run over a pinned beam, against their modal closed form; and forces that
// follow a table of speeds.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "offline/pack/time_schemes.h"
#include "offline/pack/travel_rows.h"
#include "online/math/sine.h"
#include "online/track/travel.h"
#include "support/crossing.h"
#include "support/model_run.h"
#include "support/sections.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

/// rail-data.md's bridge: L 25 m, EI 1.68e10, 12 t/m; A = 1e4 m2 makes it Euler and Bernoulli's.
Track stiff_bridge(int elements) {
  return pinned_beam({.area = 1e4, .inertia_y = .08, .inertia_z = 1., .torsion = 1.},
                     {210e9, .3, 1.2}, 25., elements);
}

/// Solution of q'' + w^2 q = cos(a t + p) from rest.
double swung(double w, double a, double p, double t) {
  return (std::cos(a * t + p) - std::cos(p) * std::cos(w * t) +
          a / w * std::sin(p) * std::sin(w * t)) /
         (w * w - a * a);
}

/// Middle of the beam under A sin(2 pi (f t + phase)) at v t: sin(k v t) sin(W t + p) is half the
/// difference of two cosines, and so is the response of each mode.
double closed_form(const PinnedModes& modes, double speed, double amplitude, double f, double phase,
                   double t) {
  const double W = 2. * M_PI * f, p = 2. * M_PI * phase;
  double sum = 0.;
  for (std::size_t i = 0; i < modes.wave.size(); ++i) {
    const double k = modes.wave[i], w = modes.natural[i], h = modes.height[i];
    const double q = .5 * (swung(w, W - k * speed, p, t) - swung(w, W + k * speed, p, t));
    sum += h * h * std::sin(.5 * k * modes.length) * amplitude * q;
  }
  return sum;
}

double midspan_height(const ModelRun& run) {
  const LineModel& line = run.model().line[0];
  return run.state.u[line.first + line.unknown_of[0][27 * (run.model().elements / 2) + 2]];
}

}  // namespace

TEST_CASE("an oscillating force that crosses a beam has its modal closed form", "[load]") {
  // The mesh is that of test_fryba.cpp with its 2e-4 of the largest deflection. The trapezoidal
  // rule shifts a mode's phase by (w dt)^2/12 w T in a crossing; the steps allow 1e-4 for the
  // highest mode that oscillates.
  struct Case {
    double speed, frequency, phase;
    int highest, elements;  // mode
  };
  // Mode n has 2.97 n^2 Hz: 40 Hz is between the third and the fourth.
  for (const Case& c : {Case{20., 2., 0., 1, 32},
                        {50., 5., .25, 1, 32},
                        {50., 40., -.1, 4, 96},
                        {74., 1., .6, 1, 32}}) {
    const Track track = stiff_bridge(c.elements);
    const PinnedModes modes(track, 30);  // the others have 30^-4
    const double w = modes.natural[static_cast<std::size_t>(2 * c.highest - 2)];
    const double time = 25. / c.speed;
    const int steps = static_cast<int>(w * time * std::sqrt(w * time / 12e-4));
    const double dt = time / steps;
    ModelRun run(track,
                 {.loads = {{.speed = c.speed,
                             .stop = 25.,
                             .amplitude = -200e3,
                             .frequency = c.frequency,
                             .phase = c.phase}}},
                 {.scheme = generalised_alpha(dt, 1.), .residual_flexibility = false});
    double error = 0., largest = 0.;
    for (int i = 0; i < steps; ++i) {
      run.step();
      if (i % 20 != 0) continue;
      const double want = closed_form(modes, c.speed, -200e3, c.frequency, c.phase, run.time());
      error = std::max(error, std::abs(midspan_height(run) - want));
      largest = std::max(largest, std::abs(want));
    }
    UNSCOPED_INFO(c.speed << " m/s, " << c.frequency << " Hz: " << error / largest);
    CHECK(error < 5e-4 * largest);
  }
}

TEST_CASE("a force with an oscillating part moves the beam as both parts add up", "[load]") {
  const auto run_of = [](double force, double amplitude) {
    ModelRun run(stiff_bridge(8),
                 {.loads = {{.speed = 50.,
                             .stop = 25.,
                             .force = force,
                             .table = {0., 1., .1, .5},
                             .amplitude = amplitude,
                             .frequency = 10.,
                             .phase = .3}}},
                 {.scheme = generalised_alpha(1e-3, .6)});
    run.until(.3);
    return run.outputs.load_deflection[0];
  };
  // The sum is linear to rounding.
  CHECK_THAT(run_of(-2e5, 5e4), WithinRel(run_of(-2e5, 0.) + run_of(0., 5e4), 1e-12));
}

TEST_CASE("the sine of turns agrees with the library's", "[load]") {
  // Its docstring states 4e-16; the library's argument 2 pi t rounds by 1.1e-16 of itself.
  for (int i = -4000; i <= 4000; ++i) {
    const double turns = i * .00123;
    CHECK_THAT(sine_of_turns(turns), WithinAbs(std::sin(2. * M_PI * turns),
                                               5e-16 + 2.3e-16 * 2. * M_PI * std::abs(turns)));
  }
  for (const double whole : {0., 1., -3., 1e9}) {
    CHECK(sine_of_turns(whole) == 0.);
    CHECK_THAT(sine_of_turns(whole + .25), WithinAbs(1., 4e-16));
    CHECK_THAT(sine_of_turns(whole - .25), WithinAbs(-1., 4e-16));
    CHECK(sine_of_turns(whole + .5) == 0.);
  }
  CHECK(sine_of_turns(std::nan("")) == 0.);
  CHECK(sine_of_turns(1e300) == 0.);
}

TEST_CASE("the distance by a table of speeds is the integral of the table", "[load]") {
  const TravelTable table = travel_table(0., {.5, 10., 1.5, 30., 2., 30., 4., 0.});
  const TravelModel travel = table.model();
  CHECK(travel.speed == 30.);
  // By hand: 10 m/s before .5 s, then 20 m, 15 m and 30 m; constant outside.
  const double want[][3] = {{-1., -10., 10.}, {0., 0., 10.},   {.5, 5., 10.},
                            {1., 12.5, 20.},  {1.5, 25., 30.}, {2., 40., 30.},
                            {3., 62.5, 15.},  {4., 70., 0.},   {9., 70., 0.}};
  for (const auto& row : want) {
    const Travelled at = travelled(travel, row[0]);
    CHECK_THAT(at.distance, WithinAbs(row[1], 1e-13));
    CHECK_THAT(at.speed, WithinAbs(row[2], 1e-13));
  }
  CHECK_THROWS_AS(travel_table(0., {0., 1., 0., 2.}), std::invalid_argument);
}

TEST_CASE("a table of one speed is that speed, and positions do not drift with the steps",
          "[load]") {
  const auto run_of = [](std::vector<double> speeds, double dt) {
    ModelRun run(stiff_bridge(8),
                 {.loads = {{.start = 1.,
                             .speed = 20.,
                             .stop = 25.,
                             .force = -2e5,
                             .speeds = std::move(speeds)}}},
                 {.scheme = generalised_alpha(dt, .6)});
    run.until(.5);
    return std::pair{run.outputs.load_x[0], run.outputs.load_deflection[0]};
  };
  const auto constant = run_of({}, 1e-3), table = run_of({0., 20., .2, 20.}, 1e-3);
  CHECK_THAT(table.first, WithinRel(constant.first, 1e-15));
  // The positions differ by rounding, 1e-16 of 11 m, and the deflections with them.
  CHECK_THAT(table.second, WithinRel(constant.second, 1e-12));
  // The load brakes from 40 to 0 m/s within a second: 1 + 40 t - 20 t^2 with any step.
  for (const double dt : {1e-2, 1e-3, 1e-4})
    CHECK_THAT(run_of({0., 40., 1., 0.}, dt).first, WithinRel(1. + 20. - 5., 1e-15));
}
