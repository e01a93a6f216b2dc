#pragma once

namespace railstep {

inline constexpr double kGravity = 9.81;     // m/s2, where nothing else is given
inline constexpr double kWheelRadius = .46;  // m, of a wheel whose radius is not given
/// Depth below the railhead's top at which the gauge is measured (EN 13848-1) and flanges touch it,
/// m.
inline constexpr double kGaugeDepth = .014;

}  // namespace railstep
