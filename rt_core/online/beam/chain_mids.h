#pragma once
#include "online/beam/chain_layout.h"

namespace RAILSTEP_KERNELS::chained {

// The mid nodes of four elements, one in each lane: their pivots, their rows of L, and what is left
// to the elements' end nodes. D L' takes the place of S, so that all of a group stays in a cache of
// 32 KiB. Every entry is S less its terms in the order of the rows above; columns are taken in
// numbers that fit the processor's 16 vectors.

/// kWide of a group's lanes.
template <int W>
struct MidLanes {
  using At = Layout<W>;
  double* S;    // the group's blocks of S / k_factor, from the first of these lanes
  double* mid;  // the group's part of the factor, likewise

  /// Column c of the two end nodes' 2W in row k of the mid node.
  [[gnu::always_inline]] double* end(int k, int c) const noexcept {
    return S + (c < W ? At::tangent(kFirstMid, c, k) : At::tangent(kMidLast, k, c - W));
  }

  /// Row after row, so that the wait for a row's pivot is filled with the ends of the one above.
  /// 1 / D is stored over k_factor.
  /// @param bad  counts the lanes' pivots that are not above 0
  [[gnu::always_inline]] void eliminate(double inverse_k, int* bad) const noexcept {
    constexpr int columns = W % 3 == 0 ? 6 : 5;
    unrolled<W>([&](auto k) __attribute__((always_inline)) {
      const Wide pivot = own_row<k>(), inverse = 1. / pivot;
      for (int lane = 0; lane < kWide; ++lane) bad[lane] += pivot[lane] > 0. ? 0 : 1;
      store(inverse * inverse_k, mid + At::mid(k, k));
      unrolled<W - 1 - k>([&](auto c) __attribute__((always_inline)) {
        constexpr int j = k + 1 + c;
        store(load(S + At::tangent(kMidMid, k, j)) * inverse, mid + At::mid(k, j));
      });
      unrolled<2 * W / columns>([&](auto part) __attribute__((always_inline)) {
        end_columns<k, columns * part, columns>(inverse);
      });
    });
  }

  /// Row k of D L' in the mid node's own columns.
  /// @returns D
  template <int k>
  [[gnu::always_inline]] Wide own_row() const noexcept {
    Wide row[W - k];
    unrolled<W - k>([&](auto c) __attribute__((always_inline)) {
      row[c] = load(S + At::tangent(kMidMid, k, k + c));
    });
    unrolled<k>([&](auto i) __attribute__((always_inline)) {
      const Wide factor = load(mid + At::mid(i, k));
      unrolled<W - k>([&](auto c) __attribute__((always_inline)) {
        row[c] -= factor * load(S + At::tangent(kMidMid, i, k + c));
      });
    });
    unrolled<W - 1 - k>([&](auto c) __attribute__((always_inline)) {
      store(row[c + 1], S + At::tangent(kMidMid, k, k + c + 1));
    });
    return row[0];
  }

  template <int k, int kFirst, int kCount>
  [[gnu::always_inline]] void end_columns(const Wide& inverse) const noexcept {
    Wide row[kCount];
    unrolled<kCount>([&](auto c)
                         __attribute__((always_inline)) { row[c] = load(end(k, kFirst + c)); });
    unrolled<k>([&](auto i) __attribute__((always_inline)) {
      const Wide factor = load(mid + At::mid(i, k));
      unrolled<kCount>([&](auto c) __attribute__((always_inline)) {
        row[c] -= factor * load(end(i, kFirst + c));
      });
    });
    unrolled<kCount>([&](auto c) __attribute__((always_inline)) {
      store(row[c], end(k, kFirst + c));
      store(row[c] * inverse, mid + At::mid(k, W + kFirst + c));
    });
  }

  /// A part of a block of S of the end nodes less what the mid node takes.
  /// @param left, right  its first row and column among the ends' 2W
  /// @param part         in S
  template <int kRows, int kColumns>
  [[gnu::always_inline]] void condense(int left, int right, double* part) const noexcept {
    Wide sum[kRows * kColumns];
    const auto each = [](const auto& entry) __attribute__((always_inline)) {
      unrolled<kRows * kColumns>([&](auto c) __attribute__((always_inline)) {
        constexpr int i = c / kColumns, j = c % kColumns;
        entry(c, std::integral_constant<int, i>{}, std::integral_constant<int, j>{});
      });
    };
    each([&](auto c, auto i, auto j) __attribute__((always_inline)) {
      sum[c] = load(part + (W * i + j) * kStraightLanes);
    });
    for (int k = 0; k < W; ++k)
      each([&](auto c, auto i, auto j) __attribute__((always_inline)) {
        sum[c] -= load(end(k, left + i)) * load(mid + At::mid(k, W + right + j));
      });
    each([&](auto c, auto i, auto j) __attribute__((always_inline)) {
      store(sum[c], part + (W * i + j) * kStraightLanes);
    });
  }

  /// A block of S of the end nodes, in parts of 3 x 3. A symmetric block has only the parts on and
  /// above its diagonal.
  template <int kPair>
  void condense_block() const noexcept {
    constexpr int parts = (W + 2) / 3;
    constexpr int left = kPair == kLastLast ? W : 0, right = kPair == kFirstFirst ? 0 : W;
    unrolled<parts>([&](auto a) __attribute__((always_inline)) {
      unrolled<parts>([&](auto b) __attribute__((always_inline)) {
        constexpr int i = 3 * a, j = 3 * b;
        if constexpr (kPair == kFirstLast || a <= b)
          condense<(W - i < 3 ? W - i : 3), (W - j < 3 ? W - j : 3)>(left + i, right + j,
                                                                     S + At::tangent(kPair, i, j));
      });
    });
  }
};

/// Mid nodes of a group out of S.
/// @returns how many pivots of the first `count` lanes are not above 0
template <int W>
int condense_group(int count, double inverse_k, double* S, double* factor) noexcept {
  int bad[kStraightLanes] = {};
  for (int lane = 0; lane < kStraightLanes; lane += kWide) {
    const MidLanes<W> lanes{S + lane, factor + lane};
    lanes.eliminate(inverse_k, bad + lane);
    lanes.template condense_block<kFirstFirst>();
    lanes.template condense_block<kFirstLast>();
    lanes.template condense_block<kLastLast>();
  }
  int all = 0;
  for (int lane = 0; lane < count; ++lane) all += bad[lane];
  return all;
}

}  // namespace RAILSTEP_KERNELS::chained
