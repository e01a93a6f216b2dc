#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <limits>
#include <vector>

#include "offline/element/matrices.h"
#include "offline/math/constants.h"

namespace railstep {

/// A rigid body at the start; inertia is about its centre of mass.
struct RigidBody {
  double mass = 0.;                                                 // kg, > 0
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();                // kg m2, in body axes
  Eigen::Vector3d position = Eigen::Vector3d::Zero();               // of the centre, m
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  // body axes to ground
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();               // of the centre, m/s
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();       // ground axes, rad/s
};

enum class BeamEnd { free, pinned, clamped };  // pinned: its position is held; clamped: all of it

/// A nonlinear ANCF beam, straight at rest.
struct FlexibleBeam {
  BeamSection section;
  Material material;
  ElementRule rule = {};  // two axial points
  double axis_z = 0.;     // of the reference line above the centroid, m
  int elements = 1;
  double length = 0.;       // m
  double half_height = 0.;  // of the section, m; it scales slopes to lengths
  Eigen::Vector3d start = Eigen::Vector3d::Zero();  // of the reference line, m
  /// Columns: along the beam, lateral (a), up (b).
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  std::array<BeamEnd, 2> ends = {BeamEnd::free, BeamEnd::free};
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();          // of the start point, m/s
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  // as a rigid body, rad/s
};

/// A part that a joint is fixed to.
struct Part {
  enum class Kind { ground, body, beam, rail } kind = Kind::ground;
  int index = 0;  // among the system's bodies or beams; of rails 0 left, 1 right
};
inline Part ground() { return {}; }
inline Part body(int index) { return {Part::Kind::body, index}; }
inline Part beam(int index) { return {Part::Kind::beam, index}; }
/// A rail of the linear track beside which the system stands.
inline Part rail(int index) { return {Part::Kind::rail, index}; }

/// s(t): a polynomial c0 + c1 t + ... of at most 6 coefficients, or a natural cubic spline through
/// a table, constant outside of it.
struct Motion {
  std::vector<double> polynomial = {};
  std::vector<std::array<double, 2>> table = {};  // s, value; at least 2 rows, s rising
};

/// Kinds of joints between two parts. Point and axes are given at rest, in ground axes.
enum class JointKind {
  spherical,       // the points coincide; a hinge in the plane
  revolute,        // the points coincide, and rotation is about the axis only
  prismatic,       // slides along the axis, without rotation
  cylindrical,     // slides along the axis and rotates about it
  fixed,           // no motion
  distance,        // point and other_point keep their distance
  point_on_line,   // B's point stays on A's line along the axis
  point_on_plane,  // B's point stays in A's plane normal to the axis
  universal,       // the points coincide; A's axis and B's stay perpendicular
  translation,     // driven: distance s(t) from A's point to B's along A's axis
  rotation,        // driven: B rotates by s(t) (rad) about the axis relative to A. It holds nothing
  // else: use it together with a revolute joint
};

struct Joint {
  JointKind kind = JointKind::spherical;
  Part a = {}, b = {};
  Eigen::Vector3d point = Eigen::Vector3d::Zero();        // m
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();        // y for rotations in planar systems
  Eigen::Vector3d other_point = Eigen::Vector3d::Zero();  // distance: on B, m; `point` is on A
  Eigen::Vector3d other_axis = Eigen::Vector3d::UnitY();  // universal: the axis of B
  Motion motion = {};                                     // of driven joints
};

/// A spring and a damper along the line between two points.
struct SpringDamper {
  Part a = {}, b = {};
  Eigen::Vector3d point_a = Eigen::Vector3d::Zero(), point_b = Eigen::Vector3d::Zero();  // m
  double stiffness = 0., damping = 0.;                       // N/m, N s/m
  double length = std::numeric_limits<double>::quiet_NaN();  // without force, m; NaN: as at rest
};

/// Direction (ground axes) times s(t), or times an input of each frame: N at a point, or N m on a
/// body.
struct SystemForce {
  Part on = {};
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
  Motion factor = {};
  bool moment = false;
  int input = -1;  // in place of s(t): index among System::input_limits
};

/// A point whose motion is published.
struct SystemSensor {
  Part on = {};
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
};

/// Bodies, beams and their joints, springs and forces, as a scene gives them. A planar system moves
/// in x and z. The lateral axes of its parts are the ground's y. It has 3 unknowns per body and 5
/// per node.
struct System {
  bool planar = false;
  Eigen::Vector3d gravity = Eigen::Vector3d(0., 0., -kGravity);
  std::vector<RigidBody> bodies = {};
  std::vector<FlexibleBeam> beams = {};
  std::vector<Joint> joints = {};
  std::vector<SpringDamper> springs = {};
  std::vector<SystemForce> forces = {};
  std::vector<SystemSensor> sensors = {};
  std::vector<double> input_limits = {};  // of each input, N or N m, above 0
};

}  // namespace railstep
