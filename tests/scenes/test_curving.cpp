// Vehicles in space on a design line.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "answer/scene_running.h"
#include "offline/energy/energy_account.h"
#include "support/bad_input.h"
#include "support/exact_vehicle.h"
#include "support/scene_run.h"
#include "support/shipped.h"

using namespace railstep;

namespace {

using Words = std::vector<std::string>;

std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", x);
  return std::string(text).find_first_of(".e") == std::string::npos ? std::string(text) + ".0"
                                                                    : text;
}

Scene in_curve(const exact::Curve& curve, const Words& more = {}) {
  Words words = {"line.curvature_table=[[0.0," + number(curve.curvature) + "]]",
                 "line.cant_table=[[0.0," + number(curve.cant) + "]]",
                 "contact.slope=" + number(curve.slope),
                 "vehicle[0].speed_m_per_s=" + number(curve.speed)};
  words.insert(words.end(), more.begin(), more.end());
  return read_scene(shipped("manchester_curve"), words);
}

double resistance_of(const RunningLoads& loads) {
  double sum = 0.;
  for (const WheelsetLoad& set : loads.wheelsets) sum += set.resistance;
  return sum;
}

constexpr double kWholeMass = 32000. + 2. * 2615. + 4. * 1813.;        // kg, of the whole vehicle
constexpr double kOfTwoTenths = .168206167, kOfOneTenth = .091105769;  // slopes by conicity

/// Acceleration towards the inside of a curve in the track's plane that the rails give, m/s2.
double lateral_acceleration(const exact::Curve& c) {
  const double roll = -std::asin(c.cant / 1.5);
  return c.speed * c.speed * c.curvature * std::cos(roll) + 9.81 * std::sin(roll);
}

}  // namespace

TEST_CASE("wheel forces in steady curves are those of a model that linearises nothing",
          "[curving]") {
  struct Case {
    exact::Curve curve;
    double error;  // over the largest force of its kind
  };
  for (const auto& [curve, error] :
       {Case{{kOfTwoTenths, 20., 1. / 300., .1}, 2e-3},
        Case{{kOfOneTenth, 20., 1. / 300., .1}, 2e-3},
        Case{{kOfTwoTenths, 28., 1. / 600., .1}, 5e-4},
        Case{{kOfOneTenth, 28., 1. / 600., .1}, 5e-4},
        Case{{kOfTwoTenths, 36., 1. / 1000., .1}, 5e-4},
        Case{{kOfOneTenth, 60., 1. / 3000., .1}, 5e-4}, Case{{.12, 25., 1. / 800., 0.}, 5e-4}}) {
    const exact::Steady steady = exact::steady_state(curve);
    const std::vector<exact::Wheel>& exactly = steady.wheels;
    const double drag = steady.drag;
    const RunningLoads loads = running_loads(in_curve(curve));
    REQUIRE(loads.wheels.size() == exactly.size());
    double q = 0., y = 0., t = 0., dq = 0., dy = 0., dt = 0.;
    for (std::size_t i = 0; i < exactly.size(); ++i) {
      q = std::max(q, std::fabs(exactly[i].q));
      y = std::max(y, std::fabs(exactly[i].y));
      t = std::max(t, std::fabs(exactly[i].t_x));
      dq = std::max(dq, std::fabs(loads.wheels[i].q - exactly[i].q));
      dy = std::max(dy, std::fabs(loads.wheels[i].y - exactly[i].y));
      dt = std::max(dt, std::fabs(loads.wheels[i].t_x - exactly[i].t_x));
    }
    CAPTURE(curve.curvature, curve.slope, dq / q, dy / y, dt / t, resistance_of(loads), drag);
    CHECK(dq < error * q);
    CHECK(dy < error * y);
    CHECK(dt < error * t);
    CHECK(std::fabs(resistance_of(loads) - drag) < 2. * error * drag);
  }
}

TEST_CASE("the rails carry the vehicle's acceleration in a curve", "[curving]") {
  for (const double cant : {0., .1, .15}) {
    const exact::Curve curve{kOfTwoTenths, 30., 1. / 900., cant};
    const RunningLoads loads = running_loads(in_curve(curve));
    double lateral = 0.;
    for (const WheelsetLoad& set : loads.wheelsets) lateral += set.sum_y;
    // They push the vehicle inwards, to the left, and are pushed to the right.
    const double inwards = kWholeMass * curve.speed * curve.speed * curve.curvature;
    CHECK(lateral == Approx(-kWholeMass * lateral_acceleration(curve)).margin(1e-3 * inwards));
  }
}

TEST_CASE("a curve to the right is the mirror image of one to the left", "[curving]") {
  const exact::Curve left{kOfTwoTenths, 28., 1. / 600., .1};
  exact::Curve right = left;
  right.curvature = -left.curvature;
  right.cant = -left.cant;
  const RunningLoads a = running_loads(in_curve(left)), b = running_loads(in_curve(right));
  for (std::size_t i = 0; i < a.wheels.size(); ++i) {
    CHECK(a.wheels[i].q == Approx(b.wheels[i ^ 1U].q).epsilon(1e-9));
    CHECK(a.wheels[i].y == Approx(b.wheels[i ^ 1U].y).epsilon(1e-9));
  }
}

TEST_CASE("a run that starts in a curve goes on as it starts, with every kind of element",
          "[curving]") {
  const Words none, more = {"vehicle[0].file=\"../vehicles/gz18.toml\""};
  for (const Words& words : {none, more}) {
    const exact::Curve curve{kOfTwoTenths, 20., 1. / 700., .08};
    Words all = words;
    all.insert(all.end(), {"step.duration_s=0.2"});
    const Scene scene = in_curve(curve, all);
    const RunningLoads loads = running_loads(scene);
    const Traced run(scene);
    for (const WheelLoad& wheel : loads.wheels) {
      const std::vector<double> q = run[wheel.name + ".q_n"], y = run[wheel.name + ".y_n"];
      for (const std::size_t i : {std::size_t{0}, q.size() - 1}) {
        CAPTURE(wheel.name, i, words.size());
        CHECK(q[i] == Approx(wheel.q).epsilon(1e-7));
        CHECK(y[i] == Approx(wheel.y).epsilon(1e-6));
      }
    }
  }
}

namespace {

/// Two vehicles, joined by a rigid rod and a buffer across.
Words coupled_train() {
  const std::string file = ",file=\"../vehicles/manchester_1.toml\",speed_m_per_s=20.0}";
  return {
      "vehicle=[{name=\"rear\",start_m=0.0" + file + ",{name=\"front\",start_m=25.0" + file + "]",
      "coupler=[{name=\"bar\",between=[\"rear.car\",\"front.car\"],type=\"rigid_rod\","
      "points_m=[[12.0,0.0,1.0],[-12.0,0.0,1.0]]},{name=\"buffer\",between=[\"rear.car\","
      "\"front.car\"],type=\"bump_stop\",point_m=[5.0,0.0,1.0],axis=\"y\",clearance_m=0.02,"
      "stiffness_n_per_m=2e4}]"};
}

}  // namespace

TEST_CASE("a coupled train stands in a curve as its statics say", "[curving]") {
  Words words = coupled_train();
  words.insert(words.end(), {"line.curvature_table=[[0.0,2e-3]]", "line.cant_table=[[0.0,0.06]]",
                             "step.duration_s=0.2"});
  const Scene scene = read_scene(shipped("manchester_curve"), words);
  const RunningLoads loads = running_loads(scene);
  const Traced run(scene);
  CHECK(std::fabs(run["buffer.force_n"].front()) > 1e3);
  for (const WheelLoad& wheel : loads.wheels) {
    CAPTURE(wheel.name);
    for (const double q : {run[wheel.name + ".q_n"].front(), run[wheel.name + ".q_n"].back()})
      CHECK(q == Approx(wheel.q).epsilon(1e-6));
  }
}

TEST_CASE("a vehicle that coasts through a curve loses the speed that its drive keeps",
          "[curving]") {
  const exact::Curve curve{kOfTwoTenths, 28., 1. / 600., .1};
  const double resistance = resistance_of(running_loads(in_curve(curve)));
  const Traced run(in_curve(curve, {"vehicle[0].drive=\"force\"", "step.duration_s=2.0"}));
  const std::vector<double> v = run["car.speed_m_per_s"];
  const double rolling = kWholeMass + 4. * 112. / (.46 * .46);
  CHECK((v.front() - v.back()) * rolling / 2. == Approx(resistance).epsilon(5e-3));
}

TEST_CASE("a ring runs through a curve", "[curving]") {
  const Scene scene = read_scene(shipped("manchester_ring"),
                                 {"line={curvature_table=[[0.0,1e-3]],cant_table=[[0.0,0.08]]}",
                                  "irregularity.geometries=[\"gauge\"]",
                                  "vehicle[0].speed_m_per_s=32.0", "step.duration_s=1.0"});
  const Traced run(scene);
  double first = 0., mean = 0.;
  for (const WheelsetLoad& set : running_loads(scene).wheelsets) {
    const std::vector<double> y = run[set.name + ".sum_y_n"];
    first += y.front();
    mean += std::accumulate(y.begin(), y.end(), 0.) / static_cast<double>(y.size());
  }
  const double expected = -kWholeMass * lateral_acceleration({0., 32., 1e-3, .08});
  CHECK(first == Approx(expected).epsilon(1e-3));
  // Sleepers pass below the wheels.
  CHECK(mean == Approx(expected).epsilon(1e-2));
}

TEST_CASE("a run through a transition ends in the steady state of the curve", "[curving]") {
  const exact::Curve curve{kOfTwoTenths, 28., 1. / 600., .1};
  const RunningLoads loads = running_loads(in_curve(curve));
  for (const std::string shape : {"linear", "bloss", "cosine"}) {
    const Traced run(
        in_curve(curve, {"line.transition=\"" + shape + "\"",
                         "line.curvature_table=[[30.0,0.0],[90.0," + number(curve.curvature) + "]]",
                         "line.cant_table=[[30.0,0.0],[90.0,0.1]]", "step.duration_s=30.0"}));
    double most = 0.;
    for (const WheelLoad& wheel : loads.wheels) most = std::max(most, wheel.q);
    for (const WheelLoad& wheel : loads.wheels) {
      CAPTURE(shape, wheel.name);
      CHECK(std::fabs(run[wheel.name + ".q_n"].back() - wheel.q) < 1e-3 * most);
      CHECK(std::fabs(run[wheel.name + ".y_n"].back() - wheel.y) < 1e-3 * most);
    }
    // The car swings along x over its bogies, hardly damped.
    const std::vector<double> drive = run["car.drive_n"];
    const double mean = std::accumulate(drive.end() - 9556, drive.end(), 0.) / 9556.;
    CHECK(mean == Approx(resistance_of(loads)).epsilon(1e-3));  // ten periods
  }
}

TEST_CASE("a curve at 1000 km is as exact as one at the start", "[curving]") {
  const exact::Curve curve{kOfTwoTenths, 28., 1. / 600., .1};
  const auto at = [&](double start) {
    const Words words = {
        "vehicle[0].start_m=" + number(start),
        "line.curvature_table=[[" + number(start - 40.) + ",0.0],[" + number(start + 20.) + "," +
            number(curve.curvature) + "]]",
        "line.cant_table=[[" + number(start - 40.) + ",0.0],[" + number(start + 20.) + ",0.1]]"};
    return running_loads(in_curve(curve, words));
  };
  const RunningLoads near = at(0.), far = at(1e6);
  for (std::size_t i = 0; i < near.wheels.size(); ++i) {
    CHECK(far.wheels[i].q == Approx(near.wheels[i].q).epsilon(1e-8));
    CHECK(far.wheels[i].y == Approx(near.wheels[i].y).epsilon(1e-7));
  }
}

TEST_CASE("a gradient draws a vehicle back by its weight", "[curving]") {
  const Words flat = {"line.curvature_table=[[0.0,0.0]]", "line.cant_table=[[0.0,0.0]]"};
  const exact::Curve straight{kOfTwoTenths, 28., 0., 0.};
  const double level = resistance_of(running_loads(in_curve(straight, flat)));
  Words words = flat;
  words.push_back("line.gradient_table=[[0.0,0.03]]");
  const Traced run(in_curve(straight, words));
  CHECK(run["car.drive_n"].back() - level == Approx(kWholeMass * 9.81 * .03).epsilon(1e-4));
  // In a sag the rails also turn the vehicle's way upwards.
  words.back() = "line.gradient_table=[[-500.0,-0.05],[500.0,0.05]]";
  double q = 0.;
  for (const WheelLoad& wheel : running_loads(in_curve(straight, words)).wheels) q += wheel.q;
  CHECK(q == Approx(kWholeMass * (9.81 + 28. * 28. * 1e-4)).epsilon(1e-4));
}

TEST_CASE("energy is in balance through a transition", "[curving]") {
  Words words = coupled_train();
  words.insert(words.end(), {"line.transition=\"bloss\"", "step.duration_s=4.0",
                             "line.curvature_table=[[40.0,0.0],[90.0,2e-3]]",
                             "line.cant_table=[[40.0,0.0],[90.0,0.06]]",
                             "line.gradient_table=[[20.0,0.0],[60.0,0.02]]"});
  const Scene train = read_scene(shipped("manchester_curve"), words);
  words = {"line={curvature_table=[[10.0,0.0],[40.0,1e-3]],cant_table=[[10.0,0.0],[40.0,0.08]]}",
           "irregularity.geometries=[\"vertical\"]", "vehicle[0].speed_m_per_s=32.0"};
  for (const Scene& scene : {train, read_scene(shipped("manchester_ring"), words)}) {
    const Simulation made(scene);
    CHECK(balance_of(*made.packed(), made.model(), made.model().steps).error < 1e-3);
  }
}

TEST_CASE("a design line that a vehicle cannot follow is refused", "[curving]") {
  const exact::Curve curve{kOfTwoTenths, 28., 1. / 600., .1};
  const auto refused = [&](const std::string& words, const char* id) {
    CAPTURE(words);
    CHECK_THROWS_WITH(in_curve(curve, {words}), Catch::Contains(id));
  };
  refused("line.curvature_table=[[0.0,0.02]]", "E-LINE-03");
  refused("line.cant_table=[[0.0,0.0],[0.0,0.1]]", "E-LINE-02");
  refused("line.cant_table=[[0.0,0.0],[1.0,0.1]]", "E-LINE-06");
  refused("line.gradient_table=[[0.0,0.0],[1e300,0.1]]", "E-LINE-07");
  refused("line.transition=\"sine\"", "transition");
}

TEST_CASE("a vehicle with profiles starts in a curve of 100 m and stays as it starts",
          "[curving]") {
  for (const char* speed : {"8.0", "10.0"}) {
    const Scene scene =
        read_scene(shipped("../hard/h69_r_100_m"),
                   {"line.curvature_table=[[0.0,0.01]]", "line.cant_table=[[0.0,0.06]]",
                    std::string("vehicle[0].speed_m_per_s=") + speed, "step.duration_s=2.0"});
    const Traced run(scene);
    double sum = 0.;
    for (const WheelLoad& wheel : running_loads(scene).wheels) {
      sum += wheel.q;
      for (const auto& [column, value] :
           {std::pair{wheel.name + ".q_n", wheel.q}, std::pair{wheel.name + ".y_n", wheel.y}})
        CHECK(run[column].back() == Approx(value).margin(1e-6 * 1e5));
    }
    const double v = std::stod(speed), roll = std::asin(.06 / 1.5);
    CHECK(
        sum ==
        Approx(kWholeMass * (9.81 * std::cos(roll) + v * v * .01 * std::sin(roll))).epsilon(5e-4));
  }
}

namespace {

/// A vehicle with profiles that runs into a curve through a transition of 50 m, or starts in it.
struct Led {
  const char *vehicle, *dt;
  double radius, cant, speed, friction;

  Scene scene(bool runs_in) const {
    const std::string from = runs_in ? "[0.0,0.0],[20.0,0.0],[70.0," : "[0.0,";
    return read_scene(shipped("../hard/h69_r_100_m"),
                      {"line.curvature_table=[" + from + number(1. / radius) + "]]",
                       "line.cant_table=[" + from + number(cant) + "]]",
                       "vehicle[0].file=\"../vehicles/" + std::string(vehicle) + ".toml\"",
                       "vehicle[0].speed_m_per_s=" + number(speed), "step.dt_s=" + std::string(dt),
                       "contact.friction=" + number(friction), "step.frame_s=0.01",
                       "step.duration_s=" + number(std::round(150. / speed) + 10.)});
  }
};

}  // namespace

TEST_CASE("a throat rides on its gauge corner on a rail that gives way", "[curving]") {
  // Under 60 kN it turns by 0.1 rad when the rail moves by 0.1 mm, as the force of a step does it.
  // Contacts that were found by the last step's forces threw the wheel to and fro, 20 kN off.
  const auto run = [](double step) {
    return Traced(read_scene(
        shipped("manchester_s1002"),
        {"line={curvature_table=[[0.0,0.0033333333333333]],cant_table=[[0.0,"
         "0.12]]}",
         "vehicle[0].speed_m_per_s=16.0", "step.dt_s=" + number(step), "step.duration_s=0.5"}));
  };
  const Traced coarse = run(1e-3), fine = run(.125e-3);
  for (const char* wheel : {"car.leading_1_right", "car.leading_2_right"})
    for (const char* force : {".q_n", ".y_n"}) {
      const std::vector<double> a = coarse[std::string(wheel) + force],
                                b = fine[std::string(wheel) + force];
      REQUIRE(a.size() == b.size());
      double off = 0., size = 0.;
      for (std::size_t i = 0; i < a.size(); ++i) {
        off += (a[i] - b[i]) * (a[i] - b[i]);
        size += b[i] * b[i];
      }
      CAPTURE(wheel, force, std::sqrt(off / size));
      CHECK(off < 1e-4 * size);
    }
}

TEST_CASE("vehicles with profiles come to rest on the flanges that lead them", "[curving]") {
  // At 100 m and a friction of 0.3 a wheel bounces at 124 Hz on a rail without damping.
  for (const Led& led :
       {Led{"manchester_1", "1e-3", 100., .06, 8., .1},
        Led{"manchester_1", "1e-3", 120., .06, 8.8, .3},
        Led{"manchester_1", "0.25e-3", 120., .06, 8.8, .3}, Led{"gz18", "1e-3", 300., .12, 16., .3},
        Led{"gz18", "0.25e-3", 300., .12, 16., .3}}) {
    INFO(led.vehicle << ", " << led.radius << " m, step of " << led.dt << " s");
    const Traced run(led.scene(true));
    for (const WheelLoad& wheel : running_loads(led.scene(false)).wheels) {
      INFO(wheel.name);
      for (const auto& [column, value] :
           {std::pair{wheel.name + ".q_n", wheel.q}, std::pair{wheel.name + ".y_n", wheel.y}}) {
        const std::vector<double> force = run[column];
        CHECK(force.back() == Approx(value).margin(1e-3 * 7e4));
        const auto [least, most] = std::minmax_element(force.end() - 100, force.end());
        CHECK(*most - *least < 1e-3 * 7e4);
      }
    }
  }
}
