#pragma once
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <complex>

#include "offline/receptance/beam_waves.h"

namespace railstep {

/// Closed form of an endless Timoshenko beam on a foundation, `bed` in N/m per metre, under a force
/// at x = 0: two waves decay on either side.
class Foundation {
 public:
  using Value = std::complex<double>;

  Foundation(const BendingBeam& beam, Value bed, double hz) {
    const double square = std::pow(2. * M_PI * hz, 2);
    const Value pull = beam.mass * square - bed, b = pull * beam.shear_softness;
    const double J = beam.rotary_inertia * square;
    // (EI kappa^2 + J)(kappa^2 + b) = pull
    const Value sum = b + J / beam.stiffness, product = (J * b - pull) / beam.stiffness;
    const Value root = std::sqrt(sum * sum / 4. - product);
    for (std::size_t i = 0; i < 2; ++i) {
      kappa[i] = std::sqrt(-sum / 2. + (i == 0 ? root : -root));
      if (kappa[i].real() > 0.) kappa[i] = -kappa[i];
    }
    // At x = 0 there is no rotation, and shear is half the force.
    Eigen::Matrix2cd at_zero;
    for (int i = 0; i < 2; ++i)
      at_zero.col(i) << kappa[static_cast<std::size_t>(i)] + b / kappa[static_cast<std::size_t>(i)],
          pull / kappa[static_cast<std::size_t>(i)];
    amplitude = at_zero.inverse() * Eigen::Vector2cd(0., .5);
  }

  Value receptance(double x) const {
    return amplitude[0] * std::exp(kappa[0] * x) + amplitude[1] * std::exp(kappa[1] * x);
  }

  std::array<Value, 2> kappa;  // 1/m, Re < 0
  Eigen::Vector2cd amplitude;  // m/N
};

}  // namespace railstep
