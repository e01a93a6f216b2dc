#pragma once
#include <filesystem>
#include <string>

#include "offline/section/outline.h"

namespace railstep {

inline constexpr double kMillimetre = 1e-3;  // m, of profile files

/// Published properties of a profile, to compare with; a value that is not published is NaN.
struct Published {
  double area, centroid_height, inertia_y, inertia_z;    // m2, m, m4, m4
  double torsion, shear_factor_y, shear_factor_z;        // m4, 1, 1
  double section_modulus_head, section_modulus_foot;     // m3
  double height, base_width, head_width, web_thickness;  // m
  double head_depth, base_thickness;                     // m
};

/// A profile file, or the outline in a list of points (of which nothing is published).
struct Profile {
  std::string name, source;
  Outline outline;
  Published published;
};

class Table;

/// A profile or a section file (TOML). Throws InputError, and for a list of points it says what to
/// do.
Table read_shape_file(const std::filesystem::path& file);

/// Reads a profile: TOML as in config/README.md, "Profiles". Throws InputError.
Profile read_profile(const std::filesystem::path& file);

/// Reads a full outline from a list of points, one "y z" a line, separated by comma, blank, tab or
/// semicolon; `metres` per unit of the file. Lines that are empty or start with # are skipped, as
/// is a first line of column names. Throws InputError.
Profile read_points(const std::filesystem::path& file, double metres);

}  // namespace railstep
