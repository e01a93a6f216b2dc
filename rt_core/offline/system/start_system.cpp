#include "offline/system/start_system.h"

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <sstream>

#include "offline/math/refuse.h"
#include "offline/math/sparse.h"
#include "online/model/beam_chain.h"
#include "online/system/row.h"
#include "online/system/rows.h"

namespace railstep {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

VectorXd vector(const double* values, std::int32_t n) {
  return Eigen::Map<const VectorXd>(values, n);
}

void add_bodies(const SystemModel& s, std::vector<Eigen::Triplet<double>>& entries) {
  for (std::int32_t b = 0; b < s.bodies; ++b) {
    const RigidBodyModel& body = s.body[b];
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) {
        if (body.column[i] < 0 || body.column[j] < 0 || (i < 3) != (j < 3)) continue;
        const double m = i >= 3 ? body.inertia[3 * (i - 3) + (j - 3)] : i == j ? body.mass : 0.;
        entries.emplace_back(body.first + body.column[i], body.first + body.column[j], m);
      }
  }
}

/// Adds the mass of a beam, column by column: the online inertia under unit accelerations of a
/// node.
void add_beam(const SystemModel& s, const BeamChainModel& beam,
              std::vector<Eigen::Triplet<double>>& entries) {
  const int width = beam_width(beam), nodes = beam.unknowns / width;
  const double* is_free = s.per_length + beam.first;  // 0 where held
  for (int c = 0; c < beam.unknowns; ++c) {
    VectorXd unit = VectorXd::Zero(beam.unknowns), force = VectorXd::Zero(beam.unknowns);
    unit[c] = 1.;
    beam_inertia(beam, unit.data(), force.data());
    const int node = c / width;
    const int from = std::max(0, node - 2) * width, to = std::min(nodes, node + 3) * width;
    for (int r = from; r < to; ++r)
      if (is_free[r] * is_free[c] != 0. && force[r] != 0.)
        entries.emplace_back(beam.first + r, beam.first + c, force[r]);
    if (is_free[c] == 0.) entries.emplace_back(beam.first + c, beam.first + c, 1.);
  }
}

/// M, with ones for unknowns that are held, that pad, or that belong to the track.
Sparse mass(const SystemModel& s) {
  std::vector<Eigen::Triplet<double>> entries;
  add_bodies(s, entries);
  std::int32_t used = 0;
  for (std::int32_t b = 0; b < s.bodies; ++b) used += s.body[b].unknowns;
  for (std::int32_t b = 0; b < s.beams; ++b) {
    add_beam(s, s.beam[b], entries);
    used += s.beam[b].unknowns;
  }
  for (std::int32_t i = used; i < s.unknowns; ++i) entries.emplace_back(i, i, 1.);
  Sparse M(s.unknowns, s.unknowns);
  M.setFromTriplets(entries.begin(), entries.end());
  return M;
}

/// M^-1; for the track its effect in a step, kg times the compliance of its ports.
class Mobility {
 public:
  explicit Mobility(const Model& model) : model_(model), inverse_(mass(model.system)) {
    if (inverse_.info() != Eigen::Success)
      refuse("E-SYSTEM-63",
             "the mass matrix is not positive definite; expected masses and inertias above 0");
  }
  MatrixXd operator*(const MatrixXd& forces) const {
    MatrixXd moved = inverse_.solve(forces);
    const SystemModel& s = model_.system;
    if (s.ports == 0) return moved;
    using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const Eigen::Index n = 9 * s.ports, first = s.port[0].first;
    moved.middleRows(first, n) = model_.scheme.kg *
                                 Eigen::Map<const Square>(s.port_compliance, n, n) *
                                 forces.middleRows(first, n);
    return moved;
  }

 private:
  const Model& model_;
  Eigen::SimplicialLDLT<Sparse> inverse_;
};

/// The system at the start, in the online workspace.
struct Standing {
  Model model;
  std::vector<double> memory, quaternion, zero, u, v;
  SystemWorkspace w;
  SystemStart start;

  Standing(const Model& from, std::vector<double> q, std::vector<double> places,
           std::vector<double> rates)
      : model(from), quaternion(std::move(q)), u(std::move(places)), v(std::move(rates)) {
    SystemModel& s = model.system;
    model.scheme.kv = model.scheme.kg = 0.;  // so that the velocities are v, accelerations 0
    s.mean = 0;
    s.constraint_method = ConstraintMethod::direct;
    memory.assign(static_cast<std::size_t>(system_workspace_doubles(s) + system_tangent_doubles(s)),
                  0.);
    zero.assign(static_cast<std::size_t>(s.unknowns), 0.);
    w = system_workspace_on(s, memory.data(), nullptr);
    std::copy(u.begin(), u.end(), w.x);
    start = {u.data(), v.data(), u.data(), v.data(), quaternion.data()};
    place();
  }
  void place() {
    place_start(model, start, w);
    place_parts(model, start, w);
    part_forces(model, start, false, w);
    outer_forces(model, 0., nullptr, w);
    for (std::int32_t r = 0; r < system_rows(model.system); ++r) w.force[r] = 0.;
    Model plain = model;
    plain.scheme.kv = 1.;  // else springs have no slope; targets of rows are not used
    set_rows(plain, 0., false, w);
  }
  Jet jet(std::int32_t r) const {
    const SystemModel& s = model.system;
    const RowModel& row = s.row[r];
    const Motions at{u.data(), v.data(), zero.data(), w.matrix};
    const Jet motion = row.motion >= 0 ? motion_at(s, row.motion, 0.) : Jet{row.offset, 0., 0.};
    return row_jet(row, marker_jet(s, s.marker[row.a], at), marker_jet(s, s.marker[row.b], at),
                   motion);
  }
  /// Rows `first` to `last` of G, dense.
  MatrixXd gradients(std::int32_t first, std::int32_t last) const {
    const SystemModel& s = model.system;
    MatrixXd G = MatrixXd::Zero(last - first, s.unknowns);
    VectorXd unit(system_rows(s)), row(s.unknowns);
    for (std::int32_t r = first; r < last; ++r) {
      unit.setZero();
      unit[r] = 1.;
      row.setZero();
      add_row_forces(s, w.gradient, unit.data(), row.data());
      G.row(r - first) = row;
    }
    return G;
  }
};

void check_joints(const SystemModel& s, const SystemWorkspace& w, double size) {
  for (std::int32_t r = 0; r < s.joint_rows; ++r) {
    if (std::abs(w.value[r]) <= 1e-9 * size) continue;
    std::ostringstream text;
    text << "joint " << s.row[r].joint << ": it is open by " << w.value[r]
         << " at the start; expected positions that close it to " << 1e-9 * size;
    refuse("E-SYSTEM-64", text.str());
  }
}

std::vector<double> start_quaternions(const System& system, const Rest* rest) {
  if (rest != nullptr) return rest->quaternion;
  std::vector<double> all;
  for (const RigidBody& body : system.bodies) {
    const Eigen::Quaterniond q = body.orientation.normalized();
    for (const double x : {q.w(), q.x(), q.y(), q.z()}) all.push_back(x);
  }
  return all;
}

/// Displacements of the system's unknowns at the start.
std::vector<double> start_places(const SystemModel& s, const Rest* rest) {
  std::vector<double> u(static_cast<std::size_t>(s.unknowns), 0.);
  if (rest != nullptr) std::copy_n(rest->u.end() - s.unknowns, s.unknowns, u.begin());
  return u;
}

/// Velocities as given, plus those of the rest that moves with loads; joints do not act yet.
std::vector<double> start_rates(const System& system, const SystemParts& parts, const Rest* rest) {
  std::vector<double> v = start_velocities(system, parts);
  if (rest == nullptr) return v;
  const std::size_t first = rest->v.size() - v.size();
  for (std::size_t i = 0; i < v.size(); ++i) v[i] += rest->v[first + i];
  return v;
}

}  // namespace

SystemStartState start_system(const System& system, const SystemParts& parts, const Model& model,
                              const Rest* rest) {
  const SystemModel& s = model.system;
  const std::vector<double> quaternion = start_quaternions(system, rest), u = start_places(s, rest);
  Standing at(model, quaternion, u, start_rates(system, parts, rest));
  check_joints(s, at.w, 1.);
  const std::int32_t joints = s.joint_rows, rows = system_rows(s), n = s.unknowns;
  const Mobility mobility(model);
  VectorXd is_free = Eigen::Map<const VectorXd>(s.per_length, n).unaryExpr([](double x) {
    return x != 0. ? 1. : 0.;
  });
  if (s.ports > 0) is_free.segment(s.port[0].first, Eigen::Index{9} * s.ports).setOnes();
  MatrixXd G = at.gradients(0, joints) * is_free.asDiagonal();
  const MatrixXd X = mobility * G.transpose();
  const MatrixXd W = G * X;
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> held;
  if (joints > 0) held.compute(W);

  VectorXd rates(joints);
  for (std::int32_t r = 0; r < joints; ++r) rates[r] = at.jet(r).v;
  if (joints > 0 && rates.cwiseAbs().maxCoeff() > 0.) {
    const VectorXd taken = X * held.solve(rates);
    for (std::int32_t i = 0; i < n; ++i) at.v[static_cast<std::size_t>(i)] -= taken[i];
    at.place();
    for (std::int32_t r = 0; r < joints; ++r)
      if (!(std::abs(at.jet(r).v) <= 1e-9 * (1. + rates.cwiseAbs().maxCoeff())))
        refuse("E-SYSTEM-65", "joint " + std::to_string(s.row[r].joint) +
                                  ": no velocities at the start fit it and the other joints; "
                                  "expected a drive that the other joints allow");
  }
  VectorXd spring_force = VectorXd::Zero(rows),
           fresh_force = spring_force;  // the part that no rest balances
  for (std::int32_t r = joints; r < rows; ++r) {
    const Jet phi = at.jet(r);
    spring_force[r] = s.row[r].stiffness * phi.x + s.row[r].damping * phi.v;
    fresh_force[r] = spring_force[r] - (rest != nullptr ? s.row[r].stiffness * phi.x : 0.);
  }
  VectorXd force = -vector(at.w.inertia, n);
  if (rest == nullptr) force = vector(at.w.outer, n) + force - vector(at.w.elastic, n);
  VectorXd row_part = VectorXd::Zero(n);
  add_row_forces(s, at.w.gradient, fresh_force.data(), row_part.data());
  force = (force - row_part).cwiseProduct(is_free);
  VectorXd wanted = VectorXd::Zero(joints);
  const VectorXd loose = mobility * force;
  for (std::int32_t r = 0; r < joints; ++r) wanted[r] = at.jet(r).a;
  const VectorXd multiplier = joints > 0 ? VectorXd(held.solve(wanted + G * loose)) : wanted;
  const VectorXd a = joints > 0 ? VectorXd(loose - X * multiplier) : loose;

  SystemStartState result;
  result.state.assign(static_cast<std::size_t>(state_doubles(model)), 0.);
  State state = state_on(model, result.state.data());
  for (std::int32_t i = 0; i < n; ++i) {
    state.u[s.first + i] = u[static_cast<std::size_t>(i)];
    state.v[s.first + i] = at.v[static_cast<std::size_t>(i)];
    state.a[s.first + i] = state.g[s.first + i] = a[i];
  }
  for (std::size_t k = 0; k < quaternion.size(); ++k) state.quaternion[k] = quaternion[k];
  for (std::int32_t r = 0; r < rows; ++r)
    state.row_force[r] = r >= joints ? spring_force[r]
                         : rest == nullptr
                             ? multiplier[r]
                             : rest->row_force[static_cast<std::size_t>(r)] + multiplier[r];
  for (std::int32_t r = 0; r < joints; ++r) result.mobility.push_back(W(r, r));
  return result;
}

}  // namespace railstep
