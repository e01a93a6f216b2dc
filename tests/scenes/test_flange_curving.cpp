// Steady curves on flanges with a limit of friction, beside a model that linearises nothing.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "answer/scene_running.h"
#include "support/exact_vehicle.h"
#include "support/scene_run.h"
#include "support/shipped.h"

using namespace railstep;

namespace {

const exact::Flange kFlange{.3, 6e-3, 6e10, true};

/// The scene of the exact model: its surfaces as profiles, its coefficients of creep.
Scene on_flanges(const exact::Curve& curve) {
  const std::string profiles = RAILSTEP_SOURCE "/tests/data/profiles/";
  const auto number = [](double x) { return std::to_string(x); };
  return read_scene(
      shipped("manchester_curve"),
      {"line.curvature_table=[[0.0," + number(1e6 * curve.curvature) + "e-6]]",
       "line.cant_table=[[0.0," + number(curve.cant) + "]]",
       "vehicle[0].speed_m_per_s=" + number(curve.speed),
       "contact={wheel=\"profile\",rail=\"profile\",wheel_profile=\"" + profiles +
           "cone_with_flange.toml\",rail_profile=\"" + profiles +
           "round_corner.toml\",inclination=0.168206167,gauge_m=1.43689207,normal=\"strips\","
           "creep=\"she\",friction=0.3,kalker=[9.25e6,8.52e6,1.95e4,53.8]}"});
}

}  // namespace

TEST_CASE("wheel forces on flanges with friction are those of a model that linearises nothing",
          "[curving]") {
  for (const exact::Curve& curve :
       {exact::Curve{.168206167, 20., 1. / 300., .1}, exact::Curve{.168206167, 28., 1. / 600., .1},
        exact::Curve{.168206167, 36., 1. / 1000., .1},
        exact::Curve{.168206167, 25., 1. / 450., .0}}) {
    const exact::Steady exactly = exact::steady_state(curve, kFlange);
    const RunningLoads loads = running_loads(on_flanges(curve));
    REQUIRE(loads.wheels.size() == exactly.wheels.size());
    double q = 0., y = 0., dq = 0., dy = 0.;
    for (std::size_t i = 0; i < loads.wheels.size(); ++i) {
      q = std::max(q, std::fabs(exactly.wheels[i].q));
      y = std::max(y, std::fabs(exactly.wheels[i].y));
      dq = std::max(dq, std::fabs(loads.wheels[i].q - exactly.wheels[i].q));
      dy = std::max(dy, std::fabs(loads.wheels[i].y - exactly.wheels[i].y));
    }
    double dyaw = 0., yaw = 0., resistance = 0.;
    for (std::size_t i = 0; i < loads.wheelsets.size(); ++i) {
      yaw = std::max(yaw, std::fabs(exactly.yaw[i]));
      dyaw = std::max(dyaw, std::fabs(loads.wheelsets[i].yaw - exactly.yaw[i]));
      resistance += loads.wheelsets[i].resistance;
    }
    CAPTURE(curve.curvature, q, y, dq / q, dy / y, dyaw / yaw, resistance, exactly.drag);
    CHECK(y > 1e4);  // on the flange
    CHECK(dq < 1e-2 * q);
    CHECK(dy < 1e-2 * y);
    CHECK(dyaw < 1e-2 * yaw);
    CHECK(std::fabs(resistance - exactly.drag) < 1e-2 * exactly.drag);
    // The models differ by the flange's approach alone.
    CHECK(std::fabs(loads.wheelsets[0].y - exactly.y[0]) < 2e-5);
  }
}
