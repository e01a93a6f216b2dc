// How far elements of a suspension that are not linear have moved, in the trace.
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "support/own_element.h"
#include "support/scene_run.h"

using namespace railstep;

TEST_CASE("the force of an element follows from its travel, in a curve too", "[force_elements]") {
  const std::string elements =
      element_on_bogie("stop",
                       "type = \"bump_stop\"\npoint_m = [9.5, 0.0, 0.7]\naxis = \"y\"\n"
                       "table = [[0.0, 0.0], [1e-3, 4e3], [0.1, 8e4]]\n") +
      element_on_bogie("yaw",
                       "type = \"nonlinear_damper\"\npoints_m = [[8.5, 1.2, 0.6], [9.5, 1.2, "
                       "0.6]]\ntable = [[0.0, 0.0], [0.01, 5e3], [1.0, 6e3]]\n");
  const Traced run(scene_with_elements(elements, "manchester_curve",
                                       {"line.curvature_table=[[0.0,0.0],[20.0,0.0],[60.0,0.0016]]",
                                        "line.cant_table=[[0.0,0.0],[20.0,0.0],[60.0,0.1]]",
                                        "step.duration_s=3.0", "step.frame_s=1e-3"}));
  const auto of = [](double first, double at, double second, double size) {
    return size < at ? first * size : first * at + second * (size - at);
  };
  const std::vector<double> pressed = run["car.stop.force_n"], moved = run["car.stop.travel_m"];
  for (std::size_t i = 0; i < pressed.size(); i += 50) {
    const double force = of(4e6, 1e-3, 76e3 / 99e-3, std::fabs(moved[i]));
    CHECK(pressed[i] == Approx(moved[i] < 0. ? force : -force).margin(1e-6 * 4e3));
  }
  CHECK(largest_of(moved) > 1.5e-3);
  const std::vector<double> damped = run["car.yaw.force_n"], along = run["car.yaw.travel_m"];
  for (std::size_t i = 1; i + 1 < along.size(); i += 50) {
    const double rate = (along[i + 1] - along[i - 1]) / 2e-3,
                 force = of(5e5, .01, 1e3 / .99, std::fabs(rate));
    CHECK(damped[i] == Approx(rate < 0. ? force : -force).margin(.01 * 5e3));
  }
  CHECK(largest_of(damped) > 500.);
}
