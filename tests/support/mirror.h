#pragma once
#include <catch2/catch.hpp>

#include "offline/analysis/statics.h"

namespace railstep {

/// Compares a track in mirror coordinates with the same track without them, between points of both
/// rails.
inline void check_alike(const Statics& mirror, const Statics& general, const RailPoint& left,
                        const RailPoint& right) {
  const double own = mirror.flexibility(left, left), bound = 1e-8 * own;
  // Rounding of two factorisations with a condition of 1e7.
  const auto check = [&](const RailPoint& a, const RailPoint& b, double within) {
    CHECK_THAT(general.flexibility(a, b),
               Catch::Matchers::WithinAbs(mirror.flexibility(a, b), within));
  };
  check(left, left, bound);
  check(left, right, bound);
  check(right, right, 1e-8 * mirror.flexibility(right, right));
}

}  // namespace railstep
