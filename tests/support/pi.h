#pragma once
#include <numbers>

namespace railstep {

inline constexpr double kPi = std::numbers::pi;

}  // namespace railstep
