#pragma once
#include <cstdint>

namespace railstep {

/// Motion along the rails: at one speed, or by a table of speeds, linear between its rows and
/// constant outside them.
struct TravelModel {
  double speed;         // m/s; with a table the one of the largest size
  std::int32_t rows;    // 0: one speed
  const double* table;  // [rows][3]  s, m/s, m since t = 0
};

}  // namespace railstep
