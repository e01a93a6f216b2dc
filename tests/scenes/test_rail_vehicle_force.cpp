// Forces on bodies of vehicles in space, by tables and given frame by frame.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "answer/scene_running.h"
#include "offline/energy/energy_account.h"
#include "run/inputs.h"
#include "support/program.h"
#include "support/scene_run.h"

using namespace railstep;

namespace {

using Words = std::vector<std::string>;

Scene forced(const std::string& scene, const std::string& force, Words changes = {}) {
  changes.push_back("vehicle[0].force=[{" + force + "}]");
  return read_scene(shipped(scene), changes);
}

Scene straight(const std::string& force, const Words& changes = {}) {
  return forced("manchester_straight", force, changes);
}

double sum_of(const RunningLoads& loads, double WheelLoad::*part) {
  double sum = 0.;
  for (const WheelLoad& wheel : loads.wheels) sum += wheel.*part;
  return sum;
}

}  // namespace

TEST_CASE("wheels carry a constant force on a body from the first step on",
          "[rail_vehicle][inputs]") {
  const double weight =
      sum_of(running_loads(read_scene(shipped("manchester_straight"))), &WheelLoad::q);
  const std::string down = "body=\"car\",direction=\"z\",table=[[0.0,-2e4]]",
                    across = "body=\"bogie_1\",direction=\"y\",table=[[0.0,3e3]]",
                    roll = "body=\"car\",direction=\"roll\",table=[[0.0,1e4]]";
  for (const std::string kind : {"full", "modal"})
    for (const std::string& force : {down, across, roll}) {
      INFO(kind << ", " << force);
      const Scene scene =
          straight(force, {"condense.kind=\"" + kind + "\"", "step.duration_s=0.5"});
      const RunningLoads loads = running_loads(scene);
      CHECK(sum_of(loads, &WheelLoad::q) ==
            Approx(weight + (force == down ? 2e4 : 0.)).epsilon(1e-10));
      double lateral = 0., moment = 0.;
      for (const WheelsetLoad& own : loads.wheelsets) lateral += own.sum_y;
      for (const WheelLoad& wheel : loads.wheels)
        moment += wheel.name.find("_left") != std::string::npos ? wheel.q : -wheel.q;
      CHECK(lateral == Approx(force == across ? 3e3 : 0.).margin(1e-6));
      CHECK((std::fabs(moment) > 1e3) == (force != down));
      const Traced run(scene);
      CHECK(run.status == Status::ok);
      for (const WheelLoad& wheel : loads.wheels) {
        INFO(wheel.name);
        const std::vector<double> q = run[wheel.name + ".q_n"], y = run[wheel.name + ".y_n"];
        CHECK(q.front() == Approx(wheel.q).epsilon(1e-11));
        CHECK(q.back() == Approx(wheel.q).epsilon(1e-8));
        CHECK(y.back() == Approx(wheel.y).epsilon(1e-7));
      }
    }
}

TEST_CASE("a force ahead on the first body is taken off its drive", "[rail_vehicle][inputs]") {
  const Traced pushed(straight("body=\"car\",direction=\"x\",table=[[0.0,5e3],[0.1,7e3]]",
                               {"step.duration_s=0.1"})),
      alone(read_scene(shipped("manchester_straight"), {"step.duration_s=0.1"}));
  const std::vector<double> with = pushed["car.drive_n"], without = alone["car.drive_n"];
  CHECK(with.front() == Approx(without.front() - 5e3).margin(1e-6));
  CHECK(with.back() == Approx(without.back() - 7e3).margin(1e-6));
}

TEST_CASE("the work of a force on a vehicle in space is in the balance of energy",
          "[rail_vehicle][inputs]") {
  const std::string push =
      "body=\"bogie_1\",direction=\"z\",table=[[0.0,0.0],[0.05,-4e4],[0.1,3e4],[0.15,0.0]]";
  for (const std::string name : {"manchester_straight", "manchester_ring"}) {
    double error = 0.;
    for (const std::string dt : {"1e-3", "5e-4"}) {
      const Scene scene =
          forced(name, push, {"step.dt_s=" + dt, "step.frame_s=" + dt, "step.duration_s=0.3"});
      const Simulation run(scene);
      const EnergyBalance balance = balance_of(*run.packed(), run.model(), run.model().steps);
      INFO(name << ", step of " << dt << " s: error " << balance.error);
      CHECK(balance.error < 1e-3);
      if (error > 0.) CHECK(balance.error < .6 * error);
      error = balance.error;
    }
  }
}

TEST_CASE("an input moves a vehicle in space as a table does", "[rail_vehicle][inputs]") {
  const auto rows = [](const std::string& force, bool given) {
    static const double pushed = 8e3;
    const FrameInputs inputs = [](std::int64_t) { return &pushed; };
    Simulation run(straight("body=\"bogie_1\",direction=\"yaw\"," + force));
    return simulate(run, 200, nullptr, true, {}, given ? inputs : FrameInputs{}).rows;
  };
  // The table begins at 0, as the input does.
  const std::vector<double> table = rows("table=[[0.0,0.0],[1e-3,8e3]]", false),
                            input = rows("input=\"twist\",limit_n_m=1e5", true);
  REQUIRE(table.size() == input.size());
  double most = 0.;
  for (std::size_t i = 0; i < table.size(); ++i)
    most = std::max(most, std::fabs(table[i] - input[i]));
  CHECK(most == 0.);
}

TEST_CASE("a force on a body that a vehicle in space does not have is refused",
          "[rail_vehicle][bad_input]") {
  const auto said = [](const std::string& force) {
    try {
      straight(force);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  CHECK_THAT(said("body=\"bogey\",direction=\"y\",table=[[0,1]]"),
             Catch::Contains("E-VEHICLE-12") && Catch::Contains("bogie_1"));
  CHECK_THAT(said("body=\"car\",direction=\"up\",table=[[0,1]]"), Catch::Contains("roll"));
}

TEST_CASE("a sensor on a vehicle in space moves as the point of its rigid body",
          "[rail_vehicle][sensor]") {
  const std::string sensors =
      "sensor=[{name=\"seat\",on=\"vehicle\",vehicle=\"car\",x_m=9.5,y_m=-1.2,z_m=-0.7},"
      "{name=\"middle\",on=\"vehicle\",vehicle=\"car\",body=\"bogie_1\"},"
      "{name=\"box\",on=\"vehicle\",vehicle=\"car\",body=\"leading_1\",y_m=1.0}]";
  const Traced run(straight("body=\"car\",direction=\"roll\",table=[[0.0,0.0],[0.02,2e4]]",
                            {sensors, "step.duration_s=0.2", "step.dt_s=5e-4", "step.frame_s=5e-4",
                             "irregularity={spectrum=\"german_low\"}"}));
  const auto column = [&](const std::string& name) { return run[name]; };
  const std::vector<double> y = column("car.car.y_m"), z = column("car.car.z_m"),
                            roll = column("car.car.roll_rad"), pitch = column("car.car.pitch_rad"),
                            yaw = column("car.car.yaw_rad"), seat_y = column("seat.y_m"),
                            seat_z = column("seat.z_m"), middle = column("middle.z_m"),
                            bogie = column("car.bogie_1.z_m"), box = column("box.y_m"),
                            leading = column("car.leading_1.y_m");
  for (std::size_t i = 0; i < y.size(); ++i) {
    CHECK(seat_y[i] == Approx(y[i] + .7 * roll[i] + 9.5 * yaw[i]).margin(1e-15));
    CHECK(seat_z[i] == Approx(z[i] - 1.2 * roll[i] - 9.5 * pitch[i]).margin(1e-15));
  }
  CHECK(middle == bogie);
  CHECK(box == leading);
  // The trapezoidal rule over accelerations and over velocities, at the ends of banded steps.
  const std::vector<double> v = column("seat.vy_m_per_s"), a = column("seat.ay_m_per_s2");
  double by_v = 0., by_a = 0., largest_v = 0.;
  for (std::size_t i = 1; i < y.size(); ++i) {
    by_v += 2.5e-4 * (v[i - 1] + v[i]);
    by_a += 2.5e-4 * (a[i - 1] + a[i]);
    largest_v = std::max(largest_v, std::fabs(v[i]));
  }
  CHECK(largest_v > 1e-3);
  CHECK(by_v == Approx(seat_y.back() - seat_y.front()).margin(1e-3 * largest_v * .2));
  CHECK(by_a == Approx(v.back() - v.front()).margin(1e-2 * largest_v));
}

TEST_CASE("a braked wheelset creeps as its law says, and slides at the limit of friction",
          "[rail_vehicle][inputs]") {
  // The treads have no slope, so there is no spin. By Shen, Hedrick and Elkins T / (mu N) is
  // 1 - (1 - u/3)^3, u the linear creep force over mu N.
  constexpr double kFriction = .25, kF11 = 9.25e6, kRadius = .46, kSpeed = 40.;
  const Words changes{"contact.creep=\"she\"", "contact.slope=0.0",
                      "vehicle[0].speed_m_per_s=" + std::to_string(kSpeed), "step.duration_s=1.0"};
  const auto braked = [&](double moment, const std::string& kind, double right) {
    Words words = changes;
    words.push_back("contact.friction=[" + std::to_string(kFriction) + "," + std::to_string(right) +
                    "]");
    words.push_back("condense.kind=\"" + kind + "\"");
    return straight("body=\"leading_1\",direction=\"pitch\",table=[[0.0,0.0],[0.2," +
                        std::to_string(-moment) + "]]",
                    words);
  };
  const Traced rolling(braked(0., "full", kFriction));
  const double q = rolling["car.leading_1_left.q_n"].back();
  CHECK(rolling.status == Status::ok);
  const double limit = 2. * kFriction * q * kRadius;  // of the moment, N m
  for (const std::string kind : {"full", "modal"}) {
    for (const double part : {.3, .9}) {
      INFO(kind << ", " << part);
      Simulation run(braked(part * limit, kind, kFriction));
      const Model& model = run.model();
      const RunnerModel& runner = model.runner[0];
      const double* const v = run.state.v + runner.first + runner.wheelset[0].first;
      const double* const f = wheel_force_of(run.state, 0, 0);
      Outputs outputs{};
      double before = 0., force = 0.;
      for (std::int64_t n = 0; n < model.steps; ++n) {
        if (n == model.steps - 20) before = v[4];
        REQUIRE(advance_frame(model, run.state, run.workspace, outputs) == Status::ok);
        if (n >= model.steps - 20) force -= f[0] / 20.;
      }
      // The bogie swings along the car, and the spin with it.
      const double slowed = (before - v[4]) / (20. * model.scheme.dt);
      CHECK(2. * force * kRadius + slowed * runner.wheelset[0].spin_inertia ==
            Approx(part * limit).epsilon(2e-3));
      const double used = -f[0] / (kFriction * f[2]);  // the car's pitch moves wheel loads
      const double creepage = 3. * (1. - std::cbrt(1. - used)) * kFriction * f[2] / kF11;
      // The wheel rolls on the radius that its contact leaves it.
      const double sunk = std::pow(f[2] / runner.contact.hertz, 2. / 3.) / kRadius;
      CHECK((v[0] - v[4] * kRadius) / kSpeed + sunk == Approx(creepage).epsilon(1e-3));
    }
    // Beyond the limit the wheelset's spin slows by what friction leaves of the moment.
    INFO(kind);
    constexpr double kRight = .2;
    Simulation run(braked(1.2 * limit, kind, kRight));
    const Model& model = run.model();
    const RunnerModel& runner = model.runner[0];
    const double& spin = run.state.v[runner.first + runner.wheelset[0].first + 4];
    Outputs outputs{};
    Status met = Status::ok;
    double before = 0., friction = 0.;
    for (std::int64_t n = 0; n < model.steps; ++n) {
      if (n == model.steps - 100) before = spin;
      met = met | advance_frame(model, run.state, run.workspace, outputs);
      if (n >= model.steps - 100)
        friction += .01 * (kFriction * outputs.wheel_q[0] + kRight * outputs.wheel_q[1]);
    }
    CHECK(met == Status::full_slip);
    const Simulation again(braked(1.2 * limit, kind, kRight));
    CHECK(balance_of(*again.packed(), again.model(), model.steps).error < 1e-5);
    const double slowed = (before - spin) / (100. * model.scheme.dt);
    CHECK(slowed * runner.wheelset[0].spin_inertia ==
          Approx(1.2 * limit - friction * kRadius).epsilon(1e-2));
  }
}
