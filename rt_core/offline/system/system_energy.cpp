#include "offline/system/system_energy.h"

#include <cmath>
#include <vector>

#include "online/model/beam_chain.h"
#include "online/system/marker.h"
#include "online/system/rotation.h"
#include "online/system/row.h"

namespace railstep {

namespace {

using Eigen::Map;
using Eigen::Vector3d;
using Node = Eigen::Matrix<double, 9, 1>;

/// Translation and rotation from a body's unknowns, three each.
Eigen::Matrix<double, 6, 1> six(const RigidBodyModel& body, const double* x) {
  Eigen::Matrix<double, 6, 1> all = Eigen::Matrix<double, 6, 1>::Zero();
  for (int c = 0; c < 6; ++c)
    if (body.column[c] >= 0) all[c] = x[body.first + body.column[c]];
  return all;
}

Eigen::Matrix3d inertia(const RigidBodyModel& body) {
  return Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(body.inertia);
}

/// All nine quantities of node n from the beam's unknowns.
Node nine(const BeamChainModel& beam, const double* x, int n) {
  const int width = beam.planar != 0 ? kPlanarUnknowns : 9;
  Node all = Node::Zero();
  for (int k = 0; k < width; ++k) all[beam.planar != 0 ? kPlanarOf[k] : k] = x[width * n + k];
  return all;
}

/// Energy of one Gauss point of a straight element.
double point_energy(const StraightBeam& beam, const Vector3d (&V)[5]) {
  double s[kProducts], sum = 0.;
  for (int k = 0; k < kProducts; ++k) {
    const int i = kProductOf[k][0], j = kProductOf[k][1];
    s[k] = V[i].dot(V[j]);
    if (i == j) s[k] *= .5;
    if (i == j && (i == 0 || i > 2)) s[k] -= .5;  // r', a and b have length 1 at rest
  }
  for (int k = 0; k < kProducts; ++k) {
    if (const int p = straight_preload(k); p >= 0) sum += beam.preload[p] * s[k];
    for (int l = 0; l < kProducts; ++l)
      if (const int c = straight_constant(k, l); c >= 0)
        sum += .5 * beam.stiffness[c] * s[k] * s[l];
  }
  return sum;
}

/// @param rest, u  unknowns of the beam
double strain_energy(const BeamChainModel& beam, const double* rest, const double* u) {
  const double g = 1. / std::sqrt(3.), h = beam.element.per_length;
  double sum = 0.;
  for (int e = 0; e < beam.elements; ++e)
    for (const double xi : {-g, g}) {
      const double value[3] = {.5 * xi * (xi - 1.), 1. - xi * xi, .5 * xi * (xi + 1.)};
      const double slope[3] = {(2. * xi - 1.) * h, -4. * xi * h, (2. * xi + 1.) * h};
      Vector3d V[5] = {Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero(),
                       Vector3d::Zero()};
      for (int n = 0; n < 3; ++n) {
        const Node q = nine(beam, rest, 2 * e + n) + nine(beam, u, 2 * e + n);
        for (int f = 0; f < 3; ++f) V[f] += slope[n] * q.segment<3>(3 * f);
        for (int f = 1; f < 3; ++f) V[2 + f] += value[n] * q.segment<3>(3 * f);
      }
      sum += point_energy(beam.element, V);
    }
  return sum;
}

/// M v of a beam.
std::vector<double> momenta(const BeamChainModel& beam, const double* v) {
  std::vector<double> p(static_cast<std::size_t>(beam.unknowns), 0.);
  beam_inertia(beam, v, p.data());
  return p;
}

double spring_energy(const Model& model, const State& state) {
  const SystemModel& s = model.system;
  std::vector<double> R(9 * static_cast<std::size_t>(s.bodies));
  for (std::int32_t b = 0; b < s.bodies; ++b)
    rotation_matrix(state.quaternion + 4 * b, R.data() + 9 * b);
  const double* u = state.u + s.first;
  double sum = 0.;
  for (std::int32_t r = s.joint_rows; r < system_rows(s); ++r) {
    const RowModel& row = s.row[r];
    const double x = row_value(row, marker_pose(s, s.marker[row.a], u, R.data()),
                               marker_pose(s, s.marker[row.b], u, R.data()), row.offset);
    sum += .5 * row.stiffness * x * x;
  }
  return sum;
}

}  // namespace

SystemEnergy system_energy(const Model& model, const State& state) {
  const SystemModel& s = model.system;
  const double *u = state.u + s.first, *v = state.v + s.first;
  SystemEnergy sum;
  for (std::int32_t i = 0; i < s.unknowns; ++i) sum.potential -= s.constant_force[i] * u[i];
  for (std::int32_t b = 0; b < s.bodies; ++b) {
    const auto rate = six(s.body[b], v);
    const Vector3d w = rate.tail<3>();
    sum.kinetic +=
        .5 * s.body[b].mass * rate.head<3>().squaredNorm() + .5 * w.dot(inertia(s.body[b]) * w);
  }
  for (std::int32_t b = 0; b < s.beams; ++b) {
    const BeamChainModel& beam = s.beam[b];
    const std::vector<double> p = momenta(beam, v + beam.first);
    for (std::int32_t i = 0; i < beam.unknowns; ++i)
      sum.kinetic += .5 * p[static_cast<std::size_t>(i)] * v[beam.first + i];
    sum.strain += strain_energy(beam, s.beam_rest + beam.first, u + beam.first);
  }
  sum.springs = spring_energy(model, state);
  return sum;
}

}  // namespace railstep
