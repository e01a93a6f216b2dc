#include "online/track/moving_load.h"

#include "online/math/sine.h"
#include "online/math/table.h"
#include "online/track/rail_point.h"
#include "online/track/travel.h"

namespace railstep {

PlacedLoad place(const Model& model, const LoadModel& load, std::int64_t step,
                 double before) noexcept {
  const double time = static_cast<double>(step) * model.scheme.dt - before;
  PlacedLoad at{};
  at.place = load.start + way_at(model, load.travel, step, before).distance;
  at.x = track_offset(model, step) + at.place;
  const PlaceOnRails found = place_on_rails(model, at.place);
  at.on_rail = found.on_rail;
  if (!at.on_rail) return at;
  at.row.rail = load.rail;
  at.row.element = found.element;
  at.xi = found.xi;
  double shape[3];
  shape_functions(at.xi, shape);
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 9; ++k) at.row.coefficient[i][k] = shape[i] * load.row[k];
  const double factor =
      load.table_points == 0 ? 1. : table_value(load.table, load.table_points, time);
  const bool taken_off = load.travel.speed >= 0. ? at.x > load.stop : at.x < load.stop;
  at.force = taken_off ? 0. : load.force * factor;
  if (load.amplitude != 0. && !taken_off)
    at.force += load.amplitude * sine_of_turns(load.frequency * time + load.phase);
  return at;
}

}  // namespace railstep
