#pragma once
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "offline/element/matrices.h"
#include "offline/system/pack_system.h"
#include "online/step/step.h"
#include "online/system/sensor.h"
#include "support/beam_energy.h"

namespace railstep {

/// A system with its state, stepped frame by frame; the workspace holds NaN before every frame.
/// Results read from the state are computed again from the scene's own numbers.
struct SystemRun {
  System system;
  std::unique_ptr<PackedSystem> packed;
  std::vector<double> memory, scratch;
  State state;
  Workspace workspace;
  Outputs outputs{};
  Status seen = Status::ok;
  double violation = 0.;  // largest of all frames, m or 1
  int iterations = 0;     // most of all frames

  SystemRun(System scene, std::unique_ptr<PackedSystem> made)
      : system(std::move(scene)),
        packed(std::move(made)),
        memory(static_cast<std::size_t>(state_doubles(model()))),
        scratch(static_cast<std::size_t>(workspace_doubles(model()))),
        state(state_on(model(), memory.data())),
        workspace(workspace_on(model(), scratch.data())) {
    reset(model(), state);
    measure_beams();
  }

  SystemRun(const System& scene, const SystemOptions& options)
      : SystemRun(scene, std::make_unique<PackedSystem>(scene, options)) {}
  /// A system beside a track.
  SystemRun(const System& scene, const SystemOptions& options, const Track& track,
            const PackOptions& track_options, const Traffic& traffic = {})
      : SystemRun(scene,
                  std::make_unique<PackedSystem>(scene, options, track, traffic, track_options)) {}

  const Model& model() const { return packed->model(); }
  double time() const { return static_cast<double>(state.steps) * model().scheme.dt; }
  void frame() {
    scratch.assign(scratch.size(), std::numeric_limits<double>::quiet_NaN());
    seen = seen | advance_frame(model(), state, workspace, outputs);
    violation = std::max(violation, outputs.constraint_violation);
    iterations = std::max(iterations, static_cast<int>(outputs.iterations));
  }
  void until(double t) {
    const auto steps = static_cast<std::int64_t>(std::llround(t / model().scheme.dt));
    while (state.steps < steps) frame();
  }

  const RigidBodyModel& body(int i) const { return model().system.body[i]; }
  Eigen::Vector3d body_position(int i) const {
    return system.bodies[at(i)].position + carried(state.u, i, 0);
  }
  /// m/s
  Eigen::Vector3d body_velocity(int i) const { return carried(state.v, i, 0); }
  Eigen::Matrix3d body_rotation(int i) const {
    const double* q = state.quaternion + 4 * static_cast<std::ptrdiff_t>(i);
    return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
  }
  /// Body axes, rad/s.
  Eigen::Vector3d body_spin(int i) const { return carried(state.v, i, 3); }

  /// Nodes of a beam as the spatial unknowns, [9 nodes]: positions and slopes, or velocities.
  Eigen::VectorXd beam_nodes(int i) const { return beam_rest(i) + unpacked(state.u, i); }
  Eigen::VectorXd beam_speeds(int i) const { return unpacked(state.v, i); }
  Eigen::VectorXd beam_rest(int i) const {
    const FlexibleBeam& b = system.beams[at(i)];
    Eigen::VectorXd rest(9 * (2 * b.elements + 1));
    for (int n = 0; n <= 2 * b.elements; ++n) {
      rest.segment<3>(9 * n) = b.start + b.axes.col(0) * (b.length * n / (2. * b.elements));
      rest.segment<3>(9 * n + 3) = b.axes.col(1);
      rest.segment<3>(9 * n + 6) = b.axes.col(2);
    }
    return rest;
  }

  /// Position of the body's material point that is at `point` at rest.
  Eigen::Vector3d point_of_body(int i, const Eigen::Vector3d& point) const {
    const RigidBody& b = system.bodies[at(i)];
    return body_position(i) + body_rotation(i) * (b.orientation.conjugate() * (point - b.position));
  }

  /// Centre of mass of a beam, m.
  Eigen::Vector3d beam_centre(int i) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    const Eigen::VectorXd p = by_mass(i, beam_nodes(i)), one = by_mass(i, all_along_x(i));
    double mass = 0.;
    for (int k = 0; k < p.size(); k += 9) {
      sum += p.segment<3>(k);
      mass += one[k];
    }
    return sum / mass;
  }

  /// Force and moment of a joint on its part b, N and N m about the joint's point, ground axes.
  Eigen::Vector3d joint_force(int joint) const {
    return Eigen::Vector3d(railstep::joint_force(model(), state, joint).force);
  }
  Eigen::Vector3d joint_moment(int joint) const {
    return Eigen::Vector3d(railstep::joint_force(model(), state, joint).moment);
  }

  /// Linear momentum of all parts, kg m/s, then angular momentum about the origin, kg m2/s.
  Eigen::Matrix<double, 6, 1> momentum() const;
  /// Kinetic energy, potential of weights and springs, and strain energy, J.
  double energy() const;

 private:
  /// One element of each beam. Its mass couples only equal components, so it is the same in all
  /// axes.
  struct OwnBeam {
    Matrix27 mass;
    Beam element;
  };
  std::vector<OwnBeam> own_beams;

  void measure_beams() {
    for (const FlexibleBeam& b : system.beams) {
      const BeamLaw law = beam_law(b.section, b.material, b.rule, b.axis_z);
      const double part = b.length / b.elements;
      own_beams.push_back(
          {element_matrices(b.section, law, part).mass, beam_element(law, straight_nodes(part))});
    }
  }
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  Eigen::Vector3d carried(const double* values, int i, int from) const {
    Eigen::Vector3d result = Eigen::Vector3d::Zero();
    for (int c = 0; c < 3; ++c)
      if (const std::int32_t k = body(i).column[from + c]; k >= 0)
        result[c] = values[model().system.first + body(i).first + k];
    return result;
  }
  Eigen::VectorXd unpacked(const double* values, int i) const {
    const double* from = values + model().system.first + model().system.beam[i].first;
    const int nodes = 2 * system.beams[at(i)].elements + 1;
    if (!system.planar) return Eigen::Map<const Eigen::VectorXd>(from, 9 * nodes);
    constexpr int kPlace[5] = {0, 2, 4, 6, 8};
    Eigen::VectorXd result = Eigen::VectorXd::Zero(9 * nodes);
    for (int n = 0; n < nodes; ++n)
      for (int k = 0; k < 5; ++k) result[9 * n + kPlace[k]] = from[5 * n + k];
    return result;
  }
  /// M times nodal values of a beam.
  Eigen::VectorXd by_mass(int i, const Eigen::VectorXd& v) const;
  Eigen::VectorXd all_along_x(int i) const {
    Eigen::VectorXd one = Eigen::VectorXd::Zero(9 * (2 * system.beams[at(i)].elements + 1));
    for (int k = 0; k < one.size(); k += 9) one[k] = 1.;
    return one;
  }
};

inline Eigen::VectorXd SystemRun::by_mass(int i, const Eigen::VectorXd& v) const {
  Eigen::VectorXd p = Eigen::VectorXd::Zero(v.size());
  for (int e = 0; e < system.beams[at(i)].elements; ++e)
    p.segment<27>(18 * e) += own_beams[at(i)].mass * v.segment<27>(18 * e);
  return p;
}

inline Eigen::Matrix<double, 6, 1> SystemRun::momentum() const {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero(), angular = linear;
  for (int i = 0; i < static_cast<int>(system.bodies.size()); ++i) {
    const RigidBody& b = system.bodies[at(i)];
    const Eigen::Vector3d p = b.mass * body_velocity(i);
    linear += p;
    angular += body_position(i).cross(p) + body_rotation(i) * (b.inertia * body_spin(i));
  }
  for (int i = 0; i < static_cast<int>(system.beams.size()); ++i) {
    const Eigen::VectorXd q = beam_nodes(i), p = by_mass(i, beam_speeds(i));
    for (int k = 0; k < q.size(); k += 3) {
      if (k % 9 == 0) linear += p.segment<3>(k);
      angular += q.segment<3>(k).cross(p.segment<3>(k));
    }
  }
  Eigen::Matrix<double, 6, 1> result;
  result << linear, angular;
  return result;
}

inline double SystemRun::energy() const {
  double sum = 0.;
  const auto place = [&](const Part& part, const Eigen::Vector3d& point) -> Eigen::Vector3d {
    return part.kind == Part::Kind::body ? point_of_body(part.index, point) : point;
  };
  for (int i = 0; i < static_cast<int>(system.bodies.size()); ++i) {
    const RigidBody& b = system.bodies[at(i)];
    const Eigen::Vector3d w = body_spin(i);
    sum += .5 * b.mass * body_velocity(i).squaredNorm() + .5 * w.dot(b.inertia * w) -
           b.mass * system.gravity.dot(body_position(i));
  }
  for (const SpringDamper& s : system.springs) {
    const double rest = std::isnan(s.length) ? (s.point_b - s.point_a).norm() : s.length;
    const double longer = (place(s.b, s.point_b) - place(s.a, s.point_a)).norm() - rest;
    sum += .5 * s.stiffness * longer * longer;
  }
  for (int i = 0; i < static_cast<int>(system.beams.size()); ++i) {
    const FlexibleBeam& b = system.beams[at(i)];
    const auto& [mass, element] = own_beams[at(i)];
    const Eigen::VectorXd q = beam_nodes(i), v = beam_speeds(i);
    for (int e = 0; e < b.elements; ++e) {
      const Vector27 own = q.segment<27>(18 * e), speed = v.segment<27>(18 * e);
      Vector27 fall = Vector27::Zero();
      for (int n = 0; n < 3; ++n) fall.segment<3>(9 * n) = system.gravity;
      sum += beam_energy(element, own.data()) + .5 * speed.dot(mass * speed) - fall.dot(mass * own);
    }
  }
  return sum;
}

/// Largest of all entries.
inline double largest(const Eigen::MatrixXd& a) { return a.cwiseAbs().maxCoeff(); }

/// A uniform rod of square section from `start`, at an angle (rad) from x towards z. It moves in
/// that plane: its start at `velocity`, with the angle's rate `rate`.
inline RigidBody rod_body(const Eigen::Vector3d& start, double length, double angle, double mass,
                          double side, const Eigen::Vector3d& velocity = Eigen::Vector3d::Zero(),
                          double rate = 0.) {
  const Eigen::Vector3d along(std::cos(angle), 0., std::sin(angle));
  const Eigen::Vector3d spin(0., -rate, 0.);
  const double across = mass * (length * length + side * side) / 12.;
  RigidBody b;
  b.mass = mass;
  b.inertia = Eigen::Vector3d(mass * side * side / 6., across, across).asDiagonal();
  b.position = start + .5 * length * along;
  b.orientation = Eigen::AngleAxisd(-angle, Eigen::Vector3d::UnitY());
  b.velocity = velocity + spin.cross(.5 * length * along);
  b.angular_velocity = spin;
  return b;
}

/// Options for comparing with known answers: Newton's residual is far below any scheme's own error.
inline SystemOptions sharp(const Scheme& scheme,
                           ConstraintMethod hold = ConstraintMethod::augmented_lagrangian) {
  SystemOptions options{.scheme = scheme};
  const Scheme mean = energy_momentum(scheme.dt);
  options.energy_momentum = scheme.kg == mean.kg && scheme.kv == mean.kv;
  options.constraint_method = hold;
  options.cap = 20;
  options.projections = 8;
  options.tolerance = 1e-12;  // otherwise round-off of places would end the iterations
  options.joint_tolerance = 1e-12;
  return options;
}

/// Order of a scheme from its errors at a step and at half of it.
inline double order(double coarse, double fine) { return std::log2(coarse / fine); }

/// Schemes of steps h, s, and their orders: the first two are of second order.
struct SchemeOrder {
  Scheme (*scheme)(double h);
  double order;
};
inline constexpr SchemeOrder kSchemeOrders[] = {
    {[](double h) { return generalised_alpha(h, .9); }, 2.},
    {[](double h) { return energy_momentum(h); }, 2.},
    {[](double h) { return backward_euler(h); }, 1.}};

inline RigidBody block(double mass, const Eigen::Vector3d& position) {
  return {.mass = mass,
          .inertia = Eigen::Vector3d(.4, .5, .6).asDiagonal().toDenseMatrix() * mass,
          .position = position};
}

/// A block that is guided along z, on a spring and a damper on the axis of the left rail.
inline System sprung_block(double x, double mass, double stiffness, double damping) {
  System s;
  s.bodies = {block(mass, {x, .75, .5})};
  s.joints = {{.kind = JointKind::prismatic,
               .a = ground(),
               .b = body(0),
               .point = {x, .75, .5},
               .axis = Eigen::Vector3d::UnitZ()}};
  s.springs = {{.a = rail(0),
                .b = body(0),
                .point_a = {x, .75, 0.},
                .point_b = {x, .75, .5},
                .stiffness = stiffness,
                .damping = damping}};
  return s;
}

/// A hinge about y.
inline Joint hinge(Part a, Part b, const Eigen::Vector3d& point, bool planar) {
  Joint j;
  j.kind = planar ? JointKind::spherical : JointKind::revolute;
  j.a = a;
  j.b = b;
  j.point = point;
  j.axis = Eigen::Vector3d::UnitY();
  return j;
}

}  // namespace railstep
