#include "offline/receptance/end_effect.h"

#include <cmath>

#include "offline/receptance/full_order.h"

namespace railstep {

Track with_other_ends(const Track& track) {
  Track other = track;
  for (RailEnd& end : other.ends) end = end == RailEnd::pinned ? RailEnd::free : RailEnd::pinned;
  return other;
}

std::vector<double> end_effect(const Track& track, const Transfer& transfer,
                               const std::vector<double>& hz,
                               const std::vector<std::complex<double>>& answer) {
  FullOrderReceptance other(with_other_ends(track), transfer);
  std::vector<double> change;
  for (std::size_t i = 0; i < hz.size(); ++i) {
    const double size = std::abs(answer[i]);  // 0 between motions that nothing couples
    change.push_back(size > 0. ? std::abs(other.at(hz[i])[0] - answer[i]) / size : 0.);
  }
  return change;
}

}  // namespace railstep
