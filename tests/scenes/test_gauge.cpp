// Strain gauges on rails: bending stress against the moment by equilibrium.
#include <fmt/core.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "support/scene_run.h"

using namespace railstep;
using Catch::Contains;
using Catch::Matchers::WithinAbs;

namespace {

constexpr double kHeight = .2319, kWidth = .0375;  // m
constexpr double kModulus = kWidth * kHeight * kHeight / 6.;
constexpr double kLoad = 50e3, kBay = .6;
constexpr int kBays = 16;

/// moving_load's left rail at rest under a standing load, with gauges under the foot.
std::vector<std::string> standing(double load, const std::string& model, int mesh,
                                  const std::vector<double>& gauges, double length) {
  std::string sensors;
  for (std::size_t i = 0; i < gauges.size(); ++i)
    sensors += fmt::format(
        "{}{{name=\"g{}\", on=\"rail\", rail=\"left\", at=\"foot\", position_m={}, "
        "gauge_length_m={}}}",
        i == 0 ? "" : ",", i, gauges[i], length);
  return {
      fmt::format("load=[{{name=\"l\", rail=\"left\", start_m={}, force_z_n={}}}]", load, -kLoad),
      "sensor=[" + sensors + "]",
      "output.supports=true",
      "step.start=\"equilibrium\"",
      "step.duration_s=1e-3",
      fmt::format("track.elements_per_bay={}", mesh),
      model};
}

/// Bending moment at x of the forces of seats and load left of x, N m; sagging is positive.
double moment(const Traced& run, double load, double x) {
  double sum = x > load ? -kLoad * (x - load) : 0.;
  for (int seat = 0; seat <= kBays && seat * kBay < x; ++seat)
    sum += run[fmt::format("support_{}.force_z_n", seat)][0] * (x - seat * kBay);
  return sum;
}

/// Its mean over a gauge by the middles of parts; loads and seats lie between these.
double mean_moment(const Traced& run, double load, double x, double length) {
  constexpr int kParts = 100;
  double sum = 0.;
  for (int i = 0; i < kParts; ++i)
    sum += moment(run, load, x + ((i + .5) / kParts - .5) * length) / kParts;
  return sum;
}

}  // namespace

TEST_CASE("a gauge under the foot reads the moment over the section modulus", "[gauge]") {
  const double load = 4.37;  // not a node of any mesh
  const std::vector<double> gauges = {1.5, 3.3, 3.9, 4.2, 4.4, 4.5, 5.1, 8.};
  const std::string model = GENERATE(std::string("condense.kind=\"full\""),
                                     std::string("condense={kind=\"modal\", modes_per_bay=2}"),
                                     std::string("condense={kind=\"craig-bampton\"}"));
  double before = 0.;
  for (const int mesh : {1, 2, 4}) {
    const Traced run("moving_load", standing(load, model, mesh, gauges, .01));
    double worst = 0., most = 0.;
    for (std::size_t i = 0; i < gauges.size(); ++i) {
      const double want = mean_moment(run, load, gauges[i], .01) / kModulus;
      const double got = run[fmt::format("g{}.stress_x_pa", i)][0];
      worst = std::max(worst, std::abs(got - want));
      most = std::max(most, std::abs(want));
    }
    CAPTURE(model, mesh, worst / most);
    // Residual flexibility gives a coarse mesh the moment too. The error is that of its tables:
    // cubics over a sixteenth of an element, at the moment's kink under the load: second order.
    CHECK(worst / most < 1e-2);
    if (before > 0.) CHECK(worst < .25 * before);
    before = worst;
  }
}

TEST_CASE("gauges at head and foot have opposite stress, and a long gauge reads the mean",
          "[gauge]") {
  std::vector<std::string> changes =
      standing(4.5, "condense.kind=\"full\"", 8, {4.5, 4.5, 4.5}, .01);
  changes.insert(changes.end(), {"sensor[1].at=\"head\"", "sensor[2].gauge_length_m=0.3"});
  const Traced run("moving_load", changes);
  const double foot = run["g0.stress_x_pa"][0], head = run["g1.stress_x_pa"][0];
  CHECK(foot > 0.);  // the rail sags under the load: the foot is in tension
  CHECK_THAT(head / foot, WithinAbs(-1., 1e-6));
  // The moment has a roof of slopes P/2 under the load: 0.15 m aside it is lower by P/2 0.15 m, and
  // the mean over both sides by half of that.
  const double lower = .5 * .5 * kLoad * .15 / kModulus;
  CHECK_THAT(run["g2.stress_x_pa"][0] / (foot - lower), WithinAbs(1., .05));
}

TEST_CASE("the whole length of a gauge must lie on the rail", "[gauge]") {
  const auto refused = [](const std::string& gauge) {
    return std::vector<std::string>{
        "sensor=[{name=\"g\", on=\"rail\", rail=\"left\", position_m=0.1, gauge_length_m=" + gauge +
        "}]"};
  };
  const std::string scene = kScenes + "moving_load.toml";
  CHECK_NOTHROW(read_scene(scene, refused("0.2")));
  CHECK_THROWS_WITH(read_scene(scene, refused("0.3")), Contains("E-SENSOR-03"));
  CHECK_THROWS_WITH(read_scene(scene, refused("0")), Contains("at least 0.001, at most 1"));
  CHECK_THROWS_WITH(read_scene(kScenes + "ballasted_track.toml", {"sensor[0].gauge_length_m=0.01"}),
                    Contains("gauge_length_m"));  // this sensor is on a sleeper
}
