#pragma once
#include "offline/beam/structure.h"
#include "offline/element/matrices.h"

namespace railstep {

/// The integration of an element, with the choices of the section.
struct StudyRule {
  ElementRule element = {};
  int section_points = 0;  // Gauss points each way in each rectangle, 1 to 3; 0: exact moments
  double reference_height = 0.;  // of the reference line above the centroid, m
};

/// The cantilever under study: section F (three rectangles, 136RE), clamped in all nine unknowns of
/// its first node. Shear factors and J are the same for every Poisson's ratio: Cowper's at 0.3.
namespace study {
inline constexpr double kLength = 2.;      // m
inline constexpr double kLargeLoad = 4.;   // F L^2 / (E Iy) of the large bending
inline constexpr double kLargeTwist = .5;  // T / (G J) of the large twist, rad/m
inline constexpr Rectangles<double> kRectangles = {{.1380985536, .02522171327, .07720505094},
                                                   {.020996636, .13308941227, .03165145173}};
inline constexpr double kCentroidHeight = .085;  // above the foot, m
}  // namespace study

/// The section with its moments as this rule integrates them.
BeamSection study_section(int section_points);

BeamLaw study_law(const StudyRule& rule, const Material& material);

/// The free unknowns: those of motion symmetric about y = 0 (bending down) or the others. A section
/// symmetric about y = 0 does not couple them.
enum class BendingPlane { vertical, lateral };

/// The cantilever of `elements` alike elements.
Structure study_cantilever(const BeamLaw& law, int elements, BendingPlane motion);

/// A place halfway between two nodes, whatever the number of elements: a quarter along the element
/// that begins at mid-length (of one element, along itself), m.
double between_nodes(int elements);

/// Deflection under a unit load, load and deflection vertical and at the centroid, small
/// displacements, m/N. NaN where the stiffness is singular.
struct Compliance {
  double tip;      // at the last node
  double between;  // at between_nodes()
};
Compliance vertical_compliance(const BeamLaw& law, int elements);

/// Timoshenko's of a load at x: x^3 / (3 E Iy) + x / (k_z G A), of the exact section.
double exact_compliance(const Material& material, double x);

/// Twist of the tip per unit torque, rad/(N m). NaN where singular.
double twist_compliance(const BeamLaw& law, int elements);

/// Saint-Venant's L / (G J).
double exact_twist(const Material& material);

/// Deflection (m, down positive) of the tip's centroid under F = kLargeLoad E Iy / L^2 which stays
/// vertical. NaN where Newton's method finds no solution.
double large_deflection(const BeamLaw& law, int elements);

/// Turn of the tip (rad) under T = kLargeTwist G J about x, mean of its two slopes'. NaN where
/// Newton's method finds no solution.
double large_turn(const BeamLaw& law, int elements);

/// Modes of one element, of its stiffness scaled by its mass.
struct ElementModes {
  int zero;      // |lambda| below 1e-10 of the largest, six of them rigid motion
  int negative;  // the stiffness is indefinite where there are some
};
ElementModes element_modes(const BeamLaw& law, double length);

}  // namespace railstep
