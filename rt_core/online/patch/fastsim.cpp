#include "online/patch/fastsim.h"

#include <cmath>

#include "online/math/pi.h"
#include "online/math/scalar.h"

namespace railstep {

namespace {

/// Values of all strips side by side.
struct Strips {
  double across[kMostStrips];  // over b
  double edge[kMostStrips], step[kMostStrips];
  // Stresses at the present cells, sums of them along the strips, and their derivatives over the
  // creepages: x along the rail, y across.
  double x[kMostStrips], y[kMostStrips];
  double x_slope[3][kMostStrips], y_slope[3][kMostStrips];
  double sum[2][kMostStrips], sum_slope[2][3][kMostStrips];
};

/// Inverse flexibilities, N/m3, and the largest limit of the stress, N/m2.
struct Stiffness {
  double along, across, spin, highest;
};

Stiffness stiffness_of(const CreepPatch& p) noexcept {
  const double a = p.half_length, b = p.half_width;
  return {3. * p.shear * p.kalker.c11 / (8. * a), 3. * p.shear * p.kalker.c22 / (8. * a),
          4. * p.shear * p.kalker.c23 / (kPi * a * square_root(a / b)),
          2. * p.limit / (kPi * a * b)};
}

template <CreepWanted wanted>
void begin(const CreepPatch& p, int strips, Strips& s) noexcept {
  for (int j = 0; j < strips; ++j) {
    s.across[j] = (2. * j + 1.) / strips - 1.;
    s.edge[j] = p.half_length * square_root(1. - s.across[j] * s.across[j]);
    s.step[j] = 2. * s.edge[j] / strips;
    s.x[j] = s.y[j] = s.sum[0][j] = s.sum[1][j] = 0.;
    for (int k = 0; k < (wanted == CreepWanted::slopes ? 3 : 0); ++k)
      s.x_slope[k][j] = s.y_slope[k][j] = s.sum_slope[0][k][j] = s.sum_slope[1][k][j] = 0.;
  }
}

/// One cell of each strip, from the leading edge on. @param part  of a cell that the step is long
template <CreepWanted wanted>
void roll(const CreepPatch& p, const Stiffness& of, const Creepages<double>& c, int cell,
          double part, int strips, Strips& s) noexcept {
  const double per_length = 1. / p.half_length;
#pragma omp simd
  for (int j = 0; j < strips; ++j) {
    const double at = s.edge[j] - (cell + .5) * s.step[j];
    const double length = part * s.step[j], middle = at + .5 * length;
    const double by_place = of.spin * p.half_width * s.across[j], by_middle = of.spin * middle;
    double x = s.x[j] - length * (of.along * c.along - by_place * c.spin);
    double y = s.y[j] - length * (of.across * c.across + by_middle * c.spin);
    const double over = at * per_length;
    const double bound = of.highest * (1. - over * over - s.across[j] * s.across[j]);
    const double square = x * x + y * y;
    const bool slides = square > bound * bound;
    const double inverse = 1. / square_root(slides ? square : 1.);
    const double cut = slides ? bound * inverse : 1.;
    s.x[j] = x * cut;
    s.y[j] = y * cut;
    s.sum[0][j] += x * cut;
    s.sum[1][j] += y * cut;
    if constexpr (wanted == CreepWanted::slopes) {
      double x0 = s.x_slope[0][j] - length * of.along, y0 = s.y_slope[0][j];
      double x1 = s.x_slope[1][j], y1 = s.y_slope[1][j] - length * of.across;
      double x2 = s.x_slope[2][j] + length * by_place, y2 = s.y_slope[2][j] - length * by_middle;
      // A stress that is cut keeps its direction: its derivatives lose what lies along it.
      const double along_x = slides ? x * inverse : 0., along_y = slides ? y * inverse : 0.;
      const double d0 = along_x * x0 + along_y * y0, d1 = along_x * x1 + along_y * y1,
                   d2 = along_x * x2 + along_y * y2;
      s.x_slope[0][j] = x0 = cut * (x0 - along_x * d0);
      s.x_slope[1][j] = x1 = cut * (x1 - along_x * d1);
      s.x_slope[2][j] = x2 = cut * (x2 - along_x * d2);
      s.y_slope[0][j] = y0 = cut * (y0 - along_y * d0);
      s.y_slope[1][j] = y1 = cut * (y1 - along_y * d1);
      s.y_slope[2][j] = y2 = cut * (y2 - along_y * d2);
      s.sum_slope[0][0][j] += x0;
      s.sum_slope[0][1][j] += x1;
      s.sum_slope[0][2][j] += x2;
      s.sum_slope[1][0][j] += y0;
      s.sum_slope[1][1][j] += y1;
      s.sum_slope[1][2][j] += y2;
    }
  }
}

template <CreepWanted wanted>
CreepForce roll_over(const CreepPatch& patch, const Creepages<double>& creepages,
                     int strips) noexcept {
  Strips s;
  begin<wanted>(patch, strips, s);
  const Stiffness of = stiffness_of(patch);
  for (int cell = 0; cell < strips; ++cell)
    roll<wanted>(patch, of, creepages, cell, cell == 0 ? .5 : 1., strips, s);
  CreepForce found{};
  const double width = 2. * patch.half_width / strips;
  for (int j = 0; j < strips; ++j) {
    const double area = width * s.step[j];
    found.x += area * s.sum[0][j];
    found.y += area * s.sum[1][j];
    for (int k = 0; k < (wanted == CreepWanted::slopes ? 3 : 0); ++k) {
      found.slope[0][k] += area * s.sum_slope[0][k][j];
      found.slope[1][k] += area * s.sum_slope[1][k][j];
    }
  }
  return found;
}

}  // namespace

CreepForce fastsim(const CreepPatch& patch, const Creepages<double>& creepages, int strips,
                   CreepWanted wanted) noexcept {
  return wanted == CreepWanted::force ? roll_over<CreepWanted::force>(patch, creepages, strips)
                                      : roll_over<CreepWanted::slopes>(patch, creepages, strips);
}

}  // namespace railstep
