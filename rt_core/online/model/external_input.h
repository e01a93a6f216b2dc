#pragma once
#include <cstdint>

namespace railstep {

// The inputs of an external wheel, counted from ExternalWheelModel::input on.
inline constexpr std::int32_t kExternalX = 0;       // place along the track, m
inline constexpr std::int32_t kExternalY = 1;       // y from the middle of the railhead's tread, m
inline constexpr std::int32_t kExternalPlaces = 2;  // x and y, which come first
inline constexpr std::int32_t kExternalForce = 2;   // on the rail along x, then along y and z, N
inline constexpr std::int32_t kExternalInputs = 5;

/// Ends of the names of these inputs.
inline constexpr const char* kExternalInputNames[kExternalInputs] = {"x_m", "y_m", "force_x_n",
                                                                     "force_y_n", "force_z_n"};

}  // namespace railstep
