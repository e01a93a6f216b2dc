// Cooperrider's bogies under a car body, on S1002 wheels: docs/critical-speed.md.
#include <fmt/format.h>

#include <catch2/catch.hpp>

#include "answer/scene_running.h"
#include "support/scene_run.h"

using namespace railstep;

namespace {

Scene on_s1002(double gauge, double poisson) {
  const std::string config = std::string(RAILSTEP_SOURCE) + "/config";
  return railstep::scene_of(
      fmt::format("schema = 1\n[track]\nform = \"rigid\"\n"
                  "[rail]\nprofile = \"{0}/profiles/60e1.toml\"\ncant = \"1:40\"\npoisson = {2}\n"
                  "[contact]\nwheel = \"profile\"\nwheel_profile = \"{0}/profiles/s1002.toml\"\n"
                  "rail = \"profile\"\nrail_profile = \"{0}/profiles/60e1.toml\"\n"
                  "normal = \"strips\"\ncreep = \"she\"\nfriction = 0.15\ngauge_m = {1}\n"
                  "[[vehicle]]\nname = \"car\"\nfile = \"{0}/vehicles/cooperrider.toml\"\n"
                  "speed_m_per_s = 100.0\n"
                  "[step]\ndt_s = 5e-4\nduration_s = 0.1\n",
                  config, gauge, poisson));
}

double hunting_speed(double gauge, double poisson) {
  const auto found = critical_speed_between(on_s1002(gauge, poisson), 90., 180.);
  return found ? found->speed : 0.;
}

}  // namespace

TEST_CASE("Cooperrider's vehicle hunts at the speed of another program's equations",
          "[cooperrider]") {
  // Their conicity at rest is that of a gauge of 1439 mm here. They have two shear moduli, one of
  // them by a sign of Poisson's ratio, which normal forces do not see.
  CHECK(hunting_speed(1.439, .27) == Approx(131.15).epsilon(5e-3));
  CHECK(hunting_speed(1.439, -.27) == Approx(109.47).epsilon(5e-3));
}

TEST_CASE("a run knows the materials that a scene may have", "[cooperrider]") {
  const Traced run(on_s1002(1.439, -.27));
  CHECK(run["car.leading_1_left.q_n"].back() == Approx(66602.).epsilon(1e-3));
}
