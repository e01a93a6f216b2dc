#pragma once
#include <vector>

#include "online/model/model.h"

namespace railstep {

/// A travel and the memory that its view looks into.
struct TravelTable {
  std::vector<double> rows;  // [n][3] s, m/s, m since t = 0; empty: one speed
  double speed;              // m/s; with rows the one of the largest size
  TravelModel model() const {
    return {speed, static_cast<std::int32_t>(rows.size() / 3), rows.data()};
  }
};

/// @param speeds  t (s), m/s, t, m/s, ... with rising times; empty: `speed` all the time
/// Throws Refused if times do not rise.
TravelTable travel_table(double speed, const std::vector<double>& speeds);

}  // namespace railstep
