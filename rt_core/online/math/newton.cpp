#include "online/math/newton.h"

#include "online/math/dense.h"
#include "online/math/lanes.h"

namespace railstep {

namespace {

constexpr double kLeastPivot = 1e-12;  // of the largest number of the matrix

/// y += sum of factors times rows [n], four at a time.
void add_rows(const double* const* row, const double* factor, int count, int n,
              double* __restrict y) noexcept {
  int m = 0;
  for (; m + 4 <= count; m += 4) {
    const double *a = row[m], *b = row[m + 1], *c = row[m + 2], *d = row[m + 3];
    const double f0 = factor[m], f1 = factor[m + 1], f2 = factor[m + 2], f3 = factor[m + 3];
#pragma omp simd
    for (int i = 0; i < n; ++i) y[i] = (((y[i] + f0 * a[i]) + f1 * b[i]) + f2 * c[i]) + f3 * d[i];
  }
  for (; m < count; ++m) {
    const double* const own = row[m];
    const double by = factor[m];
#pragma omp simd
    for (int i = 0; i < n; ++i) y[i] += by * own[i];
  }
}

/// Y B, column by column, [ranks][n]. Most forces do not act on all coordinates of their law.
void spread_through(const NewtonProblem& p, NewtonSlopes& s) noexcept {
  const double* spread = s.spread;
  double* column = s.moved;
  for (int b = 0; b < p.blocks; ++b) {
    const LawBlock& own = p.block[b];
    for (int k = 0; k < own.rank; ++k, column += p.n) {
      const double* row[kMostLaw];
      double factor[kMostLaw];
      int count = 0;
      for (int m = 0; m < own.size; ++m) {
        if (spread[m * own.rank + k] == 0.) continue;
        row[count] = p.Y + (own.first + m) * p.n;
        factor[count++] = spread[m * own.rank + k];
      }
      for (int i = 0; i < p.n; ++i) column[i] = 0.;
      add_rows(row, factor, count, p.n, column);
    }
    spread += own.size * own.rank;
  }
}

/// Rows of one law in I - S Y B, without I.
/// @param slope   [rank][size]
/// @param factor  the first of these rows in the first of `ranks` columns
template <int rank>
void fill_rows(const NewtonProblem& p, const LawBlock& own, const double* slope,
               const NewtonSlopes& s, double* factor) noexcept {
  double across[kMostLaw][rank];
  for (int k = 0; k < rank; ++k)
    for (int m = 0; m < own.size; ++m) across[m][k] = slope[k * own.size + m];
  for (int j = 0; j < s.ranks; ++j) {
    const double* const moved = s.moved + j * p.n + own.first;
    double sum[rank] = {};
    for (int m = 0; m < own.size; ++m)
      for (int k = 0; k < rank; ++k) sum[k] -= across[m][k] * moved[m];
    for (int k = 0; k < rank; ++k) factor[j * s.ranks + k] = sum[k];
  }
}

/// I - S Y B, [ranks][ranks], column by column.
void fill(const NewtonProblem& p, NewtonSlopes& s) noexcept {
  constexpr int kAtOnce = 6;  // three forces of two wheels
  const double* slope = s.slope;
  double* factor = s.factor;
  for (int b = 0; b < p.blocks; ++b) {
    const LawBlock& own = p.block[b];
    int k = 0;
    for (; k + kAtOnce <= own.rank; k += kAtOnce)
      fill_rows<kAtOnce>(p, own, slope + k * own.size, s, factor + k);
    for (; k < own.rank; ++k) fill_rows<1>(p, own, slope + k * own.size, s, factor + k);
    slope += own.size * own.rank;
    factor += own.rank;
  }
  for (int i = 0; i < s.ranks; ++i) s.factor[i * s.ranks + i] += 1.;
}

/// Largest absolute value, by lanes that do not wait for each other.
double largest_of(const double* x, int n) noexcept {
  double most[kLanes] = {};
  int i = 0;
  for (; i + kLanes <= n; i += kLanes) {
#pragma omp simd
    for (int l = 0; l < kLanes; ++l) {
      const double size = std::fabs(x[i + l]);
      most[l] = size > most[l] ? size : most[l];
    }
  }
  for (; i < n; ++i) most[0] = std::fabs(x[i]) > most[0] ? std::fabs(x[i]) : most[0];
  for (int l = 1; l < kLanes; ++l) most[0] = most[l] > most[0] ? most[l] : most[0];
  return most[0];
}

/// L U = A in place, with row exchanges; the diagonal then has the inverse pivots. The largest of
/// equal pivots is the first one.
/// @param A  [n][n] column by column
/// @param exchange  [n] out: row that took the place of each
/// @returns false where a pivot is too small
bool eliminate(double* A, int* exchange, int n) noexcept {
  const double largest = largest_of(A, n * n);
  for (int j = 0; j < n; ++j) {
    int best = j;
    double* const pivot = A + j * n;
    for (int i = j + 1; i < n; ++i)
      if (std::fabs(pivot[i]) > std::fabs(pivot[best])) best = i;
    exchange[j] = best;
    for (int k = 0; best != j && k < n; ++k) {
      const double kept = A[k * n + j];
      A[k * n + j] = A[k * n + best];
      A[k * n + best] = kept;
    }
    if (!(std::fabs(pivot[j]) > kLeastPivot * largest)) return false;
    pivot[j] = 1. / pivot[j];
    for (int i = j + 1; i < n; ++i) pivot[i] *= pivot[j];
    for (int k = j + 1; k < n; ++k) {
      double* const column = A + k * n;
      const double factor = column[j];
#pragma omp simd
      for (int i = j + 1; i < n; ++i) column[i] -= pivot[i] * factor;
    }
  }
  return true;
}

/// Solves L U x = b in place, by columns, whose sums do not wait for each other.
void substitute(const double* A, const int* exchange, double* b, int n) noexcept {
  for (int j = 0; j < n; ++j) {
    const double kept = b[exchange[j]];
    b[exchange[j]] = b[j];
    b[j] = kept;
  }
  for (int j = 0; j < n; ++j) {
    const double* const column = A + j * n;
    const double own = b[j];
#pragma omp simd
    for (int i = j + 1; i < n; ++i) b[i] -= column[i] * own;
  }
  for (int j = n - 1; j >= 0; --j) {
    const double* const column = A + j * n;
    const double own = b[j] *= column[j];
#pragma omp simd
    for (int i = 0; i < j; ++i) b[i] -= column[i] * own;
  }
}

/// Takes the solution of (I - A) t = b to that of (I - D A) t = D b, A = S Y B and D the changes of
/// the slopes of its scalars. With t = D x it is (I - A) x = b - A (I - D) x, whose right-hand side
/// follows the last x. Each pass leaves as much of the error as slopes changed.
/// @param rest  [ranks] scratch
void take_changes(const NewtonSlopes& s, const double* steep, double* rest, double* t) noexcept {
  const int n = s.ranks;
  double x[kMostNewton], change[kMostNewton];
  bool changed = false;
  for (int i = 0; i < n; ++i) {
    change[i] = s.steep[i] > 0. ? steep[i] / s.steep[i] : 1.;
    changed = changed || change[i] != 1.;
  }
  if (!changed) return;
  for (int i = 0; i < n; ++i) x[i] = t[i];
  for (int pass = 0; pass < kChangePasses; ++pass) {
    for (int i = 0; i < n; ++i) rest[i] = (1. - change[i]) * x[i];
    for (int i = 0; i < n; ++i) x[i] = t[i] + rest[i];
    substitute(s.factor, s.exchange, rest, n);
    for (int i = 0; i < n; ++i) x[i] -= rest[i];
  }
  for (int i = 0; i < n; ++i) t[i] = change[i] * x[i];
}

/// The step of each coordinate by itself. A law that falls faster than its part gives way stands.
void step_alone(const NewtonProblem& p, const NewtonSlopes& s, const double* missed,
                double* step) noexcept {
  std::ptrdiff_t passed = 0;
  for (int b = 0; b < p.blocks; ++b) {
    const LawBlock& own = p.block[b];
    const double *spread = s.spread + passed, *slope = s.slope + passed;
    for (int k = 0; k < own.size; ++k) {
      const int i = own.first + k;
      double own_slope = 0.;
      for (int m = 0; m < own.rank; ++m)
        own_slope += spread[k * own.rank + m] * slope[m * own.size + k];
      const double pivot = 1. - p.Y[i * p.n + i] * own_slope;
      step[i] = -missed[i] / (pivot > 1. ? pivot : 1.);
    }
    passed += std::ptrdiff_t{own.size} * own.rank;
  }
}

}  // namespace

bool is_usable(const NewtonProblem& p, const double* force) noexcept {
  if (p.n < 0 || p.n > kMostNewton) return false;
  int end = 0;
  for (int b = 0; b < p.blocks; ++b) {
    if (p.block[b].first != end || p.block[b].size < 1 || p.block[b].size > kMostLaw) return false;
    if (p.block[b].rank < 1 || p.block[b].rank > p.block[b].size) return false;
    end += p.block[b].size;
    if (end > p.n) return false;
  }
  if (end != p.n) return false;
  // 0 times an infinity or NaN is NaN, and so is every sum with it.
  double sum[kLanes] = {};
  for (int i = 0; i < p.n; ++i) sum[0] += 0. * p.z_free[i] + 0. * force[i];
  const int all = p.n * p.n;
  int k = 0;
  for (; k + kLanes <= all; k += kLanes) {
#pragma omp simd
    for (int l = 0; l < kLanes; ++l) sum[l] += 0. * p.Y[k + l];
  }
  for (; k < all; ++k) sum[1] += 0. * p.Y[k];
  return lane_sum(sum) == 0.;
}

void find_roots(const NewtonProblem& p, double* root) noexcept {
  for (int i = 0; i < p.n; ++i) {
    const double own = p.diagonal != nullptr ? p.diagonal[i] : p.Y[i * p.n + i];
    root[i] = own > 0. ? std::sqrt(own) : 0.;
  }
}

void find_missed(const NewtonProblem& p, const double* root, NewtonPoint& at) noexcept {
  double moved[kMostNewton];
  for (int i = 0; i < p.n; ++i) {
    moved[i] = p.z_free[i];
    at.missed[i] = at.force[i] * root[i];
  }
  const double most = largest_of(at.missed, p.n);
  symmetric_multiply_add(p.Y, at.force, moved, p.n);
  at.residual = 0.;
  for (int i = 0; i < p.n; ++i) {
    at.missed[i] = at.z[i] - moved[i];
    const double size = (std::fabs(at.z[i]) + std::fabs(p.z_free[i])) + root[i] * most;
    const double missed = std::fabs(at.missed[i]);
    // Not a comparison of quotients: a coordinate that is 0 in all terms misses nothing.
    if (!(missed <= at.residual * size)) at.residual = missed / size;
  }
}

void place_slopes(const NewtonProblem& p, NewtonSlopes& slopes) noexcept {
  std::ptrdiff_t blocks = 0;
  slopes.ranks = 0;
  for (int b = 0; b < p.blocks; ++b) {
    slopes.ranks += p.block[b].rank;
    blocks += std::ptrdiff_t{p.block[b].size} * p.block[b].rank;
  }
  slopes.spread = p.scratch;
  slopes.slope = slopes.spread + blocks;
  slopes.moved = slopes.slope + blocks;
  slopes.factor = slopes.moved + p.n * slopes.ranks;
}

void factor_slopes(const NewtonProblem& p, NewtonSlopes& slopes) noexcept {
  spread_through(p, slopes);
  fill(p, slopes);
  slopes.solvable = eliminate(slopes.factor, slopes.exchange, slopes.ranks);
}

void newton_step(const NewtonProblem& p, const NewtonSlopes& slopes, const NewtonPoint& at,
                 double* step) noexcept {
  if (!slopes.solvable) return step_alone(p, slopes, at.missed, step);
  double t[kMostNewton];
  const double* slope = slopes.slope;
  int row = 0;
  for (int b = 0; b < p.blocks; ++b) {
    const LawBlock& own = p.block[b];
    for (int k = 0; k < own.rank; ++k, ++row) {
      t[row] = 0.;
      for (int m = 0; m < own.size; ++m) t[row] -= *slope++ * at.missed[own.first + m];
    }
  }
  substitute(slopes.factor, slopes.exchange, t, slopes.ranks);
  take_changes(slopes, at.steep, step, t);
  for (int i = 0; i < p.n; ++i) step[i] = -at.missed[i];
  columns_multiply_add(slopes.moved, t, step, p.n, slopes.ranks);
}

}  // namespace railstep
