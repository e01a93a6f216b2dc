#pragma once
#include "online/math/search.h"
#include "online/model/progress.h"

namespace railstep {

struct Travelled {
  double distance, speed, acceleration;  // m since t = 0, m/s, m/s2
};

/// Distance, speed and acceleration at a time, from the time alone. Between two rows of a table the
/// place is a parabola from the first of them.
inline Travelled travelled(const TravelModel& travel, double time) noexcept {
  if (travel.rows == 0) return {travel.speed * time, travel.speed, 0.};
  const double* const row =
      travel.table + std::ptrdiff_t{3} * row_at(travel.table, 3, travel.rows, time);
  const double since = time - row[0];
  const bool inside = since > 0. && row + 3 < travel.table + 3 * travel.rows;
  const double rate = inside ? (row[4] - row[1]) / (row[3] - row[0]) : 0.;
  return {row[2] + since * (row[1] + .5 * rate * since), row[1] + rate * since, rate};
}

/// Distance along the model's elements, and speed, `before` seconds before a step's end. On a track
/// without end the distance is from the last bay border before that end.
inline Travelled way_at(const Model& model, const TravelModel& travel, std::int64_t step,
                        double before = 0.) noexcept {
  if (model.endless.bays != 0)
    return {within_bay(model, step) - travel.speed * before, travel.speed, 0.};
  return travelled(travel, static_cast<double>(step) * model.scheme.dt - before);
}

}  // namespace railstep
