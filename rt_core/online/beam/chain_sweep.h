#pragma once
#include "online/beam/chain_layout.h"

namespace RAILSTEP_KERNELS::chained {

// Substitution through one node, over a number type T whose lanes are right-hand sides or elements.
// entry(k, j) is row k, column j of the node's rows in the factor.

/// y := L^-1 y of a node.
template <int W, class T, class Entry>
[[gnu::always_inline]] inline void substitute(const Entry& entry, T* y) noexcept {
  unrolled<W>([&](auto k) __attribute__((always_inline)) {
    unrolled<k>([&](auto j) __attribute__((always_inline)) { y[k] -= entry(j, k) * y[j]; });
  });
}

/// An unknown of another node less what the node's y takes.
template <int W, class T, class Entry>
[[gnu::always_inline]] inline T less_taken(const Entry& entry, int column, const T* y,
                                           T unknown) noexcept {
  unrolled<W>([&](auto k) __attribute__((always_inline)) { unknown -= entry(k, column) * y[k]; });
  return unknown;
}

/// y := D^-1 y.
template <int W, class T, class Entry>
[[gnu::always_inline]] inline void scale(const Entry& entry, T* y) noexcept {
  unrolled<W>([&](auto k) __attribute__((always_inline)) { y[k] *= entry(k, k); });
}

/// y less an unknown of another node, whose column this is.
template <int W, class T, class Entry>
[[gnu::always_inline]] inline void take_back(const Entry& entry, int column, const T& unknown,
                                             T* y) noexcept {
  unrolled<W>([&](auto k) __attribute__((always_inline)) { y[k] -= entry(k, column) * unknown; });
}

/// y := L'^-1 y of a node; what is known last is taken last, so that little waits for it.
template <int W, class T, class Entry>
[[gnu::always_inline]] inline void substitute_back(const Entry& entry, T* y) noexcept {
  unrolled<W>([&](auto up) __attribute__((always_inline)) {
    constexpr int k = W - 1 - up;
    unrolled<up>([&](auto c) __attribute__((always_inline)) {
      constexpr int j = W - 1 - c;
      y[k] -= entry(k, j) * y[j];
    });
  });
}

}  // namespace RAILSTEP_KERNELS::chained
