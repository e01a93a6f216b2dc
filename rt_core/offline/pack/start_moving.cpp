#include <cmath>
#include <complex>
#include <limits>
#include <stdexcept>

#include "offline/pack/start.h"
#include "offline/pack/start_flange.h"
#include "online/model/course.h"
#include "online/step/step.h"
#include "online/step/table.h"

namespace railstep {

namespace {

constexpr std::int64_t kMostSteps = std::int64_t{1} << 20;  // of a passage, and of all
constexpr double kSettled = 1e-9;  // of the largest displacement, from passage to passage

/// A wheel as the force with which it stands.
LoadModel load_of(const Model& model, const WheelsetModel& w, int side) {
  LoadModel load{};
  load.row[2] = 1.;
  load.row[8] = model.head_z[side];
  load.rail = side;
  load.start = w.start;
  load.travel = w.travel;
  load.stop = std::numeric_limits<double>::infinity();
  load.force = -wheel_load(w);
  load.kind = w.kind[side];
  return load;
}

/// The model with forces that stay as they are at the start, on an even track.
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
  for (std::int32_t b = 0; b < even.wheelsets; ++b) {
    WheelsetModel& w = even.wheelset[b];
    w.weight = 2. * wheel_load(w);
    w.forces = 0;
    w.tread[0] = w.tread[1] = {};
  }
  return even;
}

/// The same with forces in place of wheels, behind its loads.
Model with_forces(const Model& even) {
  Model carried = even;
  if (carried.loads + 2 * carried.wheelsets > kMaxLoads)
    throw std::invalid_argument("a start on the move takes 32 loads and wheels at most");
  for (std::int32_t b = 0; b < even.wheelsets; ++b)
    for (const int side : {0, 1})
      carried.load[carried.loads++] = load_of(even, even.wheelset[b], side);
  carried.wheelsets = carried.flanges = 0;
  return carried;
}

/// The model with its state, on the way of its forces.
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
  /// Displacements under all forces as the state stands, m.
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

/// z0 of z0 = k^n z0 + r after `bays` bays, k^n turned by them; r stands in the passage's state.
void close_wave(const LineModel& line, const Course& course, const State& r, State& z) {
  const BayShift& shift = line.shift;
  for (std::int32_t k = 0; k < line.size; ++k) {
    const std::int32_t i = line.first + k, j = line.first + shift.from[k];
    const std::complex<double> turn =
        std::pow(std::complex<double>(shift.own[k], shift.other[k]), course.bays);
    const std::complex<double> keep =
        std::pow(std::complex<double>(line.modal.keep.re[k], line.modal.keep.im[k]), course.period);
    const std::complex<double> c = keep * turn.real(), s = keep * turn.imag();
    const std::complex<double> own(r.u[i], r.v[i]), other(r.u[j], r.v[j]);
    const std::complex<double> found = ((1. - c) * own + s * other) / ((1. - c) * (1. - c) + s * s);
    z.u[i] = found.real();
    z.v[i] = found.imag();
  }
}

void settle_ring(const Model& carried, std::vector<double>& memory) {
  std::vector<double> rest = memory;
  State state = state_on(carried, memory.data()), still = state_on(carried, rest.data());
  for (std::int32_t i = 0; i < carried.bodies; ++i) still.u[i] = still.v[i] = 0.;
  forces(carried, 0, still.a, still.g);
  Passage passage(carried, rest);
  passage.go(carried.endless.course.period);
  for (std::int32_t l = 0; l < carried.lines; ++l)
    close_wave(carried.line[l], carried.endless.course, passage.state(), state);
  for (std::int32_t i = 0; i < carried.bodies; ++i) {
    state.a[i] = still.a[i];
    state.g[i] = still.g[i];
  }
}

/// Largest change of the model's displacements in a passage, and the largest of the lines, m. A
/// wheelset's way along x is its guide's.
std::pair<double, double> change_of(const Model& model, const std::vector<double>& before,
                                    const std::vector<double>& after) {
  double change = 0., size = 0.;
  const auto take = [&](std::int32_t i) {
    const auto at = static_cast<std::size_t>(i);
    change = std::max(change, std::abs(after[at] - before[at]));
  };
  for (std::int32_t i = 0; i < model.bodies; ++i) {
    take(i);
    size = std::max(size, std::abs(before[static_cast<std::size_t>(i)]));
  }
  for (std::int32_t b = 0; b < model.wheelsets; ++b)
    for (int k = 1; k < 6; ++k) take(model.wheelset[b].first + k);
  return {change, size};
}

/// Passes bays until every passage is as the one before.
void settle(const Model& even, std::vector<double>& memory) {
  const std::int64_t period = even.endless.course.period;
  Passage passage(even, memory);
  for (std::int64_t steps = period; steps <= kMostSteps; steps += period) {
    const std::vector<double> before = passage.memory();
    passage.go(period);
    const auto [change, size] = change_of(even, before, passage.memory());
    if (!(change <= kSettled * size)) continue;
    memory = passage.memory();
    return;
  }
  throw std::invalid_argument(
      "the track does not settle into a moving steady state; accepted is step.start = "
      "\"equilibrium\"");
}

/// Wheelsets on the track as it moves; rates by differences over the first steps.
void stand_up(const Model& model, const Model& carried, std::vector<double>& memory) {
  Passage passage(carried, memory);
  std::vector<double> at[3] = {passage.heights(), {}, {}};
  for (std::vector<double>* later : {at + 1, at + 2}) {
    passage.go(1);
    *later = passage.heights();
  }
  State state = state_on(model, memory.data());
  for (std::int32_t b = 0; b < model.wheelsets; ++b) {
    const WheelsetModel& w = model.wheelset[b];
    std::array<double, 6> pose[3];
    for (int n = 0; n < 3; ++n) {
      const double* height = at[n].data() + model.loads + 2 * b;
      pose[n] = standing_wheelset(model, w, {height[0], height[1]});
    }
    for (std::size_t k = 0; k < 6; ++k) {
      const std::int32_t i = w.first + static_cast<int>(k);
      state.u[i] = pose[0][k];
      state.v[i] = (k == 0 ? w.travel.speed : 0.) +
                   (4. * pose[1][k] - 3. * pose[0][k] - pose[2][k]) / (2. * model.scheme.dt);
    }
    for (int side = 0; side < 2; ++side) state.wheel_force[2 * b + side] = wheel_load(w);
  }
}

}  // namespace

std::vector<double> start_moving(const Track& track, const PackedModel& packed, double gravity) {
  const Model& model = packed.model();
  if (model.endless.bays == 0)
    throw std::invalid_argument("a start on the move wants a track without end");
  if (model.endless.course.period > kMostSteps)
    throw std::invalid_argument(
        "no number of steps is a whole number of bays; accepted is a speed at which one is, or "
        "step.start = \"equilibrium\"");
  for (std::int32_t b = 0; b < model.wheelsets; ++b)
    if (side_force(model.wheelset[b]) != 0.)
      throw std::invalid_argument(
          "a start on the move takes no lateral force on a wheelset at the start");
  const Model even = evened(model);
  if (model.condensed == 0) {
    std::vector<double> memory = start_in_equilibrium(track, packed, gravity);
    settle(even, memory);
    return memory;
  }
  const Model carried = with_forces(even);
  std::vector<double> memory = start_released(packed);
  settle_ring(carried, memory);
  if (model.wheelsets == 0) return memory;
  stand_up(even, carried, memory);
  // Wheels press anew in every step; only loads were there before it.
  State state = state_on(model, memory.data());
  forces(model, 0, state.a, state.g);
  settle(even, memory);
  return memory;
}

}  // namespace railstep
