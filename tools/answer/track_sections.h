#pragma once
#include <vector>

#include "answer/assessment.h"
#include "offline/runner/line_shape.h"

namespace railstep {

/// The sections in which a part of a design line is assessed. Straight track and curves of one
/// radius are divided into equal sections of about 250 m, in curves below 600 m of radius of 100 m
/// and below 400 m of 70 m (from memory of EN 14363); a transition is one section. Parts shorter
/// than that are whole sections.
/// @param from, to  m along the line
/// Kinds are those over 10 m, so that tables of rows that are close, or that were measured, divide
/// as others do: a transition changes its curvature by more than 1e-5 1/m or its cant by more than
/// 1.5 mm there.
std::vector<TrackSection> sections_between(const LineShape& line, double from, double to);

/// The length of a whole section of its kind, m; 0 of transitions.
double nominal_length(const TrackSection& part);

}  // namespace railstep
