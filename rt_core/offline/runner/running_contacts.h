#pragma once
#include <array>

#include "offline/runner/running.h"

namespace railstep {

inline Eigen::Index first_of(std::size_t body) {
  return kMotions * static_cast<Eigen::Index>(body);
}

/// Rates of a wheelset's material on a design line. @param first  of its coordinates
std::array<double, kMotions> material_rates(const RailsUnder& rails, double radius,
                                            Eigen::Index first, const Eigen::VectorXd& u,
                                            const Eigen::VectorXd& v);

/// Forces of the rails on all wheelsets, [n].
/// @param u, v  [n] motions and their rates
Eigen::VectorXd forces_at(const Runner& runner, const RollingContact& contact, double speed,
                          const Eigen::VectorXd& u, const Eigen::VectorXd& v,
                          const std::vector<RailsUnder>& rails);

/// The same with their derivatives.
struct RailForces {
  Eigen::VectorXd force;            // [n]
  Eigen::MatrixXd by_displacement;  // [n][n]
  Eigen::MatrixXd by_rate;
};
RailForces contacts_at(const Runner& runner, const RollingContact& contact, double speed,
                       const Eigen::VectorXd& u, const Eigen::VectorXd& v,
                       const std::vector<RailsUnder>& rails = {});

}  // namespace railstep
