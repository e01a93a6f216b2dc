// Random wheels on random tracks that no drive works on: their energy never grows, in full order
// and condensed. Damped modes ("complex-modes") have no energies and are left out.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <string>

#include "support/passive_run.h"
#include "support/sanitized.h"
#include "text/read.h"

using namespace railstep;

namespace {

// Two million steps in all; each takes some twenty times as long under a sanitizer.
#ifdef RAILSTEP_SANITIZED
constexpr int kShare = 20;
#else
constexpr int kShare = 1;
#endif
constexpr int kSteps = 1000;  // per scene

const std::string kEuler = "scheme = \"backward-euler\"\n";
const std::string kTrapezoid = "scheme = \"newmark\"\n";
const std::string kMean = "contact = \"discrete-gradient\"\n";
const std::string kAtEnd = "rho_inf = 0.0\n";

/// Largest values of a run, over their bounds.
struct Worst {
  double made = 0.;     // of a step: energy added over the bound of round-off
  double made_in = 0.;  // of a step: energy added over the largest energy
  double all = 0.;      // of the run: the same for the sum of all steps
  std::int64_t steps = 0, pressed = 0;
  bool lost = false;  // a wheel ran off, or a solve did not converge
  bool fails() const { return !(made <= 1.) || lost; }
};

void take(Worst& to, const Worst& from) {
  to.made = std::max(to.made, from.made);
  to.made_in = std::max(to.made_in, from.made_in);
  to.all = std::max(to.all, from.all);
  to.steps += from.steps;
  to.pressed += from.pressed;
}

/// Checks that no step adds energy, for a convex potential.
Worst never_grows(const RandomScene& scene) {
  PassiveRun run(scene);
  Worst worst;
  double made = 0.;
  for (; worst.steps < scene.steps; ++worst.steps) {
    run.step();
    const StepEnergies e = run.energies();
    made += e.after - e.before;
    worst.made = std::max(worst.made, (e.after - e.before) / e.bound);
    worst.made_in = std::max(worst.made_in, (e.after - e.before) / run.reference());
    worst.all = std::max(worst.all, made / run.reference());
    for (int i = 0; i < wheel_count(run.model()); ++i)
      worst.pressed += run.state().contact_force[i] > 0. ? 1 : 0;
    if (!std::isfinite(e.after)) worst.made = std::numeric_limits<double>::infinity();
  }
  worst.lost = has(run.seen(), Status::off_rail) || has(run.seen(), Status::cap_reached);
  return worst;
}

RandomScene falling(std::uint64_t seed, const std::string& scheme, const std::string& kind) {
  Draw draw(seed);
  RandomScene s = random_track(seed, draw);
  s.steps = kSteps;
  s.scheme = scheme;
  // One bay that is clamped at both ends has no node left for condensation.
  if ((kind == "guyan" || kind == "irs") && s.ends[0] != "free") s.ends[1] = "free";
  s.vehicle = random_vehicle(draw, s, false);
  const bool residual = draw.chance(.5);
  if (kind != "full" && s.sleepers && s.sleeper_mass == 0.) s.pad_damper = s.ballast_damper = 0.;
  s.condense =
      "kind = \"" + kind + "\"\nresidual_flexibility = " + (residual ? "true\n" : "false\n");
  if (kind == "modal" || kind == "craig-bampton" || kind == "krylov")
    s.condense += fmt::format("modes_per_bay = {}\n", draw.whole(1, 4));
  return s;
}

/// Work on linear contacts by the drive of the wheels, in a step of the trapezoidal rule.
///
/// f0 acts in the row of the wheel's place x0, f1 in that of x1. The path from x0 to x1 changes the
/// approach by p at the track's state before the step and by q at that after it. With f linear, c a
/// = d + c G f, the contact stores (f0 + f1)/2 (a1 - a0) - f0' (G1 - G0) f1 / 2. The bodies give
/// (f0 row0 + f1 row1)/2 du of it and the path the rest, (f1 p + f0 q)/2 - f0' (G1 - G0) f1 / 2.
double carried(const PassiveRun& run) {
  const std::int64_t step = run.state().steps;
  const StandingWheels at00 = run.wheels(run.old(), step - 1), at01 = run.wheels(run.old(), step);
  const StandingWheels at10 = run.wheels(run.state(), step - 1);
  const StandingWheels at11 = run.wheels(run.state(), step);
  const double *f0 = run.old().contact_force, *f1 = run.state().contact_force;
  double sum = 0.;
  for (std::size_t i = 0; i < at00.place.size(); ++i) {
    sum += .5 * f1[i] * (at01.approach[i] - at00.approach[i]);
    sum += .5 * f0[i] * (at11.approach[i] - at10.approach[i]);
    sum -= .5 * f0[i] * (run.moved(at11, f1, i) - run.moved(at10, f1, i));
  }
  return sum;
}

/// Checks the trapezoidal rule on linear contacts: to round-off on both sides every step keeps the
/// energy except what dampers take and the path adds. The first step is left out, since its
/// accelerations are the start's own.
Worst is_kept(const RandomScene& scene) {
  PassiveRun run(scene);
  Worst worst;
  run.step();
  double before = run.of_all(run.state(), 1);
  for (worst.steps = 1; worst.steps < scene.steps; ++worst.steps) {
    run.step();
    const StepEnergies e{before, run.of_all(run.state(), run.state().steps), 0.};
    before = e.after;
    const double off = std::abs(e.after - e.before + run.damped() - carried(run));
    worst.made = std::max(worst.made, off / run.bound(e));
    worst.made_in = std::max(worst.made_in, off / run.reference());
    for (int i = 0; i < wheel_count(run.model()); ++i)
      worst.pressed += run.state().contact_force[i] != 0. ? 1 : 0;
    if (!std::isfinite(e.after)) worst.made = std::numeric_limits<double>::infinity();
  }
  worst.lost = has(run.seen(), Status::off_rail) || has(run.seen(), Status::cap_reached);
  return worst;
}

/// Rebound speed over impact speed of one mass on the spring f = d^n, by the textbook's
/// generalised-alpha 0.6: the largest over all phases of the step at which contact begins.
/// @param steps  per contact
double largest_rebound(double n, double steps) {
  const double af = .375, am = .125, gamma = .75, beta = .390625;  // for rho_inf = 0.6
  const double deepest = std::pow(.5 * (n + 1.), 1. / (n + 1.));
  const double h = 2. * deepest * std::sqrt(std::numbers::pi) * std::tgamma(1. + 1. / (n + 1.)) /
                   std::tgamma(.5 + 1. / (n + 1.)) / steps;
  double most = 0.;
  for (int phase = 0; phase < 64; ++phase) {
    double u = -h * phase / 64., v = 1., a = 0., g = 0.;
    for (int i = 0; i < static_cast<int>(steps) + 12; ++i) {
      const double held = (af * g - am * a) / (1. - am),
                   give = h * h * beta * (1. - af) / (1. - am);
      const double free = u + h * v + h * h * ((.5 - beta) * a + beta * held);
      double low = 0., high = std::max(0., free);
      for (int k = 0; k < 60; ++k) {
        const double x = .5 * (low + high);
        (x + give * std::pow(x, n) > free ? high : low) = x;
      }
      g = -std::pow(low, n);
      const double a1 = held + (1. - af) / (1. - am) * g;
      v += h * ((1. - gamma) * a + gamma * a1);
      u = free + give * g;
      a = a1;
    }
    most = std::max(most, -v);
  }
  return most;
}

/// Largest factor on a rebound's speed, for a mass on a spring between d^1.5 (a rigid rail) and d
/// (a soft one). The worst is a spring k that lets go in the middle of a step: the chord over the
/// kink of its force is above the force by k v h/8 in the step's mean (k v h/12 over all phases).
/// That is (omega h)^2/8 of the speed, omega h = pi / steps, which a linear spring reaches with
/// many steps. Hertz's spring lets go without a kink and has a third of it.
double gain(double steps) {
  return 1. + std::numbers::pi * std::numbers::pi / (8. * steps * steps);
}

/// Steps per contact on a rigid rail: a contact on a soft one lasts longer.
double contact_steps(const RandomScene& s) {
  const double v = s.vehicle->drop_speed;
  const double deep = std::pow(1.25 * s.vehicle->mass * v * v / 9.412508e10, .4);
  return 2.943275 * deep / v / s.dt;
}

/// Checks the energy of a fall under generalised-alpha 0.6 while no wheel presses, over the gain
/// that its impacts may have.
Worst rebounds(const RandomScene& scene) {
  PassiveRun run(scene);
  Worst worst;
  double start = 0., may = 1.;
  bool pressed = false;
  for (; worst.steps < scene.steps; ++worst.steps) {
    run.step();
    const StepEnergies e = run.energies();
    if (worst.steps == 0) start = e.before;
    const bool presses = run.state().contact_force[0] > 0.;
    if (presses && !pressed) may *= std::pow(gain(contact_steps(scene)), 2);
    pressed = presses;
    worst.pressed += presses ? 1 : 0;
    if (presses) continue;
    worst.all = std::max(worst.all, e.after / start - 1.);
    worst.made = std::max(worst.made, (e.after / start - 1.) / (may - 1. + 1e-9));
  }
  worst.lost = has(run.seen(), Status::off_rail) || has(run.seen(), Status::cap_reached);
  return worst;
}

RandomScene dropped_mass(std::uint64_t seed) {
  Draw draw(seed);
  RandomScene s = random_track(seed, draw);
  s.steps = kSteps;
  s.vehicle = random_vehicle(draw, s, false);
  s.vehicle->type = "mass";
  s.vehicle->wheelbase = s.vehicle->speed = 0.;
  s.vehicle->gravity = false;
  s.pad_damper = s.ballast_damper = 0.;
  s.dt = 1.;
  s.dt = contact_steps(s) / draw.of_any_size(3., 100.);
  s.vehicle->drop_height = draw.between(0., 1.) * s.vehicle->drop_speed * s.dt;
  s.condense = draw.chance(.5) ? "" : "residual_flexibility = false\n";
  return s;
}

/// Worst of many scenes. A failing scene is shrunk and written; after three the search ends.
template <typename Make, typename Check>
Worst worst_of(std::uint64_t first, int scenes, const Make& make, const Check& check) {
  Worst worst;
  int failed = 0;
  for (std::uint64_t seed = first; seed < first + static_cast<std::uint64_t>(scenes / kShare);
       ++seed) {
    CAPTURE(seed);
    const RandomScene scene = make(seed);
    Worst found;
    const auto refused = [&](const RandomScene& s) {
      try {
        found = check(s);
      } catch (const InputError& e) {
        return std::string(e.what()).substr(std::string(e.what()).find(' '));  // past the file
      }
      return std::string();
    };
    const std::string said = refused(scene);
    if (said.empty()) take(worst, found);
    if (!said.empty() || found.fails()) ++failed;
    if (!said.empty())
      report(scene, "a scene" + said, [&](const RandomScene& s) { return refused(s) == said; });
    else if (found.fails())
      report(scene, fmt::format("{:.3g} of its bound, lost: {}", found.made, found.lost),
             [&](const RandomScene& s) { return check(s).fails(); });
    if (failed == 3) break;
  }
  return worst;
}

}  // namespace

TEST_CASE("backward Euler takes energy from every fall in each step", "[passive]") {
  // With u1 = u0 + h v1 and M (v1 - v0) = -h (grad P(u1) + C v1), P convex:
  //   T1 - T0 <= v1' M (v1 - v0) = -(u1 - u0)' grad P(u1) - h v1' C v1 <= P(u0) - P(u1).
  // Hertz springs, G f^2/2, linear and one-sided springs and weight are convex. Dampers that only
  // press add to what a closing spring takes. The energy of the wheels at the step's start, P(u0)
  // with the forces f0, is not below the least over all f, which the solve finds.
  const Worst worst = worst_of(
      1000, 500,
      [](std::uint64_t seed) {
        RandomScene s = falling(seed, kEuler, "full");
        s.unilateral = seed % 4 == 0;
        return s;
      },
      never_grows);
  CAPTURE(worst.steps, worst.pressed, worst.made, worst.made_in, worst.all);
  CHECK(worst.pressed > worst.steps / 20);  // wheels do meet the rail
  CHECK(worst.all < 1e-9);                  // round-off of a thousand steps
}

TEST_CASE("with mean contact forces no condensed track adds energy to a fall", "[passive]") {
  // Lines and vehicles take f du of a force held over a step, less their dampers' share. A mean law
  // has f (d1 - d0) = V(d1) - V(d0), and with a = d + G f
  //   f1' (a1 - a0) - d(V + f' G f / 2) = df' G df / 2 >= 0.
  const std::string kind =
      GENERATE(as<std::string>(), "modal", "guyan", "irs", "craig-bampton", "krylov");
  const Worst worst = worst_of(
      2000, 120, [&](std::uint64_t seed) { return falling(seed, kMean, kind); }, never_grows);
  CAPTURE(worst.steps, worst.pressed, worst.made, worst.made_in, worst.all);
  CHECK(worst.pressed > worst.steps / 20);
  CHECK(worst.all < 1e-7);  // the eigen solver's 1e-10 over a thousand steps
}

TEST_CASE("with contact forces of the step's end no condensed track adds energy to a fall",
          "[passive]") {
  // The same holds with theta = 1: f1 (d1 - d0) >= V(d1) - V(d0) as V is convex.
  const std::string kind =
      GENERATE(as<std::string>(), "modal", "guyan", "irs", "craig-bampton", "krylov");
  const Worst worst = worst_of(
      3000, 60, [&](std::uint64_t seed) { return falling(seed, kAtEnd, kind); }, never_grows);
  CAPTURE(worst.steps, worst.pressed, worst.made, worst.made_in, worst.all);
  CHECK(worst.pressed > worst.steps / 20);
  CHECK(worst.all < 1e-7);  // the eigen solver's 1e-10 over a thousand steps
}

TEST_CASE("the trapezoidal rule keeps the energy of wheels on linear contacts in each step",
          "[passive]") {
  const Worst worst = worst_of(
      4000, 300,
      [](std::uint64_t seed) {
        Draw draw(seed);
        RandomScene s = random_track(seed, draw);
        s.steps = kSteps;
        s.scheme = kTrapezoid;
        s.vehicle = random_vehicle(draw, s, true);
        s.vehicle->gravity = true;  // gravity sets it in motion
        s.condense =
            draw.chance(.5) ? "residual_flexibility = true\n" : "residual_flexibility = false\n";
        if (draw.chance(.5)) s.pad_damper = s.ballast_damper = s.vehicle->damping = 0.;
        return s;
      },
      is_kept);
  CAPTURE(worst.steps, worst.pressed, worst.made, worst.made_in, worst.all);
  CHECK(worst.pressed > worst.steps / 2);
}

TEST_CASE("with generalised-alpha a rebound gains as much as the chord over its end", "[passive]") {
  // Hertz's spring gains 1.2 % at 3.0 steps per contact, and more between whole numbers of steps.
  CHECK_THAT(largest_rebound(1.5, 3.), Catch::Matchers::WithinAbs(1.012, 5e-4));
  CHECK(largest_rebound(1.5, 3.25) > 1.03);
  for (double steps = 3.; steps < 102.; steps += .25) {
    CAPTURE(steps);
    CHECK(largest_rebound(1.5, steps) < gain(steps));
    CHECK(largest_rebound(1., steps) < gain(steps));
  }
}

TEST_CASE("with generalised-alpha falls on tracks gain no more than falls on springs",
          "[passive]") {
  // The scheme keeps a norm of its own, not the energy. The bound is that of one mass on a spring
  // for every impact; the test shows, but does not prove, that a rail's own mass stays below it.
  const Worst worst = worst_of(5000, 200, dropped_mass, rebounds);
  CAPTURE(worst.steps, worst.pressed, worst.made, worst.made_in, worst.all);
  CHECK(worst.pressed > worst.steps / 100);
  if (kShare == 1) CHECK(worst.all > 0.);  // in a few scenes none may gain
}
