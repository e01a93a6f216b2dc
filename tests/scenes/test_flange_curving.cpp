// Steady curves on flanges with a limit of friction, beside a model that linearises nothing.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "answer/scene_running.h"
#include "offline/runner/curving.h"
#include "offline/runner/running.h"
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

namespace {

/// The stiffness of small motions in a curve, in the order of the exact model's bodies.
Eigen::MatrixXd stiffness_in_curve(const Scene& scene, const exact::Curve& curve, bool turned) {
  const RailVehicleScene& v = scene.rail_vehicles.front();
  RunningOn on;
  on.line = design_line(scene.design_line, reach_of(v.runner));
  on.gravity = v.gravity;
  const RunnerMatrices loaded = runner_matrices(v.runner, v.gravity);
  Running here = running_on(on, v.runner, loaded, v.contact, curve.speed);
  if (!turned) here.matrices.turned.setZero();
  const SteadyRunning steady =
      steady_running(v.runner, here.matrices, v.contact, curve.speed, here.rails);
  const Eigen::MatrixXd K =
      linear_running(v.runner, here.matrices, v.contact, curve.speed, steady, {here.rails})
          .stiffness;
  Eigen::MatrixXd sorted(exact::kSize, exact::kSize);
  std::vector<Eigen::Index> from;
  for (const char* name :
       {"car", "bogie_1", "bogie_2", "leading_1", "trailing_1", "leading_2", "trailing_2"})
    for (std::size_t b = 0; b < v.runner.bodies.size(); ++b)
      if (v.runner.bodies[b].name == name)
        for (Eigen::Index k = 0; k < 6; ++k) from.push_back(6 * static_cast<Eigen::Index>(b) + k);
  REQUIRE(from.size() == std::size_t{exact::kSize});
  for (Eigen::Index i = 0; i < exact::kSize; ++i)
    for (Eigen::Index j = 0; j < exact::kSize; ++j)
      sorted(i, j) = K(from[static_cast<std::size_t>(i)], from[static_cast<std::size_t>(j)]);
  return sorted;
}

/// The largest entry of a difference of stiffnesses over those of its row and column. Pitches of
/// wheelsets are not there: the exact model has rates in their places.
double difference(const Eigen::MatrixXd& K, const Eigen::MatrixXd& exactly) {
  double most = 0.;
  const auto is_spin = [](Eigen::Index i) { return i >= 18 && i % 6 == 4; };
  for (Eigen::Index i = 1; i < K.rows(); ++i)
    for (Eigen::Index j = 1; j < K.cols(); ++j)
      if (!is_spin(i) && !is_spin(j)) {
        const double own =
            std::fabs(K(i, j) - exactly(i, j)) / std::sqrt(exactly(i, i) * exactly(j, j));
        if (!std::isfinite(own)) return own;
        most = std::max(most, own);
      }
  return most;
}

}  // namespace

TEST_CASE("small motions in a curve meet the stiffness of the model that linearises nothing",
          "[curving]") {
  const exact::Curve curve{.168206167, 20., 1. / 300., .1};
  const Eigen::MatrixXd exactly = -exact::steady_state(curve).slopes;
  const Scene scene = read_scene(
      shipped("manchester_curve"),
      {"line.curvature_table=[[0.0,3.3333333333333333e-3]]", "vehicle[0].speed_m_per_s=20.0"});
  const double with = difference(stiffness_in_curve(scene, curve, true), exactly),
               without = difference(stiffness_in_curve(scene, curve, false), exactly);
  CAPTURE(with, without);
  CHECK(with < 1e-3);
  CHECK(without > 3. * with);
}

TEST_CASE("a vehicle on a ring starts where a throat rides on its gauge corner", "[curving]") {
  // Zones that ended at strips of the search leapt by 1 % of a wheel's force: no state was found.
  for (const auto& [radius, speed] :
       {std::pair{190., 10.}, std::pair{180., 10.5}, std::pair{210., 11.}, std::pair{250., 11.}}) {
    const Scene scene = read_scene(
        shipped("manchester_s1002"),
        {"irregularity.geometries=[\"vertical\"]",
         "line.curvature_table=[[0.0," + std::to_string(1e6 / radius) + "e-6]]",
         "line.cant_table=[[0.0,0.06]]", "vehicle[0].speed_m_per_s=" + std::to_string(speed)});
    double sum = 0., most = 0.;
    for (const WheelLoad& wheel : running_loads(scene).wheels) {
      sum += wheel.q;
      most = std::max(most, wheel.y);
    }
    const double roll = std::asin(.06 / 1.5), mass = 32000. + 2. * 2615. + 4. * 1813.;
    CAPTURE(radius, speed, most);
    CHECK(most > 2e4);
    CHECK(sum == Approx(mass * (9.81 * std::cos(roll) + speed * speed / radius * std::sin(roll)))
                     .epsilon(1e-3));
  }
}

TEST_CASE("the critical speed in a curve is sought where the vehicle runs steadily", "[curving]") {
  const auto scene = [](const char* curvature) {
    return read_scene(shipped("manchester_curve"),
                      {std::string("line.curvature_table=[[0.0,") + curvature + "]]"});
  };
  // Cones without flanges and linear creep: in a wide curve it is that of straight track.
  const double straight = critical_speed_between(scene("0.0"), 80., 110.)->speed;
  SpeedRange searched{};
  const auto wide = critical_speed_between(scene("1e-4"), 60., 110., &searched);
  REQUIRE(wide);
  CHECK(wide->speed == Approx(straight).epsilon(1e-3));
  CHECK(searched.from == 60.);
  // At 600 m the inner wheels lift at 45 m/s.
  CHECK_FALSE(critical_speed_between(scene("1.6667e-3"), 20., 80., &searched));
  CHECK(searched.from == 20.);
  CHECK(searched.to > 35.);
  CHECK(searched.to < 60.);
}
