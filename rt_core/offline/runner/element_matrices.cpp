#include "offline/runner/element_matrices.h"

#include <cmath>

#include "offline/math/refuse.h"
#include "online/runner/element_law.h"

namespace railstep {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Points of RisingCurve of a list of places and values.
std::vector<double> curve_points(const std::vector<double>& curve, double slope_behind) {
  std::vector<double> points;
  for (std::size_t i = 0; i < curve.size(); i += 2) {
    const bool last = i + 2 == curve.size();
    points.insert(points.end(), {curve[i], curve[i + 1],
                                 last ? slope_behind
                                      : (curve[i + 3] - curve[i + 1]) / (curve[i + 2] - curve[i])});
  }
  return points;
}

void check(const RunnerForceElement& e) {
  const auto refuse_it = [&](const std::string& why) {
    refuse("E-SUSPENSION-06", "element " + e.name + " has " + why);
  };
  if (is_friction(e.law)) {
    if (!(e.stiffness > 0.) || !(e.damping >= 0.))
      refuse_it(
          "a stiffness that is not above 0, or a damping below 0; expected a stiffness above "
          "0 and a damping of 0 or more");
    return;
  }
  if (!has_curve(e.law)) return;
  if (!(e.slope_before >= 0.) || !(e.slope_behind >= 0.) || !(e.series >= 0.))
    refuse_it("a stiffness or damping below 0; expected 0 or more");
  for (std::size_t i = 2; i < e.curve.size(); i += 2) {
    // Both ends of the gap of a bump stop may be one place.
    const bool level = e.curve[i] == e.curve[i - 2] && e.curve[i + 1] == e.curve[i - 1];
    if (!level && (!(e.curve[i] > e.curve[i - 2]) || !(e.curve[i + 1] >= e.curve[i - 1])))
      refuse_it(
          "a table that falls, or whose places do not rise; expected places that rise and "
          "forces that do not fall: the force of a falling table is not unique");
  }
}

std::vector<double> level_points(const RunnerForceElement& e) {
  std::vector<double> curve = e.curve;
  if (curve.size() == 4 && curve[0] == curve[2]) curve.resize(2);
  return curve_points(curve, e.slope_behind);
}

VectorXd row_of(const Runner& runner, const RunnerForceElement& e, Eigen::Index n) {
  if (e.is_brake()) {  // suspensions do not turn wheelsets, brakes do
    VectorXd row = VectorXd::Zero(n);
    row[kMotions * e.a + e.axis] = 1.;
    if (e.b != kGround) row[kMotions * e.b + e.axis] = -1.;
    return row;
  }
  if (e.along == RunnerForceElement::Along::line) {
    RunnerElement line{};
    line.kind = RunnerElement::Kind::line;
    line.a = e.a;
    line.b = e.b;
    line.point_a = e.point_a;
    line.point_b = e.point_b;
    return elongation(runner, line);
  }
  const bool about = e.along == RunnerForceElement::Along::about_axis;
  return deflection(runner, e.a, e.b, e.point_a, static_cast<BodyMotion>(e.axis + (about ? 3 : 0)));
}

bool is_line(const RunnerElement& e) { return e.kind != RunnerElement::Kind::mid_frame; }

/// The force with which an element presses its ends together: that along z, or against its tension.
/// Its displacement is such that it rises with the force.
void add_load(const Runner& runner, const RunnerElement& presser, RunnerMatrices::Element& made) {
  constexpr auto z = static_cast<std::size_t>(index_of(BodyMotion::z));
  const bool line = is_line(presser);
  const double preload = line ? presser.preload[0] : presser.preload[z];
  const double sign = line || preload >= 0. || presser.presses_only ? -1. : 1.;
  made.law.loaded = 1;
  made.law.load_stiffness = line ? presser.stiffness[0] : presser.stiffness[z];
  made.law.load_at_rest = line ? -preload : std::fabs(preload);
  made.law.load_at_rest -= made.law.load_stiffness * presser.clearance;
  made.load =
      sign * (line ? elongation(runner, presser)
                   : deflection(runner, presser.a, presser.b, presser.point_a, BodyMotion::z));
}

/// The curve of a spring along z that presses only, from its force at rest on.
void add_pressing(const RunnerElement& presser, RunnerMatrices::Element& made) {
  constexpr auto z = static_cast<std::size_t>(index_of(BodyMotion::z));
  const double k = presser.stiffness[z], preload = presser.preload[z];
  if (preload < 0.)
    refuse("E-SUSPENSION-08",
           "support " + presser.name + " would carry " + std::to_string(preload) +
               " N where the vehicle stands; expected 0 or more: its first body stands on the "
               "second");
  made.law.preload = preload;
  made.law.curve.slope_before = k;
  made.curve = {preload / k - presser.clearance, preload, 0.};
}

/// The slope of an element where it is at rest.
double slope_at_rest(const RunnerMatrices::Element& e) {
  ForceElement law = e.law;
  law.curve.points = static_cast<std::int32_t>(e.curve.size() / 3);
  law.curve.point = e.curve.data();
  // Where a corner stands at rest: the mean of both sides.
  constexpr double kStill = 1e-12;
  return .5 * (curve_at(law.curve, -kStill).slope + curve_at(law.curve, kStill).slope);
}

/// The value at the start: inputs are 0.
double first_value(const RunnerMatrices::Element& e) { return e.value.empty() ? 0. : e.value[1]; }

/// The force of an element that has come from its place at rest to a displacement in one way, along
/// the coordinates; no force of dampers and brakes.
ElementForce force_at(const RunnerMatrices::Element& e, const VectorXd& u) {
  if (e.law.law == ElementLaw::damper || is_brake(e.law)) return {0., 0., 0.};
  ForceElement law = e.law;
  law.curve.points = static_cast<std::int32_t>(e.curve.size() / 3);
  law.curve.point = e.curve.data();
  const double memory[kMostElementMemory] = {};
  return element_force(law, {memory, first_value(e), 0., 0.}, e.row.dot(u) + e.moved,
                       e.law.loaded != 0 ? e.load.dot(u) + e.load_moved : 0.);
}

}  // namespace

RunnerMatrices::Element made_element(const Runner& runner, const RunnerForceElement& e,
                                     RunnerMatrices& m) {
  check(e);
  RunnerMatrices::Element made{row_of(runner, e, m.mass.size()), {}, level_points(e), e.value};
  made.law.law = e.law;
  made.law.stiffness = e.stiffness;
  made.law.damping = e.damping;
  made.law.per_way = e.per_way;
  made.law.value.input = e.input;
  made.law.curve.slope_before = e.slope_before;
  if (e.pressed_by >= 0) {
    const RunnerElement& presser = runner.elements[static_cast<std::size_t>(e.pressed_by)];
    if (is_friction(e.law))
      add_load(runner, presser, made);
    else
      add_pressing(presser, made);
  }
  if (e.series > 0.) {
    made.series = static_cast<int>(m.series.size());
    m.series.push_back({made.row, e.series, slope_at_rest(made)});
    made.law.loaded = 1;
    made.law.load_stiffness = e.series;
    made.load = made.row;
    made.row.setZero();
  }
  return made;
}

VectorXd element_forces(const RunnerMatrices& m, const VectorXd& u) {
  VectorXd sum = VectorXd::Zero(u.size());
  for (const RunnerMatrices::Element& e : m.force_elements) sum += force_at(e, u).force * e.row;
  return sum;
}

MatrixXd stiffness_at(const RunnerMatrices& m, const VectorXd& u) {
  MatrixXd K = m.stiffness;
  for (const RunnerMatrices::Element& e : m.force_elements) {
    const ElementForce own = force_at(e, u);
    K -= own.slope * e.row * e.row.transpose();
    if (e.law.loaded != 0) K -= own.load_slope * e.row * e.load.transpose();
  }
  return K;
}

MatrixXd sticking_stiffness_at(const RunnerMatrices& m, const VectorXd& u) {
  MatrixXd K = m.stiffness;
  for (const RunnerMatrices::Element& e : m.force_elements)
    if (!is_brake(e.law))
      K += (is_friction(e.law.law) ? e.law.stiffness : -force_at(e, u).slope) * e.row *
           e.row.transpose();
  return K;
}

MatrixXd damping_at_rest(const RunnerMatrices& m) {
  MatrixXd C = m.damping;
  for (const RunnerMatrices::Element& e : m.force_elements) {
    if (e.law.law == ElementLaw::damper) C += slope_at_rest(e) * e.row * e.row.transpose();
    if (is_friction(e.law.law) && !is_brake(e.law)) C += e.law.damping * e.row * e.row.transpose();
  }
  return C;
}

}  // namespace railstep
