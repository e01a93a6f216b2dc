#include <cmath>

#include "offline/math/constants.h"
#include "scene/scene_read.h"

namespace railstep {

TrackScene read_rigid_track(const Table& t) {
  TrackScene track{};
  track.rigid = true;
  track.unknowns = Unknowns::rigid_section;
  track.rails = static_cast<int>(t.integer("rails", 1, 2, 2));
  track.rail_spacing = t.number("rail_spacing_m", between(0.3, 3.0), 1.5);
  track.end_zone_bays = kEndZoneBays;
  track.elements_per_bay = 1;
  track.endless = !t.has("length_m");
  // Traffic is found by elements. Their number costs nothing where no line has unknowns.
  constexpr double kBay = .6, kEndless = 600.;  // m, more than any train
  const double length = t.number("length_m", between(1., 5e4), kEndless);
  track.bays = static_cast<std::int64_t>(std::ceil(length / kBay));
  track.bay = length / static_cast<double>(track.bays);
  return track;
}

RailScene read_rigid_rail(const Table& root) {
  if (const std::optional<Table> rail = root.table_if("rail")) return read_rail(*rail);
  RailScene upright{};
  upright.shape = RectangleSizes{.15, .0315, .0165, .0895, .072, .051};
  upright.young = kSteelYoung;
  upright.poisson = kSteelPoisson;
  upright.density = kSteelDensity;
  upright.crown_radius = kCrownRadius;
  return upright;
}

}  // namespace railstep
