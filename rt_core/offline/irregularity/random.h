#pragma once
#include <cstdint>

namespace railstep {

/// A number in [0, 1) for each seed, stream and index: Steele, Lea and Flood's SplitMix64 (OOPSLA
/// 2014) as a counter, so that no number depends on how many were drawn before. Integer arithmetic
/// and one exact scaling: the same on every machine.
inline double uniform(std::uint64_t seed, std::uint64_t stream, std::uint64_t index) {
  const auto mix = [](std::uint64_t z) {
    z += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  };
  const std::uint64_t bits = mix(mix(mix(seed) ^ stream) ^ index);
  return static_cast<double>(bits >> 11) * 0x1p-53;
}

}  // namespace railstep
