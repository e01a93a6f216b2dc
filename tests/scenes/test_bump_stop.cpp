// Bump stops of a vehicle in space: a stop without gap is a spring, a stop with one limits a motion
// and keeps its energy.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "answer/scene_running.h"
#include "offline/energy/energy_account.h"
#include "online/step/step.h"
#include "run/simulation.h"
#include "support/own_element.h"
#include "support/scene_run.h"

using namespace railstep;

namespace {

/// A scene of the shipped vehicle with one more element between its car and its first bogie.
Scene scene_with(const std::string& element, const std::string& scene,
                 const std::vector<std::string>& words) {
  return scene_with_elements(element_on_bogie("stop", "point_m = [9.5, 0.3, 0.9]\n" + element),
                             scene, words);
}

const std::string kSpring =
    "type = \"bushing\"\nstiffness_n_per_m = [0.0, 2.0e7, 0.0]\npreload_n = [0.0, 0.0, 0.0]\n";
std::string stop(const std::string& gap) {
  return "type = \"bump_stop\"\naxis = \"y\"\nclearance_m = " + gap +
         "\nstiffness_n_per_m = 2.0e7\n";
}

const std::string kUneven =
    "irregularity={spectrum=\"german_low\",geometries=[\"vertical\",\"alignment\",\"cross_level\"],"
    "period_m=1000.0}";

/// Largest difference of a column over the largest value of the second.
double difference(const Traced& a, const Traced& b, const std::string& column) {
  std::vector<double> gap = a[column];
  for (std::size_t i = 0; i < gap.size(); ++i) gap[i] -= b[column][i];
  return largest_of(gap) / largest_of(b[column]);
}

}  // namespace

TEST_CASE("a bump stop without gap is a spring", "[bump_stop]") {
  for (const char* scene : {"manchester_straight", "manchester_ring"})
    for (const char* kind : {"full", "modal"}) {
      if (std::string(scene) == "manchester_ring" && std::string(kind) == "full") continue;
      INFO(scene << ", " << kind);
      const std::vector<std::string> words{kUneven, std::string("condense.kind=\"") + kind + "\"",
                                           "step.duration_s=0.5"};
      const Traced spring(scene_with(kSpring, scene, words));
      const Traced pressed(scene_with(stop("0.0"), scene, words));
      CHECK(pressed.status == Status::ok);
      for (const char* column : {"car.car.y_m", "car.bogie_1.y_m", "car.leading_1.y_m",
                                 "car.leading_1.sum_y_n", "car.leading_1_left.q_n"})
        // Where forces are held over a step, that of a stop is the one at the step's end.
        CHECK(difference(pressed, spring, column) < (std::string(kind) == "full" ? 1e-8 : 5e-3));
    }
}

TEST_CASE("a bump stop counts in the linear motions where it presses", "[bump_stop]") {
  const auto speed = [](const std::string& element) {
    const auto found =
        critical_speed_between(scene_with(element, "manchester_straight", {}), 10., 150.);
    REQUIRE(found);
    return found->speed;
  };
  const double with_spring = speed(kSpring), alone = speed(stop("[0.1, 0.2]"));
  CHECK(speed(stop("0.0")) == Approx(with_spring).epsilon(1e-9));
  CHECK(std::fabs(with_spring - alone) > .05);
}

TEST_CASE("a bump stop limits a motion and keeps its energy", "[bump_stop]") {
  const auto scene = [](const std::string& gap, double dt) {
    return scene_with(stop(gap), "manchester_straight",
                      {kUneven, "step.duration_s=2.0", "vehicle[0].speed_m_per_s=25.0",
                       "step.dt_s=" + std::to_string(dt)});
  };
  // How far the car moves against the bogie where the stop is.
  const auto moved = [](const Traced& run) {
    std::vector<double> way = run["car.car.y_m"];
    for (std::size_t i = 0; i < way.size(); ++i)
      way[i] += 9.5 * run["car.car.yaw_rad"][i] - (.9 - 1.8) * run["car.car.roll_rad"][i] -
                run["car.bogie_1.y_m"][i] + (.9 - .6) * run["car.bogie_1.roll_rad"][i];
    return largest_of(way);
  };
  const Traced free(scene("1.0", 1e-3)), held(scene("1e-3", 1e-3));
  INFO(moved(free) << " m without, " << moved(held) << " m with the stop");
  CHECK(moved(held) > 1e-3);
  CHECK(moved(held) < .8 * moved(free));
  double error = 0.;
  for (const double dt : {1e-3, 5e-4}) {
    const Simulation run(scene("1e-3", dt));
    const EnergyBalance balance = balance_of(*run.packed(), run.model(), run.model().steps);
    INFO("step of " << dt << " s: error " << balance.error << ", loss " << balance.numerical_loss);
    CHECK(balance.error < 2e-4);
    CHECK(balance.numerical_loss > -1e-4);
    if (error > 0.) CHECK(balance.error < .7 * error);
    error = balance.error;
  }
}

TEST_CASE("a bump stop has a snapshot and a model file as all else", "[bump_stop]") {
  const Scene scene =
      scene_with(stop("[5e-4, 1e-3]"), "manchester_ring", {kUneven, "step.duration_s=0.2"});
  Simulation whole(scene), loaded(whole.block(), "model");
  Outputs a{}, b{};
  for (int frame = 0; frame < 100; ++frame) {
    static_cast<void>(advance_frame(whole.model(), whole.state, whole.workspace, a));
    static_cast<void>(advance_frame(loaded.model(), loaded.state, loaded.workspace, b));
  }
  CHECK(state_hash(whole.model(), whole.state) == state_hash(loaded.model(), loaded.state));
}
