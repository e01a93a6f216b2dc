#pragma once
#include <cstdint>

#include "online/math/finite.h"

namespace railstep {

// Checks of values that were read from a block.

inline bool within(const std::int32_t* values, std::int64_t n, std::int64_t least,
                   std::int64_t most) noexcept {
  for (std::int64_t i = 0; i < n; ++i)
    if (values[i] < least || values[i] > most) return false;
  return true;
}

inline bool are_above_zero(const double* values, std::int64_t n) noexcept {
  for (std::int64_t i = 0; i < n; ++i)
    if (!(values[i] > 0.)) return false;
  return true;
}

inline bool are_moderate(const double* values, std::int64_t n) noexcept {
  bool moderate = true;
  for (std::int64_t i = 0; i < n; ++i) moderate = moderate && is_moderate(values[i]);
  return moderate;
}
inline bool are_not_negative(const double* values, std::int64_t n) noexcept {
  for (std::int64_t i = 0; i < n; ++i)
    if (!(values[i] >= 0.)) return false;
  return true;
}

/// Whether the diagonal of a matrix [n][n] is above 0.
inline bool diagonal_is_above_zero(const double* matrix, std::int64_t n) noexcept {
  for (std::int64_t i = 0; i < n; ++i)
    if (!(matrix[i * n + i] > 0.)) return false;
  return true;
}

inline bool diagonal_is_not_negative(const double* matrix, std::int64_t n) noexcept {
  for (std::int64_t i = 0; i < n; ++i)
    if (!(matrix[i * n + i] >= 0.)) return false;
  return true;
}

}  // namespace railstep
