// Cooperrider's bogie (after Kaas-Petersen, Acta Mechanica 61, 1986, 89-107): from which speed it
// hunts, and how far. The reference is an integration of its seven equations of lateral motion.
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "answer/scene_running.h"
#include "support/coned_wheelset.h"
#include "support/scene_run.h"

using namespace railstep;

namespace {

/// Creep along and across, N: the sets that are printed for it differ in which is which.
struct CreepPair {
  double along, across;
};

constexpr double kCreep = 6.563e6;  // G pi a b, N
constexpr CreepPair kFirst{kCreep / .54219, kCreep / .60252},
    kOther{kCreep / .60252, kCreep / .54219};

/// Its equations know no roll of the wheelsets: those with wheels of this radius hardly roll by
/// their cones. With wheels of 0.4572 m the bogie hunts from 67.3 m/s on.
constexpr double kRadius = .03;  // m

std::string bushing(const std::string& name, const std::string& on, double x, double z,
                    const std::string& more) {
  return fmt::format(
      "[[vehicle.element]]\nname = \"{}\"\ntype = \"bushing\"\nbetween = [\"frame\", \"{}\"]\n"
      "point_m = [{}, 0.0, {}]\n{}\n",
      name, on, x, z, more);
}

/// The equations know no weight of the frame: it hangs from far above. Elements along the other
/// motions, which they do not have, only hold the bogie.
std::string bogie() {
  constexpr double d1 = .62, d2 = .68, h1 = .0762, h2 = .6584;           // m
  constexpr double k1 = 1823e3, k2 = 3646e3, k3 = 3646e3, k4 = 182.3e3;  // N/m
  constexpr double k5 = 333.3e3, k6 = 2.71e6, D1 = 20e3, D2 = 29.2e3;    // N/m, N m, N s/m
  std::string text = fmt::format(
      "[[vehicle.body]]\nname = \"frame\"\nmass_kg = 2918.0\n"
      "inertia_kg_m2 = [6780.0, 6780.0, 6780.0]\ncentre_m = [0.0, 0.0, {0}]\n"
      "[[vehicle.element]]\nname = \"hanger\"\ntype = \"spring_damper\"\n"
      "between = [\"frame\", \"ground\"]\npoints_m = [[0.0, 0.0, {0}], [0.0, 0.0, 100.0]]\n"
      "stiffness_n_per_m = 1e7\ndamping_n_s_per_m = 1e5\n",
      kRadius + h1);
  for (const bool front : {true, false}) {
    const char* name = front ? "front" : "rear";
    const double x = front ? 1.074 : -1.074;
    text += fmt::format(
        "[[vehicle.wheelset]]\nname = \"{0}\"\nmass_kg = 1022.0\nplace_m = {1}\nradius_m = {2}\n"
        "inertia_kg_m2 = [678.0, 0.1, 678.0]\n"
        "[[vehicle.element]]\nname = \"flanges_{0}\"\ntype = \"bump_stop\"\naxis = \"y\"\n"
        "between = [\"{0}\", \"ground\"]\npoint_m = [{1}, 0.0, {2}]\nclearance_m = 0.0091\n"
        "stiffness_n_per_m = 14.6e6\n"
        "[[vehicle.force]]\nbody = \"{0}\"\ndirection = \"z\"\ntable = [[0.0, {3}]]\n",
        name, x, kRadius, 1022. * 9.81 - 2e4 / .3);
    text += bushing(fmt::format("primary_{}", name), name, x, kRadius,
                    fmt::format("stiffness_n_per_m = [1e7, {}, 0.0]\n"
                                "damping_n_s_per_m = [1e5, 0.0, 1e4]\n"
                                "stiffness_n_m_per_rad = [0.0, 0.0, {}]",
                                2. * k1, 2. * k2 * d1 * d1));
  }
  return text + bushing("secondary", "ground", 0., kRadius + h1 + h2,
                        fmt::format("stiffness_n_per_m = [1e6, {}, 0.0]\n"
                                    "damping_n_s_per_m = [1e5, {}, 0.0]\n"
                                    "stiffness_n_m_per_rad = [{}, 1e7, {}]\n"
                                    "damping_n_m_s_per_rad = [{}, 1e5, 0.0]",
                                    2. * k4, 2. * D2, 2. * k5 * d2 * d2 + 4. * k3 * d1 * d1, k6,
                                    2. * D1 * d2 * d2));
}

Scene bogie_at(const CreepPair& creep, double speed, const std::string& law,
               const std::string& push = "") {
  const double slope = coned(kRadius, .05 * kRadius / .4572, .716).slope;
  return railstep::scene_of(
      fmt::format("schema = 1\n[track]\nform = \"rigid\"\n"
                  "[contact]\nwheel = \"cone\"\nrail = \"crown\"\nnormal = \"hertz\"\nslope = {}\n"
                  "distance_m = 1.432\nhertz_n_per_m15 = 1e14\nkalker = [{}, {}, 0.0, 0.0]\n{}"
                  "[[vehicle]]\nname = \"bogie\"\ntype = \"rail_vehicle\"\nspeed_m_per_s = {}\n{}{}"
                  "[step]\ndt_s = 1e-3\nduration_s = 30.0\n",
                  slope, creep.along, creep.across, law, speed, push, bogie()));
}

double linear_speed(const CreepPair& creep) {
  const auto found = critical_speed_between(bogie_at(creep, 50., "creep = \"linear\"\n"), 50., 80.);
  return found ? found->speed : 0.;
}

/// The largest shift of the front wheelset in the last 6 s of a run that begins with a push, m.
/// Friction is 10 kN on each wheel.
double amplitude(const CreepPair& creep, double speed) {
  const Traced run(bogie_at(creep, speed, "creep = \"she\"\nfriction = 0.3\n",
                            "[[vehicle.force]]\nbody = \"front\"\ndirection = \"y\"\n"
                            "table = [[0.0, 0.0], [0.05, 6e4], [0.15, 6e4], [0.2, 0.0]]\n"));
  std::vector<double> y = run["bogie.front.y_m"];
  y.erase(y.begin(), y.begin() + static_cast<std::ptrdiff_t>(4 * y.size() / 5));
  return largest_of(y);
}

}  // namespace

TEST_CASE("Cooperrider's bogie hunts at the speed of its equations", "[cooperrider]") {
  CHECK(linear_speed(kFirst) == Approx(65.2896).epsilon(5e-4));
  CHECK(linear_speed(kOther) == Approx(68.6440).epsilon(5e-4));
}

TEST_CASE("Cooperrider's bogie hunts as far as its equations, and below that speed too",
          "[cooperrider]") {
  struct Known {
    double speed, amplitude;  // m/s, m; 0: none
  };
  const auto check = [](const CreepPair& creep, const std::vector<Known>& all) {
    for (const Known& known : all) {
      INFO(known.speed << " m/s");
      const double found = amplitude(creep, known.speed);
      if (known.amplitude > 0.)
        CHECK(found == Approx(known.amplitude).epsilon(2e-3));
      else
        CHECK(found < 1e-4);
    }
  };
  check(kFirst, {{72., 10.777e-3}, {68., 10.136e-3}, {65., 9.598e-3}, {64., 9.384e-3}, {63., 0.}});
  check(kOther, {{72., 10.608e-3}, {68., 9.743e-3}, {67., 9.486e-3}, {66., 0.}});
}
