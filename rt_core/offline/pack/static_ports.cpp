#include "offline/pack/static_ports.h"

#include <algorithm>
#include <array>

#include "offline/math/refuse.h"
#include "online/contact/ports.h"

namespace railstep {

Eigen::VectorXd static_port_forces(const Eigen::MatrixXd& compliance,
                                   const Eigen::VectorXd& stiffness, const Eigen::VectorXd& free) {
  constexpr double kNothing = 1e-9;  // N/m, for a damper alone: a law needs a slope above 0
  constexpr int kMostRounds = 20;    // each has 8 iterations; a step makes one such solve
  const auto n = static_cast<int>(free.size());
  std::array<PortLaw, kMaxFixedPorts> law;
  std::array<double, kMaxFixedPorts> force{}, depth{};
  for (int j = 0; j < n; ++j)
    law[static_cast<std::size_t>(j)] = {0., std::max(stiffness[j], kNothing), 0.};
  PortStatus met = PortStatus::cap_reached;
  for (int iteration = 0; iteration < kMostRounds && met != PortStatus::converged; ++iteration)
    met = solve_ports(n, compliance.data(), law.data(), free.data(), force.data(), depth.data())
              .status;
  if (met != PortStatus::converged)
    refuse("E-PACK-50",
           "no equilibrium was found: the one-sided supports open and close again and again; "
           "expected loads that keep the track on its supports");
  return Eigen::Map<const Eigen::VectorXd>(force.data(), n);
}

}  // namespace railstep
