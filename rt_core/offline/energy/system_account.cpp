#include "offline/energy/system_account.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "offline/energy/single_steps.h"
#include "online/system/rotation.h"
#include "online/system/row.h"

namespace railstep {
namespace {

using Eigen::Vector3d;

/// Positions and velocities of the parts; views into the state and `matrix`.
Motions motions_of(const SystemModel& s, const State& state, std::vector<double>& matrix) {
  matrix.resize(9 * static_cast<std::size_t>(s.bodies));
  for (std::int32_t b = 0; b < s.bodies; ++b)
    rotation_matrix(state.quaternion + std::ptrdiff_t{4} * b,
                    matrix.data() + std::ptrdiff_t{9} * b);
  return {state.u + s.first, state.v + s.first, state.g + s.first, matrix.data()};
}

Vector3d point_of(const MarkerJet& jet) { return {jet.point[0].x, jet.point[1].x, jet.point[2].x}; }

/// Angular velocity of a body in ground axes, rad/s.
Vector3d angular_velocity(const SystemModel& s, std::int32_t b, const Motions& at) {
  const RigidBodyModel& body = s.body[b];
  Vector3d own = Vector3d::Zero();
  for (int k = 0; k < 3; ++k)
    if (body.column[3 + k] >= 0) own[k] = at.v[body.first + body.column[3 + k]];
  using Rows = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  return Eigen::Map<const Rows>(at.matrix + std::ptrdiff_t{9} * b) * own;
}

/// The same pose without motion.
MarkerJet held(MarkerJet jet) {
  for (int c = 0; c < 3; ++c) {
    jet.point[c] = {jet.point[c].x, 0., 0.};
    for (auto& axis : jet.axis) axis[c] = {axis[c].x, 0., 0.};
  }
  return jet;
}

}  // namespace

SystemAccount::Standing SystemAccount::stand(const State& state) const {
  const SystemModel& s = model_.system;
  const double time = static_cast<double>(state.steps) * model_.scheme.dt;
  std::vector<double> matrix;
  const Motions at = motions_of(s, state, matrix);
  Standing now;
  now.stored = system_energy(model_, state);
  for (std::int32_t f = 0; f < s.forces; ++f) {
    const PointForceModel& force = s.force[f];
    const MarkerModel& marker = s.marker[force.marker];
    const double size =
        force.input >= 0 ? state.input[force.input] : motion_at(s, force.motion, time).x;
    now.force.emplace_back(size *
                           Vector3d(force.direction[0], force.direction[1], force.direction[2]));
    now.point.push_back(force.moment != 0 ? angular_velocity(s, marker.part, at)
                                          : point_of(marker_jet(s, marker, at)));
  }
  for (std::int32_t r = 0; r < s.joint_rows + s.spring_rows; ++r) {
    const RowModel& row = s.row[r];
    const bool spring = r >= s.joint_rows, driven = !spring && row.motion >= 0;
    const MarkerJet a = marker_jet(s, s.marker[row.a], at), b = marker_jet(s, s.marker[row.b], at);
    if (spring) {
      now.length.push_back((point_of(b) - point_of(a)).norm());
      continue;
    }
    now.multiplier.push_back(driven ? state.row_force[r] : 0.);
    now.drive_rate.push_back(
        driven ? row_jet(row, held(a), held(b), motion_at(s, row.motion, time)).v : 0.);
  }
  return now;
}

SystemAccount::SystemAccount(const Model& model, const State& start)
    : model_(model), last_(stand(start)), start_(last_.stored.total()) {}

void SystemAccount::add_forces(const Standing& now) {
  for (std::size_t f = 0; f < now.force.size(); ++f) {
    const bool held = model_.system.mean != 0 && model_.system.force[f].input >= 0;
    const Vector3d mean = held ? now.force[f] : Vector3d(.5 * (last_.force[f] + now.force[f]));
    const Vector3d way = model_.system.force[f].moment != 0
                             ? Vector3d(.5 * model_.scheme.dt * (last_.point[f] + now.point[f]))
                             : Vector3d(now.point[f] - last_.point[f]);
    work_ += mean.dot(way);
  }
}

void SystemAccount::add_drives(const Standing& now) {
  const double half = .5 * model_.scheme.dt;
  for (std::size_t r = 0; r < now.multiplier.size(); ++r) {
    const double before = model_.system.mean != 0 ? now.multiplier[r] : last_.multiplier[r];
    work_ += half * (before * last_.drive_rate[r] + now.multiplier[r] * now.drive_rate[r]);
  }
}

void SystemAccount::add_dampers(const Standing& now) {
  const SystemModel& s = model_.system;
  for (std::size_t k = 0; k < now.length.size(); ++k) {
    const double stretched = now.length[k] - last_.length[k];
    dissipated_ += s.row[static_cast<std::size_t>(s.joint_rows) + k].damping * stretched *
                   stretched / model_.scheme.dt;
  }
}

void SystemAccount::follow(const State& state) {
  Standing now = stand(state);
  add_forces(now);
  add_drives(now);
  add_dampers(now);
  last_ = std::move(now);
}

namespace {

/// The accounts of a system and of its track together.
class JoinedAccount {
 public:
  JoinedAccount(const PackedSystem& packed, const Model& model, const State& start)
      : system_(model, start) {
    if (packed.track() != nullptr) track_.emplace(*packed.track(), model, start);
  }

  void follow(const State& now) {
    system_.follow(now);
    if (track_) track_->follow(now);
    note();
  }

  /// Largest imbalance so far, with its sign, over the largest energy turned over.
  double imbalance() const { return turned_over_ > 0. ? largest_ / turned_over_ : 0.; }

 private:
  void note() {
    const StoredEnergy line = track_ ? track_->stored() : StoredEnergy{};
    const EnergyFlow flow = track_ ? track_->flow() : EnergyFlow{};
    const SystemEnergy& e = system_.stored();
    turned_over_ =
        std::max({turned_over_, line.total() - line.forward + e.kinetic + e.strain + e.springs,
                  std::abs(e.potential), std::abs(system_.work()), std::abs(flow.loads),
                  std::abs(flow.weight), system_.dissipated() + flow.dissipated,
                  track_ ? track_->turned_over() : 0.});
    const double missing = system_.imbalance() + (track_ ? track_->imbalance() : 0.);
    if (std::abs(missing) > std::abs(largest_)) largest_ = missing;
  }

  SystemAccount system_;
  std::optional<EnergyAccount> track_;
  double turned_over_ = 0., largest_ = 0.;
};

}  // namespace

EnergyBalance balance_of(const PackedSystem& packed, std::int64_t frames,
                         const std::function<void(std::int64_t)>& after,
                         const FrameInputs& inputs) {
  SingleSteps run(packed.model());
  JoinedAccount account(packed, run.model(), run.state());
  run.make(frames, account, after, inputs);
  const double missing = account.imbalance();
  return {std::abs(missing), -missing, state_hash(run.model(), run.state())};
}

}  // namespace railstep
