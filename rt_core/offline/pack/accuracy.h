#pragma once
#include "offline/pack/pack.h"

namespace railstep {

/// Largest error of the static deflection under a unit force of every kind of port, over places in
/// the first, middle and last bay half-way between the tables' own, against a track of elements so
/// fine that these are nodes; over the largest deflection. 0 without ports.
/// One-sided supports are open.
double static_error(const Track& track, const PackedModel& packed);

/// The same of the receptance magnitude and phase together, |H - H_ref| over the largest |H_ref|,
/// at the middle of the track's middle bay and over its seat, from kReceptanceFrom to kReceptanceTo
/// at kReceptancePoints logarithmic steps, against a track of 2 times finer elements.
double receptance_error(const Track& track, const PackedModel& packed);

inline constexpr double kReceptanceFrom = 20., kReceptanceTo = 1500.;  // Hz
inline constexpr int kReceptancePoints = 40;

}  // namespace railstep
