#include "scene/scene_read.h"

namespace railstep {
namespace {

StopScene read_stop(const Table& t, const Scene& scene) {
  StopScene s{};
  s.name = checked_name(t, "name", t.string("name"));
  const bool left = t.choice("rail", {"left", "right"}, 0) == 0;
  if (scene.track.rails == 2 && !t.has("rail"))
    t.refuse("rail", "E-STOP-01",
             "the track has two rails, and key 'rail' is missing; expected \"left\" "
             "or \"right\"");
  if (scene.track.rails == 1 && !left)
    t.refuse("rail", "E-SCENE-01",
             "rail = \"right\", but the track has one rail; expected \"left\"");
  s.rail = left ? kLeftRail : kRightRail;
  s.x = t.number("position_m", between(0.0, scene.track.length()));
  s.direction = t.choice("direction", {"y", "z"}) == 0 ? 1 : 2;
  if (s.direction == 1 && scene.track.unknowns == Unknowns::vertical)
    t.refuse("direction", "E-STOP-03",
             "direction = \"y\", but the track does not move sideways; expected "
             "track.unknowns = \"full\" or \"rigid-section\"");
  // +y is left, +z up.
  const bool along = s.direction == 1 ? t.choice("side", {"left", "right"}) == 0
                                      : t.choice("side", {"above", "below"}) == 0;
  s.side = along ? 1. : -1.;
  constexpr Height kHeights[] = {Height::axis, Height::head, Height::foot};
  s.at = kHeights[t.choice("at", {"axis", "head", "foot"}, 0)];
  s.gap = t.number("gap_m", between(0.0, 0.1), 0.0);
  s.stiffness = t.number("stiffness_n_per_m", above_upto(0.0, 1e13));
  s.damping = t.number("damping_n_s_per_m", between(0.0, 1e11), 0.0);
  return s;
}

}  // namespace

std::vector<StopScene> read_stops(const Table& root, const Scene& scene) {
  std::vector<StopScene> stops;
  root.each("stop", [&](const Table& t) { stops.push_back(read_stop(t, scene)); });
  return stops;
}

}  // namespace railstep
