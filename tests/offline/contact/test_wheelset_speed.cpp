// Wheelsets with a table of speeds: their positions, their forces, and the work of the drive.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "offline/energy/energy_account.h"
#include "online/track/travel.h"
#include "run/simulate.h"
#include "support/vehicles.h"

using namespace railstep;
using Catch::Matchers::Contains;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

/// 8 m/s, then 100 m/s2 up to 18 m/s, then down to 3 m/s.
const std::vector<double> kSpeeds = {0., 8., .05, 8., .15, 18., .3, 3.};
constexpr double kWay[] = {.4, .4 + 1.3, .4 + 1.3 + 1.575};  // distance at .05, .15 and .3 s, m

Track two_rails() {
  Track t = one_rail(20);
  t.rails = 2;
  return t;
}

Wheelset quick(Guide guide = Guide::augmented_lagrangian) {
  Wheelset w;
  w.mass = 1200.;
  w.inertia_roll = w.inertia_yaw = 700.;
  w.inertia_spin = 100.;
  w.weight = 9e4;
  w.start = 4.13;
  w.speeds = kSpeeds;
  w.guide = guide;
  w.alpha = w.beta = 200.;
  return w;
}

ModelRun run_of(bool modal, double dt, double rho, const Wheelset& w) {
  const Track track = two_rails();
  return from_rest(track, {.wheelsets = {w}, .head = {.0}}, options_of(modal, track, dt, rho));
}

}  // namespace

TEST_CASE("a wheelset is where its table of speeds puts it", "[wheelset]") {
  for (const bool modal : {false, true}) {
    ModelRun run = run_of(modal, 1e-4, .6, quick());
    CHECK(run.state.v[run.model().wheelset[0].first] == 8.);
    int at = 0;
    for (const double time : {.05, .15, .3}) {
      run.until(time);
      CAPTURE(modal, time);
      CHECK_THAT(run.body()[0], WithinAbs(kWay[at++], 1e-10));  // the guide's tolerance
    }
    CHECK_THAT(run.state.v[run.model().wheelset[0].first], WithinAbs(3., 1e-12));
    CHECK(run.outputs.constraint_violation < 1e-10);
    CHECK(run.seen == Status::ok);
  }
}

TEST_CASE("Baumgarte's guide follows a table of speeds except at its corners", "[wheelset]") {
  // A step has the acceleration of its end. At a corner the speed errs by half a step of the jump,
  // 200 m/s2 at most, from which e'' + 2 beta e' + beta^2 e = 0 makes jump dt/(2 e beta) m.
  for (const double dt : {4e-4, 2e-4, 1e-4}) {
    ModelRun run = run_of(false, dt, .6, quick(Guide::baumgarte));
    double most = 0., last = 0.;
    while (run.time() < .29 - .5 * dt) {
      run.step();
      const Travelled want = travelled(run.model().wheelset[0].travel, run.time());
      last = std::abs(run.body()[0] - want.distance);
      most = std::max(most, last);
    }
    CAPTURE(dt, most, last);
    CHECK(most < 200. * dt / (2. * std::exp(1.) * 200.));
    CHECK(most > 0.);
    CHECK(last < 1e-9);  // 28 time constants after a corner
  }
}

TEST_CASE("a wheelset with a table has the forces of two half masses with that table",
          "[wheelset][vehicle]") {
  // The rails are uncoupled. A vehicle's contact is vertical at the place given by time. A
  // wheelset's is the nearest point, which is off by the radius times the rail's slope: .46 mm at a
  // slope of 1e-3, which over bays of .6 m is 2 pi .46e-3/.6 of the swing.
  for (const bool modal : {false, true}) {
    const Track track = two_rails();
    Vehicle half;
    half.bodies = {{.mass = 600., .carried = 45e3 / 9.81 - 600.}};
    half.wheels = {{0, 0., .46}};
    RunningVehicle v;
    v.vehicle = half;
    v.start = 4.13;
    v.speeds = kSpeeds;
    const PackOptions options = options_of(modal, track, 1e-4, 1.);
    ModelRun set = run_of(modal, 1e-4, 1., quick());
    ModelRun mass = from_rest(track, {.vehicles = {v}, .head = {.0}}, options);
    CHECK_THAT(mass.state.contact_force[0], WithinRel(45e3, 1e-9));
    double error = 0., swing = 0.;
    while (set.time() < .3) {
      set.step();
      mass.step();
      for (int side = 0; side < 2; ++side)
        error = std::max(error,
                         std::abs(set.outputs.contact_force[side] - mass.outputs.contact_force[0]));
      swing = std::max(swing, std::abs(mass.outputs.contact_force[0] - 45e3));
      CHECK_THAT(set.outputs.contact_x[0], WithinAbs(mass.outputs.contact_x[0], 1e-3));
    }
    CAPTURE(modal, error, swing);
    CHECK(error < 5e-3 * swing);
  }
}

namespace {

/// Energy account of a run up to .15 s.
EnergyAccount account_of(ModelRun& run) {
  EnergyAccount energy(*run.packed, run.model(), run.state);
  while (run.time() < .15 - .5 * run.model().scheme.dt) {
    run.step();
    energy.follow(run.state);
  }
  return energy;
}

}  // namespace

TEST_CASE("energies of an accelerating wheelset balance as at a constant speed",
          "[wheelset][energy]") {
  for (const bool modal : {false, true})
    for (const Guide guide : {Guide::augmented_lagrangian, Guide::baumgarte, Guide::elimination}) {
      std::vector<double> error;
      for (const double dt : {2e-4, 1e-4, 5e-5}) {
        Wheelset even = quick(guide);
        even.speeds.clear();
        even.speed = 13.;
        ModelRun constant = run_of(modal, dt, 1., even), run = run_of(modal, dt, 1., quick(guide));
        const double constant_error = account_of(constant).balance_error();
        const EnergyAccount energy = account_of(run);
        error.push_back(energy.balance_error());
        CAPTURE(modal, static_cast<int>(guide), dt, constant_error, error);
        CHECK(error.back() < 1.5 * constant_error);
        // From 8 to 18 m/s; Baumgarte's guide errs by the corner that it has just met. The rails
        // take some J besides.
        CHECK_THAT(energy.flow().guides,
                   WithinRel(.5 * 1200. * (18. * 18. - 8. * 8.), 200. * dt / 10.));
      }
      // Banded runs err by the contacts' frozen geometry, 1.5e-5, at any speed.
      for (std::size_t i = 0; modal && i < 2; ++i)
        CHECK_THAT(std::log2(error[i] / error[i + 1]), WithinAbs(2., .5));
    }
}

TEST_CASE("a wheelset's table of speeds is read and checked", "[scene][wheelset]") {
  const std::string file = std::string(RAILSTEP_SOURCE) + "/config/scenes/ballasted_track.toml";
  const auto with = [&](const std::string& table) {
    return read_scene(file, {"wheelset=[{name=\"w\", mass_kg=1200.0, inertia_roll_kg_m2=700.0, "
                             "inertia_spin_kg_m2=100.0, inertia_yaw_kg_m2=700.0, radius_m=0.46, "
                             "start_m=3.0, carried_mass_kg=8800.0, " +
                                 table + "}]",
                             "sensor=[]"});
  };
  const auto told = [&](const std::string& table) {
    try {
      with(table);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  const Scene scene = with("speed_table=[[0, 8.0], [0.1, 18.0]]");
  REQUIRE_FALSE(scene.wheelsets[0].speeds.empty());
  CHECK(scene.wheelsets[0].speed == 8.);
  CHECK(fastest(scene.wheelsets[0]) == 18.);
  CHECK_THAT(told("speed_m_per_s=8.0, speed_table=[[0, 8.0]]"), Contains("E-RUNNER-22"));
  CHECK_THAT(told("speed_table=[[0, 8.0], [0.1, -18.0]]"), Contains("E-RUNNER-23"));
  CHECK_THAT(told("speed_table=[[0, 8.0], [0.01, 1000.0]]"), Contains("E-RUNNER-06"));
  CHECK_THAT(told("speed_m_per_s=8.0, mas_kg=1.0"), Contains("'mas_kg'"));
}

TEST_CASE("a table of speeds on a track without end is refused in a sentence", "[wheelset]") {
  try {
    const Simulation run(read_scene(
        std::string(RAILSTEP_SOURCE) + "/config/scenes/endless_track.toml",
        {"wheelset=[{name=\"w\", mass_kg=1200.0, inertia_roll_kg_m2=700.0, "
         "inertia_spin_kg_m2=100.0, inertia_yaw_kg_m2=700.0, radius_m=0.46, start_m=0.0, "
         "speed_table=[[0, 8.0], [0.1, 18.0]]}]",
         "sensor=[]", "defect=[]"}));
    FAIL("accepted");
  } catch (const InputError& error) {
    CHECK_THAT(error.what(), Contains("E-PACK-30"));
  }
}
