#include "online/beam/chain.h"
#include "online/beam/chain_sweep.h"

namespace RAILSTEP_KERNELS {

namespace {

using namespace chained;

/// Rows of an end node in the factor.
template <int W>
struct EndRow {
  const double* of;
  [[gnu::always_inline]] double operator()(int k, int j) const noexcept {
    return of[kChainRow<W> * k + j];
  }
};
/// Rows of the mid node of one element.
template <int W>
struct MidRow {
  const double* of;  // its lane
  [[gnu::always_inline]] double operator()(int k, int j) const noexcept {
    return of[Layout<W>::mid(k, j)];
  }
};
/// Rows of the mid nodes of kWide elements.
template <int W>
struct MidRowLanes {
  const double* of;  // the first lane
  [[gnu::always_inline]] Wide operator()(int k, int j) const noexcept {
    return load(of + Layout<W>::mid(k, j));
  }
};

/// A right-hand side, or kWide of four side by side.
[[gnu::always_inline]] inline void get(const double* from, double& x) noexcept { x = *from; }
[[gnu::always_inline]] inline void get(const double* from, Wide& x) noexcept { x = load(from); }
[[gnu::always_inline]] inline void put(const double& x, double* to) noexcept { *to = x; }
[[gnu::always_inline]] inline void put(const Wide& x, double* to) noexcept { store(x, to); }

/// Unknowns of a node one after the other, `kStep` doubles apart.
template <int W, int kStep, class T>
struct Node {
  T of[W];
  [[gnu::always_inline]] explicit Node(const double* x) noexcept {
    unrolled<W>([&](auto i) __attribute__((always_inline)) { get(x + kStep * i, of[i]); });
  }
  [[gnu::always_inline]] void set(double* x) const noexcept {
    unrolled<W>([&](auto i) __attribute__((always_inline)) { put(of[i], x + kStep * i); });
  }
};

/// Takes the parts of kOthers nodes from a node's y; then y := D^-1 y.
/// @param others  of the node's columns from W on, W each
template <int W, int kStep, class T, int kOthers, class Entry>
[[gnu::always_inline]] inline void take_of_others(const Entry& entry, double* x,
                                                  double* const (&others)[kOthers]) noexcept {
  Node<W, kStep, T> y(x);
  for (int other = 0; other < kOthers; ++other)
    for (int i = 0; i < W; ++i) {
      T unknown;
      get(others[other] + kStep * i, unknown);
      put(less_taken<W>(entry, W * (other + 1) + i, y.of, unknown), others[other] + kStep * i);
    }
  scale<W>(entry, y.of);
  y.set(x);
}

/// A node's y less what the solution of kOthers nodes takes.
template <int W, int kStep, class T, int kOthers, class Entry>
[[gnu::always_inline]] inline void take_from_others(
    const Entry& entry, double* x, const double* const (&others)[kOthers]) noexcept {
  Node<W, kStep, T> y(x);
  for (int other = 0; other < kOthers; ++other)
    for (int i = 0; i < W; ++i) {
      T unknown;
      get(others[other] + kStep * i, unknown);
      take_back<W>(entry, W * (other + 1) + i, unknown, y.of);
    }
  y.set(x);
}

/// The sides of x that T holds, through end nodes, and through the mid nodes of a group.
template <int W, int kStep, class T>
struct Sweep {
  using At = Layout<W>;
  static constexpr long kNodeStep = long{W} * kStep;
  const double* factor;
  const double* nodes;
  double* x;

  EndRow<W> end(int e) const noexcept { return {nodes + e * At::kNode}; }
  MidRow<W> mid(int e) const noexcept {
    return {factor + e / kStraightLanes * At::kMids + e % kStraightLanes};
  }
  double* node(int n) const noexcept { return x + n * kNodeStep; }

  void end_forward(int e) const noexcept {
    double* const next[] = {node(2 * e + 2)};
    Node<W, kStep, T> y(node(2 * e));
    substitute<W>(end(e), y.of);
    y.set(node(2 * e));
    take_of_others<W, kStep, T>(end(e), node(2 * e), next);
  }
  void end_backward(int e) const noexcept {
    const double* const next[] = {node(2 * e + 2)};
    take_from_others<W, kStep, T>(end(e), node(2 * e), next);
    Node<W, kStep, T> y(node(2 * e));
    substitute_back<W>(end(e), y.of);
    y.set(node(2 * e));
  }
  void last(int e) const noexcept {
    Node<W, kStep, T> y(node(2 * e));
    substitute<W>(end(e), y.of);
    scale<W>(end(e), y.of);
    substitute_back<W>(end(e), y.of);
    y.set(node(2 * e));
  }
  // The steps of all mid nodes that wait for each other's results first, then those that do not.
  void mids_forward(int first, int count) const noexcept {
    for (int e = first; e < first + count; ++e) {
      Node<W, kStep, T> y(node(2 * e + 1));
      substitute<W>(mid(e), y.of);
      y.set(node(2 * e + 1));
    }
    for (int e = first; e < first + count; ++e) {
      double* const ends[] = {node(2 * e), node(2 * e + 2)};
      take_of_others<W, kStep, T>(mid(e), node(2 * e + 1), ends);
    }
  }
  void mids_backward(int first, int count) const noexcept {
    for (int e = first; e < first + count; ++e) {
      const double* const ends[] = {node(2 * e), node(2 * e + 2)};
      take_from_others<W, kStep, T>(mid(e), node(2 * e + 1), ends);
    }
    for (int e = first; e < first + count; ++e) {
      Node<W, kStep, T> y(node(2 * e + 1));
      substitute_back<W>(mid(e), y.of);
      y.set(node(2 * e + 1));
    }
  }
};

/// One right-hand side: the mid nodes of kWide elements side by side, and what they take of their
/// last nodes before what they take of their first ones, as one element after the other would.
template <int W>
struct SweepOne : Sweep<W, 1, double> {
  using At = Layout<W>;
  static constexpr long kElement = 2 * W;  // doubles of x from one element to the next

  /// kWide elements; lanes from `count` on repeat the last of these and are not written.
  struct Lanes {
    double* x;  // the first one's first node
    int count;
    [[gnu::always_inline]] Wide get(int unknown) const noexcept {
      Wide lanes{};
      for (int l = 0; l < kWide; ++l)
        lanes[l] = x[kElement * (l < count ? l : count - 1) + unknown];
      return lanes;
    }
    [[gnu::always_inline]] void put(const Wide& lanes, int unknown) const noexcept {
      for (int l = 0; l < kWide; ++l)
        if (l < count) x[kElement * l + unknown] = lanes[l];
    }
  };
  MidRowLanes<W> rows(int first) const noexcept { return {this->mid(first).of}; }

  void mids_forward(int first, int all) const noexcept {
    for (int e = first; e < first + all; e += kWide) {
      const Lanes lanes{this->node(2 * e), first + all - e};
      const MidRowLanes<W> entry = rows(e);
      Wide y[W];
      unrolled<W>([&](auto i) __attribute__((always_inline)) { y[i] = lanes.get(W + i); });
      substitute<W>(entry, y);
      for (int i = 0; i < W; ++i)
        lanes.put(less_taken<W>(entry, 2 * W + i, y, lanes.get(2 * W + i)), 2 * W + i);
      for (int i = 0; i < W; ++i) lanes.put(less_taken<W>(entry, W + i, y, lanes.get(i)), i);
      scale<W>(entry, y);
      unrolled<W>([&](auto i) __attribute__((always_inline)) { lanes.put(y[i], W + i); });
    }
  }
  void mids_backward(int first, int all) const noexcept {
    for (int e = first; e < first + all; e += kWide) {
      const Lanes lanes{this->node(2 * e), first + all - e};
      const MidRowLanes<W> entry = rows(e);
      Wide y[W];
      unrolled<W>([&](auto i) __attribute__((always_inline)) { y[i] = lanes.get(W + i); });
      for (int i = 0; i < W; ++i) take_back<W>(entry, W + i, lanes.get(i), y);
      for (int i = 0; i < W; ++i) take_back<W>(entry, 2 * W + i, lanes.get(2 * W + i), y);
      substitute_back<W>(entry, y);
      unrolled<W>([&](auto i) __attribute__((always_inline)) { lanes.put(y[i], W + i); });
    }
  }
};

/// Mid nodes of a group, then its end nodes, group after group; and back.
template <int W, class Sweep>
void sweep(int elements, const Sweep& of) noexcept {
  const int groups = straight_groups(elements);
  const auto count = [elements](int first) {
    return elements - first < kStraightLanes ? elements - first : kStraightLanes;
  };
  for (int group = 0; group < groups; ++group) {
    const int first = kStraightLanes * group;
    of.mids_forward(first, count(first));
    for (int e = first; e < first + count(first); ++e) of.end_forward(e);
  }
  of.last(elements);
  for (int group = groups - 1; group >= 0; --group) {
    const int first = kStraightLanes * group;
    for (int e = first + count(first) - 1; e >= first; --e) of.end_backward(e);
    of.mids_backward(first, count(first));
  }
}

}  // namespace

template <int W>
void chain_solve(const Chain& chain, const double* factor, double* x) noexcept {
  for (int h = 0; h < chain.held_count; ++h)
    for (int s = 0; s < kChainSides; ++s) x[long{kChainSides} * chain.held[h] + s] = 0.;
  const double* nodes = factor + Layout<W>::nodes(chain.elements);
  for (int side = 0; side < kChainSides; side += kWide)
    sweep<W>(chain.elements, Sweep<W, kChainSides, Wide>{factor, nodes, x + side});
}

template <int W>
void chain_solve_one(const Chain& chain, const double* factor, double* x) noexcept {
  for (int h = 0; h < chain.held_count; ++h) x[chain.held[h]] = 0.;
  const double* nodes = factor + Layout<W>::nodes(chain.elements);
  sweep<W>(chain.elements, SweepOne<W>{{factor, nodes, x}});
}

template void chain_solve<9>(const Chain&, const double*, double*) noexcept;
template void chain_solve<5>(const Chain&, const double*, double*) noexcept;
template void chain_solve_one<9>(const Chain&, const double*, double*) noexcept;
template void chain_solve_one<5>(const Chain&, const double*, double*) noexcept;

}  // namespace RAILSTEP_KERNELS
