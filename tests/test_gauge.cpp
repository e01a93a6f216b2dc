// Rails as far apart as their gauge says.
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <string>

#include "build.h"
#include "program.h"
#include "scene.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;

namespace {

const std::filesystem::path kScenes = std::filesystem::path(RAILSTEP_SOURCE) / "config/scenes";

const std::string k60E1 = "rail={profile=\"../profiles/60e1.toml\"}";

double spacing(const std::string& scene, const std::vector<std::string>& overrides) {
  return track_of(read_scene(kScenes / scene, overrides)).rail_spacing;
}

void refused(const std::string& scene, const std::vector<std::string>& overrides,
             const std::string& why) {
  std::string said;
  try {
    (void)read_scene(kScenes / scene, overrides);
  } catch (const InputError& error) {
    said = error.what();
  }
  CAPTURE(said);
  CHECK(said.find(why) != std::string::npos);
}

}  // namespace

TEST_CASE("the gauge of 60E1 rails is between their heads 14 mm down", "[gauge]") {
  // rail-data.md: the side, 1:20, ends at (36, 157.7) mm, where the arc of 13 mm takes over; at
  // 158 mm it is x = c + sqrt(13^2 - (158 - z_c)^2), its centre 13 mm inside the side.
  const double side = std::hypot(20.975, 1.049);
  const double c = 36. - 13. * 20.975 / side, z_c = 157.7 - 13. * 1.049 / side;
  const double width = 2e-3 * (c + std::sqrt(169. - std::pow(158. - z_c, 2)));
  // Chords leave the outline by 1e-5 m at most, on either side.
  CHECK_THAT(spacing("moving_load.toml", {k60E1, "track.gauge_m=1.435"}),
             WithinAbs(1.435 + width, 2e-5));
  CHECK_THAT(spacing("moving_load.toml", {k60E1, "track.gauge_m=1.0", "rail.outline=\"exact\""}),
             WithinAbs(1. + width, 2e-5));
}

TEST_CASE("the gauge of rectangles is between the one that is 14 mm down", "[gauge]") {
  CHECK_THAT(spacing("moving_load.toml", {"track.gauge_m=1.435"}), WithinAbs(1.435 + .0375, 1e-15));
  const std::string feet =
      "foot_width_m=0.14,foot_height_m=0.022,web_width_m=0.025,"
      "web_height_m=0.12,head_width_m=0.07,head_height_m=";
  const auto with = [&](const std::string& head, const std::string& right) {
    return spacing("moving_load.toml",
                   {"rail={rectangles={" + feet + head + "}" + right + "}", "track.gauge_m=1.435"});
  };
  CHECK_THAT(with("0.03", ""), WithinAbs(1.505, 1e-15));
  CHECK_THAT(with("0.012", ""), WithinAbs(1.46, 1e-15));  // the web's
  CHECK_THAT(with("0.03", ",right={rectangle={height_m=0.172,width_m=0.05}}"),
             WithinAbs(1.495, 1e-15));
}

TEST_CASE("a gauge wants two rails with heads, and stands alone", "[gauge]") {
  refused("moving_load.toml", {"track.gauge_m=1.435", "track.rail_spacing_m=1.5"}, "beside");
  refused("receptance_s1.toml", {"track.gauge_m=1.435"}, "one rail");
  refused("receptance_s1.toml",
          {"track.gauge_m=1.435", "track.rails=2", "sleeper.roll_inertia_kg_m2=75.0"}, "14 mm");
  refused("moving_load.toml", {"track.gauge_m=1435"}, "millimetres");
}
