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
std::vector<TrackSection> sections_between(const LineShape& line, double from, double to);

}  // namespace railstep
