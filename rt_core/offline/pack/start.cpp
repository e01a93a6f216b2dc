#include "offline/pack/start.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "offline/track/statics.h"
#include "online/step/load.h"
#include "online/step/table.h"

namespace railstep {

namespace {

/// Vertical force at t = 0 on a wheel of a wheelset on its rails, N: no force acts on roll, so both
/// carry half.
double wheel_load(const WheelsetModel& w) {
  double vertical = w.weight;
  for (std::int32_t i = 0; i < w.forces; ++i) {
    const double force = table_value(w.force[i].table, w.force[i].points, 0.);
    if (w.force[i].direction == 2) vertical -= force;
    if (w.force[i].direction == 1 && force != 0.)
      throw std::invalid_argument(
          "no equilibrium: a lateral force acts on a wheelset at the start and nothing holds it");
  }
  if (!(vertical > 0.))
    throw std::invalid_argument("no equilibrium in contact: nothing presses a wheelset down");
  return vertical / 2.;
}

double residual_at(const Model& model, const double* table, double x) {
  if (table == nullptr) return 0.;
  const double scaled = x / model.element_length;
  const auto element = std::min(static_cast<std::int32_t>(scaled), model.elements - 1);
  return interpolate(table + static_cast<std::ptrdiff_t>(element) * (model.residual_points + 1),
                     model.residual_points, 2. * (scaled - element) - 1.);
}

/// Displacements of all unknowns in equilibrium, with everything that moves shifted by `time`.
std::vector<double> equilibrium(const Statics& statics, const Model& model, double gravity,
                                double time) {
  std::vector<PointForce> forces;
  for (std::int32_t i = 0; i < model.loads; ++i) {
    const LoadModel& load = model.load[i];
    const PlacedLoad at = place(model, load, 0);
    const double x = at.x + load.speed * time;
    if (at.on_rail && x >= 0. && x <= statics.track().length())
      forces.push_back({{load.rail, x, 0., load.row[8], 2}, at.force});
  }
  const auto wheel = [&](const WheelsetModel& w, int rail) {
    return RailPoint{rail, w.start + w.speed * time, 0., model.head_z, 2};
  };
  for (std::int32_t b = 0; b < model.wheelsets; ++b)
    for (const int rail : {0, 1})
      forces.push_back({wheel(model.wheelset[b], rail), -wheel_load(model.wheelset[b])});
  const std::vector<Eigen::VectorXd> lines = statics.solve(forces, gravity);

  std::vector<double> u(static_cast<std::size_t>(model.unknowns), 0.);
  for (std::size_t l = 0; l < lines.size(); ++l)
    for (Eigen::Index i = 0; i < lines[l].size(); ++i)
      u[static_cast<std::size_t>(model.line[l].first + i)] = lines[l][i];
  for (std::int32_t b = 0; b < model.wheelsets; ++b) {
    const WheelsetModel& w = model.wheelset[b];
    const double force = wheel_load(w), x = w.start + w.speed * time;
    double height[2];
    for (const int rail : {0, 1})
      height[rail] =
          statics.at(lines, wheel(w, rail)) - force * residual_at(model, w.residual[rail], x);
    double* p = u.data() + w.first;
    const double approach = std::pow(force / w.hertz, 2. / 3.);
    p[2] = .5 * (height[0] + height[1]) - approach;
    p[3] = (height[0] - height[1]) / (model.rail_y[0] - model.rail_y[1]);
  }
  return u;
}

}  // namespace

void start_rolling(const Model& model, State& state) {
  for (std::int32_t b = 0; b < model.wheelsets; ++b)
    state.v[model.wheelset[b].first] = model.wheelset[b].speed;
}

void start_in_equilibrium(const Track& track, const Model& model, double gravity, State& state) {
  const Statics statics(track);
  const std::vector<double> u = equilibrium(statics, model, gravity, 0.);
  const double dt = 1e-6;  // s; the shape's change over it is far above rounding, and linear
  const std::vector<double> later = equilibrium(statics, model, gravity, dt);
  const std::vector<double> before = equilibrium(statics, model, gravity, -dt);
  for (std::size_t i = 0; i < u.size(); ++i) {
    state.u[i] = u[i];
    state.v[i] = (later[i] - before[i]) / (2. * dt);
  }
  start_rolling(model, state);
  for (std::int32_t b = 0; b < model.wheelsets; ++b)
    for (int i = 0; i < 2; ++i) state.wheel_force[2 * b + i] = wheel_load(model.wheelset[b]);
}

}  // namespace railstep
