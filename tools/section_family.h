#pragma once
#include <vector>

#include "section_fit.h"

namespace railstep {

/// Sections that have the targets, on a grid of head heights, every branch of the family. With both
/// outer heights given, A, A z_c and Iy + A z_c2 are linear in the three widths; their solution
/// leaves one equation, Iz, whose roots are bracketed on a grid of foot heights and bisected. Good
/// to about 1e-12 relative; only positive dimensions. Neighbours along a branch are not adjacent in
/// the list.
std::vector<Rectangles<double>> section_family(const FitTargets& targets, int head_heights);

}  // namespace railstep
