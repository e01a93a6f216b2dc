#include "answer/rules.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

namespace railstep {
namespace {

constexpr int kElements[] = {1, 2, 4, 8, 16};
constexpr double kPoissons[] = {0., .3, .45, .49, .499};
constexpr int kReferenceElements = 64;
constexpr double kNoAnswer = std::numeric_limits<double>::quiet_NaN();

/// Floating-point operations of beam_force() at one point whose stiffness has this many entries.
int point_flops(int entries) {
  constexpr int vectors = 15 * 5;            // three products and two sums each
  constexpr int strains = 15 * 6 + 5;        // a dot product less s0; halves on the diagonal
  constexpr int vector_forces = 25 * 3 * 2;  // 10 products act on two vectors, 5 on one
  constexpr int nodal = 9 * 2 + 18 * 4;      // of r; of a and b by slope and value
  return vectors + strains + 2 * entries + vector_forces + nodal;
}

/// Entries that are not round-off: true ones are above 1e-7 of the largest, round-off below 1e-15.
int nonzeros(const BeamPoint& point) {
  const Eigen::Map<const Eigen::Matrix<double, kProducts, kProducts>> C(&point.stiffness[0][0]);
  return static_cast<int>((C.array().abs() > 1e-12 * C.cwiseAbs().maxCoeff()).count());
}

int force_flops(const Beam& beam) {
  int sum = 0;
  for (int g = 0; g < beam.points; ++g) sum += point_flops(nonzeros(beam.point[g]));
  return sum;
}

/// Microseconds per call, the best of 20 batches.
template <typename Call>
double best_time(int calls, const Call& call) {
  double best = std::numeric_limits<double>::infinity();
  for (int batch = 0; batch < 20; ++batch) {
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < calls; ++i) call();
    const std::chrono::duration<double, std::micro> took = std::chrono::steady_clock::now() - start;
    best = std::min(best, took.count() / calls);
  }
  return best;
}

constexpr double kLargePoisson = .3;

/// Deflection and turn that all rules are compared with where displacements are large.
struct LargeReference {
  double deflection, turn;
};
LargeReference large_reference() {
  const BeamLaw law = study_law({}, {.poisson = kLargePoisson});
  return {large_deflection(law, kReferenceElements), large_turn(law, kReferenceElements)};
}

bool of_section(const NamedRule& rule) {
  return rule.family == "default" || rule.family == "section";
}

/// The rows of one rule, material and mesh.
void add_rows(StudyRow row, const Material& material, const LargeReference& large,
              std::vector<StudyRow>& rows) {
  const BeamLaw law = study_law(row.rule.rule, material);
  const ElementModes modes = element_modes(law, study::kLength / row.elements);
  row.rank_deficiency = modes.zero - 6;
  row.negative_eigenvalues = modes.negative;
  row.twist_error = twist_compliance(law, row.elements) / exact_twist(material) - 1.;
  const Compliance found = vertical_compliance(law, row.elements);
  const auto add = [&](const char* load, double x, double error) {
    row.load = load;
    row.load_x = x;
    row.tip_error = error;
    rows.push_back(row);
  };
  const double tip = study::kLength, between = between_nodes(row.elements);
  add("tip node", tip, found.tip / exact_compliance(material, tip) - 1.);
  add("between nodes", between, found.between / exact_compliance(material, between) - 1.);
  if (row.poisson != kLargePoisson) return;
  if (of_section(row.rule) || row.rule.family == "axial")
    add("large bending", tip, large_deflection(law, row.elements) / large.deflection - 1.);
  if (of_section(row.rule)) {
    const bool singular = std::isnan(row.twist_error);
    add("large twist", tip, singular ? kNoAnswer : large_turn(law, row.elements) / large.turn - 1.);
  }
}

}  // namespace

std::vector<NamedRule> study_rules() {
  std::vector<NamedRule> all = {{"default", "default", {}}};
  for (const int points : {1, 3, 4, 5})
    all.push_back(
        {"axial", fmt::format("{} axial points", points), {.element = {.axial_points = points}}});
  constexpr int pairs[][2] = {{1, 2}, {1, 3}, {2, 1}, {2, 3}, {2, 4},
                              {2, 5}, {3, 1}, {3, 2}, {3, 4}, {4, 2}};
  for (const auto& [axial, coupling] : pairs)
    all.push_back({"coupling-points",
                   fmt::format("D0 at {} and Dv at {}", axial, coupling),
                   {.element = {.axial_points = axial, .coupling_points = coupling}}});
  for (const int points : {1, 2, 3})
    all.push_back(
        {"section", fmt::format("{0}x{0} per rectangle", points), {.section_points = points}});
  const double height =
      study::kRectangles.height[0] + study::kRectangles.height[1] + study::kRectangles.height[2];
  const std::pair<const char*, double> lines[] = {
      {"mid-height", .5 * height - study::kCentroidHeight}, {"foot", -study::kCentroidHeight}};
  for (const auto& [name, up] : lines) {
    all.push_back(
        {"reference-line", fmt::format("reference line at {}", name), {.reference_height = up}});
    all.push_back({"reference-line",
                   fmt::format("reference line and Dv at {}", name),
                   {.element = {.coupling = Coupling::axis}, .reference_height = up}});
  }
  all.push_back({"coupling", "D not split", {.element = {.coupling = Coupling::section}}});
  all.push_back({"shear", "torsion not split", {.element = {.shear = Shear::factors}}});
  all.push_back({"shear", "2E13 at shear centre", {.element = {.shear = Shear::offset}}});
  all.push_back({"shear", "neither factors nor split", {.element = {.shear = Shear::published}}});
  return all;
}

RuleCost rule_cost(const StudyRule& rule) {
  const int axial = rule.element.axial_points;
  const int coupling = rule.element.coupling_points == 0 ? axial : rule.element.coupling_points;
  const int n = rule.section_points;
  const int apart = coupling == axial ? 0 : coupling;
  const Vector27 rest = straight_nodes(.6);
  const Beam beam = beam_element(study_law(rule, {}), rest);
  Vector27 q = rest, force;
  for (int i = 0; i < 27; ++i) q[i] += 1e-3 * (i % 5 - 2);
  Matrix27 tangent;
  return {n == 0 ? axial + apart : 3 * n * n * axial + coupling, force_flops(beam),
          best_time(200, [&] { beam_force(beam, q.data(), force.data()); }),
          best_time(20, [&] { beam_tangent(beam, q.data(), force.data(), tangent.data()); })};
}

std::vector<StudyRow> study_rows(const std::vector<NamedRule>& rules) {
  const LargeReference large = large_reference();
  std::vector<StudyRow> rows;
  for (const NamedRule& rule : rules) {
    const RuleCost cost = rule_cost(rule.rule);
    for (const double poisson : kPoissons)
      for (const int elements : kElements)
        add_rows({.rule = rule, .poisson = poisson, .elements = elements, .cost = cost},
                 {.poisson = poisson}, large, rows);
  }
  return rows;
}

}  // namespace railstep
