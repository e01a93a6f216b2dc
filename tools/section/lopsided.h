#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "offline/section/outline.h"
#include "text/message.h"

namespace railstep {

/// Properties that are 0 for a section that is symmetric about its axis. Offsets are along y, from
/// the middle of the foot, where a seat carries it.
struct Lopsided {
  double share;                // of the area, as asymmetry()
  double product_of_inertia;   // Iyz, m4
  double centroid_offset;      // m
  double shear_centre_offset;  // m; NaN where it is not known
};

/// Angle of the principal axis next to the level one, rad, from it towards up; within 45 degrees.
double principal_angle(const AreaProperties<double>& area, double product_of_inertia);

/// A warning with the numbers where the part that a symmetric section leaves out matters to a
/// track; nothing where it does not. A vertical force bends the outline sideways by Iyz/Iz of its
/// deflection, and twists it about the shear centre as a lateral force at the crown does that is
/// smaller by the offset over the crown's height above it. The warning is given from a tenth of
/// either on: standards allow a railhead 1.2 mm off its axis, and that rail bends sideways by 0.05
/// of its deflection.
std::optional<Message> lopsided_warning(const Lopsided& lopsided, const Section& section);

/// [asymmetry] of a section file, where it has one. Throws InputError.
std::optional<Lopsided> read_lopsided(const std::filesystem::path& file);

}  // namespace railstep
