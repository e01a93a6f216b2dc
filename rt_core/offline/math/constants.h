#pragma once

namespace railstep {

inline constexpr double kGravity = 9.81;     // m/s2, where nothing else is given
inline constexpr double kWheelRadius = .46;  // m, of a wheel whose radius is not given

}  // namespace railstep
