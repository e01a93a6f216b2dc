#include "online/math/newton.h"

#include "online/math/dense.h"

namespace railstep {

namespace {

constexpr double kLeastPivot = 1e-12;  // of the largest number of the matrix

/// A = I - Y J.
void fill(const NewtonProblem& p, const NewtonPoint& at, double* A) noexcept {
  const int n = p.n;
  const double* slope = at.slope;
  for (int b = 0; b < p.blocks; ++b) {
    const LawBlock& own = p.block[b];
    for (int i = 0; i < n; ++i) {
      const double* y = p.Y + i * n + own.first;
      double* const row = A + i * n + own.first;
      for (int k = 0; k < own.size; ++k) row[k] = 0.;
      for (int m = 0; m < own.size; ++m)
#pragma omp simd
        for (int k = 0; k < own.size; ++k) row[k] -= y[m] * slope[m * own.size + k];
    }
    slope += own.size * own.size;
  }
  for (int i = 0; i < n; ++i) A[i * n + i] += 1.;
}

/// Solves A x = b in place, with row exchanges. The largest of equal pivots is the first one.
/// @returns false where a pivot is too small; b is then meaningless
bool eliminate(double* A, double* b, int n) noexcept {
  double largest = 0.;
  for (int i = 0; i < n * n; ++i) {
    const double size = std::fabs(A[i]);
    largest = size > largest ? size : largest;
  }
  for (int j = 0; j < n; ++j) {
    int best = j;
    for (int i = j + 1; i < n; ++i)
      if (std::fabs(A[i * n + j]) > std::fabs(A[best * n + j])) best = i;
    double* const pivot = A + j * n;
    if (best != j) {
      double* const other = A + best * n;
      for (int k = j; k < n; ++k) {
        const double kept = pivot[k];
        pivot[k] = other[k];
        other[k] = kept;
      }
      const double kept = b[j];
      b[j] = b[best];
      b[best] = kept;
    }
    if (!(std::fabs(pivot[j]) > kLeastPivot * largest)) return false;
    const double inverse = 1. / pivot[j];
    for (int i = j + 1; i < n; ++i) {
      double* const row = A + i * n;
      const double factor = row[j] * inverse;
#pragma omp simd
      for (int k = j + 1; k < n; ++k) row[k] -= factor * pivot[k];
      b[i] -= factor * b[j];
    }
  }
  for (int j = n - 1; j >= 0; --j) {
    for (int k = j + 1; k < n; ++k) b[j] -= A[j * n + k] * b[k];
    b[j] /= A[j * n + j];
  }
  return true;
}

/// The step of each coordinate by itself. A law that falls faster than its part gives way stands.
void step_alone(const NewtonProblem& p, const NewtonPoint& at, double* step) noexcept {
  const double* slope = at.slope;
  for (int b = 0; b < p.blocks; ++b) {
    const LawBlock& own = p.block[b];
    for (int k = 0; k < own.size; ++k) {
      const int i = own.first + k;
      const double pivot = 1. - p.Y[i * p.n + i] * slope[k * own.size + k];
      step[i] = -at.missed[i] / (pivot > 1. ? pivot : 1.);
    }
    slope += own.size * own.size;
  }
}

}  // namespace

bool is_usable(const NewtonProblem& p, const double* force) noexcept {
  if (p.n < 0 || p.n > kMostNewton) return false;
  int end = 0;
  for (int b = 0; b < p.blocks; ++b) {
    if (p.block[b].first != end || p.block[b].size < 1 || p.block[b].size > kMostLaw) return false;
    end += p.block[b].size;
    if (end > p.n) return false;
  }
  if (end != p.n) return false;
  for (int i = 0; i < p.n; ++i) {
    if (!std::isfinite(p.z_free[i]) || !std::isfinite(force[i])) return false;
    for (int j = 0; j < p.n; ++j)
      if (!std::isfinite(p.Y[i * p.n + j])) return false;
  }
  return true;
}

void find_roots(const NewtonProblem& p, double* root) noexcept {
  for (int i = 0; i < p.n; ++i) {
    const double own = p.Y[i * p.n + i];
    root[i] = own > 0. ? std::sqrt(own) : 0.;
  }
}

void find_missed(const NewtonProblem& p, const double* root, NewtonPoint& at) noexcept {
  double moved[kMostNewton], most = 0.;
  for (int i = 0; i < p.n; ++i) {
    moved[i] = p.z_free[i];
    const double own = std::fabs(at.force[i]) * root[i];
    most = own > most ? own : most;
  }
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

bool newton_step(const NewtonProblem& p, const double* root, const NewtonPoint& at,
                 double* step) noexcept {
  double* const A = p.scratch;
  fill(p, at, A);
  // Coordinates over the roots have one unit, so that pivots can be compared.
  double unit[kMostNewton];
  for (int i = 0; i < p.n; ++i) unit[i] = root[i] > 0. ? root[i] : 1.;
  for (int i = 0; i < p.n; ++i) {
    const double inverse = 1. / unit[i];
    step[i] = -at.missed[i] * inverse;
#pragma omp simd
    for (int k = 0; k < p.n; ++k) A[i * p.n + k] *= inverse * unit[k];
  }
  if (eliminate(A, step, p.n)) {
    // A coordinate that does not give way goes where it is free, without rounding.
    for (int i = 0; i < p.n; ++i) step[i] = root[i] > 0. ? step[i] * unit[i] : -at.missed[i];
    return true;
  }
  step_alone(p, at, step);
  return false;
}

}  // namespace railstep
