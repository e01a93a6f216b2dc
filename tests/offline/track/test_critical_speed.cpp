// A force near the critical speed of a rail on seats so close that they act as a bed.
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <vector>

#include "offline/analysis/critical_speed.h"
#include "offline/analysis/statics.h"
#include "offline/pack/time_schemes.h"
#include "support/model_run.h"
#include "support/sections.h"

using namespace railstep;

namespace {

/// Section F on 3e7 N/m each .6 m (R9 and H14 of hard-cases.md), as seats each .1 m.
Track bed(int bays) {
  Track t;
  t.section = section_f();
  t.section.shear_factor_z = .472;
  t.unknowns = Unknowns::vertical;
  t.rails = 1;
  t.bays = bays;
  t.bay_length = .1;
  t.elements_per_bay = 1;
  t.support.stiffness = {0., 0., 5e6};
  return t;
}

/// A table that grows from 0 to 1 by half a cosine over a time. Near the critical speed the
/// oscillation from a sudden force leaves it slowly.
std::vector<double> soft(double time) {
  std::vector<double> rows;
  for (int i = 0; i <= 40; ++i) {
    rows.push_back(time * i / 40.);
    rows.push_back(.5 - .5 * std::cos(M_PI * i / 40.));
  }
  return rows;
}

/// Mean deflection under the force over its last 5 m, over the static deflection.
double ratio_at(double speed, int bays) {
  const Track track = bed(bays);
  const double dt = .1 / speed / 3., way = track.length() - 20.;
  ModelRun run(track,
               {.loads = {{.start = 10.05,
                           .speed = speed,
                           .stop = track.length(),
                           .force = -1e5,
                           .table = soft(.8 * way / speed)}}},
               {.scheme = generalised_alpha(dt, .6)});
  double sum = 0.;
  int count = 0;
  while (run.time() * speed < way) {
    run.step();
    if (run.time() * speed < way - 5.) continue;
    sum += run.outputs.load_deflection[0];
    ++count;
  }
  const RailPoint middle{0, .5 * track.length() + .05, 0., 0., 2};
  return sum / count / (-1e5 * Statics(bed(bays)).flexibility(middle, middle));
}

}  // namespace

TEST_CASE("deflections below the critical speed have the reference's ratios to the static one",
          "[load]") {
  const double critical = 754.04;  // m/s, R9
  const double ratios[][2] = {{.25, 1.0329}, {.5, 1.1553}, {.75, 1.5138}, {.9, 2.2986}};
  for (const auto& [part, want] : ratios) {
    const double found = ratio_at(part * critical, part < .8 ? 600 : 1600);
    CAPTURE(part);
    UNSCOPED_INFO(part << " of critical speed: " << found);
    CHECK(std::abs(found / want - 1.) < .01);  // H14
  }
}

namespace {

/// The wave of least speed: m/s, 1/s, d2(omega)/dk2 in m2/s, and its share of a force.
struct CriticalWave {
  double speed, frequency, alpha, share;
};

/// A Timoshenko beam of the same rail on a continuous bed, wave by wave.
struct Bed {
  double mass, rotary, shear, bending, stiffness, damping;  // kg/m, kg m, N, N m2, N/m2, N s/m2

  explicit Bed(const Track& t)
      : mass(t.material.density * t.section.area),
        rotary(t.material.density * t.section.inertia_y),
        shear(t.section.shear_factor_z * t.material.shear_modulus() * t.section.area),
        bending(t.material.young * t.section.inertia_y),
        stiffness(t.support.stiffness[2] / t.bay_length),
        damping(t.support.damping[2] / t.bay_length) {}

  struct Wave {
    double square[2], share[2];  // for both branches: omega^2, and the share of a force over m
  };
  /// For wave number k: m w'' + (S k^2 + stiffness) w + S k a = f, r a'' + (B k^2 + S) a + S k w =
  /// 0.
  Wave wave(double k) const {
    const double A = (shear * k * k + stiffness) / mass, D = (bending * k * k + shear) / rotary;
    const double b2 = shear * k * shear * k / (mass * rotary);
    const double half = .5 * (A + D), root = std::sqrt(.25 * (D - A) * (D - A) + b2);
    const double low = (A * D - b2) / (half + root), high = half + root;
    const double turn = b2 / ((D - low) * (D - low));
    return {{low, high}, {1. / (1. + turn), turn / (1. + turn)}};
  }
  double frequency(double k) const { return std::sqrt(wave(k).square[0]); }
  /// Wave of least omega / k, found by thirds; its waves carry energy at that speed.
  CriticalWave critical() const {
    double low = .1, high = 10.;
    while (high - low > 1e-7) {
      const double a = low + (high - low) / 3., b = high - (high - low) / 3.;
      if (frequency(a) / a < frequency(b) / b)
        high = b;
      else
        low = a;
    }
    const double k = .5 * (low + high), h = 1e-3, w = frequency(k);
    return {w / k, w, (frequency(k + h) - 2. * w + frequency(k - h)) / (h * h), wave(k).share[0]};
  }
  /// Deflection under a force that appears at x0 at t = 0 and runs along a beam on pinned ends,
  /// from the closed form of each of its sines.
  double under(double force, double speed, double x0, double time, double length) const {
    double sum = 0.;
    for (int n = 1; n < 2000; ++n) {
      const double k = n * M_PI / length, W = k * speed, at = k * x0;
      const Wave own = wave(k);
      for (int j = 0; j < 2; ++j) {
        const double w = std::sqrt(own.square[j]);
        sum += own.share[j] *
               (std::sin(at + W * time) - std::sin(at) * std::cos(w * time) -
                W / w * std::cos(at) * std::sin(w * time)) /
               (own.square[j] - W * W) * std::sin(at + W * time);
      }
    }
    return 2. * force / (mass * length) * sum;
  }
  /// Deflection under a force that has always run.
  double steady(double force, double speed) const {
    double sum = 0.;
    const double dk = 1e-4;
    for (double k = .5 * dk; k < 200.; k += dk) {
      const double W = k * speed;
      const std::complex<double> held(shear * k * k + stiffness - mass * W * W, damping * W);
      const double turns = bending * k * k + shear - rotary * W * W;
      sum += (turns / (held * turns - shear * k * shear * k)).real();
    }
    return force * sum * dk / M_PI;
  }
};

}  // namespace

TEST_CASE("at the critical speed a deflection grows with the root of time", "[load]") {
  // There is no damper. Around the critical wave omega - v k = alpha (k - k0)^2 / 2, and the waves
  // that the force feeds spread only by sqrt(alpha t), so that
  //   w = F / (m omega) sqrt(t / (pi alpha)) + a constant + O(1/sqrt(t)).
  const Track track = bed(1300);
  const Bed exact(track);
  const CriticalWave at = exact.critical();
  CHECK(std::abs(at.speed / 754.04 - 1.) < 1e-5);  // R9
  const double force = -1e5, from = 30.05, dt = .1 / at.speed / 6.;
  ModelRun run(track, {.loads = {{.start = from, .speed = at.speed, .stop = 130., .force = force}}},
               {.scheme = generalised_alpha(dt, .6)});
  const RailPoint middle{0, 30.05, 0., 0., 2};
  const double still = force * Statics(bed(600)).flexibility(middle, middle);
  const double rate = force * at.share / (exact.mass * at.frequency * std::sqrt(M_PI * at.alpha));
  double first = 0., first_time = 0.;
  for (int i = 1; i <= 7; ++i) {  // before reflections from the ends arrive
    run.until(.01 * i);
    const double found = run.outputs.load_deflection[0];
    const double want = exact.under(force, at.speed, from, run.time(), track.length());
    CAPTURE(run.time(), found, want);
    CHECK(std::abs(found / want - 1.) < .01);  // H14
    if (i > 1) continue;
    first = found;
    first_time = run.time();
  }
  const double last = run.outputs.load_deflection[0];
  const double grown = (last - first) / (std::sqrt(run.time()) - std::sqrt(first_time));
  CAPTURE(grown / rate, last / still);
  // The next term of the series over the time is 1/(omega sqrt(t0 t1)) = 3 %.
  CHECK(std::abs(grown / rate - 1.) < 1. / (at.frequency * std::sqrt(first_time * run.time())));
  CHECK(last / still > 5.);
  CHECK(run.seen == Status::ok);
}

TEST_CASE("the critical speed of a bed is that of its slowest wave", "[load]") {
  // hard-cases.md prints R9 to 6 digits.
  Track track = bed(10);
  CHECK(critical_speed(track).value() == Approx(754.04).epsilon(1e-5));
  track.support.stiffness[2] = 1e8 / 6.;
  CHECK(critical_speed(track).value() == Approx(1001.73).epsilon(1e-5));
  // Pads of twice the stiffness, ballast of twice the stiffness and sleepers without mass.
  track.support.stiffness[2] = 2e8 / 6.;
  track.sleeper = Sleeper{0., 1., {0., 0., 2e8 / 6.}, {}};
  CHECK(critical_speed(track).value() == Approx(1001.73).epsilon(1e-5));
  track.support.stiffness[2] = 0.;
  CHECK_FALSE(critical_speed(track));
}

namespace {

/// The same bed with half sleepers of 25 kg each .1 m, each on ballast of 1/6 of 1e8 N/m.
Track on_sleepers(int bays, double pad, double damping) {
  Track track = bed(bays);
  track.support.stiffness[2] = pad;
  track.support.damping[2] = damping;
  track.sleeper = Sleeper{50., 1., {0., 0., 1e8 / 6.}, {}};
  track.sleeper->ballast_damping[2] = damping;
  return track;
}

/// Deflection under a force that has always run, on a smeared bed: over all wave numbers.
double steady_on_sleepers(const Track& track, double force, double speed) {
  const Bed rail(track);
  const double l = track.bay_length, mass = .5 * track.sleeper->mass / l;
  double sum = 0.;
  const double dk = 2e-4;
  for (double k = .5 * dk; k < 200.; k += dk) {
    const double W = k * speed;
    const std::complex<double> pad(rail.stiffness, rail.damping * W);
    const std::complex<double> ballast(track.sleeper->ballast_stiffness[2] / l - mass * W * W,
                                       track.sleeper->ballast_damping[2] / l * W);
    const std::complex<double> held =
        rail.shear * k * k + pad * ballast / (pad + ballast) - rail.mass * W * W;
    const double turns = rail.bending * k * k + rail.shear - rail.rotary * W * W;
    sum += (turns / (held * turns - rail.shear * k * rail.shear * k)).real();
  }
  return force * sum * dk / M_PI;
}

}  // namespace

TEST_CASE("on sleepers the deflection is largest at the critical speed", "[load]") {
  // With pads of 5e6 N/m the lower branch has no least omega / k, with 1e9 it has one.
  for (const double pad : {5e6, 1e9}) {
    const Track track = on_sleepers(10, pad, 30.);
    const double critical = critical_speed(track).value();
    double most = 0., at = 0.;
    for (double part = .5; part < 1.5; part += .01) {
      const double found = std::abs(steady_on_sleepers(track, 1., part * critical));
      if (found > most) at = part;
      most = std::max(most, found);
    }
    CAPTURE(pad, critical, at);
    CHECK(std::abs(at - 1.) < .015);  // a step of the scan; dampers lower it by less
    CHECK(most > 2. * std::abs(steady_on_sleepers(track, 1., .1 * critical)));
  }
  // Sleepers that move with the rail would give 329 m/s, far below.
  CHECK(critical_speed(on_sleepers(10, 5e6, 0.)).value() == Approx(786.).epsilon(1e-3));
}

TEST_CASE("deflections on sleepers are those of the smeared bed", "[load]") {
  const Track track = on_sleepers(1000, 5e6, 1e3);
  const double critical = critical_speed(track).value(), still = steady_on_sleepers(track, 1., 1.);
  for (const double part : {.42, .9}) {  // at .42 sleepers would move with the rail
    const double speed = part * critical, dt = .1 / speed / 3.;
    ModelRun run(track,
                 {.loads = {{.start = 10.05,
                             .speed = speed,
                             .stop = track.length(),
                             .force = -1e5,
                             .table = soft(50. / speed)}}},
                 {.scheme = generalised_alpha(dt, .6)});
    run.until(70. / speed);
    double sum = 0.;
    const int steps = 150;  // over 50 seats
    for (int i = 0; i < steps; ++i) {
      run.step();
      sum += run.outputs.load_deflection[0] / steps;
    }
    const double want = steady_on_sleepers(track, -1e5, speed);
    CAPTURE(part, sum, want, want / (-1e5 * still));
    CHECK(std::abs(sum / want - 1.) < .01);  // H14
  }
}

TEST_CASE("a rail whose axial force would buckle it has no critical speed", "[load]") {
  Track track = bed(10);
  const Bed rail(track);
  const double buckles = 2. * std::sqrt(rail.stiffness * rail.bending);  // by Euler and Bernoulli
  track.axial_force = -.5 * buckles;
  CHECK(critical_speed(track).value() < 754.);
  track.axial_force = -1.1 * buckles;
  CHECK_FALSE(critical_speed(track));
}

TEST_CASE("dampers limit the deflection at the critical speed", "[load]") {
  // On a bed with damping c per length it is F / (2 m omega sqrt(alpha delta)), delta = c / 2m, to
  // the first order of delta / omega. The force has run for 8 time constants.
  Track track = bed(1300);
  track.support.damping = {0., 0., 1e3};
  const Bed exact(track);
  const CriticalWave at = exact.critical();
  const double force = -1e5, delta = exact.damping / (2. * exact.mass);
  ModelRun run(track,
               {.loads = {{.start = 30.05, .speed = at.speed, .stop = 130., .force = force}}},
               {.scheme = generalised_alpha(.1 / at.speed / 6., .6)});
  run.until(.1);
  double sum = 0.;
  const int steps = 60;  // over ten seats
  for (int i = 0; i < steps; ++i) {
    run.step();
    sum += run.outputs.load_deflection[0] / steps;
  }
  const double held = exact.steady(force, at.speed);
  const double leading =
      force * at.share / (2. * exact.mass * at.frequency * std::sqrt(at.alpha * delta));
  CAPTURE(sum, held, leading);
  CHECK(std::abs(sum / held - 1.) < .01);  // H14
  CHECK(std::abs(held / leading - 1.) < delta / at.frequency);
}
