#include <Eigen/LU>
#include <string>

#include "offline/math/refuse.h"
#include "offline/pack/pack.h"
#include "online/math/table.h"

namespace railstep {

namespace {

/// (s K + s kv C + kg M)^-1, symmetric to the last bit.
/// @param is_held  without the first coordinate, whose row and column are then 0
Eigen::MatrixXd step_inverse(const SuspendedMatrices& m, const Scheme& scheme, double s,
                             bool is_held) {
  Eigen::MatrixXd A = s * m.stiffness + s * scheme.kv * m.damping;
  A.diagonal() += scheme.kg * m.mass;
  const Eigen::Index all = A.rows(), free = is_held ? all - 1 : all;
  const Eigen::MatrixXd own = A.bottomRightCorner(free, free).partialPivLu().inverse();
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(all, all);
  inverse.bottomRightCorner(free, free) = .5 * (own + own.transpose());
  return inverse;
}

}  // namespace

double first_force(const OuterForce& force) {
  if (force.input >= 0) return 0.;
  return table_value(force.table.data(), static_cast<std::int32_t>(force.table.size() / 2), 0.);
}

Eigen::MatrixXd PackedModel::add_suspended(const SuspendedMatrices& m, bool is_held,
                                           const std::vector<OuterForce>& forces,
                                           SuspendedModel& packed) {
  const auto n = static_cast<std::int32_t>(m.mass.size());
  // Coordinates without mass are the last ones; nothing pushes them from outside.
  const auto most = static_cast<int>((m.mass.array() > 0.).count()) - 1;
  for (const OuterForce& force : forces)
    if (force.direction < 0 || force.direction > most)
      refuse("E-PACK-44", "a force acts along coordinate " + std::to_string(force.direction) +
                              " of a vehicle; expected 0 to " + std::to_string(most));
  Eigen::MatrixXd inverse = step_inverse(m, model_.scheme, held_fraction(model_), is_held);
  packed.first = model_.unknowns;
  packed.size = n;
  packed.mass = keep(column_by_column(m.mass));
  packed.rest = keep(column_by_column(m.rest));
  packed.damping = keep(column_by_column(m.damping));
  packed.stiffness = keep(column_by_column(m.stiffness));
  packed.inverse = keep(column_by_column(inverse));
  packed.forces = keep(forces, packed.force, "vehicle");
  model_.unknowns += (n + kLanes - 1) / kLanes * kLanes;
  return inverse;
}

}  // namespace railstep
