#pragma once

namespace railstep {

// Standard C++17 has no pi and a machine without a system has no other name for it.
inline constexpr double kPi = 3.14159265358979323846;

}  // namespace railstep
