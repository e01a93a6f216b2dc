#pragma once
#include <filesystem>
#include <optional>

#include "section/section_fit.h"
#include "text/read.h"

namespace railstep {

inline constexpr double kFitPoisson = 0.3;  // of steel, in Cowper's shear factors

inline constexpr double kChordTolerance = 1e-5;  // m, of the outline in the Saint-Venant solution

/// Constants of an outline itself.
struct OutlineShear {
  SaintVenant constants;
  double shear_centre_y;  // m, from the centroid; 0 of a symmetric one
  std::string missing;    // why its shear factors are NaN, else empty
};

/// Constants of an outline. A lopsided outline has those of Twist, and its shear factors are the
/// mean of both halves, each mirrored; NaN where it is too lopsided for that, or where Cowper's
/// factors lie outside of 0 to 1. Throws Refused for an outline that is too thin or ragged. @param
/// uneven  its asymmetry()
OutlineShear outline_shear(const Outline& outline, double uneven);

/// All properties of the three rectangles; `height` of the profile, m. Throws NoSection where their
/// shear factors cannot be had.
Section fitted_section(const SectionFit& fit, double height);

/// Constants of a section, from [rail.constants] or a section file's [section]. Throws InputError.
Section read_constants(const Table& t);

/// The largest second moment for vertical bending that a shape with a section's area, height and
/// centroid can have, m4: that of all its area at foot and head, A c (h - c).
double most_inertia(const Section& section);

/// Reads a section file, as `railstep fit --out` writes it: what a scene's `section` names. Only
/// its table [section] is used; the others say where it came from. Throws InputError, also where no
/// shape has its constants: a second moment over A c (h - c), that of all the area at foot and
/// head.
Section read_section(const std::filesystem::path& file);

/// The three rectangles of a section file, where it has [dimensions]. Throws InputError.
std::optional<Rectangles<double>> read_dimensions(const std::filesystem::path& file);

}  // namespace railstep
