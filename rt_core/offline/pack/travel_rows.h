#pragma once
#include <vector>

#include "online/model/model.h"

namespace railstep {

/// A travel with the memory that it looks into.
struct TravelTable {
  std::vector<double> rows;  // [n][3] s, m/s, m gone since t = 0; none: one speed
  double speed;              // m/s; with rows that of the largest size
  TravelModel model() const {
    return {speed, static_cast<std::int32_t>(rows.size() / 3), rows.data()};
  }
};

/// @param speeds  t (s), m/s, t, m/s, ... with rising times; empty: `speed` all the time
/// Throws std::invalid_argument where times do not rise.
TravelTable travel_table(double speed, const std::vector<double>& speeds);

}  // namespace railstep
