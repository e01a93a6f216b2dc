#include "online/contact/newton.h"

namespace railstep {

namespace {

constexpr double kLeastPivot = 1e-12;  // of the largest number of its row

/// A = I - Y J.
void fill(const NewtonProblem& p, const NewtonPoint& at, double* A) noexcept {
  const int n = p.n;
  const double* slope = at.slope;
  for (int b = 0; b < p.blocks; ++b) {
    const LawBlock& own = p.block[b];
    for (int i = 0; i < n; ++i) {
      const double* y = p.Y + i * n + own.first;
      double* const row = A + i * n + own.first;
      for (int k = 0; k < own.size; ++k) {
        double sum = 0.;
        for (int m = 0; m < own.size; ++m) sum += y[m] * slope[m * own.size + k];
        row[k] = -sum;
      }
    }
    slope += own.size * own.size;
  }
  for (int i = 0; i < n; ++i) A[i * n + i] += 1.;
}

/// Solves A x = b in place. @returns false where a pivot is too small; b is then meaningless
bool eliminate(double* A, double* b, int n) noexcept {
  double least[kMostNewton];
  for (int i = 0; i < n; ++i) {
    double largest = 0.;
    for (int k = 0; k < n; ++k) {
      const double size = std::fabs(A[i * n + k]);
      largest = size > largest ? size : largest;
    }
    least[i] = kLeastPivot * largest;
  }
  for (int j = 0; j < n; ++j) {
    const double* pivot = A + j * n;
    if (!(pivot[j] > least[j])) return false;
    const double inverse = 1. / pivot[j];
    for (int i = j + 1; i < n; ++i) {
      double* const row = A + i * n;
      const double factor = row[j] * inverse;
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

void find_missed(const NewtonProblem& p, NewtonPoint& at) noexcept {
  at.residual = 0.;
  for (int i = 0; i < p.n; ++i) {
    double sum = 0., size = 0.;
    for (int j = 0; j < p.n; ++j) {
      const double part = p.Y[i * p.n + j] * at.force[j];
      sum += part;
      size += std::fabs(part);
    }
    at.missed[i] = at.z[i] - (p.z_free[i] + sum);
    size += std::fabs(at.z[i]) + std::fabs(p.z_free[i]);
    const double missed = std::fabs(at.missed[i]);
    // Not a comparison of quotients: a coordinate that is 0 in all terms misses nothing.
    if (!(missed <= at.residual * size)) at.residual = missed / size;
  }
}

bool newton_step(const NewtonProblem& p, const NewtonPoint& at, double* step) noexcept {
  double A[kMostNewton * kMostNewton];
  fill(p, at, A);
  for (int i = 0; i < p.n; ++i) step[i] = -at.missed[i];
  if (eliminate(A, step, p.n)) return true;
  step_alone(p, at, step);
  return false;
}

}  // namespace railstep
