#pragma once
#include <optional>
#include <vector>

#include "section/section_fit.h"

namespace railstep {

/// Sections that have the targets, on a grid of head heights, every branch of the family. With both
/// outer heights given, A, A z_c and Iy + A z_c2 are linear in the three widths; their solution
/// leaves one equation, Iz, whose roots are bracketed on a grid of foot heights and bisected. Good
/// to about 1e-12 relative; only positive dimensions. Neighbours along a branch are not adjacent in
/// the list.
std::vector<Rectangles<double>> section_family(const FitTargets& targets, int head_heights);

/// The exact section of this head height, m, whose foot is next to that of a given one, within a
/// twentieth of the height; nothing where no such section exists.
std::optional<Rectangles<double>> section_beside(const FitTargets& targets,
                                                 const Rectangles<double>& section, double head);

}  // namespace railstep
