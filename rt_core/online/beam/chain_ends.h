#pragma once
#include "online/beam/chain_layout.h"

namespace railstep::chained {

// The end nodes of a chain whose mid nodes are condensed: block tridiagonal, one node after the
// other, a node's row as vectors of its own columns, the next node's and padding of 0. Vectors that
// the diagonal crosses carry numbers left of it that nobody reads.

/// Vectors that hold a row's own columns, and all of it.
template <int W>
inline constexpr int kOwnVectors = (W + kWide - 1) / kWide;
template <int W>
inline constexpr int kRowVectors = kChainRow<W> / kWide;

/// kWide columns of a row of the condensed elements, turned from lanes to elements.
/// @param at  where a column is in the group's blocks, at(column); 0 beyond `columns`
template <class At>
[[gnu::always_inline]] inline void turned(const double* S, int column, int columns, const At& at,
                                          Wide* of_lane) noexcept {
  for (int c = 0; c < kWide; ++c)
    of_lane[c] = column + c < columns ? load(S + at(column + c)) : Wide{};
  transpose(of_lane);
}

/// Adds the condensed elements `first` to `first` + `count` - 1 to their end nodes, of which each
/// sets the next one.
/// @param S      the group's blocks
/// @param nodes  the factor's end nodes
template <int W>
void add_condensed(int first, int count, const double* S, double* nodes) noexcept {
  using At = Layout<W>;
  Wide of_lane[kWide];
  for (int lane = 0; lane < count; lane += kWide) {
    double* node = nodes + (first + lane) * At::kNode;
    const int lanes = count - lane < kWide ? count - lane : kWide;
    unrolled<W>([&](auto i) __attribute__((always_inline)) {
      constexpr int diagonal = i / kWide;
      unrolled<kOwnVectors<W> - diagonal>([&](auto v) __attribute__((always_inline)) {
        constexpr int column = kWide * (diagonal + v);
        const auto last = [=](int j) { return At::tangent(kLastLast, i, j); };
        turned(S + lane, column, W, last, of_lane);
        for (int l = 0; l < lanes; ++l)
          store(of_lane[l], node + (l + 1) * At::kNode + At::kRow * i + column);
      });
    });
    unrolled<W>([&](auto i) __attribute__((always_inline)) {
      constexpr int diagonal = i / kWide;
      unrolled<kRowVectors<W> - diagonal>([&](auto v) __attribute__((always_inline)) {
        constexpr int column = kWide * (diagonal + v);
        const auto both = [=](int j) {
          return j < W ? At::tangent(kFirstFirst, i, j) : At::tangent(kFirstLast, i, j - W);
        };
        turned(S + lane, column, 2 * W, both, of_lane);
        for (int l = 0; l < lanes; ++l) {
          double* to = node + l * At::kNode + At::kRow * i + column;
          store(diagonal + v < kOwnVectors<W> ? load(to) + of_lane[l] : of_lane[l], to);
        }
      });
    });
  }
}

/// A node's rows become those of L, kVectors of each: all of the row, or of the last node its own.
/// @param D    D L', [W][kChainRow<W> + kWide], overwritten
/// @returns how many pivots are not above 0
template <int W, int kVectors, int kStride>
[[gnu::always_inline]] inline int factor_rows(double inverse_k, double* node,
                                              double (*D)[kStride]) noexcept {
  constexpr int row = kChainRow<W>;
  int bad = 0;
  unrolled<W>([&](auto k) __attribute__((always_inline)) {
    constexpr int from = k / kWide, vectors = kVectors - from;
    double* L = node + row * k + kWide * from;
    Wide sum[vectors];
    unrolled<vectors>([&](auto v) __attribute__((always_inline)) { sum[v] = load(L + kWide * v); });
    unrolled<k>([&](auto i) __attribute__((always_inline)) {
      const double factor = node[row * i + k];
      unrolled<vectors>([&](auto v) __attribute__((always_inline)) {
        sum[v] -= factor * load(D[i] + kWide * (from + v));
      });
    });
    const double pivot = sum[0][k % kWide], inverse = 1. / pivot;
    bad += pivot > 0. ? 0 : 1;
    unrolled<vectors>([&](auto v) __attribute__((always_inline)) {
      store(sum[v], D[k] + kWide * (from + v));
      store(sum[v] * inverse, L + kWide * v);
    });
    node[row * k + k] = inverse * inverse_k;
  });
  return bad;
}

/// kRows rows of the next node, from `first` on, less what a node takes.
template <int W, int kFirst, int kRows, int kStride>
[[gnu::always_inline]] inline void take_rows(const double* node, const double (*D)[kStride],
                                             double* next) noexcept {
  constexpr int row = kChainRow<W>, from = kFirst / kWide, vectors = kOwnVectors<W> - from;
  Wide sum[kRows * vectors];
  double* to = next + row * kFirst + kWide * from;
  const auto each = [](const auto& entry) __attribute__((always_inline)) {
    unrolled<kRows * vectors>([&](auto c) __attribute__((always_inline)) {
      constexpr int i = c / vectors, v = c % vectors;
      entry(c, std::integral_constant<int, i>{}, std::integral_constant<int, v>{});
    });
  };
  each([&](auto c, auto i, auto v)
           __attribute__((always_inline)) { sum[c] = load(to + row * i + kWide * v); });
  for (int k = 0; k < W; ++k)
    each([&](auto c, auto i, auto v) __attribute__((always_inline)) {
      sum[c] -= node[row * k + W + kFirst + i] * load(D[k] + W + kWide * (from + v));
    });
  each([&](auto c, auto i, auto v)
           __attribute__((always_inline)) { store(sum[c], to + row * i + kWide * v); });
}

/// Eliminates a node: its rows become those of L, the next node's lose what it takes.
/// @returns how many pivots are not above 0
template <int W>
int eliminate_node(double inverse_k, double* node, double* next) noexcept {
  // The next node's columns as vectors reach beyond the row's padding.
  double D[W][kChainRow<W> + 4];
  for (int k = 0; k < W; ++k)
    for (int c = kChainRow<W>; c < kChainRow<W> + 4; ++c) D[k][c] = 0.;
  const int bad = factor_rows<W, kRowVectors<W>>(inverse_k, node, D);
  unrolled<(W + 2) / 3>([&](auto part) __attribute__((always_inline)) {
    take_rows<W, 3 * part, (W - 3 * part < 3 ? W - 3 * part : 3)>(node, D, next);
  });
  return bad;
}

template <int W>
int eliminate_last_node(double inverse_k, double* node) noexcept {
  double D[W][kChainRow<W> + 4];
  return factor_rows<W, kOwnVectors<W>>(inverse_k, node, D);
}

}  // namespace railstep::chained
