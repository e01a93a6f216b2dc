#include "offline/system/pack_system.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "offline/cost/cost.h"
#include "offline/math/refuse.h"
#include "offline/start/start.h"
#include "offline/start/start_impact.h"
#include "offline/system/pack_parts.h"
#include "offline/system/pack_track_ports.h"
#include "offline/system/start_system.h"

namespace railstep {

struct PackedSystem::Memory {
  SystemParts parts;
  std::unique_ptr<PackedModel> track;
  TrackPorts ports;
  WidenedTrack widened;
  std::vector<std::int32_t> traced_joint, traced_spring;
  std::vector<double> start;
};

PackedSystem::~PackedSystem() = default;

namespace {

void check(const System& system, const SystemOptions& o, bool with_scheme) {
  if (!system.gravity.allFinite())
    refuse("E-SYSTEM-48", "gravity is not finite; expected three finite numbers");
  if (o.steps_per_frame < 1)
    refuse("E-PACK-18",
           "a frame has " + std::to_string(o.steps_per_frame) + " steps; expected 1 or more");
  if (o.cap < 1 || o.projections < 0 || o.keep_steps < 1)
    refuse("E-SYSTEM-50",
           "a cap of the solution of the joints is too low; expected at least 1 iteration, 0 "
           "projections and 1 step that keeps its matrix");
  if (!(o.penalty >= 0.) || !(o.tolerance > 0.) || !(o.joint_tolerance > 0.))
    refuse("E-SYSTEM-51",
           "a tolerance is not above 0, or the penalty is negative; expected tolerances above 0 "
           "and a penalty of at least 0");
  if (!(o.alpha >= 0.) || !(o.beta >= 0.))
    refuse("E-SYSTEM-52",
           "Baumgarte's alpha or beta is negative; expected both to be at least 0 1/s");
  const Scheme& c = o.scheme;
  if (with_scheme && c.stage_fraction > 0.)
    refuse("E-SYSTEM-53",
           "the scheme has two stages, but bodies and beams need a scheme of one stage; expected "
           "another step.scheme than \"tr-bdf2\"");
  const bool means = std::abs(c.kg * c.dt * c.dt - 2.) < 1e-9 &&
                     std::abs(c.kv * c.dt - 2.) < 1e-9;  // energy_momentum(dt)
  if (with_scheme && means != o.energy_momentum)
    refuse("E-SYSTEM-54",
           "the scheme and the option energy_momentum do not match; expected the scheme "
           "energy_momentum() with this option, and no other scheme with it");
  const bool by_mean = o.constraint_method == ConstraintMethod::augmented_lagrangian ||
                       o.constraint_method == ConstraintMethod::direct;
  if (o.energy_momentum && !by_mean)
    refuse("E-SYSTEM-55",
           "the energy-momentum scheme does not hold joints by this method; expected joints.hold = "
           "\"augmented-lagrangian\" or \"direct\"");
}

/// Index 3 has -rho_inf as a double root: with a scheme that does not damp, joint forces swing from
/// step to step and grow (Cardona and Geradin 1989). Projections prevent this, and so do rows of
/// velocities.
void check_damping(const System& system, const SystemOptions& o, const Scheme& c) {
  const bool index_3 =
      o.constraint_method == ConstraintMethod::direct ||
      (o.constraint_method == ConstraintMethod::augmented_lagrangian && o.projections == 0);
  if (!index_3 || o.energy_momentum || system.joints.empty()) return;
  // generalised_alpha: a0 / ag = alpha_f / (1 - alpha_f) = rho_inf
  if (c.a0 >= (1. - 1e-9) * c.ag || radius_at_infinity(c) >= 1. - 1e-7)
    refuse("E-SYSTEM-56",
           "nothing damps the joint forces, which swing from step to step and grow: joints.hold is "
           "\"direct\", or \"augmented-lagrangian\" without projections, and the scheme has "
           "rho_inf = 1, newmark_gamma = 0.5 or hht_alpha = 0; expected rho_inf below 1, or "
           "another joints.hold");
}

/// Options of the search for the equilibrium: long steps of backward Euler, joints held without
/// penalty, tolerances near round-off.
SystemOptions still_options(SystemOptions options, double dt) {
  options.scheme = backward_euler(dt);
  options.energy_momentum = options.at_rest = false;
  options.steps_per_frame = 1;
  options.constraint_method = ConstraintMethod::direct;
  options.renew = Renew::every_iteration;
  options.cap = 40;
  options.tolerance = 1e-12;
  options.joint_tolerance = 1e-11;
  return options;
}

/// Loads at their places `shift` seconds later, with their force at the start, and no wheels.
Traffic standing_loads(const Traffic& traffic, double shift) {
  Traffic standing;
  standing.held = traffic.held;
  standing.loads = traffic.loads;
  standing.head = traffic.head;
  standing.right_head = traffic.right_head;
  for (MovingLoad& load : standing.loads) {
    load.start += first_speed(load) * shift;
    load.frequency = 0.;
  }
  return standing;
}

/// Whether wheels run on a track.
bool has_wheels(const Model& track) { return track_row_count(track) > 0 || track.runners > 0; }

/// Checks indices of traced items against their number.
std::vector<std::int32_t> indices(const std::vector<int>& traced, std::size_t count) {
  for (const int index : traced)
    if (index < 0 || static_cast<std::size_t>(index) >= count)
      refuse("E-SYSTEM-57", "joint or spring " + std::to_string(index) +
                                " is traced, but does not exist; expected one of " +
                                std::to_string(count) + ", counted from 0");
  return {traced.begin(), traced.end()};
}

/// The start of a track beside a system in a rest. Lines in full order are as they are there.
std::vector<double> start_beside(const Track& track, const PackedModel& packed, double gravity,
                                 const Acting& ports, const Rest& rest) {
  const Model& model = packed.model();
  const bool banded = model.form == Form::banded, wheels = has_wheels(model);
  std::vector<double> memory(static_cast<std::size_t>(state_doubles(model)), 0.);
  std::vector<double> rate;
  for (const double own : rest.port_rate) rate.push_back(-own);  // the ports press with -force
  if (wheels || !banded) memory = start_in_equilibrium(track, packed, gravity, ports, rate);
  if (!banded) return memory;
  const State state = state_on(model, memory.data());
  if (!wheels) std::copy_n(rest.u.begin(), model.line_unknowns, state.u);
  std::copy_n(rest.v.begin(), model.line_unknowns, state.v);
  return memory;
}

}  // namespace

const PackedModel* PackedSystem::track() const { return memory_->track.get(); }

PackedSystem::PackedSystem(const System& system, const SystemOptions& options)
    : memory_(std::make_unique<Memory>()) {
  model_.scheme = options.scheme;
  model_.steps_per_frame = options.steps_per_frame;
  // A model always has a run: one frame if no length is given.
  model_.steps = options.steps > 0 ? options.steps : options.steps_per_frame;
  std::optional<Rest> rest;
  if (options.at_rest)
    rest = find_rest(
        [&](double dt, double) {
          return std::make_unique<PackedSystem>(system, still_options(options, dt));
        },
        {}, 0.);
  build(system, options, nullptr, rest);
}

PackedSystem::PackedSystem(const System& system, const SystemOptions& options, const Track& track,
                           const Traffic& traffic, const PackOptions& track_options)
    : memory_(std::make_unique<Memory>()) {
  if (options.constraint_method == ConstraintMethod::gear_gupta_leimkuhler)
    refuse("E-SYSTEM-60",
           "joints.hold is \"gear-gupta-leimkuhler\" beside a track; expected another joints.hold");
  if (options.energy_momentum != track_options.reduction.has_value())
    refuse("E-SYSTEM-61",
           "bodies take forces at the mean of a step beside condensed tracks alone, which hold "
           "forces over a step; expected the option energy_momentum beside these, and not beside "
           "tracks in full order");
  Traffic both = traffic;
  for (int rail = 0; rail < track.rails; ++rail) both.held.push_back(rail);
  memory_->track = std::make_unique<PackedModel>(track, both, track_options);
  std::optional<Rest> rest;
  if (options.at_rest)
    rest = rest_on_track(system, options, track, both, track_options);
  else if (has_wheels(memory_->track->model()))
    memory_->track->set_start(start_under_impact(track, *memory_->track, track_options.gravity));
  model_ = memory_->track->model();
  build(system, options, &track, rest);
}

/// The forces of the wheels and those of the system depend on each other by the rails alone, and
/// change little with these, so that they settle when found in turn.
Rest PackedSystem::rest_on_track(const System& system, const SystemOptions& options,
                                 const Track& track, const Traffic& traffic,
                                 const PackOptions& track_options) {
  constexpr int kMostPasses = 30;
  constexpr double kSettled = 1e-10;  // of the largest force
  PackedModel& packed = *memory_->track;
  const bool wheels = has_wheels(packed.model());
  const bool condensed = track_options.reduction.has_value();
  const double gravity = track_options.gravity;
  Acting beside;
  std::vector<double> before;
  std::vector<Eigen::VectorXd> pressing;  // forces of the wheels, at a shift in time
  double pressing_at = 0.;
  for (int pass = 0; pass < kMostPasses; ++pass) {
    pressing.clear();
    Rest rest = find_rest(
        [&](double dt, double shift) {
          PackOptions still = track_options;
          still.scheme = backward_euler(dt);
          still.steps_per_frame = 1;
          still.reduction.reset();
          if (condensed) still.gravity = 0.;  // all forces are among those of the lines
          if ((wheels || condensed) && (pressing.empty() || shift != pressing_at))
            pressing = standing_line_forces(track, packed, gravity, beside, pressing_at = shift);
          still.line_forces = pressing;
          Traffic standing = standing_loads(traffic, shift);
          if (condensed) standing.loads.clear();
          return std::make_unique<PackedSystem>(system, still_options(options, dt), track, standing,
                                                still);
        },
        starting_places(packed.model()), track.length());
    beside.contacts = forces_of_ports(packed.model(), rest.port, rest.port_force);
    double most = 0., change = 0.;
    for (std::size_t i = 0; i < rest.port_force.size(); ++i) {
      most = std::max(most, std::abs(rest.port_force[i]));
      if (!before.empty()) change = std::max(change, std::abs(rest.port_force[i] - before[i]));
    }
    const bool settled = !before.empty() && change <= kSettled * most;
    if (wheels && !rest.port_force.empty() && !settled) {
      before = rest.port_force;
      continue;
    }
    packed.set_start(start_beside(track, packed, gravity, beside, rest));
    return rest;
  }
  refuse("E-SYSTEM-66",
         "no static equilibrium of bodies and wheels on the same rails was found at the start; "
         "expected step.start = \"released\", or joints and springs that hold the bodies");
}

void PackedSystem::build(const System& system, const SystemOptions& options, const Track* track,
                         const std::optional<Rest>& rest) {
  check(system, options, track == nullptr);
  check_damping(system, options, model_.scheme);
  SystemParts& parts = memory_->parts;
  add_parts(system, parts);
  add_connections(system, track, parts);
  const std::int32_t first = model_.unknowns;
  const auto own = static_cast<std::int32_t>(parts.constant_force.size());
  if (track != nullptr) memory_->widened.widen(own, model_);
  model_.unknowns = first + own;
  for (PointForceModel& force : parts.forces)
    if (force.input >= 0) force.input += model_.inputs;  // those of the track come first
  take_inputs(system.input_limits, model_);
  SystemModel& s = model_.system;
  const auto count = [](const auto& items) { return static_cast<std::int32_t>(items.size()); };
  s.bodies = count(parts.bodies);
  s.beams = count(parts.beams);
  s.markers = count(parts.markers);
  s.joint_rows = count(parts.joint_rows);
  s.spring_rows = count(parts.spring_rows);
  s.motions = count(parts.motions);
  s.forces = count(parts.forces);
  s.sensors = count(parts.sensors);
  s.ends = count(parts.ends);
  s.held = count(parts.held);
  s.pieces = count(parts.piece_start);
  memory_->traced_joint = indices(options.traced.joints, system.joints.size());
  memory_->traced_spring = indices(options.traced.springs, system.springs.size());
  s.traced_joints = count(memory_->traced_joint);
  s.traced_springs = count(memory_->traced_spring);
  s.first = first;
  s.unknowns = own;
  s.constraint_method = options.constraint_method;
  s.renew = options.renew;
  s.mean = options.energy_momentum ? 1 : 0;
  s.cap = options.cap;
  s.projections = options.projections;
  s.keep_steps = options.keep_steps;
  const bool given = options.alpha > 0. || options.beta > 0.;
  s.alpha = given ? options.alpha : .2 / model_.scheme.dt;
  s.beta = given ? options.beta : .2 / model_.scheme.dt;
  s.tolerance = options.tolerance;
  s.joint_tolerance = options.joint_tolerance;
  s.rank_tolerance = 1e-10;
  s.body = parts.bodies.data();
  s.beam = parts.beams.data();
  s.marker = parts.markers.data();
  s.row = parts.rows.data();
  s.end = parts.ends.data();
  s.part_end = parts.part_end.data();
  s.motion = parts.motions.data();
  s.force = parts.forces.data();
  s.piece_start = parts.piece_start.data();
  s.piece = parts.piece.data();
  s.beam_rest = parts.beam_rest.data();
  s.held_unknown = parts.held.data();
  s.sensor = parts.sensors.data();
  s.sensor_rest = parts.sensor_rest.data();
  s.traced_joint = memory_->traced_joint.data();
  s.traced_spring = memory_->traced_spring.data();
  s.constant_force = parts.constant_force.data();
  s.per_length = parts.per_length.data();
  s.ports = count(parts.ports);
  s.port = parts.ports.data();
  memory_->ports = track_ports(model_, memory_->track.get());
  s.port_compliance = memory_->ports.compliance.data();
  s.port_shapes = memory_->ports.shapes.data();
  const SystemStartState start = start_system(system, parts, model_, rest ? &*rest : nullptr);
  const double penalty = options.penalty > 0. ? options.penalty : 1e9;
  for (std::size_t r = 0; r < parts.joint_rows.size(); ++r)
    parts.rows[r].compliance = start.mobility[r] / (model_.scheme.kg * penalty);
  memory_->start = start.state;
  if (track != nullptr) memory_->widened.put_start(memory_->track->model(), model_, memory_->start);
  model_.start = memory_->start.data();
  model_.cost = cost_of(model_);
}

Scheme energy_momentum(double dt) {
  Scheme s = held_force(dt, 1.);
  s.theta = 1.;
  return s;
}

}  // namespace railstep
