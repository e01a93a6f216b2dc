#pragma once
#include "offline/track/track.h"

namespace railstep {

/// How many ends of the track do not reflect.
int end_zones(const Track& track);

/// Rate r of the damping C_e = r M_e that the zone of a non-reflecting end puts on an element of a
/// rail, 1/s; 0 outside the zones. With s from 0 at the start of the zone to 1 at the end of the
/// rail, L its length, and s taken at the middle of the element,
///   r(s) = 4 P v/L s^3,   v = sqrt(k_z G/rho),   P = 3/2.
/// A wave of group velocity c keeps e^(-P v/c) of its amplitude on the way to the end and back,
/// whatever L. Waves of v, the limit of Timoshenko's bending waves, keep 22 %; waves of 500 to 1500
/// Hz, half as fast, keep 5 %. The cube and the length keep the start of the zone from reflecting.
/// Forces on mass alone do not change statics and damp every motion of the section alike.
double end_damping_rate(const Track& track, int rail, int element);

}  // namespace railstep
