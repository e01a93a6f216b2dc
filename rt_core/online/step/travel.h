#pragma once
#include "online/model/model.h"

namespace railstep {

struct Travelled {
  double distance, speed, acceleration;  // m since t = 0, m/s, m/s2
};

/// How far something is at a time, from the time alone: between two rows of a table the place is a
/// parabola from the first of them. At most travel.rows turns.
inline Travelled travelled(const TravelModel& travel, double time) noexcept {
  if (travel.rows == 0) return {travel.speed * time, travel.speed, 0.};
  const double* row = travel.table;
  for (std::int32_t i = 1; i < travel.rows && time >= row[3]; ++i) row += 3;
  const double since = time - row[0];
  const bool inside = since > 0. && row + 3 < travel.table + 3 * travel.rows;
  const double rate = inside ? (row[4] - row[1]) / (row[3] - row[0]) : 0.;
  return {row[2] + since * (row[1] + .5 * rate * since), row[1] + rate * since, rate};
}

}  // namespace railstep
