#include "online/patch/kalker.h"

namespace railstep {

namespace {

constexpr int kRows = 19;
constexpr double kRatio[kRows] = {.1,      .2,      .3,      .4,      .5, .6,  .7,      .8, .9, 1.,
                                  1. / .9, 1. / .8, 1. / .7, 1. / .6, 2., 2.5, 1. / .3, 5., 10.};
constexpr double kC11[2][kRows] = {
    {3.31, 3.37, 3.44, 3.53, 3.62, 3.72, 3.81, 3.91, 4.01, 4.12, 4.22, 4.36, 4.54, 4.78, 5.10, 5.57,
     6.34, 7.78, 11.7},
    {3.520, 3.571, 3.635, 3.709, 3.800, 3.896, 3.987, 4.075, 4.173, 4.269, 4.376, 4.512, 4.688,
     4.925, 5.240, 5.717, 6.483, 7.952, 11.909}};
constexpr double kC22[2][kRows] = {
    {2.52, 2.63, 2.75, 2.88, 3.01, 3.14, 3.28, 3.41, 3.54, 3.67, 3.81, 3.99, 4.21, 4.50, 4.90, 5.48,
     6.40, 8.14, 12.8},
    {2.513, 2.626, 2.749, 2.883, 3.019, 3.165, 3.301, 3.437, 3.573, 3.709, 3.853, 4.040, 4.277,
     4.587, 5.003, 5.616, 6.589, 8.435, 13.384}};
constexpr double kC23[2][kRows] = {
    {.473, .603, .715, .823, .929, 1.03, 1.14, 1.25, 1.36, 1.47, 1.59, 1.75, 1.95, 2.23, 2.62, 3.24,
     4.32, 6.63, 14.6},
    {.5045, .6309, .7371, .8409, .9449, 1.056, 1.162, 1.268, 1.379, 1.488, 1.615, 1.772, 1.984,
     2.268, 2.673, 3.309, 4.424, 6.828, 15.08}};
constexpr double kC33[kRows] = {8.28, 4.27, 2.96, 2.32, 1.93, 1.68, 1.50, 1.37, 1.27, 1.19,
                                1.11, 1.04, .965, .892, .819, .747, .674, .601, .526};

/// (r - 1) / (r + 1): ratios from 0 to infinity become -1 to 1, and r and 1/r opposite numbers.
double place_of(double ratio) noexcept { return (ratio - 1.) / (ratio + 1.); }

/// Weights of four rows at a ratio, by Lagrange's polynomials in place_of().
struct Rows {
  int first;
  double weight[4];
};

Rows rows_at(double ratio) noexcept {
  int above = 2;  // the first row beyond the ratio
  while (above < kRows - 2 && kRatio[above] < ratio) ++above;
  Rows rows{above - 2, {}};
  const double t = place_of(ratio);
  for (int i = 0; i < 4; ++i) {
    const double own = place_of(kRatio[rows.first + i]);
    rows.weight[i] = 1.;
    for (int j = 0; j < 4; ++j) {
      if (i == j) continue;
      const double other = place_of(kRatio[rows.first + j]);
      rows.weight[i] *= (t - other) / (own - other);
    }
  }
  return rows;
}

/// Coefficients grow with the ratio as 1 + ratio; what is left of them is flat.
double interpolated(const double* table, const Rows& rows, double ratio) noexcept {
  double sum = 0.;
  for (int i = 0; i < 4; ++i)
    sum += rows.weight[i] * table[rows.first + i] / (1. + kRatio[rows.first + i]);
  return sum * (1. + ratio);
}

/// c33 falls with the ratio as 1 + 1/ratio.
double interpolated_fall(const double* table, const Rows& rows, double ratio) noexcept {
  double sum = 0.;
  for (int i = 0; i < 4; ++i)
    sum += rows.weight[i] * table[rows.first + i] / (1. + 1. / kRatio[rows.first + i]);
  return sum * (1. + 1. / ratio);
}

double within(double x, double low, double high) noexcept {
  return x < low ? low : x > high ? high : x;
}

}  // namespace

Kalker kalker(double ratio, double poisson) noexcept {
  const double r = within(ratio, kRatio[0], kRatio[kRows - 1]);
  const double part = within((poisson - .25) / .05, 0., 1.);
  const Rows rows = rows_at(r);
  const auto of = [&](const double(&table)[2][kRows]) {
    return (1. - part) * interpolated(table[0], rows, r) + part * interpolated(table[1], rows, r);
  };
  return {of(kC11), of(kC22), of(kC23), interpolated_fall(kC33, rows, r)};
}

}  // namespace railstep
