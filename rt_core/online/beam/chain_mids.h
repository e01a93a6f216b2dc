#pragma once
#include "online/beam/chain_layout.h"

namespace railstep::chained {

// The mid nodes of four elements, one in each lane: their pivots, their rows of L, and what is left
// to the elements' end nodes. Every entry is S less its terms in the order of the rows above;
// blocks and columns are taken in numbers that fit the processor's 16 vectors.

/// Rows of the mid node in kWide lanes: D L' in its own columns and in those of the two end nodes.
template <int W>
struct MidRows {
  using At = Layout<W>;
  Wide own[W][W], ends[W][2 * W];

  /// Pivots, and L' of the own columns. 1 / D is stored over k_factor.
  /// @param S    the group's blocks of S / k_factor, from the first of these lanes
  /// @param mid  the group's part of the factor, likewise
  /// @param bad  counts the lanes' pivots that are not above 0
  [[gnu::always_inline]] void set_own(const double* S, double inverse_k, double* mid,
                                      int* bad) noexcept {
    unrolled<W>([&](auto k) __attribute__((always_inline)) {
      Wide row[W];
      unrolled<W - k>([&](auto c) __attribute__((always_inline)) {
        row[k + c] = load(S + At::tangent(kMidMid, k, k + c));
      });
      unrolled<k>([&](auto i) __attribute__((always_inline)) {
        const Wide factor = load(mid + At::mid(i, k));
        unrolled<W - k>([&](auto c) __attribute__((always_inline)) {
          row[k + c] -= factor * own[i][k + c];
        });
      });
      const Wide inverse = 1. / row[k];
      for (int lane = 0; lane < kWide; ++lane) bad[lane] += row[k][lane] > 0. ? 0 : 1;
      store(inverse * inverse_k, mid + At::mid(k, k));
      pivot[k] = inverse;
      unrolled<W - 1 - k>([&](auto c) __attribute__((always_inline)) {
        constexpr int j = k + 1 + c;
        own[k][j] = row[j];
        store(row[j] * inverse, mid + At::mid(k, j));
      });
    });
  }

  /// kCount columns of the end nodes from `first` on.
  template <int kCount>
  [[gnu::always_inline]] void set_columns(const double* S, int first, double* mid) noexcept {
    unrolled<W>([&](auto k) __attribute__((always_inline)) {
      Wide row[kCount];
      unrolled<kCount>([&](auto c) __attribute__((always_inline)) {
        row[c] = load(S + (first < W ? At::tangent(kFirstMid, first + c, k)
                                     : At::tangent(kMidLast, k, first + c - W)));
      });
      unrolled<k>([&](auto i) __attribute__((always_inline)) {
        const Wide factor = load(mid + At::mid(i, k));
        unrolled<kCount>([&](auto c) __attribute__((always_inline)) {
          row[c] -= factor * ends[i][first + c];
        });
      });
      unrolled<kCount>([&](auto c) __attribute__((always_inline)) {
        ends[k][first + c] = row[c];
        store(row[c] * pivot[k], mid + At::mid(k, W + first + c));
      });
    });
  }

  /// A block of S of the end nodes less what the mid node takes.
  /// @param left, right  its first row and column among the ends' 2W
  template <int kRows, int kColumns>
  [[gnu::always_inline]] void condense(const double* mid, int left, int right,
                                       double* block) const noexcept {
    Wide sum[kRows * kColumns];
    const auto each = [](const auto& entry) __attribute__((always_inline)) {
      unrolled<kRows * kColumns>([&](auto c) __attribute__((always_inline)) {
        constexpr int i = c / kColumns, j = c % kColumns;
        entry(c, std::integral_constant<int, i>{}, std::integral_constant<int, j>{});
      });
    };
    each([&](auto c, auto i, auto j) __attribute__((always_inline)) {
      sum[c] = load(block + (W * i + j) * kStraightLanes);
    });
    for (int k = 0; k < W; ++k)
      each([&](auto c, auto i, auto j) __attribute__((always_inline)) {
        sum[c] -= ends[k][left + i] * load(mid + At::mid(k, W + right + j));
      });
    each([&](auto c, auto i, auto j) __attribute__((always_inline)) {
      store(sum[c], block + (W * i + j) * kStraightLanes);
    });
  }

 private:
  Wide pivot[W];  // 1 / D
};

/// A block of W: in parts of 3; above the diagonal's parts alone if it is symmetric.
template <int W>
void condense_block(const MidRows<W>& rows, const double* mid, int pair, double* S) noexcept {
  constexpr int parts = (W + 2) / 3;
  const int left = pair == kLastLast ? W : 0, right = pair == kFirstFirst ? 0 : W;
  unrolled<parts>([&](auto a) __attribute__((always_inline)) {
    unrolled<parts>([&](auto b) __attribute__((always_inline)) {
      constexpr int i = 3 * a, j = 3 * b;
      if (pair == kFirstLast || a <= b)
        rows.template condense<(W - i < 3 ? W - i : 3), (W - j < 3 ? W - j : 3)>(
            mid, left + i, right + j, S + Layout<W>::tangent(pair, i, j));
    });
  });
}

/// Mid nodes of a group out of S.
/// @returns how many pivots of the first `count` lanes are not above 0
template <int W>
int condense_group(int count, double inverse_k, double* S, double* factor) noexcept {
  constexpr int columns = W % 2 == 0 ? W / 2 : (W % 3 == 0 ? W / 3 : W);
  int bad[kStraightLanes] = {};
  for (int lane = 0; lane < kStraightLanes; lane += kWide) {
    MidRows<W> rows;
    rows.set_own(S + lane, inverse_k, factor + lane, bad + lane);
    for (int first = 0; first < 2 * W; first += columns)
      rows.template set_columns<columns>(S + lane, first, factor + lane);
    for (const int pair : {kFirstFirst, kFirstLast, kLastLast})
      condense_block<W>(rows, factor + lane, pair, S + lane);
  }
  int all = 0;
  for (int lane = 0; lane < count; ++lane) all += bad[lane];
  return all;
}

}  // namespace railstep::chained
