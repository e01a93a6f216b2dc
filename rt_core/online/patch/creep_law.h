#pragma once
#include <cstdint>

namespace railstep {

enum class CreepLaw : std::int32_t { linear, she, fastsim, polach };

/// Whether a force is wanted with its derivatives. Without them it is the same force, in less time.
enum class CreepWanted : bool { force, slopes };

/// Largest number of FASTSIM's strips.
inline constexpr int kMostStrips = 100;

}  // namespace railstep
