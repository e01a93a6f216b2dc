// A random track without end: a ring in Floquet modes, or a window in full order.
#include <algorithm>
#include <cmath>
#include <string>

#include "generators.h"

namespace railstep::property {
namespace {

/// Makes all seats equal and their pads points, stiff enough for a short ring.
void make_uniform(Draw& draw, Document& scene) {
  Document& pad = scene["support"];
  pad.erase("length_m");
  pad.erase("unilateral");
  pad["stiffness_z_n_per_m"] = draw.of_any_size(1e8, 1e9);
  pad["damping_z_n_s_per_m"] = draw.of_any_size(1e4, 1e5);
  if (scene.contains("ballast")) {
    for (const char* key : {"length_m", "unilateral"}) scene["ballast"].erase(key);
    scene["ballast"]["stiffness_z_n_per_m"] = draw.of_any_size(5e7, 5e8);
    scene["ballast"]["damping_z_n_s_per_m"] = draw.of_any_size(3e4, 2e5);
    if (number(scene["sleeper"], "mass_kg") == 0.) scene["sleeper"]["mass_kg"] = 200.;
  }
  scene["rail"].erase("axial_force_n");
}

}  // namespace

Document random_endless_scene(std::uint64_t seed) {
  Draw draw(seed, 3);
  Document scene = {{"schema", 1}};
  const char* unknowns = draw.one_of({"vertical", "vertical", "full", "rigid-section"});
  const bool window = draw.chance(.4), vertical = std::string(unknowns) == "vertical";
  add_ground(draw, {unknowns, draw.whole(1, 2), window ? 24 : 12}, scene);
  make_uniform(draw, scene);
  Document& track = scene["track"];
  track["length"] = "endless";
  if (!window) {
    scene["condense"] = {{"kind", "modal"}, {"modes_per_bay", draw.whole(1, 3)}};
    if (draw.chance(.1)) scene["condense"]["residual_flexibility"] = false;
  }
  add_step(draw, scene);
  // A step moves by a whole fraction of a bay, as the moving start requires.
  const double bay = number(track, "bay_m"), dt = number(scene["step"], "dt_s");
  double speed = 0.;
  if (draw.chance(.85))
    speed = bay / dt / std::ceil(bay / dt / std::min(100., draw.between(.02, .5) * bay / dt));
  add_traffic(draw, scene, &speed);
  const bool wheels = scene.contains("wheelset") || scene.contains("vehicle");
  // In other scenes the moving start takes seconds.
  if (!wheels && vertical && draw.chance(.6)) scene["step"]["start"] = "moving";
  return scene;
}

}  // namespace railstep::property
