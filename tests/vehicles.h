#pragma once
#include "offline/vehicle/kinds.h"

namespace railstep {

/// The Manchester benchmark's, of one rail.
inline const BogieData kBogie{.frame_mass = 1307.5,
                              .frame_inertia = 738.,
                              .wheel_mass = 906.5,
                              .wheelbase = 2.56,
                              .axles = 2,
                              .primary_stiffness = 1.22e6,
                              .primary_damping = 4e3,
                              .carried = 8000.};
inline const CarData kCar{.bogie = {1307.5, 738., 906.5, 2.56, 2, 1.22e6, 4e3},
                          .body_mass = 16000.,
                          .body_inertia = 9.85e5,
                          .bogie_distance = 19.,
                          .secondary_stiffness = 4.3e5,
                          .secondary_damping = 2e4};

}  // namespace railstep
