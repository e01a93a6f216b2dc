// Trains: vehicles in space that are coupled, and vehicles that are held to the ground, by rigid
// rods and by elements that give way.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "answer/scene_running.h"
#include "offline/energy/energy_account.h"
#include "support/bad_input.h"
#include "support/scene_run.h"

using namespace railstep;

namespace {

using Words = std::vector<std::string>;

/// Two passenger vehicles, 26 m apart. @param more  keys of both, as ",x=1"
std::string two_vehicles(const std::string& front = "", const std::string& rear = "") {
  const std::string file = "file=\"../vehicles/manchester_1.toml\",speed_m_per_s=60.0";
  return "vehicle=[{name=\"front\",start_m=40.0," + file + front +
         "},{name=\"rear\",start_m=14.0," + file + rear + "}]";
}

/// A coupler of the given type from the rear of the first car to the front of the second.
std::string coupler(const std::string& type) {
  return "coupler=[{name=\"bar\",between=[\"front.car\",\"rear.car\"],"
         "points_m=[[-12.5,0,1.0],[12.5,0,1.0]]," +
         type + "}]";
}
const std::string kRod = "type=\"rigid_rod\"";
std::string spring(double stiffness) {
  return "type=\"spring\",stiffness_n_per_m=" + std::to_string(stiffness);
}

Scene train(const std::string& coupling, Words changes = {}) {
  changes.insert(changes.begin(), two_vehicles());
  changes.push_back(coupling);
  return read_scene(shipped("manchester_straight"), changes);
}

/// A force along x on the car of the second vehicle: 10 kN against its motion for 0.05 s, which
/// then rises to 30 kN by half a wave of the given time.
std::string pulled(double rise) {
  std::string table = "[0.0,-1e4]";
  for (int i = 0; i <= 40; ++i) {
    const double part = .5 - .5 * std::cos(3.14159265358979 * i / 40.);
    table +=
        ",[" + std::to_string(.05 + rise * i / 40.) + "," + std::to_string(-1e4 - 2e4 * part) + "]";
  }
  return two_vehicles("", ",force=[{body=\"car\",direction=\"x\",table=[" + table + "]}]");
}

double largest(const std::vector<double>& x) {
  double most = 0.;
  for (const double value : x) most = std::max(most, std::fabs(value));
  return most;
}

double largest_difference(const std::vector<double>& x, const std::vector<double>& y) {
  REQUIRE(x.size() == y.size());
  double most = 0.;
  for (std::size_t i = 0; i < x.size(); ++i) most = std::max(most, std::fabs(x[i] - y[i]));
  return most;
}

std::vector<RunningMode> modes_of(const Scene& scene) { return modes_at_speed(scene, 40.); }

/// Largest difference of two lists of modes, over the frequency.
double apart(const std::vector<RunningMode>& x, const std::vector<RunningMode>& y) {
  REQUIRE(x.size() == y.size());
  double most = 0.;
  for (std::size_t i = 0; i < x.size(); ++i) {
    most = std::max(most, std::fabs(x[i].frequency - y[i].frequency) / x[i].frequency);
    most = std::max(most, std::fabs(x[i].damping_ratio - y[i].damping_ratio));
  }
  return most;
}

}  // namespace

TEST_CASE("a rod carries to the drive what pulls the second vehicle", "[coupler]") {
  for (const std::string kind : {"full", "modal"}) {
    INFO(kind);
    const Scene scene = train(
        coupler(kRod), {pulled(20.), "condense.kind=\"" + kind + "\"", "step.duration_s=30.0"});
    // The treads are cones, so that contacts spin: a rolling resistance whatever the pull.
    double rear = 1e4, all = 1e4;
    for (const WheelLoad& wheel : running_loads(scene).wheels) {
      all -= wheel.t_x;
      if (wheel.name.starts_with("rear")) rear -= wheel.t_x;
    }
    CHECK(rear > 1e4 + 10.);
    const Traced run(scene);
    CHECK(run.status == Status::ok);
    const std::vector<double> tension = run["bar.force_n"], drive = run["front.drive_n"];
    for (std::size_t i = 0; i < 49; ++i) {
      CHECK(tension[i] == Approx(rear).epsilon(1e-9));
      CHECK(drive[i] == Approx(all).epsilon(1e-9));
    }
    CHECK(tension.back() == Approx(2e4 + rear).epsilon(1e-3));
    CHECK(drive.back() == Approx(2e4 + all).epsilon(1e-3));
    CHECK(largest(run["rear.car.pitch_rad"]) > 1e-6);  // it pulls below the centre
  }
}

TEST_CASE("a train that speeds up starts with the forces of its first step", "[coupler]") {
  const std::string file =
      "file=\"../vehicles/manchester_1.toml\",speed_table=[[0.0,60.0],[10.0,65.0]]";
  const Words words{"vehicle=[{name=\"front\",start_m=40.0," + file +
                        "},{name=\"rear\",start_m=14.0," + file + "}]",
                    coupler(kRod), "step.dt_s=1e-4", "step.frame_s=1e-4", "step.duration_s=0.01"};
  Simulation run(read_scene(shipped("manchester_straight"), words));
  const Model& model = run.model();
  Outputs start{}, first{};
  publish_start(model, run.state, start);
  static_cast<void>(advance_frame(model, run.state, run.workspace, first));
  // The rod takes half a metre per second squared of the second car, and the drive that of both;
  // the bogies follow on their springs.
  const double car = .5 * 32000.;
  CHECK(start.rod_tension[0] == Approx(car).epsilon(2e-2));
  CHECK(start.drive_force[0] == Approx(2. * car).epsilon(2e-2));
  CHECK(first.rod_tension[0] == Approx(start.rod_tension[0]).margin(1e-3 * car));
  CHECK(first.drive_force[0] == Approx(start.drive_force[0]).margin(1e-3 * car));
}

TEST_CASE("a rod keeps its length to rounding, step by step", "[coupler]") {
  for (const std::string scheme : {"rho_inf=0.8", "rho_inf=1.0"}) {
    INFO(scheme);
    Simulation run(train(coupler(kRod), {pulled(.1), "step." + scheme, "step.duration_s=100.0"}));
    const Model& model = run.model();
    const RunnerModel& own = model.runner[0];
    Outputs outputs{};
    double longer = 0., faster = 0.;
    while (run.state.steps < model.steps) {
      static_cast<void>(advance_frame(model, run.state, run.workspace, outputs));
      longer = std::max(longer, outputs.constraint_violation);
      double rate = 0.;
      for (std::int32_t k = 0; k < own.size; ++k)
        rate += own.rod_row[k] * run.state.v[own.first + k];
      faster = std::max(faster, std::fabs(rate));
    }
    CHECK(longer < 1e-16);
    CHECK(faster < 1e-12);
  }
}

TEST_CASE("a stiffer and stiffer spring comes to a rod as its compliance does", "[coupler]") {
  const auto tension = [](const std::string& type) {
    return Traced(train(coupler(type), {pulled(.1), "step.duration_s=0.4"}))["bar.force_n"];
  };
  const auto damped = [](double stiffness) {
    return "type=\"spring_damper\",stiffness_n_per_m=" + std::to_string(stiffness) +
           ",damping_n_s_per_m=" + std::to_string(.01 * stiffness);
  };
  const std::vector<double> rod = tension(kRod);
  const double soft = largest_difference(tension(damped(1e10)), rod),
               stiff = largest_difference(tension(damped(1e11)), rod);
  CHECK(soft < .02 * largest(rod));
  CHECK(stiff < .15 * soft);
  const std::vector<RunningMode> held = modes_of(train(coupler(kRod)));
  // A spring has one mode more, of the bar itself, beyond all others.
  const auto with = [&](double stiffness) {
    std::vector<RunningMode> all = modes_of(train(coupler(spring(stiffness))));
    while (all.size() > held.size()) all.pop_back();
    return apart(held, all);
  };
  const double off = with(1e11);
  CHECK(off < 1e-3);
  CHECK(with(1e12) < .15 * off);
}

TEST_CASE("vehicles on a coupler that does not hold are as they are alone", "[coupler]") {
  // Each has a drive: that of the second is a rod to the ground.
  const Scene loose = train(
      "coupler=[{name=\"bar\",between=[\"front.car\",\"rear.car\"],type=\"anti_roll_bar\","
      "stiffness_n_m_per_rad=0.0},{name=\"drive\",between=[\"rear.car\",\"ground\"],"
      "type=\"rigid_rod\",points_m=[[0,0,1.8],[1.0,0,1.8]]}]",
      {"step.duration_s=0.1"});
  const Scene alone = read_scene(shipped("manchester_straight"));
  const RunningLoads of_both = running_loads(loose), of_one = running_loads(alone);
  REQUIRE(of_both.wheels.size() == 2 * of_one.wheels.size());
  double resistance = 0.;
  for (const WheelLoad& wheel : of_one.wheels) resistance -= wheel.t_x;
  for (std::size_t i = 0; i < of_both.wheels.size(); ++i)
    CHECK(of_both.wheels[i].q == Approx(of_one.wheels[i % of_one.wheels.size()].q).epsilon(1e-10));
  CHECK(critical_speed_between(loose, 60., 120.)->speed ==
        Approx(critical_speed_between(alone, 60., 120.)->speed).epsilon(1e-8));
  const Traced run(loose);
  CHECK(run["front.drive_n"].back() == Approx(resistance).epsilon(1e-9));
  CHECK(run["drive.force_n"].back() == Approx(resistance).epsilon(1e-9));
}

TEST_CASE("a rod to the ground takes the lateral force on a car", "[coupler]") {
  const std::string held =
      "coupler=[{name=\"hold\",between=[\"car.car\",\"ground\"],type=\"rigid_rod\","
      "points_m=[[0,0,1.8],[0,3.0,1.8]]}]";
  const std::string side = "vehicle[0].force=[{body=\"car\",direction=\"y\",table=[[0.0,2e4]]}]";
  const Traced run(read_scene(shipped("manchester_straight"), {held, side, "step.duration_s=0.2"}));
  const std::vector<double> tension = run["hold.force_n"];
  CHECK(largest(run["car.car.y_m"]) < 1e-15);
  for (const double force : tension) CHECK(force == Approx(-2e4).epsilon(1e-9));
  const Traced free(read_scene(shipped("manchester_straight"), {side, "step.duration_s=0.2"}));
  CHECK(largest(free["car.car.y_m"]) > 1e-2);
}

TEST_CASE("the energy of a train on a rod is balanced", "[coupler]") {
  double error = 0.;
  for (const std::string dt : {"1e-3", "5e-4"}) {
    const Scene scene = train(coupler(kRod), {pulled(.1), "step.dt_s=" + dt, "step.frame_s=" + dt,
                                              "step.duration_s=0.3"});
    const Simulation run(scene);
    const EnergyBalance balance = balance_of(*run.packed(), run.model(), run.model().steps);
    INFO("step of " << dt << " s: error " << balance.error);
    CHECK(balance.error < 1e-3);
    if (error > 0.) CHECK(balance.error < .6 * error);
    error = balance.error;
  }
}

TEST_CASE("the drive of a wheelset takes the creep of its own wheels", "[coupler]") {
  // A lone wheelset of 10 t: the first body is the one that rolls. It hunts after a while.
  const std::string set =
      "vehicle=[{name=\"one\",type=\"rail_vehicle\",speed_m_per_s=30.0,wheelset=[{name=\"set\","
      "mass_kg=1e4,inertia_kg_m2=[1e3,1e2,1e3],place_m=0.0}]}]";
  const Scene scene = read_scene(shipped("manchester_straight"), {set, "step.duration_s=0.05"});
  double resistance = 0.;
  for (const WheelLoad& wheel : running_loads(scene).wheels) resistance -= wheel.t_x;
  CHECK(resistance > 5.);
  const Traced run(scene);
  CHECK(run["one.drive_n"].front() == Approx(resistance).epsilon(1e-6));
  // Newton's method ends at 1e-10 of the wheels' 49 kN.
  CHECK(run["one.drive_n"].back() == Approx(resistance).margin(1e-4));
}

TEST_CASE("sensors and forces find the bodies of each vehicle of a train", "[coupler]") {
  const Traced run(
      train(coupler(kRod),
            {two_vehicles(",force=[{body=\"bogie_2\",direction=\"z\",table=[[0.0,-2e4]]}]",
                          ",force=[{body=\"bogie_1\",direction=\"z\",table=[[0.0,-4e4]]}]"),
             "sensor=[{name=\"seat\",on=\"vehicle\",vehicle=\"rear\",body=\"bogie_1\",z_m=0.5}]",
             "step.duration_s=0.1"}));
  CHECK(run["front.leading_2_left.q_n"].front() > run["front.leading_1_left.q_n"].front() + 4e3);
  CHECK(run["rear.leading_1_left.q_n"].front() > run["rear.leading_2_left.q_n"].front() + 8e3);
  CHECK(largest_difference(run["seat.z_m"], run["rear.bogie_1.z_m"]) < 1e-15);
  CHECK(run["rear.bogie_1.z_m"].front() < run["front.bogie_1.z_m"].front() - 1e-3);
}

TEST_CASE("the trace has the force of a bump stop between two vehicles", "[coupler]") {
  // Buffers: the second car may come up by 20 mm before it presses.
  const std::string pushed =
      two_vehicles("", ",force=[{body=\"car\",direction=\"x\",table=[[0.0,0.0],[0.5,4e3]]}]");
  const Traced run(
      train("coupler=[{name=\"buffer\",between=[\"front.car\",\"rear.car\"],type=\"bump_stop\","
            "axis=\"x\","
            "point_m=[-13.0,0,1.0],clearance_m=[0.02,1.0],stiffness_n_per_m=1e6},"
            "{name=\"link\",between=[\"front.car\",\"rear.car\"],type=\"spring_damper\","
            "points_m=[[-12.5,0,1.0],[12.5,0,1.0]],stiffness_n_per_m=1e5,damping_n_s_per_m=1e5}]",
            {pushed, "step.duration_s=20.0"}));
  const std::vector<double> buffer = run["buffer.force_n"], link = run["link.force_n"],
                            drive = run["front.drive_n"];
  CHECK(buffer.front() == 0.);
  CHECK(*std::max_element(buffer.begin(), buffer.end()) > 0.);
  for (std::size_t i = 0; i < link.size(); ++i)
    if (buffer[i] > 0.) CHECK(link[i] < -1e5 * .02 + 1e3);
  // Both together carry the push, less the rolling resistance of the second vehicle.
  CHECK(buffer.back() - link.back() == Approx(4e3 - 56.).margin(60.));
}

TEST_CASE("couplers that join nothing are refused", "[coupler][bad_input]") {
  const auto said = [](const std::string& coupling, Words changes = {}) {
    try {
      const Built built(train(coupling, std::move(changes)));
    } catch (const std::exception& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const auto between = [](const std::string& a, const std::string& b) {
    return "coupler=[{name=\"bar\",between=[\"" + a + "\",\"" + b +
           "\"],type=\"rigid_rod\",points_m=[[0,0,1],[1,0,1]]}]";
  };
  CHECK(said(between("front.car", "rear.cab")).find("E-COUPLER-01") != std::string::npos);
  CHECK(said(between("ground", "ground")).find("E-COUPLER-04") != std::string::npos);
  CHECK(said(between("front.car", "front.car")).find("E-SUSPENSION-01") != std::string::npos);
  CHECK(said(coupler(kRod), {"vehicle[1].speed_m_per_s=61.0"}).find("E-COUPLER-02") !=
        std::string::npos);
  CHECK(said("coupler=[{name=\"bar\",between=[\"front.car\",\"ground\"],type=\"rigid_rod\","
             "points_m=[[0,0,1.8],[1,0,1.8]]}]")
            .find("E-PACK-58") != std::string::npos);
}
