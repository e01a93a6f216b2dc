#include "answer/rules_beam.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "offline/beam/equilibrium.h"

namespace railstep {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Vertical displacement of the centroid at x, as a row over the unknowns.
Eigen::VectorXd centroid_row(const BeamLaw& law, int elements, double x) {
  const double length = study::kLength / elements;
  const int e = std::min(static_cast<int>(x / length), elements - 1);
  Eigen::VectorXd row = Eigen::VectorXd::Zero(9 * (2 * elements + 1));
  row.segment<27>(18 * e) =
      point_row(2. * (x - e * length) / length - 1., 0., law.moments.centroid_z(), 2);
  return row;
}

/// The stiffness at rest, factored.
class Flexibility {
 public:
  explicit Flexibility(const Structure& s) : structure_(s) {
    Eigen::VectorXd scale(s.unknowns());  // slopes as displacements at slope_length
    for (int i = 0; i < s.unknowns(); ++i) scale[i] = i % 9 < 3 ? 1. : 1. / s.slope_length;
    scale_ = free_part(s, scale);
    const Eigen::MatrixXd K = free_part(s, tangent(s, s.rest));
    solver_.compute(scale_.asDiagonal() * K * scale_.asDiagonal());
  }
  /// row' K^-1 row; NaN where K lacks a rank, to round-off of its largest pivot.
  double operator()(const Eigen::VectorXd& full_row) const {
    if (!solver_.isInvertible()) return kNone;
    const Eigen::VectorXd row = scale_.cwiseProduct(free_part(structure_, full_row));
    return row.dot(solver_.solve(row));
  }

 private:
  const Structure& structure_;
  Eigen::VectorXd scale_;
  Eigen::FullPivLU<Eigen::MatrixXd> solver_;
};

}  // namespace

BeamSection study_section(int section_points) {
  const auto& parts = study::kRectangles;
  return {.area = 8700e-6,
          .inertia_y = 39.0e-6,
          .inertia_z = 6.0e-6,
          .torsion = 1.9514e-6,
          .shear_factor_y = .4796,
          .shear_factor_z = .4721,
          .shear_centre_z = -.0391,
          .moments = section_points == 0 ? moments(parts) : moments(parts, section_points)};
}

BeamLaw study_law(const StudyRule& rule, const Material& material) {
  return beam_law(study_section(rule.section_points), material, rule.element,
                  rule.reference_height);
}

Structure study_cantilever(const BeamLaw& law, int elements, BendingPlane motion) {
  const double length = study::kLength / elements;
  const int nodes = 2 * elements + 1;
  Structure s;
  s.laws = {beam_element(law, straight_nodes(length))};
  s.elements = chain(elements);
  s.rest = Eigen::VectorXd::Zero(9 * nodes);
  for (int node = 0; node < nodes; ++node) {
    s.rest[9 * node] = .5 * node * length;
    s.rest[9 * node + 4] = s.rest[9 * node + 8] = 1.;
  }
  constexpr bool vertical[9] = {true, false, true, false, true, false, true, false, true};
  for (int i = 0; i < 9 * nodes; ++i)
    s.held.push_back(i < 9 || vertical[i % 9] != (motion == BendingPlane::vertical));
  return s;
}

double between_nodes(int elements) {
  const int before = elements / 2;  // the element that begins at mid-length
  return study::kLength / elements * (before + .25);
}

Compliance vertical_compliance(const BeamLaw& law, int elements) {
  const Structure s = study_cantilever(law, elements, BendingPlane::vertical);
  const Flexibility flexibility(s);
  return {flexibility(centroid_row(law, elements, study::kLength)),
          flexibility(centroid_row(law, elements, between_nodes(elements)))};
}

double exact_compliance(const Material& material, double x) {
  const SectionMoments m = moments(study::kRectangles);
  return x * x * x / (3. * material.young * m.of[0][2]) +
         x / (study_section(0).shear_factor_z * material.shear_modulus() * m.area());
}

double twist_compliance(const BeamLaw& law, int elements) {
  const Structure s = study_cantilever(law, elements, BendingPlane::lateral);
  Eigen::VectorXd row = Eigen::VectorXd::Zero(s.unknowns());
  const int tip = s.unknowns() - 9;
  row[tip + 5] = .5;  // (a_z - b_y)/2
  row[tip + 7] = -.5;
  return Flexibility(s)(row);
}

double exact_twist(const Material& material) {
  return study::kLength / (material.shear_modulus() * study_section(0).torsion);
}

double large_deflection(const BeamLaw& law, int elements) {
  const Structure s = study_cantilever(law, elements, BendingPlane::vertical);
  const Eigen::VectorXd tip = centroid_row(law, elements, study::kLength);
  const double force = study::kLargeLoad * law.material.young * study_section(0).inertia_y /
                       (study::kLength * study::kLength);
  const Equilibrium found = equilibrium(s, {.force = -force * tip});
  return found.converged ? -tip.dot(found.q - s.rest) : kNone;
}

double large_turn(const BeamLaw& law, int elements) {
  Structure s = study_cantilever(law, elements, BendingPlane::lateral);
  for (std::size_t i = 9; i < s.held.size(); ++i) s.held[i] = false;
  const double torque = study::kLargeTwist * law.material.shear_modulus() * law.torsion;
  const StructureLoad load{.force = Eigen::VectorXd::Zero(s.unknowns()),
                           .moments = {{2 * elements, {torque, 0., 0.}}}};
  const Equilibrium found = equilibrium(s, load);
  if (!found.converged) return kNone;
  const Eigen::VectorXd slopes = found.q.tail(6);  // a, b
  return .5 * (std::atan2(slopes[2], slopes[1]) + std::atan2(-slopes[4], slopes[5]));
}

ElementModes element_modes(const BeamLaw& law, double length) {
  const ElementMatrices e = element_matrices(study_section(0), law, length);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(
      Eigen::MatrixXd(e.stiffness), Eigen::MatrixXd(e.mass), Eigen::EigenvaluesOnly);
  const Eigen::ArrayXd values = solver.eigenvalues().array();
  const double limit = 1e-10 * values.abs().maxCoeff();
  return {static_cast<int>((values.abs() < limit).count()),
          static_cast<int>((values <= -limit).count())};
}

}  // namespace railstep
