#include "offline/system/pack_parts.h"

#include <Eigen/Dense>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <string>

#include "offline/element/straight_beam.h"
#include "offline/math/refuse.h"
#include "online/math/lanes.h"
#include "online/model/beam_chain.h"

namespace railstep {

void SystemParts::pad() {
  const std::int32_t panels = (unknowns + kLanes - 1) / kLanes;
  const std::size_t n = std::size_t{kLanes} * static_cast<std::size_t>(panels);
  constant_force.resize(n, 0.);
  per_length.resize(n, 0.);
  beam_rest.resize(n, 0.);
}

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

std::string at(const char* what, std::size_t index) {
  return std::string(what) + " " + std::to_string(index) + ": ";
}

bool is_lateral(const Vector3d& v) { return v.x() == 0. && v.z() == 0.; }

/// Whether a rotation keeps the lateral axis.
bool keeps_plane(const Matrix3d& R) { return (R.col(1) - Vector3d::UnitY()).norm() < 1e-12; }

void set(double (&to)[9], const Matrix3d& from) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) to[3 * i + j] = from(i, j);
}

void check_body(const RigidBody& body, const std::string& name) {
  if (!(body.mass > 0.) || !std::isfinite(body.mass))
    refuse("E-SYSTEM-32", name + "its mass is " + std::to_string(body.mass) +
                              " kg; expected a finite mass above 0");
  if (!body.inertia.allFinite() ||
      (body.inertia - body.inertia.transpose()).norm() > 1e-12 * body.inertia.norm())
    refuse(
        "E-SYSTEM-33",
        name + "its inertia is not finite or not symmetric; expected a finite, symmetric matrix");
  const Vector3d own = Eigen::SelfAdjointEigenSolver<Matrix3d>(body.inertia).eigenvalues();
  if (!(own[0] > 0.))
    refuse(
        "E-SYSTEM-34",
        name +
            "its inertia about an axis is not above 0; expected inertias above 0 about every axis");
  if (own[2] > (own[0] + own[1]) * (1. + 1e-9))
    refuse("E-SYSTEM-35", name +
                              "its inertia about one axis is above the sum of the other two, which "
                              "no mass has; expected at most their sum");
  if (!(std::abs(body.orientation.norm() - 1.) < 1e-9))
    refuse("E-SYSTEM-36", name + "the quaternion of its orientation has the length " +
                              std::to_string(body.orientation.norm()) + "; expected 1");
}

void add_body(const RigidBody& body, std::size_t index, bool planar, SystemParts& parts) {
  const std::string name = at("body", index);
  check_body(body, name);
  if (planar && !(body.velocity.y() == 0. && is_lateral(body.angular_velocity) &&
                  keeps_plane(body.orientation.toRotationMatrix())))
    refuse("E-SYSTEM-37", name +
                              "its orientation or velocity leaves the plane; expected motion in x "
                              "and z and rotation about y in a planar system");
  if (planar && body.inertia.row(1).cwiseAbs().dot(Vector3d(1., 0., 1.)) > 0.)
    refuse(
        "E-SYSTEM-38",
        name +
            "y is not a principal axis of its inertia; expected Ixy = Iyz = 0 in a planar system");
  RigidBodyModel& packed = parts.bodies.emplace_back();
  packed.first = parts.unknowns;
  packed.unknowns = planar ? 3 : 6;
  constexpr std::int32_t kSpatial[6] = {0, 1, 2, 3, 4, 5}, kPlanar[6] = {0, -1, 1, -1, 2, -1};
  for (int k = 0; k < 6; ++k) packed.column[k] = planar ? kPlanar[k] : kSpatial[k];
  packed.mass = body.mass;
  set(packed.inertia, body.inertia);
  set(packed.inverse_inertia, body.inertia.inverse());
  for (int k = 0; k < 3; ++k) packed.rest[k] = body.position[k];
  packed.radius = std::sqrt(body.inertia.diagonal().maxCoeff() / body.mass);
  parts.unknowns += packed.unknowns;
}

void check_beam(const FlexibleBeam& beam, const std::string& name, bool planar) {
  if (beam.elements < 1 || beam.elements > kMostElementsOfBeam)
    refuse("E-SYSTEM-39", name + "it has " + std::to_string(beam.elements) +
                              " elements; expected 1 to " + std::to_string(kMostElementsOfBeam));
  if (!(beam.length > 0.) || !std::isfinite(beam.length))
    refuse("E-SYSTEM-40", name + "its length is " + std::to_string(beam.length) +
                              " m; expected a finite length above 0");
  if (!(beam.half_height > 0.))
    refuse("E-SYSTEM-41", name + "half its height is " + std::to_string(beam.half_height) +
                              " m; expected a height above 0");
  if (!(beam.material.density > 0.))
    refuse("E-SYSTEM-42", name + "its density is " + std::to_string(beam.material.density) +
                              " kg/m3; expected a density above 0");
  if (!((beam.axes.transpose() * beam.axes - Matrix3d::Identity()).norm() < 1e-12) ||
      beam.axes.determinant() < 0.)
    refuse("E-SYSTEM-43", name +
                              "its axes are not perpendicular, of length 1 and right-handed; "
                              "expected a rotation matrix");
  if (planar &&
      !(keeps_plane(beam.axes) && beam.velocity.y() == 0. && is_lateral(beam.angular_velocity)))
    refuse("E-SYSTEM-37", name +
                              "its orientation or velocity leaves the plane; expected motion in x "
                              "and z and rotation about y in a planar system");
}

/// Positions and slopes of a node, [9].
Eigen::Matrix<double, 9, 1> node_at_rest(const FlexibleBeam& beam, int node) {
  Eigen::Matrix<double, 9, 1> q;
  q << beam.start + beam.axes.col(0) * (beam.length * node / (2. * beam.elements)),
      beam.axes.col(1), beam.axes.col(2);
  return q;
}

/// The values of those of a node's nine quantities that are unknowns.
std::vector<double> carried(bool planar, const Eigen::Matrix<double, 9, 1>& q) {
  std::vector<double> out(planar ? kPlanarUnknowns : 9);
  for (std::size_t k = 0; k < out.size(); ++k)
    out[k] = q[planar ? kPlanarOf[k] : static_cast<int>(k)];
  return out;
}

template <class Node>
std::vector<double> over_nodes(const FlexibleBeam& beam, bool planar, const Node& node) {
  std::vector<double> all;
  for (int n = 0; n <= 2 * beam.elements; ++n) {
    const std::vector<double> own = carried(planar, node(n));
    all.insert(all.end(), own.begin(), own.end());
  }
  return all;
}

/// 1 for free unknowns, 0 for held ones.
Eigen::Matrix<double, 9, 1> free_of(const FlexibleBeam& beam, int node) {
  Eigen::Matrix<double, 9, 1> is_free = Eigen::Matrix<double, 9, 1>::Ones();
  if (node != 0 && node != 2 * beam.elements) return is_free;
  const BeamEnd end = beam.ends[node == 0 ? 0 : 1];
  if (end != BeamEnd::free) is_free.head<3>().setZero();
  if (end == BeamEnd::clamped) is_free.setZero();
  return is_free;
}

/// Adds the held unknowns of a beam to those of the others.
void add_held(const FlexibleBeam& beam, BeamChainModel& packed, SystemParts& parts) {
  const std::vector<double> is_free =
      over_nodes(beam, packed.planar != 0, [&](int n) { return free_of(beam, n); });
  packed.first_held = static_cast<std::int32_t>(parts.held.size());
  for (std::size_t i = 0; i < is_free.size(); ++i)
    if (is_free[i] == 0.) parts.held.push_back(static_cast<std::int32_t>(i));
  packed.held = static_cast<std::int32_t>(parts.held.size()) - packed.first_held;
}

void add_beam(const FlexibleBeam& beam, std::size_t index, bool planar, SystemParts& parts) {
  const std::string name = at("beam", index);
  check_beam(beam, name, planar);
  const BeamLaw law = beam_law(beam.section, beam.material, beam.rule, beam.axis_z);
  BeamChainModel& packed = parts.beams.emplace_back();
  packed.first = parts.unknowns;
  packed.planar = planar ? 1 : 0;
  packed.elements = beam.elements;
  packed.unknowns = (planar ? kPlanarUnknowns : 9) * (2 * beam.elements + 1);
  packed.slope_scale = beam.half_height;
  packed.element = straight_beam(law, beam.length / beam.elements);
  const auto mass = chain_mass(beam.section, law);
  std::copy(mass.begin(), mass.end(), packed.mass);
  add_held(beam, packed, parts);
  const std::vector<double> rest =
      over_nodes(beam, planar, [&](int n) { return node_at_rest(beam, n); });
  parts.beam_rest.resize(static_cast<std::size_t>(packed.first), 0.);
  parts.beam_rest.insert(parts.beam_rest.end(), rest.begin(), rest.end());
  parts.unknowns += packed.unknowns;
}

/// Adds the weight on every unknown, and the factors that make forces comparable to each other.
void add_weight(const System& system, SystemParts& parts) {
  const Vector3d& g = system.gravity;
  for (const RigidBodyModel& body : parts.bodies)
    for (int c = 0; c < 6; ++c)
      if (body.column[c] >= 0) {
        const std::int32_t unknown = body.first + body.column[c];
        const auto k = static_cast<std::size_t>(unknown);
        parts.constant_force[k] = c < 3 ? body.mass * g[c] : 0.;
        parts.per_length[k] = c < 3 ? 1. : 1. / body.radius;
      }
  for (std::size_t b = 0; b < parts.beams.size(); ++b) {
    const BeamChainModel& beam = parts.beams[b];
    Eigen::Matrix<double, 9, 1> fall, weighing;
    fall << g, Vector3d::Zero(), Vector3d::Zero();
    weighing << Vector3d::Ones(), Vector3d::Constant(1. / beam.slope_scale),
        Vector3d::Constant(1. / beam.slope_scale);
    const FlexibleBeam& from = system.beams[b];
    const auto first = static_cast<std::size_t>(beam.first);
    const std::vector<double> a = over_nodes(from, system.planar, [&](int) { return fall; });
    const std::vector<double> per = over_nodes(from, system.planar, [&](int n) {
      return Eigen::Matrix<double, 9, 1>(weighing.cwiseProduct(free_of(from, n)));
    });
    beam_inertia(beam, a.data(), parts.constant_force.data() + first);
    std::copy(per.begin(), per.end(),
              parts.per_length.begin() + static_cast<std::ptrdiff_t>(first));
  }
}

}  // namespace

void add_parts(const System& system, SystemParts& parts) {
  if (system.bodies.size() + system.beams.size() > static_cast<std::size_t>(kMaxSystemParts))
    refuse("E-SYSTEM-45",
           "the system has " + std::to_string(system.bodies.size() + system.beams.size()) +
               " bodies and beams; expected at most " + std::to_string(kMaxSystemParts));
  if (system.planar && system.gravity.y() != 0.)
    refuse("E-SYSTEM-46",
           "gravity has a lateral part; expected gravity in x and z in a planar system");
  for (std::size_t i = 0; i < system.bodies.size(); ++i)
    add_body(system.bodies[i], i, system.planar, parts);
  for (std::size_t i = 0; i < system.beams.size(); ++i)
    add_beam(system.beams[i], i, system.planar, parts);
  if (parts.unknowns == 0)
    refuse("E-SYSTEM-47", "the system has neither a body nor a beam; expected at least one");
  parts.pad();
  add_weight(system, parts);
}

std::vector<double> start_velocities(const System& system, const SystemParts& parts) {
  std::vector<double> v(parts.constant_force.size(), 0.);
  for (std::size_t b = 0; b < parts.bodies.size(); ++b) {
    const RigidBody& body = system.bodies[b];
    Eigen::Matrix<double, 6, 1> own;
    own << body.velocity, body.orientation.conjugate() * body.angular_velocity;
    for (int c = 0; c < 6; ++c)
      if (parts.bodies[b].column[c] >= 0) {
        const std::int32_t k = parts.bodies[b].first + parts.bodies[b].column[c];
        v[static_cast<std::size_t>(k)] = own[c];
      }
  }
  for (std::size_t b = 0; b < parts.beams.size(); ++b) {
    const FlexibleBeam& beam = system.beams[b];
    const std::vector<double> own = over_nodes(beam, system.planar, [&](int n) {
      Eigen::Matrix<double, 9, 1> lever = node_at_rest(beam, n);
      lever.head<3>() -= beam.start;
      const Vector3d& w = beam.angular_velocity;
      Eigen::Matrix<double, 9, 1> rate;
      for (int field = 0; field < 9; field += 3)
        rate.segment<3>(field) = w.cross(Vector3d(lever.segment<3>(field)));
      rate.head<3>() += beam.velocity;
      return Eigen::Matrix<double, 9, 1>(rate.cwiseProduct(free_of(beam, n)));
    });
    std::copy(own.begin(), own.end(), v.begin() + parts.beams[b].first);
  }
  return v;
}

}  // namespace railstep
