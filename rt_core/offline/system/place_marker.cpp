#include "offline/system/place_marker.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "offline/element/shape.h"
#include "offline/math/refuse.h"

namespace railstep {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

void set_frame(MarkerModel& marker, const Matrix3d& axes, const Matrix3d& own) {
  const Matrix3d rows = axes.transpose() * own;  // row k: direction k in the part's axes
  for (int k = 0; k < 3; ++k)
    for (int c = 0; c < 3; ++c) marker.frame[3 * k + c] = rows(k, c);
}

/// Sets the place of a marker on a beam from a point.
void put_on_beam(const FlexibleBeam& beam, const Vector3d& point, MarkerModel& marker) {
  const Vector3d local = beam.axes.transpose() * (point - beam.start);
  const double slack = 1e-9 * beam.length;
  if (!(local.x() >= -slack && local.x() <= beam.length + slack))
    refuse("E-SYSTEM-02", "its point is at " + std::to_string(local.x()) +
                              " m along a beam; expected 0 to " + std::to_string(beam.length) +
                              " m");
  const double along = std::clamp(local.x() / beam.length * beam.elements, 0., 1. * beam.elements);
  const int element = std::min(static_cast<int>(along), beam.elements - 1);
  double xi = 2. * (along - element) - 1.;
  for (const double node : {-1., 0., 1.})
    if (std::abs(xi - node) < 1e-9) xi = node;
  marker.node = 2 * element;
  const auto n = shape(xi);
  for (std::size_t i = 0; i < 3; ++i) marker.value[i] = n[i];
  marker.position[1] = local.y();
  marker.position[2] = local.z();
}

/// Sets the place of a marker on a rail from a point, and adds the port that carries it.
void put_on_rail(const Part& part, const Vector3d& point, const Track* track, SystemParts& parts,
                 MarkerModel& marker) {
  if (track == nullptr)
    refuse("E-SYSTEM-04",
           "it names a rail, but the scene has no track; expected a body, a beam or the ground");
  if (part.index < 0 || part.index >= track->rails)
    refuse("E-SYSTEM-05", "it names rail " + std::to_string(part.index) +
                              ", which the track does not have; expected 0 to " +
                              std::to_string(track->rails - 1));
  if (!(point.x() >= 0. && point.x() <= track->length()))
    refuse("E-SYSTEM-06", "its point is at x = " + std::to_string(point.x()) +
                              " m, beyond the rail's ends; expected 0 to " +
                              std::to_string(track->length()) + " m");
  const double side = track->rails == 2 ? track->rail_spacing / 2. : 0.;
  const double y = part.index == 0 ? side : -side;
  const double along = point.x() / track->element_length();
  RailPortModel port{};
  port.first = parts.unknowns;
  port.rail = part.index;
  port.element = std::min(static_cast<int>(along), track->elements() - 1);
  const auto n = shape(2. * (along - port.element) - 1.);
  for (std::size_t i = 0; i < 3; ++i) port.value[i] = n[i];
  const Cant lean = track->lean(part.index);
  const double rest[9] = {point.x(), y,  0.,         0.,         lean.cosine,
                          lean.sine, 0., -lean.sine, lean.cosine};
  for (int k = 0; k < 9; ++k) port.rest[k] = rest[k];
  marker.part = static_cast<std::int32_t>(parts.ports.size());
  const double from_axis[3] = {0., point.y() - y, point.z()};
  to_rail(lean, from_axis, marker.position);
  parts.ports.push_back(port);
  parts.unknowns += 9;
}

}  // namespace

std::int32_t place_marker(const System& system, const Track* track, const Part& part,
                          const Vector3d& point, const Matrix3d& axes, SystemParts& parts) {
  if (!point.allFinite())
    refuse("E-SYSTEM-07", "its point is not finite; expected three finite numbers");
  MarkerModel m{};
  m.part = part.index;
  if (part.kind == Part::Kind::ground) {
    m.kind = PartKind::ground;
    for (int c = 0; c < 3; ++c) m.position[c] = point[c];
    set_frame(m, axes, Matrix3d::Identity());
  } else if (part.kind == Part::Kind::body) {
    if (part.index < 0 || static_cast<std::size_t>(part.index) >= system.bodies.size())
      refuse("E-SYSTEM-08", "it names body " + std::to_string(part.index) +
                                ", which does not exist; expected one of the " +
                                std::to_string(system.bodies.size()) + " bodies, counted from 0");
    const RigidBody& body = system.bodies[static_cast<std::size_t>(part.index)];
    const Matrix3d R = body.orientation.toRotationMatrix();
    m.kind = PartKind::body;
    const Vector3d local = R.transpose() * (point - body.position);
    for (int c = 0; c < 3; ++c) m.position[c] = local[c];
    set_frame(m, axes, R);
  } else if (part.kind == Part::Kind::rail) {
    m.kind = PartKind::rail;
    put_on_rail(part, point, track, parts, m);
    const double* rest = parts.ports.back().rest;
    Matrix3d section;
    section << Vector3d::UnitX(), Vector3d(rest + 3), Vector3d(rest + 6);
    set_frame(m, axes, section);
  } else {
    if (part.index < 0 || static_cast<std::size_t>(part.index) >= system.beams.size())
      refuse("E-SYSTEM-09", "it names beam " + std::to_string(part.index) +
                                ", which does not exist; expected one of the " +
                                std::to_string(system.beams.size()) + " beams, counted from 0");
    const FlexibleBeam& beam = system.beams[static_cast<std::size_t>(part.index)];
    m.kind = PartKind::beam;
    put_on_beam(beam, point, m);
    set_frame(m, axes, beam.axes);
  }
  parts.markers.push_back(m);
  return static_cast<std::int32_t>(parts.markers.size()) - 1;
}

}  // namespace railstep
