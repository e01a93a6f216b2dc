// The shipped scene of the paper's wheelset between flanges, and messages about flanges.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "build/build.h"
#include "offline/energy/energy_account.h"
#include "online/contact/wheel.h"
#include "online/step/step.h"
#include "support/program.h"
#include "support/scene_run.h"

using namespace railstep;
using Catch::Contains;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

const double kAngle = 70. * M_PI / 180.;
constexpr double kMass = 100., kPush = 10., kClearance = 7e-3, kWeight = 981.;

/// A run of the scene, step by step.
struct Steps {
  Simulation run;
  Model model;
  Outputs out{};
  Status seen = Status::ok;

  explicit Steps(const std::vector<std::string>& changes = {})
      : run(read_scene(kScenes + "wheelset_flange.toml", changes)), model(run.model()) {
    model.steps_per_frame = 1;
  }
  double time() const { return static_cast<double>(run.state.steps) * model.scheme.dt; }
  double at(const double* of, int k) const { return of[model.wheelset[0].first + k]; }
  double y() const { return at(run.state.u, 1); }
  double speed() const { return at(run.state.v, 1); }
  void step() {
    REQUIRE(run.state.steps < model.steps);  // what is waited for does not come
    seen = seen | advance_frame(model, run.state, run.workspace, out);
  }
  void until(double t) {
    while (time() < t - 1e-9) step();
  }
};

/// Contact of the left flange of a lone wheelset, behind its two treads.
constexpr ContactId kLeftFlange{2};

/// Lateral parts of the normals of treads and flanges in the next step, for that step's forces.
struct Push {
  double lateral[4];

  explicit Push(const Steps& s) {
    std::vector<double> u(static_cast<std::size_t>(s.model.unknowns));
    for (std::size_t i = 0; i < u.size(); ++i)
      u[i] = s.run.state.u[i] + s.model.scheme.dt * s.run.state.v[i];
    WheelContact contact[4];
    const Configuration at{u.data(), {s.run.state.u, s.run.state.v}};
    find_contacts(s.model, 0, at, contact);
    find_flanges(s.model, s.model.flange[0], at, contact + 2);
    for (int i = 0; i < 4; ++i) lateral[i] = contact[i].body_row[1];
  }
  double on(const State& state) const {
    double sum = 0.;
    for (int i = 0; i < 4; ++i) sum += lateral[i] * state.contact_force[i];
    return sum;
  }
};

}  // namespace

TEST_CASE("wheelset_flange: impact, rebound and rest agree with closed forms", "[scenes]") {
  Steps s;
  s.until(1.);
  const double y0 = s.y();
  // Until it meets the flange v^2 = 2 F s / m, but for 1e-4 since the loaded rail lies lower.
  while (s.out.contact_force[kLeftFlange] <= 0.) s.step();
  CHECK(s.out.contact_force[kLeftFlange + 1] == 0.);
  Steps before;
  const double met = s.time() - s.model.scheme.dt;
  before.until(met);
  const double way = before.y() - y0, speed = before.speed();
  CHECK_THAT(way, WithinAbs(kClearance, speed * s.model.scheme.dt + 1e-6));
  CHECK_THAT(speed, WithinRel(std::sqrt(2. * kPush * way / kMass), 1e-3));
  CHECK_THAT(met, WithinAbs(1. + std::sqrt(2. * kMass * kClearance / kPush), 1e-3));
  // After the rebound the wheelset moves against the push as far as its energy allows.
  while (s.out.contact_force[kLeftFlange] > 0. || s.speed() > 0.) s.step();
  const double back = s.speed(), from = s.y();
  while (s.speed() < 0.) s.step();
  CHECK_THAT(from - s.y(), WithinRel(kMass * back * back / (2. * kPush), 2e-3));
  const double zeta = 1.35e4 * std::sin(kAngle) / (2. * std::sqrt(1e7 * kMass));
  const double e = std::exp(-(M_PI - 2. * std::asin(zeta)) * zeta / std::sqrt(1. - zeta * zeta));
  CHECK_THAT(-back / speed, WithinRel(e, .1));
  // At rest: f sin = F, N_left + N_right + f cos = Q, and the moments about the centre, with the
  // roll of 2.5e-6 rad that the rails' compliance causes and that tilts all three normals. Means
  // over 0.2 s, since 1e-3 of the force still swings with the wheelset's roll at 108 Hz.
  s.until(2.8);
  double f = 0., left = 0., right = 0., roll = 0., depth = 0.;
  constexpr int kSteps = 4000;
  for (int i = 0; i < kSteps; ++i) {
    s.step();
    f += s.out.contact_force[kLeftFlange] / kSteps;
    left += s.out.contact_force[0] / kSteps;
    right += s.out.contact_force[1] / kSteps;
    roll += s.at(s.run.state.u, 3) / kSteps;
    depth -= s.out.contact_gap[kLeftFlange] / kSteps;
  }
  CHECK(s.seen == Status::ok);
  CHECK(std::abs(s.speed()) < 1e-6);
  // Means over 21.6 swings of 1e-3 leave 1e-3 / (2 pi 21.6) = 1e-5.
  const double sine = std::sin(kAngle), cosine = std::cos(kAngle);
  CHECK_THAT(f * std::sin(kAngle + roll) + (left + right) * std::sin(roll), WithinRel(kPush, 3e-5));
  CHECK_THAT(left + right + f * cosine, WithinRel(kWeight, 1e-6));
  CHECK_THAT(f, WithinRel(kPush / sine, 3e-4));  // without the roll: Q roll / F = 2.5e-4
  const double half = .5 * .07720505094;
  const double moment = left * (.5 - s.y()) - right * (.5 + s.y()) +
                        f * cosine * (.5 - half - s.y()) - f * sine * .162 -
                        (left + right) * (.3 + .148) * roll;
  CHECK_THAT(moment, WithinAbs(0., 1e-5 * kPush * .5));
  CHECK_THAT(depth, WithinRel(f / 1e7, 1e-4));  // from the contact law
}

TEST_CASE("wheelset_flange: momentum changes by push and normal forces in each step", "[scenes]") {
  Steps s({"step.duration_s=3.0"});
  s.until(.9);
  double given = 0., passed = 0., largest = 0., worst = 0.;
  const double start = kMass * s.speed();
  while (s.time() < 2.9 - 1e-9) {
    const Push push(s);
    s.step();
    // m g = F for the scheme's own acceleration, to rounding of the step's displacement: 1e-16 m
    // over dt^2 for 100 kg.
    const double force = (s.time() > 1. - 1e-9 ? kPush : 0.) + push.on(s.run.state);
    const double miss = kMass * s.at(s.run.state.g, 1) - force;
    worst = std::max(worst, std::abs(miss));
    largest = std::max(largest, std::abs(force));
    given += force * s.model.scheme.dt;
    passed += std::abs(force) * s.model.scheme.dt;
  }
  CHECK(worst < 1e-4);
  CHECK(largest > 500.);
  // The scheme's velocity is the sum of the accelerations but for those at both ends.
  CHECK_THAT(kMass * s.speed() - start, WithinAbs(given, 1e-6 * passed));
}

namespace {

/// Energies of a run: the part of the imbalance beyond the scheme's own loss, the error over the
/// energy turned over, and the largest force of a flange.
struct Balance {
  double rest, error, turned, flange;
  ContactLaw law;
};

Balance balance(const std::string& name, const std::vector<std::string>& changes) {
  Simulation run(read_scene(kScenes + name + ".toml", changes));
  Model single = run.model();
  single.steps_per_frame = 1;
  Outputs out{};
  EnergyAccount account(*run.packed(), single, run.state);
  Balance found{0., 0., 0., 0., single.contact[flange_contact(single, 0)].law};
  for (std::int64_t n = 0; n < single.steps; ++n) {
    static_cast<void>(advance_frame(single, run.state, run.workspace, out));
    account.follow(run.state);
    found.rest = std::max(found.rest, std::abs(account.imbalance() + account.flow().loss));
    found.flange = std::max(found.flange, out.contact_force[kLeftFlange]);
  }
  found.turned = account.turned_over();
  found.error = account.balance_error();
  return found;
}

}  // namespace

TEST_CASE("wheelset_flange: energies balance, including the flange's", "[scenes]") {
  const std::string kind = GENERATE("full", "modal");
  const std::string contact =
      GENERATE("contact=\"linear\", stiffness_n_per_m=1.0e7, damping_n_s_per_m=1.35e4",
               "contact=\"hertz\", corner_radius_m=0.013");
  const Balance found =
      balance("wheelset_flange",
              {"condense.kind=\"" + kind + "\"", "step.dt_s=2e-5", "step.duration_s=0.15",
               "wheelset[0].flange={clearance_m=1e-4, " + contact + "}",
               "wheelset[0].force[0].table=[[0.05, 0.0], [0.051, 40.0]]"});
  CAPTURE(kind, contact, found.rest, found.error, found.turned, found.flange);
  // The loss in closed form misses the contacts' geometry, which a step freezes, and on condensed
  // tracks the dissipation's trapezoids. The energy in spring or Hertz contact is far larger.
  const double f = found.flange;
  const double kept = found.law.hertz > 0. ? .4 * f * std::pow(f / found.law.hertz, 2. / 3.)
                                           : .125 * f * f / found.law.stiffness;
  const double bound = (kind == "full" ? 1e-6 : 1e-4) * found.turned;
  CHECK(found.rest < bound);
  CHECK(kept > 10. * bound);
  CHECK(found.error < 1e-2);
}

TEST_CASE("a wheelset at 30 m/s along its flange balances energy on a track with or without ends",
          "[scenes]") {
  using Choice = std::pair<const char*, const char*>;
  const auto [name, kind] =
      GENERATE(Choice{"ballasted_track", "full"}, Choice{"endless_track", "modal"});
  const std::string flange =
      "wheelset[0].flange={clearance_m=1e-4, contact=\"linear\", stiffness_n_per_m=2e7, "
      "damping_n_s_per_m=5e4}";
  const Balance found = balance(
      name, {std::string("condense.kind=\"") + kind + "\"", "track.bays=24", "step.duration_s=0.05",
             flange, "wheelset[0].force=[{direction=\"y\", table=[[0.0, 0.0], [0.01, 10e3]]}]"});
  CHECK(found.flange > 10e3);
  // The bounds are those of test_energy for the same wheelset without flanges.
  CHECK(found.rest < 1e-4 * found.turned);
  CHECK(found.error < 1e-3);
}

TEST_CASE("wheelset_flange: a push to the other side gives the mirror image", "[scenes]") {
  const std::string soon = "wheelset[0].force[0].table=[[0.1, 0.0], [0.1001, ";
  const std::vector<std::string> near = {"wheelset[0].flange.clearance_m=1e-4",
                                         "step.duration_s=0.3"};
  const auto run = [&](const char* push) {
    std::vector<std::string> changes = near;
    changes.push_back(soon + push + "]]");
    return Traced("wheelset_flange", changes);
  };
  const Traced left = run("20.0"), right = run("-20.0");
  for (const auto& [one, other] :
       {std::pair{"wheel_left", "wheel_right"}, std::pair{"wheel_right", "wheel_left"}})
    for (const char* of : {".flange_force_n", ".force_z_n", ".flange_impulse_n_s"}) {
      const std::vector<double> a = left[std::string(one) + of], b = right[std::string(other) + of];
      double miss = 0., size = 0.;
      for (std::size_t i = 0; i < a.size(); ++i) {
        miss = std::max(miss, std::abs(a[i] - b[i]));
        size = std::max(size, std::abs(a[i]));
      }
      CAPTURE(one, of, miss, size);
      // Rounding: sums over the two rails have one order, over all steps of contact.
      CHECK(miss <= 1e-8 * (size + 1.));
    }
  const std::vector<double> touched = left["wheel_left.flange_force_n"];
  CHECK(*std::max_element(touched.begin(), touched.end()) > 50.);
}

TEST_CASE("wheelset_flange: condensation and a finer step give the same rebound", "[scenes]") {
  const auto thrown = [](const std::string& change) {
    Steps s({change, "wheelset[0].flange.clearance_m=1e-3",
             "wheelset[0].force[0].table=[[0.2, 0.0], [0.2001, 10.0]]"});
    s.until(.45);
    return s.y();
  };
  const double fine = thrown("step.dt_s=1.25e-5");
  const double coarse = thrown("step.dt_s=1e-4"), half = thrown("step.dt_s=5e-5"),
               condensed = thrown("condense={kind=\"modal\", modes_per_bay=4}");
  // The rebound is 0.3 mm. The scheme is of second order, 2.2 um at 1e-4 s (less regular where the
  // damper jumps within a step). Modes up to 4 a bay miss some of the rails' compliance.
  CHECK_THAT(coarse, WithinAbs(fine, 5e-6));
  CHECK_THAT(half, WithinAbs(fine, 1.5e-6));
  CHECK_THAT(condensed, WithinAbs(fine, 1e-5));
}

TEST_CASE("a wrong flange is refused in one sentence", "[scene]") {
  const auto said = [](const std::string& flange, const std::string& more = "step.dt_s=50e-6") {
    const Ran ran = railstep_program("run " + kScenes + "wheelset_flange.toml --set '" + more +
                                     "' --set 'wheelset[0].flange=" + flange + "'");
    CHECK(ran.code == 2);
    return ran.err;
  };
  const std::string missing = "E-KEY-01", out_of_range = "E-KEY-05";
  CHECK_THAT(said("{}"), Contains("clearance_m") && Contains(missing));
  CHECK_THAT(said("{clearance_m=7.0}"),
             Contains("clearance_m = 7 ") && Contains("0.1") && Contains(out_of_range));
  CHECK_THAT(said("{clearance_m=7e-3, angle_deg=90}"), Contains("angle_deg = 90 ") &&
                                                           Contains("20") && Contains("85") &&
                                                           Contains(out_of_range));
  CHECK_THAT(said("{clearance_m=7e-3, height_m=0.014}"),
             Contains("height_m = 0.014 ") && Contains(out_of_range));
  CHECK_THAT(said("{clearance_m=7e-3, contact=\"linear\"}"),
             Contains("stiffness_n_per_m") && Contains(missing));
  CHECK_THAT(said("{clearance_m=7e-3, damping_n_s_per_m=1.0}"),
             Contains("damping_n_s_per_m") && Contains("E-FLANGE-01"));
  CHECK_THAT(said("{clearance_m=7e-3, contact=\"linear\", stiffness_n_per_m=1e7, "
                  "corner_radius_m=0.01}"),
             Contains("E-FLANGE-02"));
  CHECK_THAT(said("{clearance_m=7e-3}", "track.unknowns=\"vertical\""), Contains("E-FLANGE-03"));
  CHECK_THAT(said("{clearance_m=7e-3}",
                  "rail={constants={area_m2=7.67e-3, inertia_y_m4=3e-5, "
                  "inertia_z_m4=5e-6, torsion_m4=2e-6, shear_factor_y=0.4, "
                  "shear_factor_z=0.4, centroid_height_m=0.08, "
                  "shear_centre_height_m=0.05, height_m=0.17}}"),
             Contains("E-FLANGE-04"));
  const std::string leans = "step.start=\"equilibrium\"' --set 'wheelset[0].force[0].table=[[0.0, ";
  CHECK_THAT(said("{clearance_m=7e-3}", leans + "3000.0]]"), Contains("E-START-14"));
  CHECK_THAT(said("{clearance_m=7e-3, stifness_n_per_m=1.0}"), Contains("E-KEY-02"));
}

TEST_CASE("a push at the start leans the wheelset on its flange, where it stays", "[scenes]") {
  const std::string kind = GENERATE("full", "modal");
  const std::string push = GENERATE("10.0", "-10.0", "300.0");
  Steps s({"condense.kind=\"" + kind + "\"", "step.start=\"equilibrium\"",
           "wheelset[0].force[0].table=[[0.0, " + push + "]]"});
  std::vector<double> start(s.run.state.u, s.run.state.u + s.model.unknowns);
  const std::vector<double> forces(s.run.state.contact_force, s.run.state.contact_force + 4);
  const std::size_t side = push[0] == '-' ? 1 : 0;
  const double f = forces[2 + side];
  CHECK(forces[3 - side] == 0.);
  CHECK(f > 0.);
  const Push normals(s);
  CHECK_THAT(normals.on(s.run.state), WithinAbs(-std::atof(push.c_str()), 1e-9));
  double moved = 0., changed = 0.;
  while (s.time() < .1) {
    s.step();
    for (int k = 1; k < 4; ++k) {
      const std::int32_t i = s.model.wheelset[0].first + k;
      moved = std::max(moved, std::abs(s.run.state.u[i] - start[static_cast<std::size_t>(i)]));
    }
    for (std::size_t i = 0; i < 4; ++i)
      changed = std::max(changed, std::abs(s.run.state.contact_force[i] - forces[i]));
  }
  CAPTURE(kind, push, moved, changed, f);
  CHECK(s.seen == Status::ok);
  // The start uses the step's own contacts, so only rounding remains.
  CHECK(moved < 1e-9 * f / 1e7);
  CHECK(changed < 1e-9 * f);
}
