#include <array>
#include <cmath>
#include <complex>
#include <iomanip>
#include <limits>
#include <sstream>
#include <string>

#include "offline/math/larger.h"
#include "offline/math/refuse.h"
#include "offline/pack/pack_progress.h"
#include "offline/start/start.h"
#include "offline/start/start_vehicle.h"
#include "offline/start/start_wheelset.h"
#include "online/math/table.h"
#include "online/model/progress.h"
#include "online/step/step.h"

namespace railstep {

namespace {

constexpr std::int64_t kMostSteps = std::int64_t{1} << 20;  // of one passage, and of all together
constexpr double kSettled = 1e-9;  // of the largest displacement, from passage to passage

/// Force of each wheel when the model stands on level, rigid rails, N.
std::vector<double> static_forces(const Model& model) {
  std::vector<double> force;
  for (std::int32_t b = 0; b < model.wheelsets; ++b)
    force.insert(force.end(), 2, wheel_load(model.wheelset[b]));
  if (model.vehicles == 0) return force;
  const Eigen::Index wheels = model.vehicle_wheels;
  const SettledVehicles rest =
      settle_vehicles(model, Eigen::MatrixXd::Zero(wheels, wheels), Eigen::VectorXd::Zero(wheels));
  force.insert(force.end(), rest.force.begin(), rest.force.end());
  return force;
}

/// A wheel as a force.
LoadModel load_of(const Model& model, ContactId wheel, double force) {
  const ContactModel& own = model.contact[wheel];
  const std::int32_t rail = own.rail;
  LoadModel load{};
  const CrownTop top = crown_top(model.cant[rail], model.head_z[rail], model.crown_radius[rail]);
  height_row(model.cant[rail], top.y, top.z, load.row);
  load.rail = rail;
  load.stop = std::numeric_limits<double>::infinity();
  load.force = -force;
  load.load_point = own.load_point;
  load.start = place_of(model, wheel);
  load.travel = bodies_of(model, wheel).travel;
  return load;
}

/// Leaves a wheelset's vertical forces of tables, as they are at t = 0.
void keep_vertical_forces(WheelsetModel& w) {
  std::int32_t kept = 0;
  for (std::int32_t i = 0; i < w.forces; ++i) {
    if (w.force[i].direction != index_of(BodyMotion::z) || w.force[i].input >= 0) continue;
    w.force[kept] = w.force[i];
    w.force[kept++].points = 1;  // before its second row a table has the value of its first one
  }
  w.forces = kept;
}

/// The model on an even track, with forces that keep their values at the start.
Model evened(const Model& model) {
  Model even = model;
  even.steps_per_frame = 1;
  even.signals = 0;
  for (std::int32_t i = 0; i < even.loads; ++i) {
    LoadModel& load = even.load[i];
    if (load.table_points > 0) load.force *= table_value(load.table, load.table_points, 0.);
    load.table_points = 0;
    load.stop = std::numeric_limits<double>::infinity();
  }
  for (std::int32_t b = 0; b < even.wheelsets; ++b) keep_vertical_forces(even.wheelset[b]);
  for (const ContactId i : contacts(even)) even.contact[i].tread = {};
  return even;
}

/// The same with forces in place of wheels; they follow the loads.
Model with_forces(const Model& even) {
  Model carried = even;
  if (carried.loads + wheel_count(even) > kMaxLoads)
    refuse("E-START-03", "a moving start takes " + std::to_string(kMaxLoads) +
                             " loads and wheels, and there are " +
                             std::to_string(carried.loads + wheel_count(even)) +
                             "; expected fewer, or step.start = \"equilibrium\"");
  int wheel = 0;
  for (const double force : static_forces(even))
    carried.load[carried.loads++] = load_of(even, {wheel++}, force);
  carried.wheelsets = carried.flanges = carried.vehicles = carried.vehicle_wheels = 0;
  return carried;
}

/// The model and its state while its forces pass bays.
class Passage {
 public:
  Passage(const Model& model, const std::vector<double>& start)
      : model_(model),
        memory_(start),
        scratch_(static_cast<std::size_t>(workspace_doubles(model))),
        state_(state_on(model_, memory_.data())),
        workspace_(workspace_on(model_, scratch_.data())) {}

  const State& state() const { return state_; }
  const std::vector<double>& memory() const { return memory_; }
  void go(std::int64_t steps) {
    for (std::int64_t n = 0; n < steps; ++n)
      static_cast<void>(advance_frame(model_, state_, workspace_, outputs_));
  }
  /// A lost state does not change any more, and so looks settled.
  bool is_lost() const { return has(state_.latched, Status::nonfinite_state); }
  /// Displacements under all forces in the present state, m.
  std::vector<double> heights() {
    publish_start(model_, state_, outputs_);
    return {outputs_.load_deflection, outputs_.load_deflection + model_.loads};
  }

 private:
  const Model& model_;
  std::vector<double> memory_, scratch_;
  State state_;
  Workspace workspace_;
  Outputs outputs_{};
};

/// Solves z0 = k^n z0 + r after `bays` bays, k^n turned by these bays. r is in the passage's state.
void close_wave(const LineModel& line, const BayProgress& progress, const State& r, State& z) {
  const BayShift& shift = line.shift;
  for (std::int32_t k = 0; k < line.size; ++k) {
    const std::int32_t i = line.first + k, j = line.first + shift.from[k];
    const std::complex<double> wave_shift =
        std::pow(std::complex<double>(shift.own[k], shift.other[k]), progress.bays);
    const std::complex<double> keep = std::pow(
        std::complex<double>(line.modal.keep.re[k], line.modal.keep.im[k]), progress.period);
    const std::complex<double> c = keep * wave_shift.real(), s = keep * wave_shift.imag();
    const std::complex<double> own(r.u[i], r.v[i]), other(r.u[j], r.v[j]);
    const std::complex<double> found = ((1. - c) * own + s * other) / ((1. - c) * (1. - c) + s * s);
    z.u[i] = found.real();
    z.v[i] = found.imag();
  }
}

void settle_ring(const Model& carried, std::vector<double>& memory) {
  std::vector<double> rest = memory;
  State state = state_on(carried, memory.data()), still = state_on(carried, rest.data());
  for (std::int32_t i = 0; i < carried.line_unknowns; ++i) still.u[i] = still.v[i] = 0.;
  forces(carried, 0, still.a, still.g);
  Passage passage(carried, rest);
  passage.go(carried.endless.progress.period);
  for (std::int32_t l = 0; l < carried.lines; ++l)
    close_wave(carried.line[l], carried.endless.progress, passage.state(), state);
  for (std::int32_t i = 0; i < carried.line_unknowns; ++i) {
    state.a[i] = still.a[i];
    state.g[i] = still.g[i];
  }
}

/// Largest change of the model's displacements in a passage, and the largest displacement of the
/// lines, m. A wheelset's motion along x is that of its guide and left out. Pitch counts in rad,
/// which is similar over the few metres of a vehicle.
std::pair<double, double> change_of(const Model& model, const std::vector<double>& before,
                                    const std::vector<double>& after) {
  double change = 0., size = 0.;
  const auto take = [&](std::int32_t i) {
    const auto at = static_cast<std::size_t>(i);
    change = larger(change, std::abs(after[at] - before[at]));
  };
  for (std::int32_t i = 0; i < model.line_unknowns; ++i) {
    take(i);
    size = std::max(size, std::abs(before[static_cast<std::size_t>(i)]));
  }
  for (std::int32_t b = 0; b < model.wheelsets; ++b)
    for (int k = 1; k < 6; ++k) take(model.wheelset[b].first + k);
  for (std::int32_t b = 0; b < model.vehicles; ++b)
    for (std::int32_t k = 0; k < model.vehicle[b].size; ++k) take(model.vehicle[b].first + k);
  return {change, size};
}

/// Passes bays until every passage equals the one before.
void settle(const Model& even, std::vector<double>& memory) {
  const std::int64_t period = even.endless.progress.period;
  Passage passage(even, memory);
  for (std::int64_t steps = period; steps <= kMostSteps; steps += period) {
    const std::vector<double> before = passage.memory();
    passage.go(period);
    if (passage.is_lost()) break;
    const auto [change, size] = change_of(even, before, passage.memory());
    if (!(change <= kSettled * size)) continue;
    memory = passage.memory();
    return;
  }
  refuse("E-START-04",
         "the track does not settle into a moving steady state; expected step.start = "
         "\"equilibrium\"");
}

/// Coordinates of wheelsets and vehicles on rails whose heads are `height` above rest under each
/// wheel, and the forces of the wheels.
struct Stand {
  std::vector<std::array<double, 6>> wheelsets;
  SettledVehicles vehicles;
};
Stand stand_on(const Model& model, const double* height) {
  Stand found;
  for (std::int32_t b = 0; b < model.wheelsets; ++b)
    found.wheelsets.push_back(
        standing_wheelset(model, b, {height[tread_of(b, 0)], height[tread_of(b, 1)]}));
  const Eigen::Index wheels = model.vehicle_wheels;
  if (wheels > 0)
    found.vehicles =
        settle_vehicles(model, Eigen::MatrixXd::Zero(wheels, wheels),
                        Eigen::Map<const Eigen::VectorXd>(height + tread_count(model), wheels));
  return found;
}

/// Puts wheelsets and vehicles on the moving track; rates are differences over the first steps.
void stand_up(const Model& model, const Model& carried, std::vector<double>& memory) {
  Passage passage(carried, memory);
  Stand at[3];
  for (int n = 0; n < 3; ++n) {
    if (n > 0) passage.go(1);
    at[n] = stand_on(model, passage.heights().data() + model.loads);
  }
  State state = state_on(model, memory.data());
  const auto put = [&](std::int32_t i, double x0, double x1, double x2) {
    state.u[i] = x0;
    state.v[i] = (4. * x1 - 3. * x0 - x2) / (2. * model.scheme.dt);
  };
  for (std::int32_t b = 0; b < model.wheelsets; ++b) {
    const WheelsetModel& w = model.wheelset[b];
    const auto own = static_cast<std::size_t>(b);
    for (std::size_t k = 0; k < 6; ++k)
      put(w.first + static_cast<int>(k), at[0].wheelsets[own][k], at[1].wheelsets[own][k],
          at[2].wheelsets[own][k]);
    state.v[w.first] += w.travel.speed;
    for (int side = 0; side < 2; ++side) state.contact_force[tread_of(b, side)] = wheel_load(w);
  }
  for (std::int32_t b = 0; b < model.vehicles; ++b) {
    const auto own = static_cast<std::size_t>(b);
    for (std::int32_t k = 0; k < model.vehicle[b].size; ++k)
      put(model.vehicle[b].first + k, at[0].vehicles.displacement[own][k],
          at[1].vehicles.displacement[own][k], at[2].vehicles.displacement[own][k]);
  }
  for (std::int32_t i = 0; i < model.vehicle_wheels; ++i)
    state.contact_force[vehicle_contact(model, i)] = at[0].vehicles.force[i];
}

/// Names speeds that are possible, with all digits that they need.
std::string no_whole_bays(const Model& model) {
  const Endless& e = model.endless;
  std::ostringstream text;
  text << std::setprecision(17)
       << "no number of steps is a whole number of bays at this speed; expected ";
  const double here = std::ldexp(static_cast<double>(e.progress.advance), -62);
  for (const WholeBays& near : whole_bays_near(here, kMostSteps / 16))
    text << "a speed of "
         << static_cast<double>(near.bays) / static_cast<double>(near.steps) * e.bay_length /
                model.scheme.dt
         << " m/s (" << near.bays << " bays in " << near.steps << " steps), ";
  text << "another with whole bays, or step.start = \"equilibrium\"";
  return text.str();
}

}  // namespace

std::vector<double> start_moving(const Track& track, const PackedModel& packed, double gravity) {
  const Model& model = packed.model();
  if (model.endless.bays == 0)
    refuse("E-START-05",
           "the start is \"moving\", but the track has ends; expected a track without end");
  if (track.rigid) return start_in_equilibrium(track, packed, gravity);  // no wave goes with it
  if (model.endless.progress.period > kMostSteps) refuse("E-START-06", no_whole_bays(model));
  for (std::int32_t b = 0; b < model.wheelsets; ++b)
    if (side_force(model.wheelset[b]) != 0.)
      refuse("E-START-07",
             "a lateral force acts on a wheelset at a moving start; expected a lateral force of 0 "
             "N at t = 0, or step.start = \"equilibrium\"");
  if (model.endless.progress.bays == 0) return start_in_equilibrium(track, packed, gravity);
  const Model even = evened(model);
  if (model.form == Form::banded) {
    std::vector<double> memory = start_in_equilibrium(track, packed, gravity);
    settle(even, memory);
    return memory;
  }
  const Model carried = with_forces(even);
  std::vector<double> memory = start_released(packed);
  settle_ring(carried, memory);
  if (wheel_count(model) == 0) return memory;
  stand_up(even, carried, memory);
  // Wheels get new forces in each step; before it, only loads acted.
  State state = state_on(model, memory.data());
  forces(model, 0, state.a, state.g);
  settle(even, memory);
  return memory;
}

}  // namespace railstep
