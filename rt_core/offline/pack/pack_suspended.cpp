#include <Eigen/LU>
#include <string>

#include "offline/math/refuse.h"
#include "offline/pack/pack.h"
#include "online/math/table.h"

namespace railstep {

namespace {

/// Sets what constraints hold to rounding to 0. @param free  the inverse without constraints
void clear_held(const Eigen::MatrixXd& free, Eigen::MatrixXd& inverse) {
  for (Eigen::Index k = 0; k < free.rows(); ++k) {
    if (inverse(k, k) > 1e-12 * free(k, k)) continue;
    inverse.row(k).setZero();
    inverse.col(k).setZero();
  }
}

/// The response by (s K + s kv C + kg M) q = force + held reaction with held' q = 0.
SuspendedResponse step_response(const SuspendedMatrices& m, const Scheme& scheme, double s) {
  Eigen::MatrixXd A = s * m.stiffness + s * scheme.kv * m.damping;
  A.diagonal() += scheme.kg * m.mass;
  if (m.penalty.size() > 0) A.diagonal() += m.penalty;
  const Eigen::MatrixXd free = A.partialPivLu().inverse();
  SuspendedResponse made{.5 * (free + free.transpose()), Eigen::MatrixXd::Zero(0, A.rows()),
                         Eigen::MatrixXd::Zero(0, 0)};
  if (m.held.cols() == 0) return made;
  const Eigen::MatrixXd moved = made.inverse * m.held;
  Eigen::MatrixXd along = m.held.transpose() * moved;
  const Eigen::VectorXd scale = along.diagonal().cwiseSqrt().cwiseInverse();
  along = scale.asDiagonal() * along * scale.asDiagonal();
  const Eigen::FullPivLU<Eigen::MatrixXd> lu(along);
  if (!lu.isInvertible() || !(lu.rcond() > 1e-9))
    refuse("E-PACK-58",
           "a rigid rod of a rail vehicle holds what its drive or other rods hold already; "
           "expected rods of which each takes a motion away");
  made.reaction = -(scale.asDiagonal() * lu.solve(scale.asDiagonal() * moved.transpose()));
  made.held = scale.asDiagonal() * lu.inverse() * scale.asDiagonal();
  const Eigen::MatrixXd left = made.inverse + moved * made.reaction;
  const Eigen::MatrixXd unheld = made.inverse;
  made.inverse = .5 * (left + left.transpose());
  clear_held(unheld, made.inverse);
  return made;
}

}  // namespace

double first_force(const OuterForce& force) {
  if (force.input >= 0) return 0.;
  return table_value(force.table.data(), static_cast<std::int32_t>(force.table.size() / 2), 0.);
}

SuspendedResponse PackedModel::add_suspended(const SuspendedMatrices& m,
                                             const std::vector<OuterForce>& forces,
                                             SuspendedModel& packed, const char* body) {
  const auto n = static_cast<std::int32_t>(m.mass.size());
  // Coordinates without mass are the last ones; nothing pushes them from outside.
  const auto most = static_cast<int>((m.mass.array() > 0.).count()) - 1;
  for (const OuterForce& force : forces)
    if (force.direction < 0 || force.direction > most)
      refuse("E-PACK-44", "a force acts along coordinate " + std::to_string(force.direction) +
                              " of a " + body + "; expected 0 to " + std::to_string(most));
  SuspendedResponse response = step_response(m, model_.scheme, held_fraction(model_));
  packed.first = model_.unknowns;
  packed.size = n;
  packed.mass = keep(column_by_column(m.mass));
  packed.rest = keep(column_by_column(m.rest));
  packed.damping = keep(column_by_column(m.damping));
  packed.stiffness = keep(column_by_column(m.stiffness));
  packed.inverse = keep(column_by_column(response.inverse));
  packed.forces = keep(forces, packed.force, body);
  model_.unknowns += (n + kLanes - 1) / kLanes * kLanes;
  return response;
}

}  // namespace railstep
