#include <fmt/core.h>

#include <array>
#include <cmath>

#include "scene/scene_read.h"

namespace railstep {
namespace {

constexpr int kExpansionPoints = 4;  // over the band, unless the scene gives expansion_hz

/// Frequencies at logarithmic steps over the band, both ends included.
std::vector<double> expansion_points(const std::array<double, 2>& band) {
  std::vector<double> hz;
  hz.reserve(kExpansionPoints);
  for (int i = 0; i < kExpansionPoints; ++i)
    hz.push_back(band[0] * std::pow(band[1] / band[0], i / (kExpansionPoints - 1.)));
  return hz;
}

std::array<double, 2> read_band(const Table& t, const std::array<double, 2>& otherwise) {
  if (!t.has("band_hz")) return otherwise;
  const std::vector<double> band = t.numbers("band_hz", above_upto(0.0, 1e5), 2, 2);
  if (!(band[0] < band[1]))
    t.refuse("band_hz", "E-CONDENSE-25",
             "band_hz does not rise; expected [low, high] with low below high");
  return {band[0], band[1]};
}

}  // namespace

CondenseScene read_condense(const Table& root, const TrackScene& track) {
  CondenseScene c;
  const std::optional<Table> t = root.table_if("condense");
  if (!t) return c;
  const std::size_t kind = t->choice(
      "kind", {"full", "modal", "guyan", "irs", "craig-bampton", "krylov", "complex-modes"}, 0);
  if (kind > 0) c.kind = static_cast<ReductionKind>(kind - 1);
  if (track.endless && kind > 1)
    t->refuse("kind", "E-CONDENSE-26",
              "a track without end is condensed in Floquet modes; expected \"full\" or "
              "\"modal\" beside track.length = \"endless\"");
  if (t->has("modes_per_bay")) c.modes_per_bay = t->number("modes_per_bay", between(0.0, 1000.0));
  if (t->has("highest_hz")) c.highest_hz = t->number("highest_hz", above_upto(0.0, 1e6));
  if (c.modes_per_bay && c.highest_hz)
    t->refuse("highest_hz", "E-CONDENSE-27",
              "highest_hz is given beside modes_per_bay; expected one of them");
  c.nodes_per_bay = static_cast<int>(t->integer("nodes_per_bay", 1, 2000, 1));
  if (2 * track.elements_per_bay % c.nodes_per_bay != 0)
    t->refuse("nodes_per_bay", "E-CONDENSE-28",
              fmt::format("nodes_per_bay = {} does not keep a bay's nodes at equal steps; expected "
                          "a divisor of 2 track.elements_per_bay = {}",
                          c.nodes_per_bay, 2 * track.elements_per_bay));
  c.band_hz = read_band(*t, c.band_hz);
  c.expansion_hz = t->has("expansion_hz") ? t->numbers("expansion_hz", above_upto(0.0, 1e5), 1, 64)
                                          : expansion_points(c.band_hz);
  c.residual_flexibility = t->boolean("residual_flexibility", true);
  return c;
}

void read_residual_beside(const Table& root, Scene& scene) {
  if (scene.condense.kind || has_wheels(scene) || !scene.external_wheels.empty()) return;
  scene.condense.residual_flexibility = false;
  const std::optional<Table> t = root.table_if("condense");
  if (t && t->boolean("residual_flexibility", false))
    t->refuse("residual_flexibility", "E-CONDENSE-31",
              "residual_flexibility = true would leave out the pull of joints and "
              "springs at the rails; expected false where bodies and loads alone are on a track in "
              "full order");
}

}  // namespace railstep
