#pragma once
#include "online/beam/chain_layout.h"

namespace railstep::chained {

// The mid nodes of four elements, one in each lane: their pivots, their rows of L, and what is left
// to the elements' end nodes.

/// Pivot rows of the mid node, and its 2W columns of the end nodes; kWide lanes.
/// @param S       a group's blocks of S, from the first of these lanes
/// @param mid     the group's part of the factor, from the first of these lanes
/// @param pivots  D [W] and D L' in the columns of the ends [W][2W], for condense()
template <int W>
struct MidRows {
  Wide of[W][2 * W];

  /// Row k of D L': S less what the rows above take, then L' = D^-1 (D L').
  /// @returns lanes' counts of pivots that are not above 0
  [[gnu::always_inline]] void set(const double* S, double* mid, std::int64_t* bad) noexcept {
    using At = Layout<W>;
    Wide own[W][W];  // D L' among the mid node's unknowns
    unrolled<W>([&](auto k) __attribute__((always_inline)) {
      unrolled<W - k>([&](auto c) __attribute__((always_inline)) {
        constexpr int j = k + c;
        Wide sum = load(S + At::tangent(kMidMid, k, j));
        unrolled<k>([&](auto i) __attribute__((always_inline)) {
          sum -= own[i][k] * load(mid + At::mid(i, j));
        });
        own[k][j] = sum;
      });
      const Wide inverse = 1. / own[k][k];
      for (int lane = 0; lane < kWide; ++lane) bad[lane] += own[k][k][lane] > 0. ? 0 : 1;
      store(inverse, mid + At::mid(k, k));
      for (int j = k + 1; j < W; ++j) store(own[k][j] * inverse, mid + At::mid(k, j));
    });
    for (int c = 0; c < 2 * W; ++c)
      unrolled<W>([&](auto k) __attribute__((always_inline)) {
        Wide sum =
            load(S + (c < W ? At::tangent(kFirstMid, c, k) : At::tangent(kMidLast, k, c - W)));
        unrolled<k>([&](auto i) __attribute__((always_inline)) {
          sum -= load(mid + At::mid(i, k)) * of[i][c];
        });
        of[k][c] = sum;
      });
    for (int k = 0; k < W; ++k) {
      const Wide inverse = load(mid + At::mid(k, k));
      for (int c = 0; c < 2 * W; ++c) store(of[k][c] * inverse, mid + At::mid(k, W + c));
    }
  }
};

/// S of the end nodes less what the mid node takes: rows and columns of two of the blocks of W.
template <int W>
void condense_block(const MidRows<W>& rows, const double* mid, int pair, double* S) noexcept {
  using At = Layout<W>;
  const int left = pair == kLastLast ? W : 0, right = pair == kFirstFirst ? 0 : W;
  for (int i = 0; i < W; ++i)
    for (int j = pair == kFirstLast ? 0 : i; j < W; ++j) {
      double* at = S + At::tangent(pair, i, j);
      Wide sum = load(at);
      for (int k = 0; k < W; ++k)
        sum -= rows.of[k][left + i] * load(mid + At::mid(k, W + right + j));
      store(sum, at);
    }
}

/// Mid nodes of a group out of S.
/// @returns how many pivots of the first `count` lanes are not above 0
template <int W>
int condense_group(int count, double* S, double* factor) noexcept {
  std::int64_t bad[kStraightLanes] = {};
  for (int lane = 0; lane < kStraightLanes; lane += kWide) {
    MidRows<W> rows;
    rows.set(S + lane, factor + lane, bad + lane);
    condense_block<W>(rows, factor + lane, kFirstFirst, S + lane);
    condense_block<W>(rows, factor + lane, kFirstLast, S + lane);
    condense_block<W>(rows, factor + lane, kLastLast, S + lane);
  }
  int all = 0;
  for (int lane = 0; lane < count; ++lane) all += static_cast<int>(bad[lane]);
  return all;
}

}  // namespace railstep::chained
