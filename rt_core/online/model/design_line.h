#pragma once
#include <cstddef>
#include <cstdint>

namespace railstep {

/// How a value goes from one row of a table to the next: linear (curvature: clothoids), Bloss's
/// cubic, or half a cosine.
enum class Transition : std::int32_t { linear, bloss, cosine };

/// A quantity over the distance along the track's middle, constant outside its rows.
struct LineTable {
  std::int32_t rows;    // 0: the quantity is 0 everywhere
  const double* value;  // [rows][2] m, and the quantity there; distances rise
};

inline constexpr int kMostLineRows = 1'000'000;
inline constexpr int kMostLinePieces = 64;  // that a vehicle may stand on
// Most of each quantity: beyond it the frames' angles are not small. Two rows of cant and gradient
// differ by these per length at most: a sudden change would throw the vehicle.
inline constexpr double kMostCurvature = .01, kMostCant = .2, kMostGradient = .1, kMostTwist = .01,
                        kMostVerticalCurvature = .01;

/// The track's shape as it was designed. Vehicles in space run in frames that follow it: x along
/// the track's middle at the top of rail, z across the canted plane.
struct DesignLine {
  Transition transition;  // of curvature and cant; a gradient is linear
  LineTable curvature;    // seen from above, per length of the line, 1/m, above 0: to the left
  LineTable cant;         // sine of the track's roll, above 0: the left rail is the higher one
  LineTable gradient;     // rise per length of the line, the sine of its slope
  std::int32_t pieces;    // most pieces of a table between the ends of a vehicle
};
/// Most pieces of a table that a length of the line touches.
inline std::int32_t pieces_within(const LineTable& table, double length) noexcept {
  std::int32_t most = 1;
  for (std::int32_t first = 0, last = 0; first < table.rows; ++first) {
    while (last < table.rows &&
           table.value[std::ptrdiff_t{2} * last] <= table.value[std::ptrdiff_t{2} * first] + length)
      ++last;
    if (last - first + 1 > most) most = last - first + 1;
  }
  return most;
}

inline bool is_there(const DesignLine& line) noexcept {
  return line.curvature.rows > 0 || line.cant.rows > 0 || line.gradient.rows > 0;
}

}  // namespace railstep
