// Vehicles whose wheels and rails touch by their profiles: hunting, limit cycles, energy, forms of
// track.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "answer/scene_running.h"
#include "offline/energy/energy_account.h"
#include "offline/runner/stability.h"
#include "online/model/snapshot.h"
#include "support/block_fields.h"
#include "support/scene_run.h"

using namespace railstep;

namespace {

using Words = std::vector<std::string>;

std::string key_of(const std::string& key, double value) {
  return key + "=" + std::to_string(value);
}

Words joined(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

Scene profiled_wheelset(const Words& changes = {}) {
  return read_scene(shipped("s1002_wheelset"), changes);
}
Scene ring(const Words& changes = {}) { return read_scene(shipped("manchester_s1002"), changes); }

/// The profiles of the wheelset under the passenger vehicle, on rigid rails that are rough.
Words vehicle(double speed) {
  return {"vehicle=[{name=\"car\",file=\"../vehicles/manchester_1.toml\",speed_m_per_s=" +
              std::to_string(speed) + "}]",
          "contact.kalker=[9.25e6,8.52e6,1.95e4,53.8]", "step.duration_s=1.0",
          "irregularity={spectrum=\"german_low\",geometries=[\"vertical\",\"alignment\","
          "\"cross_level\"]}"};
}

/// Growth of a small lateral motion after a short push, 1/s, by its highest points from 4 s on.
double growth_at(const std::string& form, double speed, double dt) {
  const std::string push = "vehicle[0].force[1].table=[[0.0,0.0],[0.05,5.0],[0.15,5.0],[0.2,0.0]]";
  const Traced run(
      profiled_wheelset({key_of("vehicle[0].speed_m_per_s", speed), key_of("step.dt_s", dt),
                         "step.duration_s=12.0", "condense.kind=\"" + form + "\"", push}));
  const std::vector<double> y = run["wheelset.axle.y_m"];
  double sums[5] = {};
  for (std::size_t i = static_cast<std::size_t>(4. / dt); i + 1 < y.size(); ++i) {
    if (!(y[i] > y[i - 1]) || !(y[i] >= y[i + 1])) continue;
    const double t = static_cast<double>(i) * dt, top = std::log(y[i]);
    const double terms[5] = {1., t, top, t * t, t * top};
    for (int k = 0; k < 5; ++k) sums[k] += terms[k];
  }
  const auto [n, t, top, tt, t_top] = sums;
  return (n * t_top - t * top) / (n * tt - t * t);
}

/// Mean of the largest values between one zero and the next.
double mean_peak(const std::vector<double>& y) {
  double sum = 0., own = 0.;
  int zeros = 0;
  for (std::size_t i = 1; i < y.size(); ++i) {
    own = std::max(own, std::fabs(y[i]));
    if (y[i] * y[i - 1] > 0.) continue;
    if (zeros++ > 0) sum += own;
    own = 0.;
  }
  return sum / (zeros - 1);
}

}  // namespace

TEST_CASE("a wheelset with profiles hunts from its linear critical speed on", "[profile_scene]") {
  // Contacts are found once a step, where they will be at the instant of the scheme's forces: its
  // end, or what `rho_inf` has of it where forces are held. Found at its start, runs hunt some per
  // cent too early at 1 ms; found at its end where they are held, too late.
  const auto linear = critical_speed_between(profiled_wheelset(), 45., 55.);
  REQUIRE(linear);
  for (const char* form : {"full", "modal"}) {
    for (const double dt : {1e-3, 5e-4}) {
      const double low = growth_at(form, .995 * linear->speed, dt),
                   high = growth_at(form, 1.005 * linear->speed, dt);
      const double found = linear->speed * (.995 + .01 * low / (low - high));
      INFO(form << ", step of " << dt << " s: " << found << " m/s");
      CHECK(low < 0.);
      CHECK(high > 0.);
      CHECK(found == Approx(linear->speed).epsilon(3e-4));
    }
  }
}

TEST_CASE("the limit cycle of a wheelset is that of an integration of its tables",
          "[profile_scene]") {
  // Tables of radius differences and contact angles of these patches under 60 kN on each wheel,
  // with y and yaw alone integrated by Runge and Kutta's rule (0.1 ms): a mean peak of 6.252 mm at
  // 50 m/s, 6.244 mm at 52 m/s, alive at 47 m/s, dead at 46.5 m/s. At 60 m/s the cycle of the
  // tables is uneven, 6.581 mm to one side; wheels that leave their rails make that of the run
  // irregular.
  const auto later = [](const Scene& scene, double from) {
    const Traced run(scene);
    std::vector<double> y = run["wheelset.axle.y_m"];
    y.erase(y.begin(),
            y.begin() + static_cast<std::ptrdiff_t>(from * static_cast<double>(y.size())));
    return y;
  };
  const auto amplitude = [&](const Scene& scene, double from) {
    return largest_of(later(scene, from));
  };
  const auto pushed = [](double speed) {
    return profiled_wheelset(
        {key_of("vehicle[0].speed_m_per_s", speed), "step.dt_s=2.5e-4", "step.duration_s=10.0",
         "vehicle[0].force[1].table=[[0.0,0.0],[0.05,4e4],[0.15,4e4],[0.2,0.0]]"});
  };
  CHECK(mean_peak(later(pushed(50.), .4)) == Approx(6.252e-3).epsilon(.005));
  CHECK(mean_peak(later(pushed(52.), .4)) == Approx(6.244e-3).epsilon(.005));
  CHECK(amplitude(pushed(60.), .5) == Approx(6.581e-3).epsilon(.02));
  // From a cycle at 50 m/s the speed falls by 0.1 m/s each second.
  const auto slowed = [](double to) {
    return profiled_wheelset(
        {"step.dt_s=5e-4", "step.frame_s=5e-3", "step.duration_s=60.0",
         "vehicle=[{name=\"wheelset\",file=\"../vehicles/sprung_wheelset.toml\","
         "speed_table=[[0.0,55.0],[5.0,50.0],[" +
             std::to_string(5. + 10. * (50. - to)) + "," + std::to_string(to) + "],[1e3," +
             std::to_string(to) +
             "]],force=[{body=\"axle\",direction=\"z\",table=[[0.0,-107741.7]]},"
             "{body=\"axle\",direction=\"y\",table=[[0.0,0.0],[0.05,4e4],[0.15,4e4],"
             "[0.2,0.0]]}]}]"});
  };
  CHECK(amplitude(slowed(47.5), .9) > 5e-3);
  CHECK(amplitude(slowed(46.2), .9) < 1e-4);
}

TEST_CASE("the energy of vehicles on profiles is balanced", "[profile_scene]") {
  const auto balance = [](const Scene& scene) {
    const Simulation run(scene);
    return balance_of(*run.packed(), run.model(), run.model().steps);
  };
  for (const double dt : {1e-3, 5e-4}) {
    const EnergyBalance rough =
        balance(profiled_wheelset(joined(vehicle(40.), {key_of("step.dt_s", dt)})));
    INFO("step of " << dt << " s: error " << rough.error << ", loss " << rough.numerical_loss);
    CHECK(rough.error < .3 * dt);
    CHECK(std::fabs(rough.numerical_loss) < 1e-4);
  }
  const EnergyBalance full = balance(ring({"condense={kind=\"full\"}", "step.duration_s=0.3"}));
  INFO("ring: error " << full.error << ", loss " << full.numerical_loss);
  CHECK(full.error < 2e-4);
  CHECK(std::fabs(full.numerical_loss) < 1e-4);
}

TEST_CASE("wheels that creep over a corrugated rail make no energy", "[profile_scene]") {
  for (const Words& kind : {Words{"condense.kind=\"modal\""}, {"condense={kind=\"full\"}"}}) {
    const Simulation run(
        ring(joined(kind, {"step.dt_s=5e-5", "step.duration_s=0.15",
                           "defect=[{kind=\"corrugation\",from_m=0.0,to_m=30.0,wavelength_m=0.06,"
                           "amplitude_m=2e-5}]"})));
    const EnergyBalance balance = balance_of(*run.packed(), run.model(), run.model().steps);
    INFO(kind[0] << ": error " << balance.error << ", loss " << balance.numerical_loss);
    // The account of a condensed track leaves out the rates of its residual flexibility.
    CHECK(balance.error < (kind.front().find("modal") == std::string::npos ? 1e-4 : 5e-4));
    CHECK(balance.numerical_loss > -5e-5);
  }
}

TEST_CASE("on a track that is stiff enough profiles run as on rigid rails", "[profile_scene]") {
  const std::string rails =
      "irregularity={spectrum=\"german_low\",geometries=[\"vertical\",\"alignment\","
      "\"cross_level\"],period_m=1000.0}";
  const std::string creep = "contact.kalker=[9.25e6,8.52e6,1.95e4,53.8]";
  const std::string car =
      "vehicle=[{name=\"car\",file=\"../vehicles/manchester_1.toml\",speed_m_per_s=40.0,"
      "start_m=11.4}]";
  const Traced rigid(profiled_wheelset(
      {car, rails, creep, "condense.kind=\"modal\"", "step.duration_s=1.0", "step.dt_s=1e-3"}));
  const Traced stiff(ring(
      {rails, creep, "step.dt_s=1e-3", "step.duration_s=1.0", "support.stiffness_x_n_per_m=5.0e11",
       "support.stiffness_y_n_per_m=5.0e11", "support.stiffness_z_n_per_m=2.0e12",
       "support.stiffness_roll_n_m_per_rad=3.0e9", "ballast.stiffness_z_n_per_m=5.0e11"}));
  // The rails bend between their seats.
  CHECK(relative_difference(stiff["car.car.z_m"], rigid["car.car.z_m"]) < .05);
  CHECK(relative_difference(stiff["car.leading_1.y_m"], rigid["car.leading_1.y_m"]) < .04);
}

TEST_CASE("a ring carries profiles as a long track does, with half the step and more modes",
          "[profile_scene]") {
  const auto run = [](const Words& more) {
    return Traced(ring(
        joined({"track.elements_per_bay=2", "step.dt_s=2.5e-4", "step.duration_s=0.4"}, more)));
  };
  const Traced modal = run({"condense.modes_per_bay=8"}),
               window = run({"track.bays=70", "condense={kind=\"full\"}"}),
               coarse = run({"condense.modes_per_bay=8", "step.dt_s=5e-4"});
  CHECK(relative_difference(modal["car.car.z_m"], window["car.car.z_m"]) < .002);
  CHECK(relative_difference(modal["car.leading_1.y_m"], window["car.leading_1.y_m"]) < .02);
  CHECK(relative_difference(modal["car.leading_1_left.q_n"], window["car.leading_1_left.q_n"]) <
        .03);
  CHECK(relative_difference(coarse["car.leading_1.y_m"], modal["car.leading_1.y_m"]) < .02);
}

TEST_CASE("vehicles start on rough rails wherever their wheels touch", "[profile_scene]") {
  // On 136RE rails a wheel starts between one patch and two; on the flange's root it rolls on
  // another radius than that of its tread.
  for (const auto& [rail, seed] : {std::pair{"136re", 1}, std::pair{"54e1", 2}}) {
    Words words = joined(vehicle(40.), {"step.duration_s=0.01", "step.dt_s=1e-3"});
    words.push_back("contact.rail_profile=\"../profiles/" + std::string(rail) + ".toml\"");
    words.push_back("irregularity.spectrum=\"german_high\"");
    words.push_back("irregularity.seed=" + std::to_string(seed));
    const Traced run(profiled_wheelset(words));
    CHECK_FALSE(has(run.status, Status::cap_reached));
    // The start is in equilibrium.
    CHECK(run["car.leading_1_left.q_n"].front() ==
          Approx(run["car.leading_1_left.q_n"][1]).epsilon(.05));
  }
}

TEST_CASE("a vehicle with profiles stays as its start has it", "[profile_scene]") {
  for (const Words& kind : {Words{"condense.kind=\"modal\""}, {"condense={kind=\"full\"}"}}) {
    Words words = joined(kind, {"irregularity.geometries=[\"vertical\"]",
                                "irregularity.shortest_wavelength_m=20.0", "step.duration_s=0.1"});
    const Scene scene = ring(words);
    const RunningLoads loads = running_loads(scene);
    const Traced run(scene);
    CHECK(run.status == Status::ok);
    for (const WheelLoad& wheel : loads.wheels) {
      INFO(wheel.name);
      CHECK(run[wheel.name + ".q_n"].front() == Approx(wheel.q).epsilon(1e-6));
      CHECK(run[wheel.name + ".q_n"].back() == Approx(wheel.q).epsilon(.02));
    }
  }
}

TEST_CASE("a model with profiles and its snapshots give the same bits", "[profile_scene]") {
  for (const bool seated : {false, true}) {
    const Simulation run(seated ? ring({"step.duration_s=0.1"})
                                : profiled_wheelset(joined(vehicle(40.), {"step.duration_s=0.1"})));
    Model loaded;
    REQUIRE(read(run.block(), loaded).status == LoadStatus::ok);
    LoadedRun packed(run.packed()->model()), whole(loaded), again(loaded);
    static_cast<void>(packed.frames(80));
    static_cast<void>(whole.frames(40));
    std::vector<unsigned char> kept(snapshot_bytes(loaded));
    save_snapshot(loaded, whole.state, kept.data());
    static_cast<void>(whole.frames(40));
    REQUIRE(restore_snapshot(loaded, kept.data(), kept.size(), again.state) == SnapshotStatus::ok);
    static_cast<void>(again.frames(40));
    CHECK(state_hash(loaded, whole.state) == state_hash(run.model(), packed.state));
    CHECK(state_hash(loaded, again.state) == state_hash(loaded, whole.state));
  }
}

TEST_CASE("steps with more patches than motions are as exact as others", "[profile_scene]") {
  // On twisted track a wheel has three patches for some steps. The scalars of the solve are then
  // the motions of its wheelset.
  const Scene scene =
      read_scene(shipped("../hard/h68_twist"),
                 {"line.cant_table=[[30.0, 0.0], [75.0, 0.15], [105.0, 0.15], [150.0, 0.0]]",
                  "line.transition=\"linear\"", "vehicle[0].start_m=90.0", "step.duration_s=10.0"});
  Simulation run(scene);
  const RunRecord record =
      simulate(run, run.model().steps / run.model().steps_per_frame, {}, false);
  CHECK(status_names(record.status).empty());
}

TEST_CASE("a wheelset that is pushed off its rails says so and steps on", "[profile_scene]") {
  const Traced run(profiled_wheelset({"vehicle[0].force[1].table=[[0.0,0.0],[0.1,3e5]]",
                                      "step.duration_s=0.5", "step.dt_s=1e-3"}));
  CHECK(has(run.status, Status::beyond_profile));
  CHECK(has(run.status, Status::contact_lost));
  CHECK_FALSE(has(run.status, Status::cap_reached));
  CHECK_FALSE(has(run.status, Status::nonfinite_state));
  CHECK(run["wheelset.axle_left.q_n"].back() == 0.);
  CHECK(run["wheelset.axle_right.q_n"].back() == 0.);
}
