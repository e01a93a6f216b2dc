#pragma once
#include "online/model/force_element.h"

namespace railstep {

/// Force on the first body, N or N m, and its slopes over the displacement and over that of its
/// load.
struct ElementForce {
  double force, slope, load_slope;
};

/// The force of an element. It does not rise with the displacement.
/// @param z     displacement; of friction from memory[0] on, m or rad
/// @param load  displacement of its load, m
ElementForce element_force(const ForceElement& e, const ElementStep& at, double z,
                           double load) noexcept;

/// The force of an element behind its own compliance: that of the z with q = z - compliance F(z).
/// Newton's method could go to and fro at the corners of laws, and over slopes that are steep
/// against the compliance.
/// @param q  m or rad, as z; slopes are over it
ElementForce element_force_behind(const ForceElement& e, const ElementStep& at, double compliance,
                                  double q, double load) noexcept;

/// Takes the end of a step over into the memory of friction.
/// @param memory  memory_of() its law
void keep_element(const ForceElement& e, const ElementStep& at, double z, double load,
                  double* memory) noexcept;

}  // namespace railstep
