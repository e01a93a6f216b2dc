#include "offline/pack/half_solve.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

namespace railstep {
namespace {

/// Part of the whole, squared, below which a solution is gone: kept() cuts far above it.
constexpr double kGone = 1e-32;

/// A solution that goes on forward panel by panel until it is gone.
class Forward {
 public:
  /// @param S     of one line
  /// @param last  panel of the right-hand side's last entry
  /// @param x     [8 panels] the right-hand side, 0 before panel `first`; overwritten
  Forward(const Band& S, std::int32_t first, std::int32_t last, double* x, double* over_pivots) {
    const auto width = static_cast<std::ptrdiff_t>(std::max(S.left / kLanes, 1));
    double whole = 0.;
    for (std::int32_t p = first; p < S.panels; ++p) {
      forward_panel(S, first, p, x);
      std::copy(x + p * kLanes, x + (p + 1) * kLanes, over_pivots + p * kLanes);
      divide_by_pivots(S, {p, p + 1}, over_pivots);
      square_.push_back(panels_dot({p, p + 1}, x, over_pivots));
      whole += square_.back();
      const bool full = static_cast<std::ptrdiff_t>(square_.size()) > width;
      if (p > last && full &&
          std::accumulate(square_.end() - width, square_.end(), 0.) <= kGone * whole)
        break;
    }
  }

  /// Panels that the solution was made in.
  std::int32_t made() const { return static_cast<std::int32_t>(square_.size()); }

  /// The first of them that hold all but kFaded of the whole.
  std::int32_t kept() const {
    const double whole = std::accumulate(square_.begin(), square_.end(), 0.);
    std::int32_t count = made();
    for (double rest = 0.; count > 1; --count) {
      rest += square_[static_cast<std::size_t>(count - 1)];
      if (rest > kFaded * kFaded * whole) break;
    }
    return count;
  }

 private:
  std::vector<double> square_;  // of the solution's part in each panel, in the norm of D^-1
};

}  // namespace

HalfSolve solve_halfway(const Band& S, std::vector<double> b) {
  HalfSolve half{
      {0, 0}, std::move(b), std::vector<double>(static_cast<std::size_t>(S.panels) * kLanes, 0.)};
  std::int32_t first = S.panels, last = -1;
  for (std::size_t i = 0; i < half.forward.size(); ++i) {
    if (half.forward[i] == 0.) continue;
    const auto panel = static_cast<std::int32_t>(i / kLanes);
    first = std::min(first, panel);
    last = panel;
  }
  if (last < 0) return half;
  const Forward run(S, first, last, half.forward.data(), half.over_pivots.data());
  half.panels = {first, first + std::max(run.kept(), last + 1 - first)};
  for (std::vector<double>* of : {&half.forward, &half.over_pivots})
    std::fill(of->begin() + half.panels.end * kLanes, of->end(), 0.);
  return half;
}

std::int32_t reach_of(const Band& S) {
  std::vector<double> x(static_cast<std::size_t>(S.panels) * kLanes, 0.), over_pivots = x;
  std::int32_t reach = 0;
  for (std::int32_t unknown = 0; unknown < S.panels * kLanes; ++unknown) {
    const std::int32_t panel = unknown / kLanes;
    x[static_cast<std::size_t>(unknown)] = 1.;
    const Forward run(S, panel, panel, x.data(), over_pivots.data());
    reach = std::max(reach, run.kept() - 1);
    std::fill(x.begin() + panel * kLanes, x.begin() + (panel + run.made()) * kLanes, 0.);
  }
  return reach;
}

}  // namespace railstep
