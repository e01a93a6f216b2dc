#include "offline/runner/suspension.h"

#include <Eigen/Dense>
#include <cmath>

#include "offline/math/refuse.h"
#include "offline/runner/element_matrices.h"

namespace railstep {

namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Rows = Eigen::Matrix<double, 3, Eigen::Dynamic>;

Vector3d vector(const std::array<double, 3>& x) { return {x[0], x[1], x[2]}; }

Matrix3d cross_matrix(const Vector3d& v) {
  Matrix3d m;
  m << 0., -v[2], v[1], v[2], 0., -v[0], -v[1], v[0], 0.;
  return m;
}

/// One end of an element: a point of a body.
struct End {
  int first;  // coordinate of the body; -1: it is the ground
  bool wheelset;
  Vector3d arm;  // from the body's centre to the point, m
};

End end_of(const Runner& runner, int body, const std::array<double, 3>& point) {
  if (body == kGround) return {-1, false, Vector3d::Zero()};
  const RunnerBody& b = runner.bodies[static_cast<std::size_t>(body)];
  return {kMotions * body, b.is_wheelset(), vector(point) - vector(b.centre)};
}

/// Rotation of the body at an end. The axle boxes of a wheelset do not spin with it.
Rows rotation(const End& end, Eigen::Index n) {
  Rows r = Rows::Zero(3, n);
  for (int d = 0; d < 3 && end.first >= 0; ++d)
    if (d != 1 || !end.wheelset) r(d, end.first + 3 + d) = 1.;
  return r;
}

/// Displacement of the point of an end, of first order.
Rows displacement(const End& end, Eigen::Index n) {
  Rows r = -cross_matrix(end.arm) * rotation(end, n);
  for (int d = 0; d < 3 && end.first >= 0; ++d) r(d, end.first + d) = 1.;
  return r;
}

/// Second derivative of p . (displacement of second order): t x (t x arm) / 2 for a rotation vector
/// t. A wheelset yaws and then rolls, so that its rotation vector has roll yaw / 2 about y.
MatrixXd bend(const End& end, const Vector3d& p, Eigen::Index n) {
  const Rows t = rotation(end, n);
  const Matrix3d turned = .5 * (p * end.arm.transpose() + end.arm * p.transpose()) -
                          p.dot(end.arm) * Matrix3d::Identity();
  MatrixXd m = t.transpose() * turned * t;
  if (end.wheelset) {
    const int roll = end.first + index_of(BodyMotion::roll),
              yaw = end.first + index_of(BodyMotion::yaw);
    const double moment = .5 * end.arm.cross(p)[1];
    m(roll, yaw) += moment;
    m(yaw, roll) += moment;
  }
  return m;
}

bool is_along_line(const RunnerElement& e) { return e.kind != RunnerElement::Kind::mid_frame; }

Vector3d direction(const RunnerElement& e) {
  const Vector3d way = vector(e.point_b) - vector(e.point_a);
  return way / way.norm();
}

/// Force on body `a` at rest.
Vector3d preload_force(const RunnerElement& e) {
  if (is_along_line(e)) return e.preload[0] * direction(e);
  return {e.preload[0], e.preload[1], e.preload[2]};
}

/// Deflections of an element's springs over the coordinates, each with its entry.
struct Spring {
  std::size_t entry;
  VectorXd row;
};
std::vector<Spring> springs(const Runner& runner, const RunnerElement& e) {
  const auto n = static_cast<Eigen::Index>(kMotions * runner.bodies.size());
  const End a = end_of(runner, e.a, e.point_a), b = end_of(runner, e.b, e.point_b);
  const Rows moved = displacement(a, n) - displacement(b, n);
  if (is_along_line(e)) return {{0, -moved.transpose() * direction(e)}};
  const Rows turned = rotation(a, n) - rotation(b, n);
  std::vector<Spring> all;
  all.reserve(kMotions);
  for (int d = 0; d < 3; ++d) all.push_back({static_cast<std::size_t>(d), moved.row(d)});
  for (int d = 0; d < 3; ++d) all.push_back({static_cast<std::size_t>(3 + d), turned.row(d)});
  return all;
}

/// Part of the stiffness that an element's preload makes.
MatrixXd geometric_stiffness(const Runner& runner, const RunnerElement& e) {
  const auto n = static_cast<Eigen::Index>(kMotions * runner.bodies.size());
  const End a = end_of(runner, e.a, e.point_a), b = end_of(runner, e.b, e.point_b);
  const Vector3d p = preload_force(e);
  const Rows moved = displacement(a, n) - displacement(b, n);
  MatrixXd g = bend(b, p, n) - bend(a, p, n);
  if (is_along_line(e)) {
    const Vector3d along = direction(e);
    const double length = (vector(e.point_b) - vector(e.point_a)).norm();
    const Matrix3d across = Matrix3d::Identity() - along * along.transpose();
    return g + e.preload[0] / length * moved.transpose() * across * moved;
  }
  const Rows mean = .5 * (rotation(a, n) + rotation(b, n));
  const MatrixXd turned = mean.transpose() * cross_matrix(p) * moved;
  return g - turned - turned.transpose();
}

/// Force of an element's preload over the coordinates.
VectorXd preload(const Runner& runner, const RunnerElement& e) {
  const auto n = static_cast<Eigen::Index>(kMotions * runner.bodies.size());
  VectorXd sum = VectorXd::Zero(n);
  const double sign = is_along_line(e) ? -1. : 1.;  // tension pulls `a` to `b`
  for (const Spring& s : springs(runner, e)) sum += sign * e.preload[s.entry] * s.row;
  return sum;
}

void check_bodies(const Runner& runner, const std::string& name, int a, int b) {
  const auto is_body = [&](int body) {
    return body >= kGround && body < static_cast<int>(runner.bodies.size());
  };
  if (!is_body(a) || !is_body(b) || a == b)
    refuse("E-SUSPENSION-01", "element " + name +
                                  " does not join two bodies of its vehicle, or a body and the "
                                  "ground; expected two different ones");
}

void check_element(const Runner& runner, const RunnerElement& e) {
  check_bodies(runner, e.name, e.a, e.b);
  if (is_along_line(e) && !((vector(e.point_b) - vector(e.point_a)).norm() > 0.))
    refuse("E-SUSPENSION-02",
           "element " + e.name + " has no length; expected two points that differ");
  for (std::size_t d = 0; d < e.stiffness.size(); ++d)
    if (!(e.stiffness[d] >= 0.) || !(e.damping[d] >= 0.) || !(e.series[d] >= 0.))
      refuse("E-SUSPENSION-03",
             "a stiffness or damping of element " + e.name + " is negative; expected 0 or more");
}

void check(const Runner& runner) {
  for (const RunnerBody& b : runner.bodies)
    if (!(b.mass > 0.) || !(b.inertia[0] > 0.) || !(b.inertia[1] > 0.) || !(b.inertia[2] > 0.))
      refuse("E-SUSPENSION-04",
             "body " + b.name + " has a mass or an inertia that is not positive; expected above 0");
  for (const RunnerElement& e : runner.elements) check_element(runner, e);
  for (const RunnerForceElement& e : runner.force_elements) check_bodies(runner, e.name, e.a, e.b);
}

VectorXd weights(const Runner& runner, double gravity) {
  VectorXd w = VectorXd::Zero(static_cast<Eigen::Index>(kMotions * runner.bodies.size()));
  for (std::size_t b = 0; b < runner.bodies.size(); ++b)
    w[kMotions * static_cast<Eigen::Index>(b) + index_of(BodyMotion::z)] =
        gravity * runner.bodies[b].mass;
  return w;
}

bool has_preload(const RunnerElement& e) {
  for (const double p : e.preload)
    if (p != 0.) return true;
  return false;
}

/// Throws Refused unless preloads carry the weight of each body without wheels.
void check_balance(const Runner& runner, const VectorXd& rest, double weight) {
  for (std::size_t b = 0; b < runner.bodies.size(); ++b) {
    if (runner.bodies[b].is_wheelset()) continue;
    const auto first = kMotions * static_cast<Eigen::Index>(b);
    if (!(rest.segment(first, kMotions).cwiseAbs().maxCoeff() <= 1e-6 * weight))
      refuse("E-SUSPENSION-05",
             "the preloads and springs of the vehicle do not carry body " + runner.bodies[b].name +
                 "; expected springs or preloads that hold its weight in balance");
  }
}

void add_rod(const Runner& runner, const RunnerElement& e, RunnerMatrices& m) {
  m.rods.conservativeResize(Eigen::NoChange, m.rods.cols() + 1);
  m.rods.rightCols(1) = elongation(runner, e);
  m.rods_moved = VectorXd::Zero(m.rods.cols());
  m.stiffness += geometric_stiffness(runner, e);
}

/// @param series  of an entry: the number of its spring in series with a damper, or -1
void add_traced(const RunnerElement& e, const std::vector<Spring>& springs,
                const std::array<int, kMotions>& series, RunnerMatrices& m) {
  const bool line = is_along_line(e);
  const double sign = line ? -1. : 1.;  // a tension grows with the length
  for (const int entry : traced_entries(e)) {
    const auto k = static_cast<std::size_t>(entry);
    TracedElement own{sign * e.stiffness[k], 0., 0., e.preload[k], 0, line ? kTracedLine : entry};
    if (series[k] >= 0) {
      own.series = sign * e.series[k];
      own.deflection = series[k];
    } else if (e.series[k] == 0.) {
      own.damping = sign * e.damping[k];
    }
    m.traced.push_back({springs[k].row, own});
  }
}

/// The deflection of least norm under a load, and the tensions of rods that keep their lengths.
std::pair<VectorXd, VectorXd> deflection_under(const MatrixXd& K, const MatrixXd& rods,
                                               const VectorXd& load) {
  const Eigen::Index n = K.rows(), held = rods.cols();
  const double scale = K.diagonal().maxCoeff();  // entries of one size, for the rank
  MatrixXd A = MatrixXd::Zero(n + held, n + held);
  A.topLeftCorner(n, n) = K;
  A.topRightCorner(n, held) = scale * rods;
  A.bottomLeftCorner(held, n) = scale * rods.transpose();
  VectorXd b = VectorXd::Zero(n + held);
  b.head(n) = load;
  const VectorXd solved = A.completeOrthogonalDecomposition().solve(b);
  return {solved.head(n), scale * solved.tail(held)};
}

}  // namespace

RunnerMatrices runner_matrices(const Runner& runner, double gravity) {
  check(runner);
  const auto n = static_cast<Eigen::Index>(kMotions * runner.bodies.size());
  RunnerMatrices m{VectorXd::Zero(n),
                   MatrixXd::Zero(n, n),
                   MatrixXd::Zero(n, n),
                   -weights(runner, gravity),
                   {},
                   {},
                   {},
                   MatrixXd::Zero(n, 0)};
  for (std::size_t b = 0; b < runner.bodies.size(); ++b)
    for (int d = 0; d < 3; ++d) {
      const auto first = kMotions * static_cast<Eigen::Index>(b);
      m.mass[first + d] = runner.bodies[b].mass;
      m.mass[first + 3 + d] = runner.bodies[b].inertia[static_cast<std::size_t>(d)];
    }
  for (const RunnerElement& e : runner.elements) {
    if (e.kind == RunnerElement::Kind::rod) {
      add_rod(runner, e, m);
      continue;
    }
    const std::vector<Spring> own = springs(runner, e);
    std::array<int, kMotions> number;
    number.fill(-1);
    for (const Spring& s : own) {
      const double damping = e.damping[s.entry], series = e.series[s.entry];
      if (!e.presses_only) m.stiffness += e.stiffness[s.entry] * s.row * s.row.transpose();
      if (series == 0.)
        m.damping += damping * s.row * s.row.transpose();
      else if (damping > 0.) {
        number[s.entry] = static_cast<int>(m.series.size());
        m.series.push_back({s.row, series, damping});
      }
    }
    if (e.traced) add_traced(e, own, number, m);
    if (!has_preload(e)) continue;
    m.stiffness += geometric_stiffness(runner, e);
    m.rest += preload(runner, e);
  }
  for (const RunnerForceElement& e : runner.force_elements)
    m.force_elements.push_back(made_element(runner, e, m));
  return m;
}

std::vector<int> traced_entries(const RunnerElement& e) {
  if (!e.traced) return {};
  if (is_along_line(e)) return {0};
  std::vector<int> all;
  for (std::size_t k = 0; k < e.stiffness.size(); ++k)
    if (e.stiffness[k] > 0. || e.damping[k] > 0.) all.push_back(static_cast<int>(k));
  return all;
}

VectorXd elongation(const Runner& runner, const RunnerElement& element) {
  return springs(runner, element).front().row;
}

VectorXd deflection(const Runner& runner, int a, int b, const std::array<double, 3>& point,
                    BodyMotion along) {
  RunnerElement e{};
  e.a = a;
  e.b = b;
  e.point_a = e.point_b = point;
  return springs(runner, e)[static_cast<std::size_t>(index_of(along))].row;
}

void balance_preloads(Runner& runner, double gravity) {
  check(runner);
  const auto n = static_cast<Eigen::Index>(kMotions * runner.bodies.size());
  VectorXd rest = -weights(runner, gravity);
  const double weight = -rest.sum();
  MatrixXd K = MatrixXd::Zero(n, n), rods = MatrixXd::Zero(n, 0);
  std::vector<RunnerElement*> open, open_rods;
  for (RunnerElement& e : runner.elements) {
    if (has_preload(e)) {
      rest += preload(runner, e);
    } else if (e.kind == RunnerElement::Kind::rod) {
      open_rods.push_back(&e);
      rods.conservativeResize(Eigen::NoChange, rods.cols() + 1);
      rods.rightCols(1) = elongation(runner, e);
    } else if (!(e.clearance > 0.)) {
      open.push_back(&e);
      for (const Spring& s : springs(runner, e))
        K += e.stiffness[s.entry] * s.row * s.row.transpose();
    }
  }
  VectorXd load = rest;
  for (std::size_t b = 0; b < runner.bodies.size(); ++b) {
    if (!runner.bodies[b].is_wheelset()) continue;
    const auto first = kMotions * static_cast<Eigen::Index>(b);
    K.middleRows(first, kMotions).setZero();
    K.middleCols(first, kMotions).setZero();
    rods.middleRows(first, kMotions).setZero();
    K.diagonal().segment(first, kMotions).setConstant(K.diagonal().maxCoeff());
    load.segment(first, kMotions).setZero();
  }
  const auto [sunk, tension] = deflection_under(K, rods, load);
  for (std::size_t i = 0; i < open_rods.size(); ++i) {
    if (std::fabs(tension[static_cast<Eigen::Index>(i)]) > 1e-12 * weight)
      open_rods[i]->preload[0] = tension[static_cast<Eigen::Index>(i)];
    rest += preload(runner, *open_rods[i]);
  }
  for (RunnerElement* e : open) {
    const double sign = is_along_line(*e) ? 1. : -1.;
    for (const Spring& s : springs(runner, *e)) {
      const double force = sign * e->stiffness[s.entry] * s.row.dot(sunk);
      if (std::fabs(force) > 1e-12 * weight) e->preload[s.entry] = force;
    }
    rest += preload(runner, *e);
  }
  check_balance(runner, rest, weight);
}

}  // namespace railstep
