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
  for (std::size_t i = 0; i < hz.size(); ++i)
    change.push_back(std::abs(other.at(hz[i])[0] - answer[i]) / std::abs(answer[i]));
  return change;
}

}  // namespace railstep
