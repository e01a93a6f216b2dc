#include "offline/element/timoshenko.h"

#include <array>

namespace railstep {
namespace {

enum : int { kX, kY, kZ, kRotationX, kRotationY, kRotationZ };

/// A pair of springs of opposite signs, k/L, on one coordinate of both nodes.
void add_bar(Matrix12& K, int coordinate, double stiffness) {
  K(coordinate, coordinate) += stiffness;
  K(6 + coordinate, 6 + coordinate) += stiffness;
  K(coordinate, 6 + coordinate) -= stiffness;
  K(6 + coordinate, coordinate) -= stiffness;
}

/// Bending in one plane: deflection and a rotation that is `sign` times its slope.
void add_bending(Matrix12& K, int deflection, int rotation, double sign, double EI, double kGA,
                 double L) {
  const double phi = 12. * EI / (kGA * L * L), k = EI / (L * L * L * (1. + phi));
  const double moment = sign * 6. * L, own = (4. + phi) * L * L, other = (2. - phi) * L * L;
  const double own_k[4][4] = {{12., moment, -12., moment},
                              {moment, own, -moment, other},
                              {-12., -moment, 12., -moment},
                              {moment, other, -moment, own}};
  const int place[4] = {deflection, rotation, 6 + deflection, 6 + rotation};
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) K(place[i], place[j]) += k * own_k[i][j];
}

}  // namespace

Matrix12 timoshenko_stiffness(const BeamSection& s, const Material& material, double length) {
  const double E = material.young, G = material.shear_modulus();
  Matrix12 K = Matrix12::Zero();
  add_bar(K, kX, E * s.area / length);
  add_bar(K, kRotationX, G * s.torsion / length);
  add_bending(K, kZ, kRotationY, -1., E * s.inertia_y, s.shear_factor_z * G * s.area, length);
  add_bending(K, kY, kRotationZ, 1., E * s.inertia_z, s.shear_factor_y * G * s.area, length);
  Matrix12 centroid = Matrix12::Identity();  // from the centroid's to the shear centre's u_y
  centroid(kY, kRotationX) = centroid(6 + kY, 6 + kRotationX) = -s.shear_centre_z;
  return centroid.transpose() * K * centroid;
}

Vector12 timoshenko_line_load(double length) {
  Vector12 load = Vector12::Zero();
  load[kZ] = load[6 + kZ] = length / 2.;
  load[kRotationY] = -length * length / 12.;
  load[6 + kRotationY] = length * length / 12.;
  return load;
}

}  // namespace railstep
