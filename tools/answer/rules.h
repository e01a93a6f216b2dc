#pragma once
#include <string>
#include <vector>

#include "answer/rules_beam.h"

namespace railstep {

/// A rule and what of it departs from the default.
struct NamedRule {
  std::string family;  // default, axial, coupling-points, section, reference-line, coupling, shear
  std::string name;
  StudyRule rule;
};

/// Every rule of the study: each family varies one choice and leaves the others at the default.
std::vector<NamedRule> study_rules();

/// The cost of one element. Counts follow from the rule alone; times are the general kernel's on
/// this machine, the best of many.
struct RuleCost {
  /// Strains a loop over Gauss points evaluates: 3 n^2 in the section for each axial point of D0,
  /// one for each of Dv; with exact moments those along the axis alone.
  int gauss_points;
  int force_flops;  // of beam_force() were it to pass over the zeros of the points' stiffness
  double force_us, tangent_us;
};
RuleCost rule_cost(const StudyRule& rule);

struct StudyRow {
  NamedRule rule;
  double poisson;
  int elements;
  RuleCost cost;
  std::string load = {};    // "tip node", "between nodes", "large bending", "large twist"
  double load_x = 0.;       // m
  double tip_error = 0.;    // of the deflection under the load (of the turn in the large twist),
                            // relative; below 0 too stiff
  double twist_error = 0.;  // of the tip's twist under a torque, against Saint-Venant's
  int rank_deficiency = 0;  // zero modes of one element beyond the six rigid ones
  int negative_eigenvalues = 0;  // of one element
};

/// All rows, errors NaN where the stiffness is singular: 1, 2, 4, 8 and 16 elements and nu = 0, .3,
/// .45, .49 and .499 for every rule. Small displacements are compared with Timoshenko's beam. Large
/// ones, at nu = .3 alone, are compared with the default rule on 64 elements, whose own error (by
/// 32) is 1e-6: bending for the families default, axial and section, twist for default and section.
std::vector<StudyRow> study_rows(const std::vector<NamedRule>& rules);

}  // namespace railstep
