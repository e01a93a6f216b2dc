#include <cmath>
#include <string>

#include "offline/math/refuse.h"
#include "offline/system/motion.h"
#include "offline/system/place_marker.h"
#include "online/system/row.h"

namespace railstep {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Adds markers and rows of a system's joints, springs, forces and sensors.
class Connector {
 public:
  Connector(const System& system, const Track* track, SystemParts& parts)
      : system_(system), track_(track), parts_(parts) {}

  void add(const Joint& joint, std::int32_t index);
  void add(const SpringDamper& spring, std::int32_t index);
  void add(const SystemForce& force);
  void add(const SystemSensor& sensor) {
    parts_.sensors.push_back(marker(sensor.on, sensor.point, Matrix3d::Identity()));
    parts_.sensor_rest.insert(parts_.sensor_rest.end(), sensor.point.begin(), sensor.point.end());
  }

 private:
  std::int32_t marker(const Part& part, const Vector3d& point, const Matrix3d& axes) {
    return place_marker(system_, track_, part, point, axes, parts_);
  }
  void check_in_plane(const Part& part, const Vector3d& point) const;
  std::int32_t motion(const Motion& motion);
  void row(RowKind kind, int i, int j = 0, int l = 0, std::int32_t motion = -1, double offset = 0.);
  void points(bool planar);
  void add_in_plane(const Joint& joint);
  void add_in_space(const Joint& joint);
  void add_either_way(const Joint& joint);

  const System& system_;
  const Track* track_;
  SystemParts& parts_;
  std::int32_t joint_ = 0, a_ = 0, b_ = 0;  // of the rows that are being added
};

/// Columns: the axis and two perpendicular ones. The second is as near to y as possible, so that in
/// a planar system it is the lateral axis if `axis` lies in the plane.
Matrix3d around(const Vector3d& axis) {
  if (!axis.allFinite() || !(axis.norm() > 0.))
    refuse("E-SYSTEM-01", "its axis is 0 or not finite; expected a finite vector that is not 0");
  const Vector3d n = axis.normalized();
  const Vector3d helper = std::abs(n.y()) < .9 ? Vector3d::UnitY() : Vector3d::UnitZ();
  Matrix3d axes;
  axes.col(0) = n;
  axes.col(1) = (helper - helper.dot(n) * n).normalized();
  axes.col(2) = n.cross(axes.col(1));
  return axes;
}

/// A force beside the axis of a planar beam would strain only its section.
void Connector::check_in_plane(const Part& part, const Vector3d& point) const {
  const auto index = static_cast<std::size_t>(part.index);
  if (index < system_.beams.size() && point.y() != system_.beams[index].start.y())
    refuse("E-SYSTEM-03", "its point is at y = " + std::to_string(point.y()) +
                              " m, beside its beam; expected the beam's y in a planar system");
}

std::int32_t Connector::motion(const Motion& motion) {
  const MotionPieces made = motion_pieces(motion);
  parts_.motions.push_back({static_cast<std::int32_t>(parts_.piece_start.size()),
                            static_cast<std::int32_t>(made.start.size())});
  parts_.piece_start.insert(parts_.piece_start.end(), made.start.begin(), made.start.end());
  parts_.piece.insert(parts_.piece.end(), made.coefficient.begin(), made.coefficient.end());
  return static_cast<std::int32_t>(parts_.motions.size()) - 1;
}

void Connector::row(RowKind kind, int i, int j, int l, std::int32_t motion, double offset) {
  RowModel r{};
  r.kind = kind;
  r.a = a_;
  r.b = b_;
  r.i = i;
  r.j = j;
  r.l = l;
  r.motion = motion;
  r.joint = joint_;
  r.offset = offset;
  (kind == RowKind::spring ? parts_.spring_rows : parts_.joint_rows).push_back(r);
}

void Connector::points(bool planar) {
  for (int c = 0; c < 3; ++c)
    if (!planar || c != 1) row(RowKind::along_ground, c);
}

/// Joints whose rows are the same in the plane and in space.
void Connector::add_either_way(const Joint& joint) {
  switch (joint.kind) {
    case JointKind::distance: {
      const double length = (joint.other_point - joint.point).norm();
      if (!(length > 0.))
        refuse("E-SYSTEM-10", "its two points are the same; expected a distance above 0 m");
      if (system_.planar && joint.point.y() != joint.other_point.y())
        refuse("E-SYSTEM-11", "its two points differ in y; expected the same y in a planar system");
      const bool driven = !joint.motion.polynomial.empty() || !joint.motion.table.empty();
      return row(RowKind::distance, 0, 0, 0, driven ? motion(joint.motion) : -1, length);
    }
    case JointKind::point_on_plane:
      return row(RowKind::along_a, 0);
    case JointKind::translation:
      return row(RowKind::along_a, 0, 0, 0, motion(joint.motion));
    case JointKind::rotation: {
      const std::int32_t angle = motion(joint.motion);
      SystemModel drive{};
      drive.motion = parts_.motions.data();
      drive.piece_start = parts_.piece_start.data();
      drive.piece = parts_.piece.data();
      const Jet start = motion_at(drive, angle, 0.);
      if (!(std::abs(start.x) < 1e-9))
        refuse("E-SYSTEM-12", "its rotation at t = 0 is " + std::to_string(start.x) +
                                  " rad; expected 0, since axes are given at rest");
      return row(RowKind::square, 2, 1, 1, angle);
    }
    default:
      break;
  }
}

void Connector::add_in_plane(const Joint& joint) {
  switch (joint.kind) {
    case JointKind::spherical:
    case JointKind::revolute:
      return points(true);
    case JointKind::prismatic:
    case JointKind::cylindrical:
      row(RowKind::along_a, 2);
      return row(RowKind::square, 0, 2);
    case JointKind::fixed:
      points(true);
      return row(RowKind::square, 0, 2);
    case JointKind::point_on_line:
      return row(RowKind::along_a, 2);
    case JointKind::universal:
      refuse("E-SYSTEM-13",
             "it is a universal joint, which a planar system does not have; expected a revolute "
             "joint");
    default:
      return add_either_way(joint);
  }
}

void Connector::add_in_space(const Joint& joint) {
  const auto across = [&] {
    row(RowKind::along_a, 1);
    row(RowKind::along_a, 2);
  };
  const auto parallel = [&] {
    row(RowKind::square, 0, 1);
    row(RowKind::square, 0, 2);
  };
  switch (joint.kind) {
    case JointKind::spherical:
      return points(false);
    case JointKind::revolute:
      points(false);
      return parallel();
    case JointKind::prismatic:
      across();
      parallel();
      return row(RowKind::square, 1, 2);
    case JointKind::cylindrical:
      across();
      return parallel();
    case JointKind::fixed:
      points(false);
      parallel();
      return row(RowKind::square, 1, 2);
    case JointKind::point_on_line:
      return across();
    case JointKind::universal:
      points(false);
      return row(RowKind::square, 0, 0);
    default:
      return add_either_way(joint);
  }
}

/// In a planar system the axis of a joint must be the lateral one, or must lie in the plane.
void check_plane(const Joint& joint) {
  const Vector3d n = joint.axis.normalized();
  const bool rotates = joint.kind == JointKind::revolute || joint.kind == JointKind::rotation;
  const bool free = joint.kind == JointKind::spherical || joint.kind == JointKind::distance;
  if (rotates && !(std::abs(n.y()) > 1. - 1e-12))
    refuse("E-SYSTEM-14", "its axis is not y; expected y in a planar system");
  if (!rotates && !free && !(std::abs(n.y()) < 1e-12))
    refuse("E-SYSTEM-15",
           "its axis leaves the plane of x and z; expected an axis in x and z in a planar system");
}

void Connector::add(const Joint& joint, std::int32_t index) {
  if (joint.a.kind == joint.b.kind && joint.a.index == joint.b.index &&
      joint.a.kind != Part::Kind::beam)
    refuse("E-SYSTEM-16", "it joins a part with itself; expected two parts");
  if (system_.planar) check_plane(joint);
  const Matrix3d axes = around(joint.axis);
  const bool two = joint.kind == JointKind::distance;
  joint_ = index;
  a_ = marker(joint.a, joint.point, axes);
  Matrix3d other = axes;
  if (joint.kind == JointKind::universal) {
    other = around(joint.other_axis);
    if (std::abs(other.col(0).dot(axes.col(0))) > 1e-12)
      refuse("E-SYSTEM-17", "its two axes are not perpendicular; expected 90 degrees between them");
  }
  b_ = marker(joint.b, two ? joint.other_point : joint.point, other);
  system_.planar ? add_in_plane(joint) : add_in_space(joint);
}

void Connector::add(const SpringDamper& spring, std::int32_t index) {
  if (!(spring.stiffness >= 0.) || !(spring.damping >= 0.) ||
      !(spring.stiffness + spring.damping > 0.))
    refuse("E-SYSTEM-18",
           "its stiffness or damping is negative, or both are 0; expected both to be at least 0, "
           "and one above 0");
  const double distance = (spring.point_b - spring.point_a).norm();
  const double length = std::isnan(spring.length) ? distance : spring.length;
  if (!(length >= 0.) || !(distance > 0.))
    refuse("E-SYSTEM-19",
           "its two points are the same, or its length is negative; expected two points and a "
           "length of at least 0 m");
  if (!std::isfinite(spring.stiffness) || !std::isfinite(spring.damping))
    refuse("E-SYSTEM-20", "its stiffness or damping is not finite; expected finite numbers");
  if (system_.planar && spring.point_a.y() != spring.point_b.y())
    refuse("E-SYSTEM-11", "its two points differ in y; expected the same y in a planar system");
  joint_ = index;
  a_ = marker(spring.a, spring.point_a, Matrix3d::Identity());
  b_ = marker(spring.b, spring.point_b, Matrix3d::Identity());
  row(RowKind::spring, 0, 0, 0, -1, length);
  parts_.spring_rows.back().stiffness = spring.stiffness;
  parts_.spring_rows.back().damping = spring.damping;
}

void Connector::add(const SystemForce& force) {
  if (force.on.kind == Part::Kind::rail)
    refuse("E-SYSTEM-21", "it acts on a rail; expected a load of the track for this");
  if (!force.direction.allFinite())
    refuse("E-SYSTEM-22", "its direction is not finite; expected three finite numbers");
  const Vector3d& d = force.direction;
  if (system_.planar && !(force.moment ? d.x() == 0. && d.z() == 0. : d.y() == 0.))
    refuse("E-SYSTEM-23",
           "its direction leaves the plane; expected a force in x and z, or a moment about y, in a "
           "planar system");
  if (system_.planar && !force.moment && force.on.kind == Part::Kind::beam)
    check_in_plane(force.on, force.point);
  if (force.moment && force.on.kind != Part::Kind::body)
    refuse("E-SYSTEM-24", "it is a moment on a part that is not a body; expected a body");
  PointForceModel packed{};
  packed.marker = marker(force.on, force.point, Matrix3d::Identity());
  if (force.input >= static_cast<int>(system_.input_limits.size()))
    refuse("E-SYSTEM-25", "its input is " + std::to_string(force.input) + "; expected one of the " +
                              std::to_string(system_.input_limits.size()) +
                              " inputs of the system, counted from 0");
  packed.motion = force.input >= 0 ? -1 : motion(force.factor);
  packed.input = force.input;
  packed.moment = force.moment ? 1 : 0;
  for (int c = 0; c < 3; ++c) packed.direction[c] = force.direction[c];
  parts_.forces.push_back(packed);
}

/// Adds items one by one; a message names the item.
template <class Item, class Add>
void each(const std::vector<Item>& items, const char* name, const Add& add) {
  for (std::size_t i = 0; i < items.size(); ++i) try {
      add(items[i], static_cast<std::int32_t>(i));
    } catch (const Refused& error) {
      refuse(error.id(), std::string(name) + " " + std::to_string(i) + ": " + error.sentence());
    }
}

/// Index of a marker's part among bodies, then beams, then the track; -1 on the ground.
std::int32_t part_of(const SystemParts& parts, const MarkerModel& marker) {
  if (marker.kind == PartKind::ground) return -1;
  if (marker.kind == PartKind::rail)
    return static_cast<std::int32_t>(parts.bodies.size() + parts.beams.size());
  return marker.part +
         (marker.kind == PartKind::beam ? static_cast<std::int32_t>(parts.bodies.size()) : 0);
}

/// Adds the ends of all rows, ordered by part.
void add_ends(SystemParts& parts) {
  const auto count = static_cast<std::int32_t>(parts.bodies.size() + parts.beams.size()) + 1;
  for (RowModel& row : parts.rows) row.end[0] = row.end[1] = -1;
  for (std::int32_t part = 0; part < count; ++part) {
    parts.part_end.push_back(static_cast<std::int32_t>(parts.ends.size()));
    for (std::size_t r = 0; r < parts.rows.size(); ++r)
      for (std::int32_t side = 0; side < 2; ++side) {
        RowModel& row = parts.rows[r];
        const std::int32_t on = side == 0 ? row.a : row.b;
        if (part_of(parts, parts.markers[static_cast<std::size_t>(on)]) != part) continue;
        row.end[side] = static_cast<std::int32_t>(parts.ends.size());
        parts.ends.push_back({static_cast<std::int32_t>(r), side});
      }
  }
  parts.part_end.push_back(static_cast<std::int32_t>(parts.ends.size()));
}

}  // namespace

void add_connections(const System& system, const Track* track, SystemParts& parts) {
  Connector connect(system, track, parts);
  each(system.joints, "joint", [&](const Joint& j, std::int32_t i) { connect.add(j, i); });
  const auto joints = static_cast<std::int32_t>(system.joints.size());
  each(system.springs, "spring",
       [&](const SpringDamper& s, std::int32_t i) { connect.add(s, joints + i); });
  each(system.forces, "force", [&](const SystemForce& f, std::int32_t) { connect.add(f); });
  each(system.sensors, "sensor", [&](const SystemSensor& s, std::int32_t) { connect.add(s); });
  parts.rows = parts.joint_rows;
  parts.rows.insert(parts.rows.end(), parts.spring_rows.begin(), parts.spring_rows.end());
  if (parts.rows.size() > static_cast<std::size_t>(kMaxSystemRows))
    refuse("E-SYSTEM-26", "joints and springs have " + std::to_string(parts.rows.size()) +
                              " rows; expected at most " + std::to_string(kMaxSystemRows));
  add_ends(parts);
  parts.pad();
}

}  // namespace railstep
