// Bodies that are joined to rails beside wheels: both move the same rails in a step.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "online/contact/vehicle_contact.h"
#include "online/step/step.h"
#include "run/simulation.h"
#include "support/shipped.h"
#include "support/traced.h"

using namespace railstep;

namespace {

const std::string kVehicles = std::string(RAILSTEP_SOURCE) + "/config/vehicles/";

std::string track_of(double cant, const std::string& condense, const std::string& start) {
  return "schema = 1\n[track]\nunknowns = \"rigid-section\"\nrails = 2\nbays = 60\nbay_m = 0.6\n"
         "elements_per_bay = 2\nrail_spacing_m = 1.5\n"
         "[rail]\nprofile = \"" +
         std::string(RAILSTEP_SOURCE) +
         "/config/profiles/60e1.toml\"\ncrown_radius_m = 0.3\ncant = " + std::to_string(cant) +
         "\n[support]\nat = \"axis\"\nstiffness_x_n_per_m = 5e7\nstiffness_y_n_per_m = 5e7\n"
         "damping_y_n_s_per_m = 2e4\nstiffness_z_n_per_m = 5e7\ndamping_z_n_s_per_m = 8e4\n"
         "stiffness_roll_n_m_per_rad = 3e5\n"
         "[step]\ndt_s = 0.5e-3\nduration_s = 0.08\nstart = \"" +
         start + "\"\n[condense]\nresidual_flexibility = false\n" + condense;
}

const std::string
    kWheels =
        "[[wheelset]]\nname = \"w\"\nwheels = [\"wl\", \"wr\"]\nmass_kg = 1200.0\n"
        "inertia_roll_kg_m2 = 700.0\ninertia_spin_kg_m2 = 100.0\n"
        "inertia_yaw_kg_m2 = 700.0\nradius_m = 0.46\ncarried_mass_kg = 8000.0\n"
        "start_m = 11.0\nspeed_m_per_s = 60.0\n",
    kBogie = "[[vehicle]]\nname = \"b\"\nfile = \"" + kVehicles +
             "manchester_bogie.toml\"\nrail = \"both\"\nstart_m = 11.0\n"
             "speed_m_per_s = 60.0\n",
    kCar =
        "[contact]\nwheel = \"cone\"\nslope = 0.1\nrail = \"crown\"\nnormal = \"hertz\"\n"
        "hertz_n_per_m15 = 9.4e10\ncreep = \"linear\"\nkalker = [9.25e6, 8.52e6, 1.95e4, 53.8]\n"
        "[[vehicle]]\nname = \"car\"\nfile = \"" +
        kVehicles + "manchester_1.toml\"\nstart_m = 22.0\nspeed_m_per_s = 10.0\n";

// A spring and a damper under the left rail at x = 14.4 m: those of a seat, or a spring of a system
// to the ground, so long that it stays upright.
const std::string kInSeat =
                      "[[support_change]]\nseats = [24]\nrail = \"left\"\n"
                      "support.stiffness_z_n_per_m = 8e7\nsupport.damping_z_n_s_per_m = 1.1e5\n",
                  kJoined =
                      "[[body]]\nname = \"far\"\nmass_kg = 1.0\ninertia_kg_m2 = [1.0, 1.0, 1.0]\n"
                      "position_m = [0.0, 50.0, 0.0]\n"
                      "[[joint]]\nname = \"hold\"\nkind = \"fixed\"\nbetween = [\"ground\", "
                      "\"far\"]\npoint_m = [0.0, 50.0, 0.0]\n"
                      "[[spring]]\nbetween = [\"rail left\", \"ground\"]\n"
                      "point_m = [14.4, 0.75, 0.0]\nother_point_m = [14.4, 0.75, -200.0]\n"
                      "stiffness_n_per_m = 3e7\ndamping_n_s_per_m = 3e4\n";

using Forces = std::vector<std::vector<double>>;

/// Forces between wheels and rails in each frame, N.
Forces forces_of(const std::string& scene) {
  const auto file = fresh_folder("beside_wheels") / "scene.toml";
  std::ofstream(file) << scene;
  const auto made = simulation_of(read_any_scene(file, {}));
  const Model& model = made->model();
  Forces all;
  Outputs outputs{};
  for (std::int64_t n = 0; n < model.steps; ++n) {
    REQUIRE((advance_frame(model, made->state, made->workspace, outputs) &
             (Status::cap_reached | Status::nonfinite_state | Status::contact_ill_posed)) ==
            Status::ok);
    all.emplace_back(outputs.contact_force, outputs.contact_force + contact_count(model));
    all.back().insert(all.back().end(), outputs.wheel_q,
                      outputs.wheel_q + 2 * model.runner_wheelsets);
  }
  return all;
}

/// Over the largest force.
double difference(const Forces& a, const Forces& b) {
  REQUIRE(a.size() == b.size());
  double largest = 0., most = 0.;
  for (std::size_t n = 0; n < a.size(); ++n)
    for (std::size_t i = 0; i < a[n].size(); ++i) {
      largest = std::max(largest, std::fabs(a[n][i]));
      most = std::max(most, std::fabs(a[n][i] - b[n][i]));
    }
  CHECK(largest > 3e4);
  return most / largest;
}

}  // namespace

TEST_CASE("wheels meet a spring of a system on a rail as the same spring of a seat",
          "[beside_wheels]") {
  struct Case {
    std::string name, runner, condense, start;
    double cant, bound;
  };
  // Equilibria differ by the rates at which the seat sinks as wheels come near. Condensed rails
  // take a spring's force as held over a step, which is of the order of the step.
  const std::string modal = "kind = \"modal\"\nmodes_per_bay = 4\n";
  for (const Case& own :
       {Case{"wheelset, released", kWheels, "", "released", 0., 1e-8},
        Case{"bogie, released", kBogie, "", "released", 0., 1e-8},
        Case{"wheelset, from its equilibrium", kWheels, "", "equilibrium", 0., 1e-4},
        Case{"vehicle in space", kCar, "", "equilibrium", 0., 3e-4},
        Case{"wheelset, condensed", kWheels, modal, "released", 0., 2e-3},
        Case{"vehicle in space, condensed", kCar, modal, "equilibrium", 0., 1e-3}}) {
    INFO(own.name);
    const std::string scene = track_of(own.cant, own.condense, own.start) + own.runner;
    const Forces in_seat = forces_of(scene + kInSeat), joined = forces_of(scene + kJoined);
    CHECK(difference(joined, in_seat) < own.bound);
    CHECK(difference(joined, forces_of(scene)) > 3. * own.bound);
  }
}

TEST_CASE("a spring of a system pulls a leaning rail along the track's axes", "[beside_wheels]") {
  const std::string scene = track_of(.05, "", "released") + kWheels;
  const Forces in_seat = forces_of(scene + kInSeat), joined = forces_of(scene + kJoined);
  // A seat's force also counts on the roll of the rail (docs/cant.md), that of a system not.
  CHECK(difference(joined, in_seat) < 2e-4);
  CHECK(difference(joined, forces_of(scene)) > 1e-2);
}

TEST_CASE("contacts beside a rotor are pressed as deep as both make the rails sink",
          "[beside_wheels]") {
  // An arm turns about a joint on the left rail by 0.05 rad a step, and a spring pulls it from
  // another place of the rail: its forces do not answer the rail's motions symmetrically. Forces
  // are held over a step, in whose middle depths are taken.
  const std::string scene =
      track_of(0., "kind = \"modal\"\nmodes_per_bay = 2\n", "released") + kBogie +
      "[[body]]\nname = \"arm\"\nmass_kg = 5.0\ninertia_kg_m2 = [0.4, 0.4, 0.4]\n"
      "position_m = [12.9, 0.75, 0.0]\nvelocity_m_per_s = [0.0, 0.0, -50.0]\n"
      "angular_velocity_rad_per_s = [0.0, 100.0, 0.0]\n"
      "[[joint]]\nname = \"pin\"\nkind = \"revolute\"\nbetween = [\"rail left\", \"arm\"]\n"
      "point_m = [12.4, 0.75, 0.0]\naxis = [0.0, 1.0, 0.0]\n"
      "[[spring]]\nbetween = [\"rail left\", \"arm\"]\npoint_m = [13.6, 0.75, 0.0]\n"
      "other_point_m = [12.9, 0.75, 0.0]\nstiffness_n_per_m = 2e7\nlength_m = 0.7\n";
  const auto file = fresh_folder("rotor") / "scene.toml";
  std::ofstream(file) << scene;
  const auto run = simulation_of(read_any_scene(file, {}));
  const Model& model = run->model();
  std::vector<double> memory(static_cast<std::size_t>(state_doubles(model)));
  Outputs outputs{};
  double off = 0., largest = 0.;
  for (std::int64_t n = 1; n <= model.steps; ++n) {
    const State before = copied_state(model, run->state, memory.data());
    REQUIRE((advance_frame(model, run->state, run->workspace, outputs) &
             (Status::cap_reached | Status::nonfinite_state | Status::contact_ill_posed)) ==
            Status::ok);
    const State& after = run->state;
    WheelContact first[kMaxWheels], last[kMaxWheels];
    const double middle = .5 * model.scheme.dt;
    find_vehicle_contacts(model, n, middle, {before.u, {before.u, before.v}}, first);
    find_vehicle_contacts(model, n, middle, {after.u, {after.u, after.v}}, last);
    for (const ContactId i : contacts(model)) {
      const double depth = model.scheme.theta * last[i].penetration +
                           (1. - model.scheme.theta) * first[i].penetration;
      const double force = model.contact[i].law.hertz * std::pow(std::max(depth, 0.), 1.5);
      off = std::max(off, std::fabs(force - after.contact_force[i]));
      largest = std::max(largest, force);
    }
  }
  CHECK(largest > 3e4);
  CHECK(off < 5e-9 * largest);  // 7e-10; 3e-8 if W took the unsymmetric part too
}

TEST_CASE("a body hangs on rails that do not give way, beside a wheelset", "[beside_wheels]") {
  const std::string scene =
      "schema = 1\n[track]\nform = \"rigid\"\nlength_m = 36.0\n"
      "[step]\ndt_s = 0.5e-3\nduration_s = 0.05\n" +
      kWheels +
      "[[body]]\nname = \"box\"\nmass_kg = 100.0\ninertia_kg_m2 = [1.0, 1.0, 1.0]\n"
      "position_m = [14.4, 0.75, -1.0]\n"
      "[[spring]]\nname = \"hanger\"\nbetween = [\"rail left\", \"box\"]\ntrace = true\n"
      "point_m = [14.4, 0.75, 0.0]\nother_point_m = [14.4, 0.75, -1.0]\n"
      "stiffness_n_per_m = 3e4\ndamping_n_s_per_m = 30.0\n";
  const auto file = fresh_folder("hangs") / "scene.toml";
  std::ofstream(file) << scene;
  const Rows trace = traced(file.string());
  REQUIRE(trace.row.size() == 101);
  for (const auto& row : trace.row) {
    CHECK(std::fabs(row[trace.column("hanger.force_n")] - 981.) < 1e-5);
    CHECK(std::fabs(row[trace.column("wl.force_z_n")] - .5 * 9200. * 9.81) < 1e-5);
  }
}
