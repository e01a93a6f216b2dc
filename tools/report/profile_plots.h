#pragma once
#include <string>

#include "answer/profile_pair.h"

namespace railstep {

// Figures of a pair of profiles, each an <svg>. They throw Failed where gnuplot fails.

/// Wheel and rail with lines between the places that touch.
std::string plot_of_contacts(const ProfileAnswer& answer);
/// Difference of the rolling radii over the shift: with roll, without, and under the load.
std::string plot_of_radii(const ProfileAnswer& answer);
/// Contact angles of both wheels over the shift.
std::string plot_of_angles(const ProfileAnswer& answer);
/// Roll of the wheelset over the shift.
std::string plot_of_roll(const ProfileAnswer& answer);
/// Equivalent conicity over the amplitude: with roll, without, and under the load.
std::string plot_of_conicity(const ProfileAnswer& answer);

}  // namespace railstep
