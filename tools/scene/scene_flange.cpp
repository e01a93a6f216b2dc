#include <algorithm>
#include <cmath>

#include "scene/scene_read.h"

namespace railstep {
namespace {

void read_law(const Table& t, Flange& flange) {
  const bool hertz = t.choice("contact", {"hertz", "linear"}, 0) == 0;
  for (const char* key : {"stiffness_n_per_m", "damping_n_s_per_m"})
    if (hertz && t.has(key))
      t.refuse(key, "E-FLANGE-01",
               std::string(key) +
                   " is given beside contact = \"hertz\"; expected contact = \"linear\" "
                   "beside a spring or damper");
  if (!hertz && t.has("corner_radius_m"))
    t.refuse("corner_radius_m", "E-FLANGE-02",
             "corner_radius_m is given beside contact = \"linear\"; expected contact "
             "= \"hertz\" beside a corner's radius");
  if (hertz) {
    flange.corner_radius = t.number("corner_radius_m", between(1e-3, 0.1), 0.013);
    return;
  }
  flange.stiffness = t.number("stiffness_n_per_m", above_upto(0.0, 1e13));
  flange.damping = t.number("damping_n_s_per_m", between(0.0, 1e11), 0.0);
}

}  // namespace

Flange read_flange(const Table& t, const Scene& scene) {
  if (scene.track.unknowns == Unknowns::vertical)
    t.refuse("", "E-FLANGE-03",
             "flanges push rails sideways, but this track does not move there; "
             "expected track.unknowns = \"full\" or \"rigid-section\"");
  const RailScene& right = scene.right_rail ? *scene.right_rail : scene.rail;
  if (!head_width(scene.rail) || !head_width(right))
    t.refuse("", "E-FLANGE-04",
             "flanges meet the railheads 14 mm below their tops, but the section does "
             "not say how wide the head is there; expected a rail whose section has a "
             "shape");
  Flange flange;
  flange.clearance = t.number("clearance_m", above_upto(0.0, 0.1));
  flange.angle = t.number("angle_deg", between(20.0, 85.0), 70.0) * (M_PI / 180.0);
  flange.height = t.number("height_m", {.least = kGaugeDepth, .most = 0.1, .least_itself = false},
                           flange.height);
  read_law(t, flange);
  return flange;
}

bool has_flanges(const Scene& scene) {
  return std::any_of(scene.wheelsets.begin(), scene.wheelsets.end(),
                     [](const WheelsetScene& w) { return w.flange.has_value(); });
}

}  // namespace railstep
