#pragma once
#include "online/beam/chain.h"
#include "online/beam/straight_kind.h"

namespace RAILSTEP_KERNELS::chained {

using straight::unrolled;

// Where things are in a batch's tangents and in the factor of a chain. In the factor's row k,
// column j > k is L(j, k), and column k is 1 / D(k).

/// Blocks of a batch's tangents.
enum Pair { kFirstFirst, kFirstMid, kFirstLast, kMidMid, kMidLast, kLastLast };

template <int W>
struct Layout {
  static constexpr int kRow = kChainRow<W>;
  static constexpr long kTangents = long{kStraightPairs} * W * W * kStraightLanes;  // of a group
  static constexpr long kMids = long{W} * 3 * W * kStraightLanes;                   // of a group
  static constexpr long kNode = long{W} * kRow;

  /// Entry of the blocks of a group's tangents, its first lane.
  static constexpr long tangent(int pair, int i, int j) noexcept {
    return ((long{pair} * W + i) * W + j) * kStraightLanes;
  }
  /// Entry of the mid nodes of a group: columns of the mid, the first and the last node.
  static constexpr long mid(int k, int j) noexcept {
    return (long{k} * 3 * W + j) * kStraightLanes;
  }
  /// The end nodes' part of a factor.
  static constexpr long nodes(int elements) noexcept { return straight_groups(elements) * kMids; }
};

/// The field of a node, r, a or b, that has an unknown.
template <int W>
constexpr int field_of(int unknown) noexcept {
  using Kind = std::conditional_t<W == 9, straight::Spatial, straight::Planar>;
  static_assert(Kind::kUnknowns == W);
  return unknown < straight::field_first<Kind>(1)
             ? 0
             : (unknown < straight::field_first<Kind>(2) ? 1 : 2);
}

/// 30 / L times the integral of N_i N_j, quadratic shape functions.
inline constexpr double kMassPairs[3][3] = {{4., 2., -1.}, {2., 16., 2.}, {-1., 2., 4.}};

}  // namespace RAILSTEP_KERNELS::chained
