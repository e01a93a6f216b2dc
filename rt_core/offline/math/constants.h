#pragma once

namespace railstep {

inline constexpr double kGravity = 9.81;         // m/s2, where nothing else is given
inline constexpr double kWheelRadius = .46;      // m, of a wheel whose radius is not given
inline constexpr double kTreadHalfWidth = .065;  // m, of a wheel whose tread is not given
inline constexpr double kCrownRadius = .3;       // m, of a rail whose crown is not given
// Steel, where no other material is given.
inline constexpr double kSteelYoung = 210e9;    // Pa
inline constexpr double kSteelPoisson = .3;     // 1
inline constexpr double kSteelDensity = 7850.;  // kg/m3
/// Depth below the railhead's top at which the gauge is measured (EN 13848-1) and flanges touch it,
/// m.
inline constexpr double kGaugeDepth = .014;

}  // namespace railstep
