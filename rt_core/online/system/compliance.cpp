#include "online/system/compliance.h"

#include <cstddef>

#include "online/math/scalar.h"

namespace railstep {

namespace {

double* row(const Pivoted& f, std::int32_t i) noexcept {
  return f.matrix + static_cast<std::ptrdiff_t>(f.n) * i;
}

void swap(double& a, double& b) noexcept {
  const double t = a;
  a = b;
  b = t;
}

/// Exchanges rows and columns of places i and k, and the rows of L.
void exchange(const Pivoted& f, std::int32_t i, std::int32_t k) noexcept {
  if (i == k) return;
  for (std::int32_t c = 0; c < f.n; ++c) swap(row(f, i)[c], row(f, k)[c]);
  for (std::int32_t r = 0; r < f.n; ++r) swap(row(f, r)[i], row(f, r)[k]);
  swap(f.scale[i], f.scale[k]);
  const std::int32_t t = f.order[i];
  f.order[i] = f.order[k];
  f.order[k] = t;
}

/// The place, from k to the end of the leading rows, with most left of its own diagonal.
std::int32_t largest(const Pivoted& f, std::int32_t k) noexcept {
  std::int32_t best = k;
  for (std::int32_t i = k + 1; i < f.leading; ++i)
    if (magnitude(row(f, i)[i]) * f.scale[best] > magnitude(row(f, best)[best]) * f.scale[i])
      best = i;
  return best;
}

/// Eliminates place k from all places after it.
void eliminate(const Pivoted& f, std::int32_t k) noexcept {
  const double* pivot = row(f, k);
  const double inverse = 1. / pivot[k];
  for (std::int32_t i = k + 1; i < f.n; ++i) {
    double* at = row(f, i);
    const double factor = at[k] * inverse;
    if (factor == 0.) continue;
#pragma omp simd
    for (std::int32_t c = k + 1; c < f.n; ++c) at[c] -= factor * pivot[c];
    at[k] = factor;
  }
}

bool used(const Pivoted& f, std::int32_t k, std::int32_t end) noexcept {
  return k < f.rank || (k >= f.leading && k < end);
}

}  // namespace

void factor_pivoted(Pivoted& f, double tolerance) noexcept {
  for (std::int32_t i = 0; i < f.n; ++i) {
    f.order[i] = i;
    f.scale[i] = magnitude(row(f, i)[i]);
  }
  f.rank = f.leading;
  for (std::int32_t k = 0; k < f.leading; ++k) {
    exchange(f, k, largest(f, k));
    if (magnitude(row(f, k)[k]) <= tolerance * f.scale[k]) {  // NaN does not reduce the rank
      f.rank = k;
      break;
    }
    eliminate(f, k);
  }
  for (std::int32_t k = f.leading; k < f.n; ++k) eliminate(f, k);
}

void solve_pivoted(const Pivoted& f, bool all, double* x, double* scratch) noexcept {
  const std::int32_t end = all ? f.n : f.leading;
  for (std::int32_t k = 0; k < f.n; ++k) scratch[k] = used(f, k, end) ? x[f.order[k]] : 0.;
  for (std::int32_t k = 0; k < end; ++k) {
    if (!used(f, k, end)) continue;
    for (std::int32_t c = 0; c < k; ++c) scratch[k] -= row(f, k)[c] * scratch[c];
  }
  for (std::int32_t k = end - 1; k >= 0; --k) {
    if (!used(f, k, end)) continue;
    for (std::int32_t i = k + 1; i < end; ++i) scratch[k] -= row(f, k)[i] * scratch[i];
    scratch[k] /= row(f, k)[k];
  }
  for (std::int32_t k = 0; k < f.n; ++k) x[f.order[k]] = scratch[k];
}

}  // namespace railstep
