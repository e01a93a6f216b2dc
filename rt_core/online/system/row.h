#pragma once
#include "online/system/marker.h"

namespace railstep {

/// s(t) of a motion with its derivatives.
Jet motion_at(const SystemModel& system, std::int32_t motion, double time) noexcept;

/// Phi of a row: for joints it must be 0, for springs it is their extension.
/// @param s  motion or offset at the same time
double row_value(const RowModel& row, const MarkerPose& a, const MarkerPose& b, double s) noexcept;

/// Phi with its derivatives. A spring's acceleration is not given (0).
Jet row_jet(const RowModel& row, const MarkerJet& a, const MarkerJet& b, Jet s) noexcept;

/// Gradient of Phi at both ends. A row's force acts as -multiplier times this.
/// @param a, b    poses at which the force is taken: the step's end, or the mean of both ends
/// @param length  of springs: |p_B - p_A| there, for a mean that of both ends' lengths, m
/// @param s       motion at the step's end
void row_gradient(const RowModel& row, const MarkerPose& a, const MarkerPose& b, double length,
                  double s, MarkerGradient& on_a, MarkerGradient& on_b) noexcept;

/// |p_B - p_A|, m.
double row_length(const MarkerPose& a, const MarkerPose& b) noexcept;

}  // namespace railstep
