#pragma once
#include <cstdint>

namespace railstep {

enum class CreepLaw : std::int32_t { linear, she, fastsim, polach };

/// Largest number of FASTSIM's strips.
inline constexpr int kMostStrips = 100;

}  // namespace railstep
