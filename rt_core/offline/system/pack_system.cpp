#include "offline/system/pack_system.h"

#include <Eigen/Dense>
#include <cmath>
#include <stdexcept>

#include "offline/system/parts.h"
#include "offline/system/start_system.h"

namespace railstep {

struct PackedSystem::Memory {
  SystemParts parts;
  std::vector<double> start;
};

PackedSystem::~PackedSystem() = default;

namespace {

void check(const System& system, const SystemOptions& o) {
  if (!system.gravity.allFinite()) throw std::invalid_argument("gravity is finite");
  if (o.steps_per_frame < 1) throw std::invalid_argument("a frame has one step or more");
  if (o.cap < 1 || o.projections < 0 || o.keep_steps < 1)
    throw std::invalid_argument("caps: 1 iteration or more, projections 0 or more, kept 1 or more");
  if (!(o.penalty > 0.) || !(o.tolerance > 0.) || !(o.joint_tolerance > 0.))
    throw std::invalid_argument("penalty and tolerances are above zero");
  if (!(o.alpha >= 0.) || !(o.beta >= 0.))
    throw std::invalid_argument("Baumgarte's alpha and beta are not negative");
  const bool by_mean = o.hold == Hold::augmented_lagrangian || o.hold == Hold::direct;
  if (o.energy_momentum && !by_mean)
    throw std::invalid_argument(
        "the energy-momentum scheme holds joints by the augmented Lagrangian or directly");
}

}  // namespace

PackedSystem::PackedSystem(const System& system, const SystemOptions& options)
    : memory_(std::make_unique<Memory>()) {
  check(system, options);
  SystemParts& parts = memory_->parts;
  add_parts(system, parts);
  add_connections(system, parts);
  model_.scheme = options.scheme;
  model_.steps_per_frame = options.steps_per_frame;
  model_.steps = options.steps;
  model_.unknowns = static_cast<std::int32_t>(parts.constant_force.size());
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
  s.unknowns = model_.unknowns;
  s.hold = options.hold;
  s.renew = options.renew;
  s.mean = options.energy_momentum ? 1 : 0;
  s.cap = options.cap;
  s.projections = options.projections;
  s.keep_steps = options.keep_steps;
  const bool own = options.alpha > 0. || options.beta > 0.;
  s.alpha = own ? options.alpha : .2 / options.scheme.dt;
  s.beta = own ? options.beta : .2 / options.scheme.dt;
  s.tolerance = options.tolerance;
  s.joint_tolerance = options.joint_tolerance;
  s.rank_tolerance = options.hold == Hold::augmented_lagrangian ? 1e-15 : 1e-10;
  s.body = parts.bodies.data();
  s.beam = parts.beams.data();
  s.marker = parts.markers.data();
  s.row = parts.rows.data();
  s.end = parts.ends.data();
  s.part_end = parts.part_end.data();
  s.motion = parts.motions.data();
  s.force = parts.forces.data();
  s.sensor = parts.sensors.data();
  s.constant_force = parts.constant_force.data();
  s.per_length = parts.per_length.data();
  const SystemStartState start = start_system(system, parts, model_);
  for (std::size_t r = 0; r < parts.joint_rows.size(); ++r)
    parts.rows[r].compliance = start.mobility[r] / (options.scheme.kg * options.penalty);
  memory_->start = start.state;
  model_.start = memory_->start.data();
}

Scheme energy_momentum(double dt) {
  Scheme s = held_force(dt, 1.);
  s.theta = 1.;
  return s;
}

}  // namespace railstep
