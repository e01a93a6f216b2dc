// [[vehicle]], swinging loads and tables of speed in a scene, and messages for wrong ones.
#include <catch2/catch.hpp>
#include <fstream>
#include <string>
#include <vector>

#include "build/build.h"
#include "run/simulation.h"
#include "scene/scene.h"
#include "support/program.h"

using namespace railstep;
using Catch::Matchers::Contains;

namespace {

const std::string kScene = std::string(RAILSTEP_SOURCE) + "/config/scenes/bogie_at_speed.toml";
const std::string kSpeed = "speed_m_per_s=10.0, start_m=20.0";

/// The scene with one vehicle in place of its own.
Scene vehicle_with(const std::string& vehicle) {
  return read_scene(kScene, {"vehicle=[{" + vehicle + "}]"});
}

std::string sentence(const std::string& vehicle) {
  try {
    vehicle_with(vehicle);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace

TEST_CASE("every type of vehicle is read with its defaults", "[scene][vehicle]") {
  const VehicleScene mass =
      vehicle_with("name=\"m\", type=\"mass\", mass_kg=100.0, " + kSpeed).vehicles.at(0);
  CHECK(mass.contact == WheelContactKind::bonded);
  CHECK(mass.vehicle.bodies.at(0).mass == 100.);
  CHECK(
      (mass.gravity == kGravity && !mass.may_leave_rail && mass.start == 20. && mass.speed == 10.));
  const VehicleScene on_spring =
      vehicle_with("name=\"m\", type=\"sprung_mass\", mass_kg=100.0, stiffness_n_per_m=1e6, " +
                   kSpeed)
          .vehicles.at(0);
  CHECK(on_spring.contact == WheelContactKind::linear);
  CHECK((on_spring.stiffness == 1e6 && on_spring.damping == 0.));
  const VehicleScene sprung =
      vehicle_with(
          "name=\"m\", type=\"sprung_mass\", mass_kg=100.0, unsprung_mass_kg=10.0, "
          "stiffness_n_per_m=1e6, damping_n_s_per_m=1e3, " +
          kSpeed)
          .vehicles.at(0);
  CHECK(sprung.contact == WheelContactKind::hertz);
  CHECK(sprung.bodies == std::vector<std::string>{"body", "wheel_1"});
  const std::string frame =
      "frame_mass_kg=1e3, frame_inertia_kg_m2=700.0, wheel_mass_kg=600.0, wheelbase_m=3.0, "
      "primary_stiffness_n_per_m=1e6, ";
  const VehicleScene three =
      vehicle_with("name=\"b\", type=\"bogie\", axles=3, " + frame + kSpeed).vehicles.at(0);
  REQUIRE(three.vehicle.wheels.size() == 3);
  CHECK(three.vehicle.wheels[0].place == 1.5);
  CHECK(three.vehicle.wheels[1].place == 0.);
  const VehicleScene whole =
      vehicle_with(
          "name=\"c\", type=\"vehicle\", body_mass_kg=1e4, body_inertia_kg_m2=1e6, "
          "bogie_distance_m=10.0, secondary_stiffness_n_per_m=4e5, " +
          frame + kSpeed)
          .vehicles.at(0);
  CHECK(whole.bodies == std::vector<std::string>{"body", "frame_1", "frame_2", "wheel_1", "wheel_2",
                                                 "wheel_3", "wheel_4"});
  CHECK(whole.vehicle.wheels[3].place == -6.5);
}

TEST_CASE("bogies that overlap are refused", "[scene][vehicle]") {
  const std::string car =
      "name=\"c\", type=\"vehicle\", body_mass_kg=1e4, body_inertia_kg_m2=1e6, "
      "secondary_stiffness_n_per_m=4e5, frame_mass_kg=1e3, frame_inertia_kg_m2=700.0, "
      "wheel_mass_kg=600.0, wheelbase_m=3.0, primary_stiffness_n_per_m=1e6, " +
      kSpeed;
  CHECK(sentence(car + ", bogie_distance_m=3.1") == "accepted");
  CHECK_THAT(sentence(car + ", bogie_distance_m=3.0"), Contains("bogie_distance_m = 3 ") &&
                                                           Contains("above 3, at most 1000") &&
                                                           Contains("E-KEY-05"));
}

TEST_CASE("shipped vehicles are read and stand with their weight on their wheels",
          "[scene][vehicle]") {
  for (const auto& [file, wheels, bodies] : {std::tuple{"manchester_passenger", 4u, 7u},
                                             {"manchester_bogie", 2u, 3u},
                                             {"freight_bogie", 2u, 3u},
                                             {"locomotive_bogie", 3u, 4u}}) {
    const Scene scene =
        vehicle_with(std::string("name=\"v\", file=\"../vehicles/") + file + ".toml\", " + kSpeed);
    CHECK(scene.vehicles.at(0).vehicle.wheels.size() == wheels);
    CHECK(scene.vehicles.at(0).bodies.size() == bodies);
    const Simulation run(scene);
    double sum = 0., weight = 0.;
    for (std::size_t i = 0; i < wheels; ++i) sum += run.state.contact_force[i];
    for (const Vehicle::Body& body : scene.vehicles[0].vehicle.bodies)
      weight += (body.mass + body.carried) * kGravity;
    CHECK(sum == Approx(weight).epsilon(1e-10));
  }
}

TEST_CASE("the trace has the wheels and bodies of a vehicle", "[scene][vehicle]") {
  const Scene scene = read_scene(kScene, {"track.rails=2", "vehicle[0].rail=\"both\"", "sensor=[]",
                                          "sleeper.roll_inertia_kg_m2=169.0"});
  REQUIRE(scene.vehicles.size() == 2);
  CHECK(scene.vehicles[1].rail == kRightRail);
  const Simulation run(scene);
  const std::vector<std::string>& names = run.columns();
  REQUIRE(names.size() == 1 + 4 * 6 + 2 * 4);
  CHECK(names[1] == "bogie_left.wheel_1.force_z_n");
  CHECK(names[7] == "bogie_left.wheel_2.force_z_n");
  CHECK(names[13] == "bogie_right.wheel_1.force_z_n");
  CHECK(names[25] == "bogie_left.frame.z_m");
  CHECK(names[26] == "bogie_left.frame.pitch_rad");
  CHECK(names[28] == "bogie_left.wheel_2.z_m");
  CHECK(names[29] == "bogie_right.frame.z_m");
}

TEST_CASE("invalid vehicles are refused with their file and key", "[scene][vehicle]") {
  const std::string named = "name=\"m\", ", mass = "type=\"mass\", mass_kg=100.0, ";
  const struct {
    std::string vehicle, told;
  } cases[] = {
      {named + mass + "start_m=20.0", "key 'speed_m_per_s'"},
      {named + mass + kSpeed + ", speed_table=[[0, 1]]", "E-RUNNER-22"},
      {named + mass + "start_m=20.0, speed_table=[[0, 1], [1, -1]]", "E-RUNNER-23"},
      {named + mass + "start_m=20.0, speed_table=[[0, 1], [0, 2]]", "E-RUNNER-02"},
      {named + mass + "start_m=20.0, speed_table=[[0, 100.0], [1, 300.0]]", "E-RUNNER-06"},
      {named + mass + "start_m=70.0, speed_m_per_s=0.0", "E-VEHICLE-11"},
      {named + "type=\"mass\", mass_kg=0.0, " + kSpeed, "mass_kg = 0"},
      {named + "type=\"tram\", " + kSpeed, "\"sprung_mass\""},
      {named + mass + kSpeed + ", contact=\"glue\"", "\"bonded\""},
      {named + mass + kSpeed + ", contact=\"linear\"", "key 'contact_stiffness_n_per_m'"},
      {named + mass + kSpeed + ", contact_damping_n_s_per_m=1.0", "E-VEHICLE-05"},
      {named + "type=\"sprung_mass\", mass_kg=1.0, stiffness_n_per_m=1e6, contact=\"hertz\", " +
           kSpeed,
       "E-VEHICLE-04"},
      {named + mass + kSpeed + ", rail=\"right\"", "E-SCENE-01"},
      {named + mass + kSpeed + ", rail=\"both\"", "E-VEHICLE-14"},
      {named + mass + kSpeed + ", file=\"../vehicles/freight_bogie.toml\"", "E-VEHICLE-03"},
      {named + "file=\"../vehicles/none.toml\", " + kSpeed, "none.toml"},
      {named + mass + kSpeed + ", radius=1.0", "'radius'"},
      {"name=\"rail\", " + mass + kSpeed, "E-RUNNER-19"},
      {named + mass + kSpeed + ", tread=[{wheel=2, kind=\"fresh_flat\", length_m=0.05}]",
       "wheel = 2"},
  };
  for (const auto& [vehicle, told] : cases) {
    CAPTURE(vehicle);
    CHECK_THAT(sentence(vehicle), Contains(told) && Contains("vehicle"));
  }
}

TEST_CASE("a vehicle's own file may have only known keys", "[scene][vehicle]") {
  const auto folder = fresh_folder("vehicle");
  std::ofstream(folder / "v.toml")
      << "schema = 1\n[vehicle]\ntype = \"mass\"\nmass_kg = 1.0\nmas_kg = 2.0\n";
  const std::string told =
      sentence("name=\"m\", file=\"" + (folder / "v.toml").string() + "\", " + kSpeed);
  CHECK_THAT(told, Contains("v.toml:5") && Contains("'mas_kg'") && Contains("E-KEY-02"));
}

TEST_CASE("a swinging load and a table of speeds are read", "[scene]") {
  const std::string file = std::string(RAILSTEP_SOURCE) + "/config/scenes/moving_load.toml";
  const Scene scene = read_scene(
      file, {"load[0].amplitude_n=1e3", "load[0].frequency_hz=20.0", "load[0].phase_deg=90.0"});
  CHECK((scene.loads[0].amplitude == 1e3 && scene.loads[0].frequency == 20.));
  CHECK(scene.loads[0].phase == .25);
  const auto told = [&](const std::vector<std::string>& changes) {
    try {
      read_scene(file, changes);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  CHECK_THAT(told({"load[0].frequency_hz=20.0"}), Contains("E-RUNNER-08"));
  CHECK_THAT(told({"load[0].amplitude_n=1e3", "load[0].frequency_hz=8000.0"}),
             Contains("E-RUNNER-09"));
  CHECK_THAT(told({"load[0].speed_table=[[0, 1]]"}), Contains("E-RUNNER-22"));
}

TEST_CASE("a vehicle that falls starts freely above the track", "[scene][vehicle]") {
  const std::string mass =
      "vehicle=[{name=\"m\", type=\"mass\", mass_kg=600.0, drop_height_m=0.01, "
      "drop_speed_m_per_s=0.2, start_m=20.0, speed_m_per_s=0.0, contact=";
  const Scene scene = read_scene(kScene, {mass + "\"hertz\"}]", "step.start=\"released\""});
  REQUIRE(scene.vehicles.at(0).falling);
  const Simulation run(scene);
  const std::int32_t z = run.model().vehicle[0].first;
  CHECK(run.state.u[z] == .01);
  CHECK(run.state.v[z] == -.2);
  CHECK(run.state.a[z] == -9.81);
  const auto told = [&](const std::string& contact, const std::string& start) -> std::string {
    try {
      read_scene(kScene, {mass + contact + "}]", "step.start=" + start});
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  CHECK_THAT(told("\"bonded\"", "\"released\""), Contains("E-VEHICLE-09"));
  CHECK_THAT(told("\"hertz\"", "\"equilibrium\""), Contains("E-VEHICLE-10"));
}
