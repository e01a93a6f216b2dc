#include "online/system/marker.h"

#include "online/system/rotation.h"

namespace railstep {

namespace {

/// Index, among a node's nine quantities, of its k-th unknown.
template <bool kPlanar>
constexpr int of_nine(int k) noexcept {
  return kPlanar ? kPlanarOf[k] : k;
}
template <bool kPlanar>
inline constexpr int kWidth = kPlanar ? kPlanarUnknowns : 9;

template <bool kPlanar>
void interpolate(const MarkerModel& marker, const double* nodes, double* out) noexcept {
  constexpr int W = kWidth<kPlanar>;
  const double* node = nodes + std::ptrdiff_t{W} * marker.node;
  for (int k = 0; k < W; ++k)
    out[of_nine<kPlanar>(k)] = (marker.value[0] * node[k] + marker.value[1] * node[W + k]) +
                               marker.value[2] * node[2 * W + k];
}

/// r, a, b at a beam's marker from nodal values of one kind.
/// @param nodes  of the beam
/// @param out    [3][3] r, a, b
void interpolate(const BeamChainModel& beam, const MarkerModel& marker, const double* nodes,
                 double out[3][3]) noexcept {
  if (beam.planar == 0) return interpolate<false>(marker, nodes, out[0]);
  for (int k = 0; k < 9; ++k) out[k / 3][k % 3] = 0.;
  interpolate<true>(marker, nodes, out[0]);
}

/// The nine quantities of a port.
void nine(const double* values, double out[3][3]) noexcept {
  for (int f = 0; f < 3; ++f)
    for (int c = 0; c < 3; ++c) out[f][c] = values[3 * f + c];
}

/// r, a, b of displacements, velocities or accelerations at a marker on a beam or rail.
void section_change(const SystemModel& s, const MarkerModel& marker, const double* x,
                    double out[3][3]) noexcept {
  if (marker.kind == PartKind::rail) return nine(x + s.port[marker.part].first, out);
  interpolate(s.beam[marker.part], marker, x + s.beam[marker.part].first, out);
}

/// Position and slopes at a marker on a beam or rail: rest and displacement.
void section_at(const SystemModel& s, const MarkerModel& marker, const double* x,
                double out[3][3]) noexcept {
  double moved[3][3];
  if (marker.kind == PartKind::rail)
    nine(s.port[marker.part].rest, out);
  else
    interpolate(s.beam[marker.part], marker, s.beam_rest + s.beam[marker.part].first, out);
  section_change(s, marker, x, moved);
  for (int f = 0; f < 3; ++f)
    for (int c = 0; c < 3; ++c) out[f][c] += moved[f][c];
}

MarkerPose on_ground(const MarkerModel& marker) noexcept {
  MarkerPose pose;
  for (int c = 0; c < 3; ++c) pose.point[c] = marker.position[c];
  for (int k = 0; k < 3; ++k)
    for (int c = 0; c < 3; ++c) pose.axis[k][c] = marker.frame[3 * k + c];
  return pose;
}

MarkerPose on_body(const RigidBodyModel& body, const MarkerModel& marker, const double* x,
                   const double* R) noexcept {
  MarkerPose pose;
  rotate(R, marker.position, pose.point);
  for (int c = 0; c < 3; ++c) {
    pose.point[c] += body.rest[c];
    if (body.column[c] >= 0) pose.point[c] += x[body.first + body.column[c]];
  }
  for (int k = 0; k < 3; ++k) rotate(R, marker.frame + 3 * k, pose.axis[k]);
  return pose;
}

MarkerPose on_section(const SystemModel& system, const MarkerModel& marker,
                      const double* x) noexcept {
  double s[3][3], d[3];
  section_at(system, marker, x, s);
  cross(s[1], s[2], d);
  MarkerPose pose;
  for (int c = 0; c < 3; ++c) {
    pose.point[c] = (s[0][c] + marker.position[1] * s[1][c]) + marker.position[2] * s[2][c];
    for (int k = 0; k < 3; ++k)
      pose.axis[k][c] = (marker.frame[3 * k] * d[c] + marker.frame[3 * k + 1] * s[1][c]) +
                        marker.frame[3 * k + 2] * s[2][c];
  }
  return pose;
}

/// x with w x x and w' x x + w x (w x x).
void rotating(const double* x, const double* w, const double* dw, Jet* out) noexcept {
  double v[3], a[3], b[3];
  cross(w, x, v);
  cross(dw, x, a);
  cross(w, v, b);
  for (int c = 0; c < 3; ++c) out[c] = {x[c], v[c], a[c] + b[c]};
}

MarkerJet jet_on_body(const RigidBodyModel& body, const MarkerModel& marker, const Motions& at,
                      const double* R) noexcept {
  const MarkerPose pose = on_body(body, marker, at.x, R);
  double own[2][3] = {}, w[3], dw[3], lever[3];
  for (int c = 0; c < 3; ++c)
    if (const std::int32_t k = body.column[3 + c]; k >= 0) {
      own[0][c] = at.v[body.first + k];
      own[1][c] = at.g[body.first + k];
    }
  rotate(R, own[0], w);
  rotate(R, own[1], dw);
  rotate(R, marker.position, lever);
  MarkerJet jet;
  rotating(lever, w, dw, jet.point);
  for (int c = 0; c < 3; ++c) {
    const std::int32_t k = body.column[c];
    jet.point[c].x = pose.point[c];
    if (k >= 0) jet.point[c] = jet.point[c] + Jet{0., at.v[body.first + k], at.g[body.first + k]};
  }
  for (int k = 0; k < 3; ++k) rotating(pose.axis[k], w, dw, jet.axis[k]);
  return jet;
}

MarkerJet jet_on_section(const SystemModel& system, const MarkerModel& marker,
                         const Motions& at) noexcept {
  double x[3][3], v[3][3], g[3][3];
  section_at(system, marker, at.x, x);
  section_change(system, marker, at.v, v);
  section_change(system, marker, at.g, g);
  Jet s[3][3], d[3];
  for (int f = 0; f < 3; ++f)
    for (int c = 0; c < 3; ++c) s[f][c] = {x[f][c], v[f][c], g[f][c]};
  for (int c = 0; c < 3; ++c)
    d[c] = s[1][(c + 1) % 3] * s[2][(c + 2) % 3] - s[1][(c + 2) % 3] * s[2][(c + 1) % 3];
  MarkerJet jet;
  for (int c = 0; c < 3; ++c) {
    jet.point[c] = (s[0][c] + marker.position[1] * s[1][c]) + marker.position[2] * s[2][c];
    for (int k = 0; k < 3; ++k)
      jet.axis[k][c] = (marker.frame[3 * k] * d[c] + marker.frame[3 * k + 1] * s[1][c]) +
                       marker.frame[3 * k + 2] * s[2][c];
  }
  return jet;
}

void force_on_body(const RigidBodyModel& body, const MarkerPose& at, const double* centre,
                   const double* matrix, const MarkerGradient& gradient, double* row) noexcept {
  double lever[3], part[3], moment[3], own[3];
  for (int c = 0; c < 3; ++c) lever[c] = at.point[c] - centre[c];
  cross(lever, gradient.point, moment);
  for (int k = 0; gradient.has_axes && k < 3; ++k) {
    cross(at.axis[k], gradient.axis[k], part);
    for (int c = 0; c < 3; ++c) moment[c] += part[c];
  }
  rotate_back(matrix, moment, own);
  for (int c = 0; c < 3; ++c) {
    if (body.column[c] >= 0) row[body.column[c]] = gradient.point[c];
    if (body.column[3 + c] >= 0) row[body.column[3 + c]] = own[c];
  }
}

/// Adds the part of the directions to the forces on a and b of a section.
void add_axes_force(const MarkerModel& marker, const MarkerPose& at, const MarkerGradient& gradient,
                    double* on) noexcept {
  double normal[3] = {}, a[3] = {}, b[3] = {}, part[3];
  for (int k = 0; k < 3; ++k)
    for (int c = 0; c < 3; ++c) {
      normal[c] += marker.frame[3 * k] * gradient.axis[k][c];
      a[c] += marker.frame[3 * k + 1] * at.axis[k][c];  // the frame's transpose gives a, b back
      b[c] += marker.frame[3 * k + 2] * at.axis[k][c];
      on[3 + c] += marker.frame[3 * k + 1] * gradient.axis[k][c];
      on[6 + c] += marker.frame[3 * k + 2] * gradient.axis[k][c];
    }
  cross(b, normal, part);  // n . (da x b) = da . (b x n)
  for (int c = 0; c < 3; ++c) on[3 + c] += part[c];
  cross(normal, a, part);  // n . (a x db) = db . (n x a)
  for (int c = 0; c < 3; ++c) on[6 + c] += part[c];
}

/// Generalised force on the r, a, b of a section.
void force_on_section(const MarkerModel& marker, const MarkerPose& at,
                      const MarkerGradient& gradient, double* on) noexcept {
  for (int c = 0; c < 3; ++c) {
    on[c] = gradient.point[c];
    on[3 + c] = marker.position[1] * gradient.point[c];
    on[6 + c] = marker.position[2] * gradient.point[c];
  }
  if (gradient.has_axes) add_axes_force(marker, at, gradient, on);
}

template <bool kPlanar>
void spread(const MarkerModel& marker, const double* on, double* row) noexcept {
  constexpr int W = kWidth<kPlanar>;
  for (int n = 0; n < 3; ++n)
    for (int k = 0; k < W; ++k) row[W * n + k] = marker.value[n] * on[of_nine<kPlanar>(k)];
}

void force_on_beam(const BeamChainModel& beam, const MarkerModel& marker, const MarkerPose& at,
                   const MarkerGradient& gradient, double* row) noexcept {
  double on[9];
  force_on_section(marker, at, gradient, on);
  beam.planar != 0 ? spread<true>(marker, on, row) : spread<false>(marker, on, row);
}

}  // namespace

MarkerPose marker_pose(const SystemModel& system, const MarkerModel& marker, const double* x,
                       const double* matrix) noexcept {
  if (marker.kind == PartKind::body)
    return on_body(system.body[marker.part], marker, x, matrix + 9 * marker.part);
  if (marker.kind == PartKind::ground) return on_ground(marker);
  return on_section(system, marker, x);
}

MarkerJet marker_jet(const SystemModel& system, const MarkerModel& marker,
                     const Motions& at) noexcept {
  if (marker.kind == PartKind::body)
    return jet_on_body(system.body[marker.part], marker, at, at.matrix + 9 * marker.part);
  if (marker.kind != PartKind::ground) return jet_on_section(system, marker, at);
  const MarkerPose pose = on_ground(marker);
  MarkerJet jet{};
  for (int c = 0; c < 3; ++c) {
    jet.point[c].x = pose.point[c];
    for (int k = 0; k < 3; ++k) jet.axis[k][c].x = pose.axis[k][c];
  }
  return jet;
}

void generalised_force(const SystemModel& system, const MarkerModel& marker, const MarkerPose& at,
                       const double* centre, const double* matrix, const MarkerGradient& gradient,
                       double* row) noexcept {
  if (marker.kind == PartKind::body)
    force_on_body(system.body[marker.part], at, centre, matrix, gradient, row);
  else if (marker.kind == PartKind::beam)
    force_on_beam(system.beam[marker.part], marker, at, gradient, row);
  else if (marker.kind == PartKind::rail)
    force_on_section(marker, at, gradient, row);
}

}  // namespace railstep
