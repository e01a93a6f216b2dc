#pragma once
#include "online/model/model.h"

namespace railstep {

inline constexpr std::int64_t kBay = std::int64_t{1} << 62;  // a bay in a BayProgress's fractions

/// Whole bays passed at a step, and the part of the next one in 2^-62.
struct BaysPassed {
  std::int64_t bays, part;
};

/// a b / 2^62 and its remainder, a and b below 2^62. It multiplies by halves, since not every
/// machine has numbers of 128 bits.
inline BaysPassed split_product(std::uint64_t a, std::uint64_t b) noexcept {
  const std::uint64_t half = 0xffffffffu;
  const std::uint64_t low = (a & half) * (b & half);
  const std::uint64_t one = (a >> 32) * (b & half) + (low >> 32);
  const std::uint64_t two = (a & half) * (b >> 32) + (one & half);
  const std::uint64_t high = (a >> 32) * (b >> 32) + (one >> 32) + (two >> 32);
  const std::uint64_t rest = (two << 32) | (low & half);
  return {static_cast<std::int64_t>((high << 2) | (rest >> 62)),
          static_cast<std::int64_t>(rest & static_cast<std::uint64_t>(kBay - 1))};
}

/// Bays passed at a step >= 0, without rounding. It cannot overflow: the remainder has at most 2^62
/// steps, each less than a bay, which is below 2^124.
inline BaysPassed bays_passed(const BayProgress& progress, std::int64_t step) noexcept {
  const std::int64_t periods = step / progress.period, rest = step % progress.period;
  const BaysPassed within =
      split_product(static_cast<std::uint64_t>(rest), static_cast<std::uint64_t>(progress.advance));
  return {periods * progress.bays + within.bays, within.part};
}

/// Place of the traffic within its bay at a step, m: 0 to below bay_length; 0 on a track with ends.
inline double within_bay(const Model& model, std::int64_t step) noexcept {
  if (model.endless.bays == 0) return 0.;
  // The leading 53 bits, so that the quotient is below 1.
  const std::int64_t part = bays_passed(model.endless.progress, step).part >> 9;
  return static_cast<double>(part) * 0x1p-53 * model.endless.bay_length;
}

/// Distance along the track less the place along the model's elements, m.
inline double track_offset(const Model& model, std::int64_t step) noexcept {
  const Endless& e = model.endless;
  if (e.bays == 0) return 0.;
  return static_cast<double>(bays_passed(e.progress, step).bays) * e.bay_length - e.origin;
}

}  // namespace railstep
