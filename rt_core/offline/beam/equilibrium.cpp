#include "offline/beam/equilibrium.h"

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseLU>
#include <cmath>
#include <limits>

#include "offline/math/sparse.h"

namespace railstep {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kRounded = 8., kIdle = 34.;  // roundings in a force; see equilibrium()

Matrix3d cross_matrix(const Vector3d& v) {
  Matrix3d m;
  m << 0., -v[2], v[1], v[2], 0., -v[0], -v[1], v[0], 0.;
  return m;
}

/// A moment M on a slope s acts as the force (M x s)/(s's).
Vector3d moment_force(const Vector3d& moment, const Vector3d& slope) {
  return moment.cross(slope) / slope.squaredNorm();
}

Matrix3d moment_tangent(const Vector3d& moment, const Vector3d& slope) {
  const double s2 = slope.squaredNorm();
  return cross_matrix(moment) / s2 - 2. / (s2 * s2) * moment.cross(slope) * slope.transpose();
}

/// Part of a moment that each slope of a node carries: b carries the moment about a, a that about
/// b, and each carries half about the normal. Frozen in the tangent, as sections stay nearly
/// square.
struct MomentShare {
  Vector3d on_a, on_b;
};

MomentShare shared(const Vector3d& moment, const Vector3d& a, const Vector3d& b) {
  const Vector3d normal = a.cross(b).normalized(), u = a.normalized(), v = normal.cross(u);
  const Vector3d along = .5 * moment.dot(normal) * normal;
  return {moment.dot(v) * v + along, moment.dot(u) * u + along};
}

/// Residual of the free unknowns: load minus internal force.
class Balance {
 public:
  Balance(const Structure& structure, const StructureLoad& load)
      : structure_(structure), load_(load), scale_(Eigen::VectorXd::Ones(structure.unknowns())) {
    for (int i = 0; i < 9 * structure.nodes(); ++i)
      if (i % 9 >= 3) scale_[i] = 1. / structure.slope_length;
  }

  Eigen::VectorXd external(const Eigen::VectorXd& q) const {
    Eigen::VectorXd force = load_.force;
    for (const auto& [node, moment] : load_.moments) {
      const Vector3d a = q.segment<3>(9 * node + 3), b = q.segment<3>(9 * node + 6);
      const MomentShare share = shared(moment, a, b);
      force.segment<3>(9 * node + 3) += moment_force(share.on_a, a);
      force.segment<3>(9 * node + 6) += moment_force(share.on_b, b);
    }
    return force;
  }

  Eigen::VectorXd residual(const Eigen::VectorXd& q, double factor) const {
    return free_part(structure_, factor * external(q) - internal_force(structure_, q));
  }

  Sparse stiffness(const Eigen::VectorXd& q, double factor) const {
    Sparse K = tangent(structure_, q);
    for (const auto& [node, moment] : load_.moments) {
      const int at[2] = {9 * node + 3, 9 * node + 6};
      const Vector3d a = q.segment<3>(at[0]), b = q.segment<3>(at[1]);
      const MomentShare share = shared(moment, a, b);
      const Matrix3d slopes[2] = {moment_tangent(share.on_a, a), moment_tangent(share.on_b, b)};
      for (int s = 0; s < 2; ++s)
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j) K.coeffRef(at[s] + i, at[s] + j) -= factor * slopes[s](i, j);
    }
    return free_part(structure_, K);
  }

  /// Norm with forces on slopes over slope_length.
  double size(const Eigen::VectorXd& free_force) const {
    return free_force.cwiseProduct(free_part(structure_, scale_)).norm();
  }

  /// Change of each internal force by a rounding of the positions. Far from where the structure
  /// lies it would excuse anything: a loose one flies away.
  Eigen::VectorXd noise(const Sparse& K, const Eigen::VectorXd& q) const {
    const double extent = 2. * structure_.rest.cwiseAbs().maxCoeff();
    const Eigen::VectorXd free_q = free_part(structure_, q).cwiseAbs().cwiseMin(extent);
    return std::numeric_limits<double>::epsilon() * (K.cwiseAbs() * free_q);
  }

 private:
  const Structure& structure_;
  const StructureLoad& load_;
  Eigen::VectorXd scale_;
};

void move(const Structure& s, const Eigen::VectorXd& step, Eigen::VectorXd& q) {
  int k = 0;
  for (int i = 0; i < s.unknowns(); ++i)
    if (!s.held[static_cast<std::size_t>(i)]) q[i] += step[k++];
}

/// One load step from `result.q`. True where it converged; then q is the new equilibrium.
bool newton(const Structure& structure, const Balance& balance, double factor, double load_size,
            const NewtonOptions& options, Equilibrium& result) {
  Eigen::VectorXd q = result.q;
  Eigen::SparseLU<Sparse> solver;
  double previous = std::numeric_limits<double>::infinity();
  int idle = 0;  // iterations in a row that did not halve the residual
  for (int iteration = 0; iteration <= options.most_iterations; ++iteration) {
    const Eigen::VectorXd residual = balance.residual(q, factor);
    const double size = balance.size(residual) / load_size;
    result.history.push_back({factor, iteration, size});
    if (!std::isfinite(size)) return false;
    const Sparse K = balance.stiffness(q, factor);
    idle = size > .5 * previous ? idle + 1 : 0;
    previous = size;
    // A load may be below the round-off of the first shape; it still moves the shape.
    const Eigen::VectorXd noise = balance.noise(K, q);
    const bool in_all = (residual.cwiseAbs() - kRounded * noise).maxCoeff() <= 0.;
    const bool in_vain = idle >= 2 && size * load_size <= kIdle * balance.size(noise);
    if (size <= options.tolerance || (iteration > 0 && (in_all || in_vain))) {
      result.q = q;
      result.residual = size;
      return true;
    }
    if (iteration == options.most_iterations) return false;
    solver.compute(K);
    if (solver.info() != Eigen::Success) return false;
    move(structure, solver.solve(residual), q);
    ++result.iterations;
  }
  return false;
}

}  // namespace

Equilibrium equilibrium(const Structure& structure, const StructureLoad& load,
                        const NewtonOptions& options, const Eigen::VectorXd* start) {
  const Balance balance(structure, load);
  Equilibrium result{false, start ? *start : structure.rest, 0., 0, 0, {}};
  const double applied = balance.size(free_part(structure, balance.external(result.q)));
  const double load_size = applied > 0. ? applied : 1.;
  double reached = 0., step = 1.;
  const double least = std::ldexp(1., -options.most_halvings);
  while (reached < 1.) {
    const double target = std::min(1., reached + step);
    if (newton(structure, balance, target, load_size, options, result)) {
      reached = target;
      ++result.load_steps;
      step *= 2.;
    } else if (step > least) {
      step = (target - reached) / 2.;  // the last step may have been cut at the whole load
    } else {
      return result;
    }
  }
  result.converged = true;
  return result;
}

bool is_stable(const Structure& structure, const Eigen::VectorXd& q) {
  const Eigen::SimplicialLDLT<Sparse> factor(free_part(structure, tangent(structure, q)));
  return factor.info() == Eigen::Success && (factor.vectorD().array() > 0.).all();
}

}  // namespace railstep
