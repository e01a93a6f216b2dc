#include "hil/hil_inputs.h"

#include <algorithm>

namespace railstep {

const double* HeldInputs::next(const double* fresh, const double* good) noexcept {
  const std::size_t count = value_.size();
  if (!stopping()) {
    if (fresh != nullptr) {
      std::copy_n(fresh, count, value_.begin());
      heard_ = true;
      silent_ = 0;
      return value_.data();
    }
    if (!heard_ || silence_ == 0 || ++silent_ < silence_) return value_.data();
    std::copy_n(good, count, base_.begin());  // finite, whatever was sent
  }
  ++stopped_for_;
  const double left = stopped_for_ < ramp_
                          ? 1. - static_cast<double>(stopped_for_) / static_cast<double>(ramp_)
                          : 0.;
  for (std::size_t i = 0; i < count; ++i) value_[i] = left * base_[i];
  for (const std::size_t i : places_) value_[i] = base_[i];
  return value_.data();
}

}  // namespace railstep
