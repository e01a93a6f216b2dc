#pragma once
#include "online/beam/chain_layout.h"

namespace RAILSTEP_KERNELS::chained {

// The end nodes of a chain whose mid nodes are condensed: block tridiagonal, one node after the
// other, a node's row as vectors of its own columns, the next node's and padding of 0. Vectors that
// the diagonal crosses carry numbers left of it that nobody reads.

/// Vectors that hold a row's own columns, and all of it.
template <int W>
inline constexpr int kOwnVectors = (W + kWide - 1) / kWide;
template <int W>
inline constexpr int kRowVectors = kChainRow<W> / kWide;

/// kWide columns of a row of the condensed elements, transposed from lanes to elements.
/// @param at  where a column is in the group's blocks, at(column); 0 beyond `columns`
template <class At>
[[gnu::always_inline]] inline void transposed(const double* S, int column, int columns,
                                              const At& at, Wide* of_lane) noexcept {
  unrolled<kWide>([&](auto c) __attribute__((always_inline)) {
    of_lane[c] = column + c < columns ? load(S + at(column + c)) : Wide{};
  });
  transpose(of_lane);
}

/// Adds the condensed elements `first` to `first` + `count` - 1 to their end nodes, of which each
/// sets the next one.
/// @param S      the group's blocks
/// @param nodes  the factor's end nodes
template <int W>
void add_condensed(int first, int count, const double* S, double* nodes) noexcept {
  using At = Layout<W>;
  for (int lane = 0; lane < count; lane += kWide) {
    double* node = nodes + (first + lane) * At::kNode;
    const int lanes = count - lane < kWide ? count - lane : kWide;
    unrolled<W>([&](auto i) __attribute__((always_inline)) {
      constexpr int diagonal = i / kWide;
      unrolled<kOwnVectors<W> - diagonal>([&](auto v) __attribute__((always_inline)) {
        constexpr int column = kWide * (diagonal + v);
        Wide of_lane[kWide];
        const auto last = [=](int j) { return At::tangent(kLastLast, i, j); };
        transposed(S + lane, column, W, last, of_lane);
        unrolled<kWide>([&](auto l) __attribute__((always_inline)) {
          if (l < lanes) store(of_lane[l], node + (l + 1) * At::kNode + At::kRow * i + column);
        });
      });
    });
    unrolled<W>([&](auto i) __attribute__((always_inline)) {
      constexpr int diagonal = i / kWide;
      unrolled<kRowVectors<W> - diagonal>([&](auto v) __attribute__((always_inline)) {
        constexpr int column = kWide * (diagonal + v);
        Wide of_lane[kWide];
        const auto both = [=](int j) {
          return j < W ? At::tangent(kFirstFirst, i, j) : At::tangent(kFirstLast, i, j - W);
        };
        transposed(S + lane, column, 2 * W, both, of_lane);
        unrolled<kWide>([&](auto l) __attribute__((always_inline)) {
          double* to = node + l * At::kNode + At::kRow * i + column;
          if (l < lanes)
            store(diagonal + v < kOwnVectors<W> ? load(to) + of_lane[l] : of_lane[l], to);
        });
      });
    });
  }
}

/// D L' of a node, a row of padding behind so that its next node's columns can be read as vectors.
template <int W>
struct EndRows {
  double of[W][kChainRow<W> + 4];
};

/// Row `kRow` of a node less `factor` times a row of D L', `from` its first number.
template <int kVectors>
[[gnu::always_inline]] inline void take(double factor, const double* from, Wide* sum) noexcept {
  unrolled<kVectors>([&](auto v) __attribute__((always_inline)) {
    sum[v] -= factor * load(from + kWide * v);
  });
}

/// Turns the rows of a node into those of L, kVectors of each: all of the row, or for the last node
/// its own columns. Each row loses first what the node before takes, then what the rows above take,
/// so that the wait for a row's pivot is filled with the work of the rows below.
/// @param before  D L' of the node before, whose rows of L are kNode doubles before; with kBefore
/// @param D       D L' of this node, overwritten
/// @returns how many pivots are not above 0
template <int W, int kVectors, bool kBefore>
int eliminate_node(double inverse_k, const EndRows<W>& before, double* node,
                   EndRows<W>& D) noexcept {
  constexpr int row = kChainRow<W>;
  int bad = 0;
  unrolled<W>([&](auto k) __attribute__((always_inline)) {
    constexpr int from = k / kWide, vectors = kVectors - from;
    double* L = node + row * k + kWide * from;
    Wide sum[vectors];
    unrolled<vectors>([&](auto v) __attribute__((always_inline)) { sum[v] = load(L + kWide * v); });
    if constexpr (kBefore)
      unrolled<W>([&](auto i) __attribute__((always_inline)) {
        const double factor = node[row * i + W + k - Layout<W>::kNode];
        take<kOwnVectors<W> - from>(factor, before.of[i] + W + kWide * from, sum);
      });
    unrolled<k>([&](auto i) __attribute__((always_inline)) {
      take<vectors>(node[row * i + k], D.of[i] + kWide * from, sum);
    });
    const double pivot = sum[0][k % kWide], inverse = 1. / pivot;
    bad += pivot > 0. ? 0 : 1;
    unrolled<vectors>([&](auto v) __attribute__((always_inline)) {
      store(sum[v], D.of[k] + kWide * (from + v));
      store(sum[v] * inverse, L + kWide * v);
    });
    node[row * k + k] = inverse * inverse_k;
  });
  return bad;
}

/// The end nodes as they come, each with D L' of the one before.
template <int W>
class EndNodes {
 public:
  EndNodes(double* nodes, double inverse_k) noexcept : nodes_(nodes), inverse_k_(inverse_k) {
    for (long i = 0; i < Layout<W>::kNode; ++i) nodes[i] = 0.;
    for (EndRows<W>& D : rows_)
      for (double(&row)[kChainRow<W> + 4] : D.of)
        for (int c = kChainRow<W>; c < kChainRow<W> + 4; ++c) row[c] = 0.;
  }
  /// @returns how many pivots are not above 0
  int eliminate(int node) noexcept {
    double* at = nodes_ + node * Layout<W>::kNode;
    const EndRows<W>& before = rows_[(node + 1) % 2];
    return node == 0
               ? eliminate_node<W, kRowVectors<W>, false>(inverse_k_, before, at, rows_[0])
               : eliminate_node<W, kRowVectors<W>, true>(inverse_k_, before, at, rows_[node % 2]);
  }
  int eliminate_last(int node) noexcept {
    return eliminate_node<W, kOwnVectors<W>, true>(
        inverse_k_, rows_[(node + 1) % 2], nodes_ + node * Layout<W>::kNode, rows_[node % 2]);
  }

 private:
  double* nodes_;
  double inverse_k_;
  EndRows<W> rows_[2];
};

}  // namespace RAILSTEP_KERNELS::chained
