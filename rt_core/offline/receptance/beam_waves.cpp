#include "offline/receptance/beam_waves.h"

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <complex>

#include "offline/math/complex.h"

namespace railstep {

namespace {

/// The two kappa of Re kappa <= 0; the others are their negatives.
std::array<ComplexNumber, 2> falling_waves(const BendingBeam& beam, double omega) {
  const double square = omega * omega, b = beam.mass * square * beam.shear_softness;
  const double half = .5 * (b + beam.rotary_inertia * square / beam.stiffness);
  const double last = (beam.rotary_inertia * b - beam.mass) * square / beam.stiffness;
  const ComplexNumber root = std::sqrt(ComplexNumber(half * half - last));
  // The root of opposite signs loses digits; the product of both roots gives it.
  const ComplexNumber low = -half - root, high = last / low;
  return {-std::sqrt(high), -std::sqrt(low)};
}

}  // namespace

BendingBeam bending_beam(const Track& track, BeamTheory theory) {
  const BeamSection& s = track.section;
  const Material& m = track.material;
  const bool shears = theory == BeamTheory::timoshenko;
  return {m.young * s.inertia_y, shears ? 1. / (s.shear_factor_z * m.shear_modulus() * s.area) : 0.,
          m.density * s.area, shears ? m.density * s.inertia_y : 0.};
}

Eigen::Matrix4cd beam_dynamic_stiffness(const BendingBeam& beam, double length, double omega) {
  const std::array<ComplexNumber, 2> falling = falling_waves(beam, omega);
  const double inertia = beam.mass * omega * omega;
  const double b = inertia * beam.shear_softness;
  Eigen::Matrix4cd moved, forces;
  for (int i = 0; i < 4; ++i) {
    const ComplexNumber kappa =
        i < 2 ? falling[static_cast<std::size_t>(i)] : -falling[static_cast<std::size_t>(i - 2)];
    const ComplexNumber rotation = kappa + b / kappa, shear = -inertia / kappa,
                        moment = beam.stiffness * kappa * rotation;
    const ComplexNumber along = std::exp(i < 2 ? kappa * length : -kappa * length);
    const ComplexNumber start = i < 2 ? 1. : along, end = i < 2 ? along : 1.;
    moved.col(i) << start, rotation * start, end, rotation * end;
    forces.col(i) << -shear * start, -moment * start, shear * end, moment * end;
  }
  return forces * moved.inverse();
}

}  // namespace railstep
