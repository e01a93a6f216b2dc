#pragma once
#include "online/model/system_workspace.h"

namespace railstep {

/// A scalar and its first and second derivative in time.
struct Jet {
  double x, v, a;
};
inline Jet operator+(Jet p, Jet q) noexcept { return {p.x + q.x, p.v + q.v, p.a + q.a}; }
inline Jet operator-(Jet p, Jet q) noexcept { return {p.x - q.x, p.v - q.v, p.a - q.a}; }
inline Jet operator*(Jet p, Jet q) noexcept {
  return {p.x * q.x, p.v * q.x + p.x * q.v, (p.a * q.x + p.x * q.a) + 2. * (p.v * q.v)};
}
inline Jet operator*(double s, Jet p) noexcept { return {s * p.x, s * p.v, s * p.a}; }

/// A marker's pose with its velocities and accelerations.
struct MarkerJet {
  Jet point[3];
  Jet axis[3][3];
};

/// Configuration of a system: x are displacements (of bodies their rotation is in `matrix`),
/// v and g velocities and accelerations in the unknowns' order.
struct Motions {
  const double* x;
  const double* v;
  const double* g;
  const double* matrix;  // [bodies][9]
};

/// @param x       [unknowns] displacements
/// @param matrix  [bodies][9] rotations
MarkerPose marker_pose(const SystemModel& system, const MarkerModel& marker, const double* x,
                       const double* matrix) noexcept;

MarkerJet marker_jet(const SystemModel& system, const MarkerModel& marker,
                     const Motions& at) noexcept;

/// Generalised force of a row at a marker on the unknowns of the marker's part, per unit of the
/// row's force: of a body its 6 or 3, of a beam those of the marker's three nodes.
/// @param at      pose at which the force is taken
/// @param centre  of the body at that pose, m
/// @param matrix  that rotates the body's axes of the rotation unknowns to the ground
/// @param row     [kMostNodeUnknowns], overwritten
void generalised_force(const SystemModel& system, const MarkerModel& marker, const MarkerPose& at,
                       const double* centre, const double* matrix, const MarkerGradient& gradient,
                       double* row) noexcept;

/// The unknowns of the system that a marker depends on: `count` from `first` on.
struct UnknownRange {
  std::int32_t first, count;
};
inline UnknownRange unknowns_of(const SystemModel& system, const MarkerModel& marker) noexcept {
  switch (marker.kind) {
    case PartKind::beam: {
      const BeamChainModel& beam = system.beam[marker.part];
      return {beam.first + beam_width(beam) * marker.node, 3 * beam_width(beam)};
    }
    case PartKind::body:
      return {system.body[marker.part].first, system.body[marker.part].unknowns};
    case PartKind::rail:
      return {system.port[marker.part].first, 9};
    case PartKind::ground:
      break;
  }
  return {0, 0};
}

}  // namespace railstep
