#pragma once
#include "online/beam/chain_layout.h"

namespace railstep::chained {

// The end nodes of a chain whose mid nodes are condensed: block tridiagonal, one node after the
// other, a node's row as vectors: its own columns and the next node's.

/// Adds the condensed elements `first` to `first` + `count` - 1 to their end nodes, which set the
/// next ones.
/// @param S      the group's blocks
/// @param nodes  the factor's end nodes
template <int W>
void add_condensed(int first, int count, const double* S, double* nodes) noexcept {
  using At = Layout<W>;
  for (int lane = 0; lane < count; ++lane) {
    double* node = nodes + (first + lane) * At::kNode;
    double* next = node + At::kNode;
    const double* of = S + lane;
    for (int i = 0; i < W; ++i) {
      for (int j = i; j < W; ++j) node[At::kRow * i + j] += of[At::tangent(kFirstFirst, i, j)];
      for (int j = 0; j < W; ++j) node[At::kRow * i + W + j] = of[At::tangent(kFirstLast, i, j)];
      for (int j = 0; j < At::kRow; ++j)
        next[At::kRow * i + j] = j >= i && j < W ? of[At::tangent(kLastLast, i, j)] : 0.;
    }
  }
}

/// Eliminates a node: its rows become those of L, the next node's lose what it takes.
/// @param next  nullptr after the last node
/// @returns how many pivots are not above 0
template <int W>
int eliminate_node(double* node, double* next) noexcept {
  constexpr int row = kChainRow<W>;
  double D[W][row];  // D L'
  int bad = 0;
  for (int k = 0; k < W; ++k) {
    double* L = node + row * k;
    for (int j = k; j < 2 * W; ++j) D[k][j] = L[j];
    for (int i = 0; i < k; ++i)
      for (int j = k; j < 2 * W; ++j) D[k][j] -= node[row * i + k] * D[i][j];
    bad += D[k][k] > 0. ? 0 : 1;
    const double inverse = 1. / D[k][k];
    for (int j = k + 1; j < 2 * W; ++j) L[j] = D[k][j] * inverse;
    L[k] = inverse;
  }
  if (next != nullptr)
    for (int i = 0; i < W; ++i)
      for (int k = 0; k < W; ++k)
        for (int j = i; j < W; ++j) next[row * i + j] -= node[row * k + W + i] * D[k][W + j];
  return bad;
}

}  // namespace railstep::chained
