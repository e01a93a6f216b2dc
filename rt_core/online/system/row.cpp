#include "online/system/row.h"

#include "online/math/scalar.h"
#include "online/math/search.h"
#include "online/system/rotation.h"

namespace railstep {

namespace {

/// cos s and sin s with their derivatives.
void cos_sin_jet(Jet s, Jet& cos, Jet& sin) noexcept {
  const CosSin at = cos_sin(s.x);
  cos = {at.cos, -at.sin * s.v, -at.cos * s.v * s.v - at.sin * s.a};
  sin = {at.sin, at.cos * s.v, -at.sin * s.v * s.v + at.cos * s.a};
}

/// Jets, or plain numbers if no rates are needed.
template <class T>
T three(const T* p, const T* q) noexcept {
  return (p[0] * q[0] + p[1] * q[1]) + p[2] * q[2];
}

/// Phi of all kinds but springs. @param Place  MarkerPose or MarkerJet
template <class T, class Place>
T joint_row(const RowModel& row, const Place& a, const Place& b, T s, T cos, T sin) noexcept {
  const T d[3] = {b.point[0] - a.point[0], b.point[1] - a.point[1], b.point[2] - a.point[2]};
  switch (row.kind) {
    case RowKind::along_ground:
      return d[row.i] - s;
    case RowKind::along_a:
      return three(a.axis[row.i], d) - s;
    case RowKind::square:
      if (row.motion < 0) return three(a.axis[row.i], b.axis[row.j]);
      return cos * three(a.axis[row.i], b.axis[row.j]) - sin * three(a.axis[row.l], b.axis[row.j]);
    case RowKind::distance:
      return (.5 / row.offset) * (three(d, d) - s * s);
    case RowKind::spring:
      break;
  }
  return s;
}

bool has_driven_angle(const RowModel& row) noexcept {
  return row.kind == RowKind::square && row.motion >= 0;
}

}  // namespace

Jet motion_at(const SystemModel& system, std::int32_t motion, double time) noexcept {
  const MotionModel& own = system.motion[motion];
  const double* start = system.piece_start + own.first;
  const std::int32_t piece = row_at(start, 1, own.pieces, time);
  const double* c = system.piece + std::ptrdiff_t{kMotionCoefficients} * (own.first + piece);
  const double t = time - start[piece];
  Jet s{0., 0., 0.};
  for (int k = kMotionCoefficients - 1; k >= 0; --k) {
    s.a = s.a * t + 2. * s.v;
    s.v = s.v * t + s.x;
    s.x = s.x * t + c[k];
  }
  return s;
}

double row_length(const MarkerPose& a, const MarkerPose& b) noexcept {
  const double d[3] = {b.point[0] - a.point[0], b.point[1] - a.point[1], b.point[2] - a.point[2]};
  return square_root(dot(d, d));
}

double row_value(const RowModel& row, const MarkerPose& a, const MarkerPose& b, double s) noexcept {
  if (row.kind == RowKind::spring) return row_length(a, b) - s;
  const CosSin angle = has_driven_angle(row) ? cos_sin(s) : CosSin{1., 0.};
  return joint_row(row, a, b, s, angle.cos, angle.sin);
}

Jet row_jet(const RowModel& row, const MarkerJet& a, const MarkerJet& b, Jet s) noexcept {
  if (row.kind == RowKind::spring) {
    const Jet d[3] = {b.point[0] - a.point[0], b.point[1] - a.point[1], b.point[2] - a.point[2]};
    const double length = square_root(three(d, d).x);
    if (!(length > 0.)) return {-s.x, 0., 0.};
    const double rate = ((d[0].x * d[0].v + d[1].x * d[1].v) + d[2].x * d[2].v) / length;
    return {length - s.x, rate - s.v, 0.};
  }
  Jet cos{1., 0., 0.}, sin{0., 0., 0.};
  if (has_driven_angle(row)) cos_sin_jet(s, cos, sin);
  return joint_row(row, a, b, s, cos, sin);
}

void row_gradient(const RowModel& row, const MarkerPose& a, const MarkerPose& b, double length,
                  double s, MarkerGradient& on_a, MarkerGradient& on_b) noexcept {
  on_a = on_b = {};
  const double d[3] = {b.point[0] - a.point[0], b.point[1] - a.point[1], b.point[2] - a.point[2]};
  double along[3] = {};
  switch (row.kind) {
    case RowKind::along_ground:
      along[row.i] = 1.;
      break;
    case RowKind::along_a:
      for (int c = 0; c < 3; ++c) {
        along[c] = a.axis[row.i][c];
        on_a.axis[row.i][c] = d[c];
      }
      on_a.has_axes = true;
      break;
    case RowKind::square: {
      const CosSin angle = row.motion < 0 ? CosSin{1., 0.} : cos_sin(s);
      for (int c = 0; c < 3; ++c) {
        on_a.axis[row.i][c] = angle.cos * b.axis[row.j][c];
        on_b.axis[row.j][c] = angle.cos * a.axis[row.i][c];
        if (row.motion < 0) continue;
        on_a.axis[row.l][c] -= angle.sin * b.axis[row.j][c];
        on_b.axis[row.j][c] -= angle.sin * a.axis[row.l][c];
      }
      on_a.has_axes = on_b.has_axes = true;
      return;
    }
    case RowKind::distance:
      for (int c = 0; c < 3; ++c) along[c] = d[c] / row.offset;
      break;
    case RowKind::spring:
      for (int c = 0; c < 3; ++c) along[c] = length > 0. ? d[c] / length : 0.;
      break;
  }
  for (int c = 0; c < 3; ++c) {
    on_b.point[c] = along[c];
    on_a.point[c] = -along[c];
  }
}

}  // namespace railstep
