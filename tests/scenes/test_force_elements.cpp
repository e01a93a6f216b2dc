// Elements of a suspension that are not linear, in vehicles that run.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "answer/scene_running.h"
#include "offline/energy/energy_account.h"
#include "online/math/dense.h"
#include "online/step/step.h"
#include "run/simulation.h"
#include "support/bad_input.h"
#include "support/own_element.h"
#include "support/scene_run.h"

using namespace railstep;

namespace {

using Words = std::vector<std::string>;

const std::string kRough =
    "irregularity={spectrum=\"german_low\",geometries=[\"vertical\",\"alignment\",\"cross_level\"],"
    "period_m=1000.0}";
const std::string kAlong = "points_m = [[8.5, 1.2, 0.6], [9.5, 1.2, 0.6]]\n";

double difference(const Traced& a, const Traced& b, const std::string& column) {
  std::vector<double> gap = a[column];
  for (std::size_t i = 0; i < gap.size(); ++i) gap[i] -= b[column][i];
  return largest_of(gap) / largest_of(b[column]);
}

/// Two runs with an element of two kinds, compared in some columns.
void compare(const std::string& element, const std::string& linear, const std::string& scene,
             const Words& words, double error) {
  INFO(scene);
  const Traced own(scene_with_elements(element_on_bogie("own", element), scene, words)),
      other(scene_with_elements(element_on_bogie("own", linear), scene, words));
  CHECK(own.status == Status::ok);
  for (const char* column :
       {"car.car.yaw_rad", "car.bogie_1.yaw_rad", "car.bogie_1.y_m", "car.leading_1.sum_y_n"}) {
    INFO(column);
    CHECK(difference(own, other, column) < error);
  }
}

EnergyBalance balance_with(const std::string& elements, const std::string& scene,
                           const Words& words) {
  const Simulation run(scene_with_elements(elements, scene, words));
  return balance_of(*run.packed(), run.model(), run.model().steps);
}

/// All kinds of force elements, so strong that they count.
std::string all_kinds() {
  const auto on = element_on_bogie;
  return on("yaw", kAlong +
                       "type = \"nonlinear_damper\"\ntable = [[0.0, 0.0], [0.01, 5e3], "
                       "[1.0, 6e3]]\n") +
         on("soft", kAlong +
                        "type = \"nonlinear_damper\"\ntable = [[0.0, 0.0], [0.01, 5e3], "
                        "[1.0, 6e3]]\nseries_stiffness_n_per_m = 5e6\n") +
         on("stop",
            "type = \"bump_stop\"\npoint_m = [9.5, 0.0, 0.7]\naxis = \"y\"\n"
            "table = [[1e-3, 0.0], [2e-3, 4e3], [1e-2, 1e5]]\n") +
         on("slider",
            "type = \"friction\"\npoint_m = [9.5, 0.0, 0.7]\naxis = \"y\"\n"
            "stiffness_n_per_m = 2e6\nlimit_n = 1e3\n") +
         on("leaf",
            "type = \"friction\"\nshape = \"exponential\"\npoint_m = [9.5, 0.9, 0.8]\n"
            "axis = \"z\"\nstiffness_n_per_m = 2e6\nfriction = 0.05\n"
            "normal = \"secondary_1_left\"\n") +
         on("rubber",
            "type = \"friction\"\nshape = \"berg\"\npoint_m = [9.5, -0.9, 0.8]\n"
            "axis = \"z\"\nstiffness_n_per_m = 2e6\nlimit_n = 1e3\n") +
         on("bearer",
            "type = \"side_bearer\"\npoint_m = [9.5, 0.7, 0.9]\nmirror = true\n"
            "stiffness_n_per_m = 5e6\nclearance_m = 5e-4\nshear_n_per_m = 5e6\n"
            "friction = 0.3\n") +
         on("turning",
            "type = \"friction\"\npoint_m = [9.5, 0.0, 0.8]\naxis = \"yaw\"\n"
            "stiffness_n_m_per_rad = 5e6\nlimit_n_m = 500.0\n");
}

}  // namespace

TEST_CASE("a damper whose table is a line is a damper", "[force_elements]") {
  const std::string table = kAlong +
                            "type = \"nonlinear_damper\"\ntable = [[0.0, 0.0], [0.1, 3e4], "
                            "[1.0, 3e5]]\n",
                    damper = kAlong + "type = \"damper\"\ndamping_n_s_per_m = 3e5\n";
  const Words words = {kRough, "step.duration_s=0.5"};
  compare(table, damper, "manchester_straight", words, 1e-8);
  // Where forces are held over a step, that of the element is the one at the step's end.
  compare(table, damper, "manchester_ring", words, 5e-3);
  compare(table + "series_stiffness_n_per_m = 6e6\n",
          kAlong +
              "type = \"maxwell\"\ndamping_n_s_per_m = 3e5\n"
              "series_stiffness_n_per_m = 6e6\n",
          "manchester_straight", words, 1e-8);
  // In a transition its ends move by their frames, too. It acts along its line as it is at rest,
  // so that its error is one by the angle between frames.
  for (const double radius : {600., 6000.})
    compare(
        table, damper, "manchester_curve",
        {"line.curvature_table=[[0.0,0.0],[20.0,0.0],[60.0," + std::to_string(1. / radius) + "]]",
         "line.cant_table=[[0.0,0.0],[20.0,0.0],[60.0," + std::to_string(60. / radius) + "]]",
         "step.duration_s=3.0"},
        1.2 * 9.5 / radius);
}

TEST_CASE("an exponential and a slider that do not slide are springs", "[force_elements]") {
  const std::string at = "point_m = [9.5, 0.3, 0.9]\n";
  for (const char* shape : {"slider", "berg", "exponential"})
    compare(at +
                "type = \"friction\"\naxis = \"y\"\nstiffness_n_per_m = 1e5\nlimit_n = 1e9\n"
                "shape = \"" +
                shape + "\"\n",
            at + "type = \"bushing\"\nstiffness_n_per_m = [0.0, 1e5, 0.0]\n"
                 "preload_n = [0.0, 0.0, 0.0]\n",
            "manchester_straight", {kRough, "step.duration_s=0.5"}, 1e-4);
}

TEST_CASE("friction remembers the displacement at which the step's force acts",
          "[force_elements]") {
  for (const char* shape : {"berg", "exponential"}) {
    INFO(shape);
    Simulation run(scene_with_elements(
        element_on_bogie("own", std::string("point_m = [9.5, 0.3, 0.9]\ntype = \"friction\"\n"
                                            "axis = \"y\"\nstiffness_n_per_m = 2e6\n"
                                            "limit_n = 2e3\nshape = \"") +
                                    shape + "\"\n"),
        "manchester_straight", {kRough, "step.duration_s=0.5"}));
    const RunnerModel& r = run.model().runner[0];
    const ForceElement& e = r.force_element[0];
    REQUIRE(r.force_elements == 1);
    const double* const row = r.element_row + std::ptrdiff_t{r.size} * e.coordinate;
    const auto displacement = [&] { return dot(row, run.state.u + r.first, r.size); };
    const double* const memory = run.state.element_memory + e.memory;
    double largest = 0., gap = 0., before = displacement();
    Outputs out{};
    for (int i = 0; i < 500; ++i) {
      REQUIRE(advance_frame(run.model(), run.state, run.workspace, out) == Status::ok);
      const double after = displacement(),
                   met = before + run.model().scheme.theta * (after - before);
      gap = std::max(gap, std::fabs(memory[0] - met));
      largest = std::max(largest, std::fabs(met));
      before = after;
    }
    CHECK(largest > 1e-4);
    CHECK(gap < 1e-12 * largest);
  }
}

TEST_CASE("a saturated damper gives its limit and no more", "[force_elements]") {
  const Traced run(scene_with_elements(
      element_on_bogie("own", kAlong + "type = \"nonlinear_damper\"\ntable = [[0.0, 0.0], [1e-3, "
                                       "2e3], [1.0, 2e3]]\n"),
      "manchester_straight", {kRough, "step.duration_s=1.0", "vehicle[0].speed_m_per_s=60.0"}));
  CHECK(largest_of(run["car.own.force_n"]) == Approx(2e3).epsilon(1e-12));
}

TEST_CASE("a saturated damper behind a spring has the spring's force in the trace",
          "[force_elements]") {
  const std::string soft = kAlong +
                           "type = \"nonlinear_damper\"\ntable = [[0.0, 0.0], [1e-3, 1e3], [1.0, "
                           "1e3]]\nseries_stiffness_n_per_m = 5e6\n";
  // On a ring forces are held over a step, and nothing damps the rate of what has no mass.
  for (const char* name : {"manchester_straight", "manchester_ring"}) {
    INFO(name);
    const Traced run(
        scene_with_elements(element_on_bogie("own", soft), name, {kRough, "step.duration_s=0.5"}));
    const std::vector<double> force = run["car.own.force_n"];
    double leap = 0.;
    for (std::size_t i = 1; i < force.size(); ++i)
      leap = std::max(leap, std::fabs(force[i] - force[i - 1]));
    CHECK(largest_of(force) > 900.);
    CHECK(largest_of(force) < 1.05e3);  // the spring overshoots within a step
    CHECK(leap < 400.);
  }
}

TEST_CASE("force elements count in the linear motions", "[force_elements]") {
  const auto speed = [](const std::string& element) {
    const auto found = critical_speed_between(
        scene_with_elements(element_on_bogie("own", element), "manchester_straight", {}), 10.,
        190.);
    REQUIRE(found);
    return found->speed;
  };
  const std::string at = "point_m = [9.5, 0.3, 0.9]\n",
                    turned = at +
                             "stiffness_n_per_m = [0.0, 0.0, 0.0]\n"
                             "preload_n = [0.0, 0.0, 0.0]\n";
  const double damped = speed(kAlong + "type = \"damper\"\ndamping_n_s_per_m = 3e4\n"),
               held =
                   speed(turned + "type = \"bushing\"\nstiffness_n_m_per_rad = [0.0, 0.0, 2e6]\n");
  const double alone = speed(turned + "type = \"bushing\"\n");
  CHECK(std::fabs(damped - alone) > .05);
  CHECK(std::fabs(held - alone) > .05);
  CHECK(speed(kAlong + "type = \"nonlinear_damper\"\ntable = [[0.0, 0.0], [0.1, 3e3], [1.0, "
                       "4e3]]\n") == Approx(damped).epsilon(1e-9));
  CHECK(speed(at + "type = \"friction\"\naxis = \"yaw\"\nstiffness_n_m_per_rad = 2e6\n"
                   "limit_n_m = 10.0\n") == Approx(held).epsilon(1e-9));
}

TEST_CASE("force elements keep the balance of energy to second order", "[force_elements]") {
  const std::string forces =
      "vehicle[0].force=[{body=\"car\",direction=\"yaw\",table=[[0.0,0.0],[0.3,2e5],[0.6,-2e5],"
      "[1.0,1e5],[1.4,0.0]]},{body=\"car\",direction=\"roll\",table=[[0.0,0.0],[0.2,3e4],"
      "[0.5,-3e4],[0.9,1e4],[1.4,0.0]]}]";
  double last = 0.;
  for (const char* dt : {"1e-3", "5e-4"}) {
    const EnergyBalance balance =
        balance_with(all_kinds(), "manchester_straight",
                     {forces, "step.duration_s=2.0", std::string("step.dt_s=") + dt});
    INFO("step of " << dt << " s: error " << balance.error << ", loss " << balance.numerical_loss);
    CHECK(balance.error < 5e-8);
    CHECK(std::fabs(balance.numerical_loss) < 5e-8);
    if (last > 0.) CHECK(balance.error < .4 * last);
    last = balance.error;
  }
}

TEST_CASE("force elements have snapshots and model files, on all forms of track",
          "[force_elements]") {
  for (const char* name : {"manchester_straight", "manchester_ring", "manchester_curve"}) {
    INFO(name);
    Words words = {"step.duration_s=0.3"};
    if (std::string(name) != "manchester_curve") words.push_back(kRough);
    const Scene scene = scene_with_elements(all_kinds(), name, words);
    Simulation whole(scene), loaded(whole.block(), "model");
    Outputs a{}, b{};
    Status met = Status::ok;
    for (int frame = 0; frame < 100; ++frame) {
      met = met | advance_frame(whole.model(), whole.state, whole.workspace, a);
      static_cast<void>(advance_frame(loaded.model(), loaded.state, loaded.workspace, b));
    }
    CHECK(met == Status::ok);
    CHECK(state_hash(whole.model(), whole.state) == state_hash(loaded.model(), loaded.state));
  }
}

TEST_CASE("a side bearer lifts off and presses, and its friction follows its load",
          "[force_elements]") {
  const std::string bearer = element_on_bogie("bearer",
                                              "type = \"side_bearer\"\npoint_m = [9.5, 0.7, 0.9]\n"
                                              "stiffness_n_per_m = 2e7\nclearance_m = 2e-4\n"
                                              "shear_n_per_m = 1e7\nfriction = 0.3\n");
  const Traced run(
      scene_with_elements(bearer, "manchester_straight",
                          {kRough, "step.duration_s=3.0", "vehicle[0].speed_m_per_s=50.0"}));
  const std::vector<double> pressed = run["car.bearer.force_n"],
                            rubbed = run["car.bearer_friction.force_n"];
  int lifted = 0, slid = 0;
  for (std::size_t i = 0; i < pressed.size(); ++i) {
    CHECK(pressed[i] >= 0.);
    CHECK(std::fabs(rubbed[i]) <= .3 * pressed[i] * (1. + 1e-6) + 1.);
    lifted += pressed[i] == 0. ? 1 : 0;
    slid += pressed[i] > 0. && std::fabs(rubbed[i]) > .299 * pressed[i] ? 1 : 0;
  }
  INFO(lifted << " frames without load, " << slid << " at the limit, of " << pressed.size());
  CHECK(lifted > 100);
  CHECK(slid > 20);
  CHECK(static_cast<std::size_t>(lifted) + 100 < pressed.size());
}

TEST_CASE("a car on centre plates stands on them and tips over their rims", "[force_elements]") {
  const std::string plate = element_on_bogie(
      "plate",
      "type = \"centre_plate\"\npoint_m = [9.5, 0.0, 0.8]\nradius_m = 0.2\n"
      "stiffness_n_per_m = [1e8, 1e8, 1e8]\nshear_n_per_m = 1e7\nfriction = 0.2\n");
  const Words words = {kRough, "step.duration_s=2.0", "vehicle[0].speed_m_per_s=40.0"};
  const Traced run(scene_with_elements(plate, "manchester_straight", words));
  CHECK(run.status == Status::ok);
  double least = 1e9, most = 0.;
  for (const char* rim : {"front", "back", "left", "right"})
    for (const double force : run[std::string("car.plate_") + rim + ".force_n"]) {
      least = std::min(least, force);
      most = std::max(most, force);
    }
  INFO("forces on rims from " << least << " to " << most << " N");
  CHECK(least < 1e-6 * most);
  CHECK(least > -1e-6 * most);
  CHECK(most > 1e4);
  CHECK(balance_with(plate, "manchester_straight", words).error < 1e-3);
}

TEST_CASE("a support whose bodies are named in the wrong order is refused", "[force_elements]") {
  const Scene scene = scene_with_elements(
      "[[element]]\nname = \"own\"\nbetween = [\"bogie_1\", \"car\"]\ntype = \"support\"\n"
      "point_m = [9.5, 0.0, 0.8]\nstiffness_n_per_m = 1e7\n",
      "manchester_straight", {});
  CHECK_THROWS_WITH(Simulation(scene), Catch::Contains("E-SUSPENSION-08"));
}

TEST_CASE("wrong force elements are refused", "[force_elements]") {
  const auto refused = [](const std::string& keys, const std::string& id) {
    CAPTURE(keys);
    CHECK_THROWS_WITH(scene_with_elements(element_on_bogie("own", keys), "manchester_straight", {}),
                      Catch::Contains(id));
  };
  const std::string point = "point_m = [9.5, 0.0, 0.7]\naxis = \"y\"\n",
                    damper = kAlong + "type = \"nonlinear_damper\"\n",
                    friction = point + "type = \"friction\"\nstiffness_n_per_m = 1e6\n";
  refused(damper + "table = [[0.0, 0.0], [1.0, 5.0], [2.0, 4.0]]\n", "E-VEHICLE-35");
  refused(damper + "table = [[0.0, 0.0], [1.0, 5.0], [1.0, 6.0]]\n", "E-VEHICLE-35");
  refused(damper + "table = [[0.0, 0.0]]\n", "E-VEHICLE-35");
  refused(damper + "table = [[-1.0, -2.0], [1.0, 5.0]]\n", "E-VEHICLE-36");
  refused(friction + "friction = 0.3\nnormal = \"nothing\"\n", "E-VEHICLE-34");
  refused(friction + "friction = 0.3\nnormal = \"anti_roll_bar\"\n", "E-VEHICLE-34");
  refused(damper + "table = [[0.0, 0.0], [1e-12, 1e6]]\n", "E-VEHICLE-35");
  refused(friction + "friction = 0.3\nnormal = \"secondary_1_left\"\nshape = \"berg\"\n",
          "E-VEHICLE-37");
}

TEST_CASE("a controlled damper of constant damping is a damper, by a table and by an input",
          "[force_elements]") {
  const auto scene = [](const std::string& kind, const std::string& name) {
    return read_scene(shipped(name),
                      {kRough, "step.duration_s=0.3",
                       "vehicle[0].actuator=[{name=\"own\",between=[\"car\",\"bogie_1\"],acts="
                       "\"damping\",points_m=[[8.5,1.2,0.6],[9.5,1.2,0.6]]," +
                           kind + "}]"});
  };
  for (const char* name : {"manchester_straight", "manchester_ring"}) {
    INFO(name);
    const Traced table(scene("table=[[0.0,3e5]]", name)),
        damper(scene_with_elements(
            element_on_bogie("own", kAlong + "type = \"damper\"\ndamping_n_s_per_m = 3e5\n"), name,
            {kRough, "step.duration_s=0.3"}));
    const bool held = std::string(name) == "manchester_ring";  // forces are held over a step
    for (const char* column : {"car.bogie_1.yaw_rad", "car.leading_1.sum_y_n"})
      CHECK(difference(table, damper, column) < (held ? 5e-3 : 1e-8));
    Simulation run(scene("input=\"valve\",limit_n_s_per_m=1e6", name));
    const double open[] = {3e5};
    const RunRecord record =
        simulate(run, 300, nullptr, true, {}, [&](std::int64_t) -> const double* { return open; });
    const std::vector<double> forces = table["car.own.force_n"];
    const auto at = static_cast<std::size_t>(
        std::find(run.columns().begin(), run.columns().end(), "car.own.force_n") -
        run.columns().begin());
    double gap = 0.;
    for (std::size_t i = 2; i < forces.size(); ++i)
      gap = std::max(gap, std::fabs(record.rows[i * run.columns().size() + at] - forces[i]));
    CHECK(gap < 1e-9 * largest_of(forces));
  }
}

TEST_CASE("an actuator pushes two bodies apart with its force", "[force_elements]") {
  const std::string place =
      "name=\"own\",between=[\"car\",\"bogie_1\"],points_m=[[8.5,1.2,0.6],"
      "[9.5,1.2,0.6]]";
  const Scene scene = read_scene(
      shipped("manchester_straight"),
      {"step.duration_s=1.0",
       "vehicle[0].actuator=[{" + place + ",table=[[0.0,0.0],[0.2,2e4],[0.5,-2e4],[1.0,0.0]]}]"});
  const Traced run(scene);
  CHECK(largest_of(run["car.own.force_n"]) == Approx(2e4));
  CHECK(run["car.own.force_n"][200] == Approx(2e4));
  // It pushes the bogie ahead on its left side, which turns it to the right.
  CHECK(run["car.bogie_1.yaw_rad"][200] < -1e-5);
  const Simulation twin(scene);
  const EnergyBalance balance = balance_of(*twin.packed(), twin.model(), twin.model().steps);
  INFO(balance.error << ", " << balance.numerical_loss);
  CHECK(balance.error < 1e-6);
  // The vehicle starts in equilibrium with it.
  const Traced rest(read_scene(
      shipped("manchester_straight"),
      {"step.duration_s=0.5", "vehicle[0].actuator=[{" + place + ",table=[[0.0,1e4]]}]"}));
  const std::vector<double> yaw = rest["car.bogie_1.yaw_rad"];
  CHECK(std::fabs(yaw.back()) > 1e-6);
  CHECK(yaw.back() == Approx(yaw.front()).epsilon(1e-6));
}

TEST_CASE("a damper that has no force at small rates leaves the linear motions alone",
          "[force_elements]") {
  const auto speed = [](const std::string& element) {
    const auto found =
        critical_speed_between(scene_with_elements(element, "manchester_straight", {}), 10., 190.);
    REQUIRE(found);
    return found->speed;
  };
  CHECK(speed(element_on_bogie(
            "own", kAlong + "type = \"nonlinear_damper\"\ntable = [[0.0, 0.0], [0.01, 0.0], [0.05, "
                            "5e3]]\nseries_stiffness_n_per_m = 6e6\n")) ==
        Approx(speed("")).epsilon(1e-9));
}

TEST_CASE("wrong actuators are refused", "[force_elements]") {
  const auto refused = [](const std::string& keys, const std::string& id) {
    CAPTURE(keys);
    CHECK_THROWS_WITH(
        read_scene(
            shipped("manchester_straight"),
            {"vehicle[0].actuator=[{name=\"own\",point_m=[0.0,0.0,1.0],axis=\"x\"," + keys + "}]"}),
        Catch::Contains(id));
  };
  refused("between=[\"car\",\"bogie_9\"],table=[[0.0,1.0]]", "E-VEHICLE-38");
  refused("between=[\"car\",\"car\"],table=[[0.0,1.0]]", "E-VEHICLE-39");
  refused("between=[\"car\",\"bogie_1\"],table=[[0.0,1.0]],input=\"a\",limit_n=1.0", "E-RUNNER-25");
  refused("between=[\"car\",\"bogie_1\"],acts=\"damping\",table=[[0.0,-1.0]]", "E-RUNNER-21");
}
