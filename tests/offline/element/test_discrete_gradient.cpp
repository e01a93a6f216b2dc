// Contact forces that are means of Hertz's law over the step: no impact adds energy.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

#include "offline/energy/energy_account.h"
#include "offline/vehicle/kinds.h"
#include "online/contact/ports.h"
#include "support/drops.h"
#include "support/model_run.h"
#include "support/scene_run.h"

using namespace railstep;
using Catch::Matchers::WithinRel;

namespace {

/// Random numbers that are the same on every machine: 53 bits of the generator, without the
/// library's distributions.
class Random {
 public:
  double between(double a, double b) {
    return a + (b - a) * std::ldexp(static_cast<double>(generator_() >> 11), -53);
  }
  double of_any_size(double a, double b) { return a * std::pow(b / a, between(0., 1.)); }

 private:
  std::mt19937_64 generator_{7};
};

double stored(double C, double d) { return d > 0. ? .4 * C * d * d * std::sqrt(d) : 0.; }

/// Force of one mean law at a depth: the ports are solved without compliance.
double force_of(double C, double from, double d) {
  PortLaw law{C, 0., 0.};
  law.mean = true;
  law.from = from;
  const double W = 0.;
  double f = 0., found = 0.;
  static_cast<void>(solve_ports(1, &W, &law, &d, &f, &found));
  return f;
}

}  // namespace

TEST_CASE("a mean law gives the mean of Hertz's force over the path of the penetration",
          "[contact]") {
  const double C = 9.412508e10;
  const auto hertz = [&](double d) { return d > 0. ? C * d * std::sqrt(d) : 0.; };
  for (const double from : {-3e-5, 0., 1e-6, 5e-5})
    for (const double d : {-2e-5, 1e-7, 4.999999e-5, 5e-5, 9e-5}) {
      CAPTURE(from, d);
      // 300 or more of the 1e5 midpoints have a force; the sum is of second order, 1e-5.
      double sum = 0.;
      constexpr int kParts = 100000;
      for (int i = 0; i < kParts; ++i) sum += hertz(from + (d - from) * (i + .5) / kParts);
      const double mean = sum / kParts;
      if (mean == 0.)
        CHECK(force_of(C, from, d) == 0.);
      else
        CHECK_THAT(force_of(C, from, d), WithinRel(mean, 1e-4));
      // Its work is the energy that the contact stores, where the difference is not small.
      if (std::abs(d - from) > 1e-6)
        CHECK_THAT(force_of(C, from, d) * (d - from) + stored(C, 1e-4),
                   WithinRel(stored(C, d) - stored(C, from) + stored(C, 1e-4), 1e-13));
    }
}

TEST_CASE("the forces of many mean laws are found within the cap and are unique", "[contact]") {
  Random random;
  for (int n = 0; n < 2000; ++n) {
    const int ports = 1 + n % 8;
    const auto size = static_cast<std::size_t>(ports);
    std::vector<double> W(size * size, 0.), row(size), free(size), force(size), depth(size);
    std::vector<PortLaw> law(size, PortLaw{9.4e10, 0., 0.});
    const double scale = random.of_any_size(1e-11, 1e-8);
    for (std::size_t k = 0; k < size; ++k) {  // the matrix is a sum of squares
      for (double& own : row) own = random.between(-1., 1.);
      for (std::size_t i = 0; i < size; ++i)
        for (std::size_t j = 0; j < size; ++j) W[i * size + j] += scale * row[i] * row[j];
      law[k].mean = random.between(0., 1.) < .8;
      law[k].from = random.between(-1e-4, 1e-4);
      free[k] = law[k].from + random.between(-2e-4, 2e-4);
    }
    const PortResult found =
        solve_ports(ports, W.data(), law.data(), free.data(), force.data(), depth.data());
    CAPTURE(n, ports, found.iterations, found.residual);
    CHECK(found.status == PortStatus::converged);
    double left = 0., largest = 0.;  // residual, and the term that kPortTolerance is relative to
    for (std::size_t k = 0; k < size; ++k) {
      double own = free[k] - depth[k], terms = std::abs(free[k]);
      for (std::size_t j = 0; j < size; ++j) {
        own -= W[k * size + j] * force[j];
        terms += std::abs(W[k * size + j] * force[j]);
      }
      left = std::max(left, std::abs(own));
      largest = std::max(largest, terms);
      CHECK(force[k] >= 0.);
      if (law[k].mean && std::abs(depth[k] - law[k].from) > 1e-6) {  // the difference is not small
        const double gained = stored(9.4e10, depth[k]) - stored(9.4e10, law[k].from);
        CHECK_THAT(force[k] * (depth[k] - law[k].from) + stored(9.4e10, 1e-4),
                   WithinRel(gained + stored(9.4e10, 1e-4), 1e-9));
      }
    }
    CHECK(left <= 2. * kPortTolerance * largest);  // the factor 2 is for rounding
  }
}

TEST_CASE("1e5 impacts add no energy, whatever the masses, the speed and the step", "[contact]") {
  // A wheel meets a rail that is a mass on a spring. Both are exact under forces held over a step;
  // some have a massless flexibility under the wheel. A step's energy errs by rounding and by the
  // force times the penetration's residual, kPortTolerance of its largest term.
  Random random;
  int grown = 0, capped = 0;
  for (int n = 0; n < 100000; ++n) {
    const double wheel = random.of_any_size(1., 2e3), rail = random.of_any_size(1., 2e3);
    const double spring = random.of_any_size(1e5, 1e10), C = random.of_any_size(1e9, 1e12);
    const double speed = random.of_any_size(1e-3, 3.), h = random.of_any_size(1e-6, 1e-3);
    const double G = random.between(0., 1.) < .3 ? random.of_any_size(1e-11, 1e-8) : 0.;
    const double omega = std::sqrt(spring / rail), c = std::cos(omega * h), s = std::sin(omega * h);
    const double half = std::sin(.5 * omega * h), given = 2. * half * half / spring;  // (1 - c) / k
    const double W = .5 * h * h / wheel + given + G;
    double u = random.between(-2., 0.) * speed * h, v = speed, force = 0.;  // of the wheel, down
    double x = random.between(-1., 1.) * 1e-5, xd = random.between(-.1, .1) * speed;
    const auto energy = [&] {
      return .5 * (wheel * v * v + rail * xd * xd + spring * x * x + G * force * force) +
             stored(C, u - x - G * force);
    };
    double before = energy();
    bool met = false;
    for (int i = 0, free = 0; i < 400 && free < 3; ++i) {
      PortLaw law{C, 0., 0.};
      law.mean = true;
      law.from = (u - x) - G * force;
      const double u1 = u + h * v, x1 = c * x + s / omega * xd, d_free = u1 - x1;
      double f = force, d;
      if (solve_ports(1, &W, &law, &d_free, &f, &d).status != PortStatus::converged) ++capped;
      const double left = kPortTolerance * (std::abs(d_free) + W * f);
      u = u1 - .5 * h * h / wheel * f;
      v -= h / wheel * f;
      const double xd1 = -omega * s * x + c * xd + s * omega / spring * f;
      x = x1 + given * f;
      xd = xd1;
      force = f;
      const double after = energy(), size = before + std::abs(f) * (std::abs(u) + std::abs(x));
      if (after > before + 2. * f * left + 1e-13 * size) ++grown;
      before = after;
      met = met || f > 0.;
      if (met && f <= 0.) ++free;
    }
  }
  CHECK(grown == 0);
  CHECK(capped == 0);
}

namespace {

/// A wheel that falls on an undamped track of condensed lines.
ModelRun falling(const Track& track, double x, const Scheme& scheme, bool residual) {
  RunningVehicle wheel;
  wheel.vehicle = point_mass(600.).vehicle;
  wheel.start = x;
  const PackOptions options{
      .scheme = scheme,
      .residual_flexibility = residual,
      .reduction = Reduction{.limit = {1'000'000, std::numeric_limits<double>::infinity()}}};
  return {track, {.vehicles = {wheel}}, options};
}

/// Bounces the wheel from `above` its rail. Returns the largest growth of energy in a step over the
/// whole energy. The contact's energy is that of the step's own penetration and force, d = -gap and
/// f: 2/5 C d^2.5 + G f^2/2; if `standing`, that of the energy account at the present state.
double most_growth(ModelRun& run, double speed, double above, bool standing) {
  const Model& model = run.model();
  const ContactModel& wheel = model.contact[0];
  reset(model, run.state);
  run.state.u[model.vehicle[0].first] = above;
  run.state.v[model.vehicle[0].first] = -speed;
  EnergyAccount energy(*run.packed, model, run.state);
  const double all = energy.stored().total();
  double last = all, most = 0.;
  bool met = false;
  for (int n = 0; n < 60; ++n) {
    run.step();
    energy.follow(run.state);
    const double f = run.outputs.contact_force[0];
    met = met || f > 0.;
    const RailForce at = rail_force(model, wheel.load_point, run.outputs.contact_place[0], f);
    const StoredEnergy& now = energy.stored();
    const double contact = stored(wheel.law.hertz, -run.outputs.contact_gap[0]) +
                           .5 * f * f * residual_under(model, at);
    const double total = now.kinetic + now.strain - energy.flow().weight +
                         (standing ? now.hertz + now.residual : contact);
    most = std::max(most, total - last);
    last = total;
  }
  CHECK(met);
  return most / all;
}

}  // namespace

TEST_CASE("a wheel that bounces on a condensed track never gains energy", "[contact]") {
  Track one = sprung_track(0.);
  one.rails = 1;
  one.bays = 4;
  one.elements_per_bay = 1;
  Random random;
  double by_point = 0.;
  for (const double dt : {1e-3, 2e-4, 2e-5})
    for (const double x : {1.5, 1.2})  // in the middle of a long element, and on a seat
      for (const bool residual : {false, true}) {
        ModelRun mean = falling(one, x, held_mean_force(dt), residual);
        ModelRun point = falling(one, x, held_force(dt, 1.), false);
        for (int n = 0; n < 4; ++n) {
          const double speed = random.of_any_size(.01, 1.);
          const double above = random.between(0., 2.) * speed * dt;
          CAPTURE(dt, x, residual, speed, above);
          // Modes keep their energy to the eigen solver's 1e-10, the contact solves to 1e-12.
          CHECK(most_growth(mean, speed, above, false) < 1e-9);
          by_point = std::max(by_point, most_growth(point, speed, above, true));
        }
      }
  CHECK(by_point > 1e-4);  // a law at one point of the step does gain
}

TEST_CASE("the discrete gradient needs condensed tracks", "[scene]") {
  const std::string mean = "step.contact=\"discrete-gradient\"";
  CHECK_THROWS_WITH(read_scene(kScenes + "ballasted_track.toml", {mean, "condense.kind=\"full\""}),
                    Catch::Contains("E-STEP-02"));
  CHECK(read_scene(kScenes + "ballasted_track.toml", {mean}).step->mean_contact);
  CHECK_FALSE(read_scene(kScenes + "ballasted_track.toml").step->mean_contact);
}

TEST_CASE("both ways to follow the penetration give a moving wheelset the same forces",
          "[contact]") {
  // Means over the step and a law at its middle (rho_inf = 1) are both of second order. At 50 us
  // the fastest motion that matters, 1 kHz, has omega dt = 0.3: they differ by (omega dt)^2/12 of
  // it or less.
  const std::vector<std::string> changes = {"track.bays=24", "step.duration_s=0.05",
                                            "step.rho_inf=1.0"};
  const Traced middle("ballasted_track", changes);
  std::vector<std::string> means = changes;
  means.push_back("step.contact=\"discrete-gradient\"");
  const Traced mean("ballasted_track", means);
  const std::vector<double> a = middle["wheel_left.force_z_n"], b = mean["wheel_left.force_z_n"];
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) CHECK_THAT(b[i], WithinRel(a[i], 1e-2));
}
