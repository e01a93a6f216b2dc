#include "offline/energy/energy_account.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "offline/energy/single_steps.h"
#include "offline/math/larger.h"
#include "online/contact/vehicle_contact.h"
#include "online/model/progress.h"
#include "online/runner/body_force.h"
#include "online/step/step.h"
#include "online/track/closing.h"
#include "online/track/shift_window.h"
#include "online/track/travel.h"

namespace railstep {
namespace {

/// Force of a wheelset's tables and inputs in one direction at a state, N.
/// @param before  steps before the state's
double outer_force(const Model& model, const WheelsetModel& w, int direction, const State& at,
                   double before = 0.) {
  const double time = (static_cast<double>(at.steps) - before) * model.scheme.dt;
  double sum = 0.;
  for (std::int32_t i = 0; i < w.forces; ++i)
    if (w.force[i].direction == direction) sum += force_at(w.force[i], time, at.input);
  return sum;
}

/// Forces of the rail on a vehicle's wheels, over its coordinates.
Eigen::VectorXd wheel_forces_on(const Model& model, const SuspendedModel& v, const State& at) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(v.size);
  for (const ContactId i : upright_wheels(model))
    if (&bodies_of(model, i) == &v)
      sum += Eigen::Map<const Eigen::VectorXd>(model.contact[i].row, v.size) * at.contact_force[i];
  return sum;
}

}  // namespace

EnergyAccount::EnergyAccount(const PackedModel& packed, const Model& model, const State& start)
    : model_(model) {
  for (std::size_t l = 0; l < packed.lines().size(); ++l)
    lines_.emplace_back(packed.lines()[l], model, model.line[l]);
  last_ = stand(start);
  stored_ = start_ = stored(last_);
  note();
}

EnergyAccount::Standing EnergyAccount::stand(const State& state) const {
  Standing at;
  at.memory.resize(static_cast<std::size_t>(state_doubles(model_)));
  at.state = copied_state(model_, state, at.memory.data());
  for (const LineEnergy& line : lines_) at.lines.push_back(line.motion(at.state));
  at.contacts = standing_contacts(model_, at.state);
  for (std::int32_t i = 0; i < model_.runners; ++i)
    at.runners.push_back(standing_runner(model_, model_.runner[i], at.state));
  for (std::int32_t j = 0; j < model_.fixed.count; ++j) {
    at.depth.push_back(closing(model_, j, at.state.u, at.state.v) - model_.fixed.gap[j]);
    at.speed.push_back(closing_speed(model_, j, at.state));
  }
  return at;
}

StoredEnergy EnergyAccount::stored(const Standing& at) const {
  StoredEnergy sum;
  for (const LineMotion& line : at.lines) {
    sum.kinetic += line.kinetic;
    sum.strain += line.strain;
  }
  const double time = static_cast<double>(at.state.steps) * model_.scheme.dt;
  for (std::int32_t b = 0; b < model_.wheelsets; ++b) {
    const WheelsetModel& w = model_.wheelset[b];
    sum.kinetic += suspended_energy(w, at.state).kinetic;
    const double speed = travelled(w.travel, time).speed;
    sum.forward += .5 * w.mass[0] * speed * (2. * at.state.v[w.first] - speed);
  }
  for (std::int32_t b = 0; b < model_.vehicles; ++b) {
    const SuspendedEnergy own = suspended_energy(model_.vehicle[b], at.state);
    sum.kinetic += own.kinetic;
    sum.strain += own.strain;
  }
  sum.hertz = at.contacts.hertz;
  for (std::size_t i = 0; i < at.runners.size(); ++i) {
    const RunnerEnergy own = runner_energy(model_, model_.runner[i], at.runners[i], at.state);
    sum.kinetic += own.kinetic;
    sum.strain += own.strain;
    sum.hertz += own.contact;
    sum.residual += own.residual;
  }
  sum.residual += at.contacts.residual;
  for (std::size_t j = 0; j < at.depth.size(); ++j)
    sum.ports += .5 * model_.fixed.stiffness[j] * std::pow(std::max(0., at.depth[j]), 2);
  return sum;
}

void EnergyAccount::follow(const State& state) {
  Standing now = stand(state);
  shift_bay(now.state.steps);
  now.external = external_in_step(model_, last_.state, now.state);
  stored_ = stored(now);
  add_lines(now);
  add_loads(now);
  if (wheel_count(model_) > 0) add_contacts(now);
  for (std::int32_t b = 0; b < model_.wheelsets; ++b) add_wheelset(now, b);
  for (std::int32_t j = 0; j < model_.fixed.count; ++j) add_port(now, j);
  if (model_.vehicles > 0) add_vehicles(now);
  for (std::size_t i = 0; i < now.runners.size(); ++i) add_runner(now, i);
  if (first_ && model_.form == Form::banded) add_start(now);
  last_ = std::move(now);  // its views stay valid: a vector's memory moves along
  first_ = false;
  note();
}

/// On a track without end, moves the state at the step's start to its bay after a border.
void EnergyAccount::shift_bay(std::int64_t step) {
  const Endless& e = model_.endless;
  if (e.bays == 0 || bays_passed(e.progress, step).bays == bays_passed(e.progress, step - 1).bays)
    return;
  std::vector<double> scratch(static_cast<std::size_t>(workspace_doubles(model_)));
  Workspace workspace = workspace_on(model_, scratch.data());
  shift_window(model_, step, last_.state, workspace);
  for (std::size_t l = 0; l < lines_.size(); ++l) last_.lines[l] = lines_[l].motion(last_.state);
  for (int i = 0; i < last_.contacts.loads; ++i)
    last_.contacts.load[i].row.element -= e.bay_elements;
  for (StandingRunner& runner : last_.runners)
    for (auto& wheelset : runner.wheels)
      for (StandingWheel& wheel : wheelset)
        for (WheelSeatRow& seat : wheel.seat) {
          seat.row.element -= e.bay_elements;
          for (std::int32_t s = 0; s < seat.row.seats; ++s) seat.row.seat[s] -= 2 * e.bay_elements;
        }
  for (ExternalContact& at : last_.external)
    for (RailRow& row : at.row) row.element -= e.bay_elements;
  for (const ContactId i : contacts(last_.contacts)) {
    RailRow& row = last_.contacts.contact[i].row;
    row.element -= e.bay_elements;
    for (std::int32_t s = 0; s < row.seats; ++s) row.seat[s] -= 2 * e.bay_elements;
  }
}

void EnergyAccount::add_lines(const Standing& now) {
  for (std::size_t l = 0; l < lines_.size(); ++l) {
    const LineMotion &before = last_.lines[l], &after = now.lines[l];
    flow_.dissipated += .5 * model_.scheme.dt * (before.power + after.power);
    flow_.weight += lines_[l].constant_work(before, after);
    flow_.loss += lines_[l].loss(before, after, model_.scheme.dt);
  }
}

void EnergyAccount::add_loads(const Standing& now) {
  const auto n = static_cast<std::size_t>(model_.unknowns);
  std::vector<double> u(n), v(n);
  for (std::size_t i = 0; i < n; ++i) {
    u[i] = now.state.u[i] - last_.state.u[i];
    v[i] = now.state.v[i] - last_.state.v[i];
  }
  const Configuration moved{u.data(), {u.data(), v.data()}};
  for (std::int32_t i = 0; i < model_.loads; ++i)
    for (const Standing* at : {static_cast<const Standing*>(&last_), &now}) {
      const PlacedLoad& load = at->contacts.load[i];
      if (load.on_rail) flow_.loads += .5 * load.force * motion(model_, load.row, moved);
    }
  flow_.outside += external_work(model_, last_.external, now.external, moved);
  flow_.carriers += residual_work(last_.contacts, now.contacts);
}

void EnergyAccount::add_contacts(const Standing& now) {
  const StandingContacts &before = last_.contacts, &after = now.contacts;
  double sum = residual_work(before, after) - (after.hertz - before.hertz) -
               (after.residual - before.residual);
  double mean[kMaxWheels];
  for (const ContactId i : contacts(after)) {
    mean[i] = wheel_force(now, i);
    const bool lost =
        !is_upright(model_, i) && !(before.contact[i].on_rail && after.contact[i].on_rail);
    if (!lost) sum += mean[i] * (after.approach[i] - before.approach[i]);
  }
  const double damped = contact_dissipation(model_, before, after, mean);
  flow_.dissipated += damped;
  flow_.loss += sum - damped;
}

void EnergyAccount::add_port(const Standing& now, std::int32_t j) {
  const auto i = static_cast<std::size_t>(j);
  const double k = model_.fixed.stiffness[j], theta = model_.scheme.theta;
  const double d0 = last_.depth[i], d1 = now.depth[i];
  const double f0 = last_.state.port_force[j], f1 = now.state.port_force[j];
  const auto spring = [&](double d) { return k * std::max(0., d); };
  const bool held = model_.form == Form::condensed;
  const double work = (held ? f1 : .5 * (f0 + f1)) * (d1 - d0);
  const double dissipated =
      held ? work - spring(theta * d1 + (1. - theta) * d0) * (d1 - d0)
           : .5 * model_.scheme.dt *
                 ((f0 - spring(d0)) * last_.speed[i] + (f1 - spring(d1)) * now.speed[i]);
  const double kept = .5 * (spring(d1) * std::max(0., d1) - spring(d0) * std::max(0., d0));
  flow_.dissipated += dissipated;
  flow_.loss += work - kept - dissipated;
}

/// Force of the scheme on a wheel over the step, N.
double EnergyAccount::wheel_force(const Standing& now, int wheel) const {
  const double f1 = now.state.contact_force[wheel];
  return model_.form == Form::condensed ? f1 : .5 * (last_.state.contact_force[wheel] + f1);
}

/// Work of a wheelset's wheels by the change of approach due to its motion along x alone, J: the
/// mean of moving before and of moving after everything else.
double EnergyAccount::passage_work(const Standing& now, std::int32_t b) const {
  const WheelsetModel& w = model_.wheelset[b];
  double sum = 0.;
  for (const bool later : {false, true}) {
    const Standing &at = later ? now : last_, &other = later ? last_ : now;
    std::vector<double> u(at.state.u, at.state.u + model_.unknowns);
    u[static_cast<std::size_t>(w.first)] = other.state.u[w.first];
    const Configuration moved_along{
        u.data(), {at.state.u, at.state.v}, track_offset(model_, now.state.steps)};
    const WheelsetContacts own = contacts_of(model_, b);
    WheelContact moved[4];
    find_contacts(model_, b, moved_along, moved);
    if (own.pair >= 0) find_flanges(model_, model_.flange[own.pair], moved_along, moved + 2);
    for (int n = 0; n < own.count; ++n) {
      const ContactId i = own.at[n];
      if (!moved[n].on_rail || !at.contacts.contact[i].on_rail) continue;
      const double change = moved[n].penetration - at.contacts.approach[i];
      sum += .5 * wheel_force(now, i) * (later ? -change : change);
    }
  }
  return sum;
}

double EnergyAccount::vehicle_passage(const Standing& now) const {
  double sum = 0.;
  for (const bool later : {false, true}) {
    const Standing& at = later ? now : last_;
    const std::int64_t step = now.state.steps;
    WheelContact moved[kMaxWheels];
    find_vehicle_contacts(model_, step, later ? model_.scheme.dt : 0.,
                          {at.state.u, {at.state.u, at.state.v}, track_offset(model_, step)},
                          moved);
    for (const ContactId i : upright_wheels(model_)) {
      const double change = moved[i].penetration - at.contacts.approach[i];
      sum += .5 * wheel_force(now, i) * (later ? -change : change);
    }
  }
  return sum;
}

void EnergyAccount::add_suspended(const SuspendedWork& work) {
  flow_.weight += work.weight;
  flow_.forces += work.forces;
  flow_.dissipated += work.dissipated;
  flow_.loss += work.loss;
}

void EnergyAccount::add_vehicles(const Standing& now) {
  for (std::int32_t b = 0; b < model_.vehicles; ++b)
    add_suspended(suspended_work(model_, model_.vehicle[b], last_.state, now.state));
  flow_.guides += vehicle_passage(now);
}

void EnergyAccount::add_runner(const Standing& now, std::size_t i) {
  const RunnerWork work = runner_work(model_, model_.runner[i], last_.runners[i], last_.state,
                                      now.runners[i], now.state);
  add_suspended(work);
  flow_.guides += work.drive;
  flow_.dissipated += work.creep;
}

double EnergyAccount::guide_work(const Standing& now, std::int32_t b) const {
  const WheelsetModel& w = model_.wheelset[b];
  const int x = w.first;
  const double du = now.state.u[x] - last_.state.u[x], dv = now.state.v[x] - last_.state.v[x];
  const bool held = model_.form == Form::condensed;
  const double force =
      held ? outer_force(model_, w, 0, now.state, .5)
           : .5 * (outer_force(model_, w, 0, last_.state) + outer_force(model_, w, 0, now.state));
  const double sum = passage_work(now, b) - force * du;
  if (is_projected(w.guide)) return sum + .5 * w.mass[0] * dv * (last_.state.v[x] + now.state.v[x]);
  const double g = held ? now.state.g[x] : .5 * (last_.state.g[x] + now.state.g[x]);
  return sum + w.mass[0] * g * du;
}

double EnergyAccount::inertia_loss(const Standing& now, const WheelsetModel& w, int k) const {
  const int i = w.first + k;
  const double dt = model_.scheme.dt, du = now.state.u[i] - last_.state.u[i];
  const double v = .5 * (last_.state.v[i] + now.state.v[i]);
  const double g = .5 * (last_.state.g[i] + now.state.g[i]);
  return w.mass[k] * ((du - dt * v) * g - v * (now.state.v[i] - last_.state.v[i] - dt * g));
}

void EnergyAccount::add_wheelset(const Standing& now, std::int32_t b) {
  const WheelsetModel& w = model_.wheelset[b];
  SuspendedWork work = suspended_work(model_, w, last_.state, now.state);
  // The guide sets the rates of what it holds.
  for (const int k : kGuided)
    if (is_projected(w.guide) && model_.form == Form::banded) work.loss -= inertia_loss(now, w, k);
  add_suspended(work);
  flow_.guides += guide_work(now, b);
}

/// Work in the first step of the forces that are out of balance at the start.
void EnergyAccount::add_start(const Standing& now) {
  const State& s = last_.state;
  std::vector<double> f(static_cast<std::size_t>(model_.unknowns));
  forces(model_, s.steps, f.data(), nullptr);
  for (const ContactId i : contacts(model_))
    for (std::int32_t l = 0; l < model_.lines && last_.contacts.contact[i].on_rail; ++l)
      spread(model_.line[l], last_.contacts.contact[i].row, -s.contact_force[i], f.data());
  for (std::size_t i = 0; i < last_.runners.size(); ++i)
    add_seat_forces(model_, last_.runners[i], f.data());
  const FixedPortModel& fixed = model_.fixed;
  for (std::int32_t j = 0; j < fixed.count; ++j)
    for (std::int32_t k = fixed.start[j]; k < fixed.start[j + 1]; ++k)
      f[static_cast<std::size_t>(fixed.index[k])] -= s.port_force[j] * fixed.value[k];
  for (std::size_t l = 0; l < lines_.size(); ++l)
    flow_.loss +=
        .5 * lines_[l].unbalanced(last_.lines[l], f.data()).dot(now.lines[l].u - last_.lines[l].u);
  for (std::int32_t b = 0; b < model_.vehicles; ++b)
    flow_.loss +=
        .5 * suspended_unbalanced(model_, model_.vehicle[b],
                                  wheel_forces_on(model_, model_.vehicle[b], s), s, now.state);
  for (std::size_t i = 0; i < now.runners.size(); ++i)
    flow_.loss += .5 * runner_unbalanced(model_, model_.runner[i], last_.runners[i], s, now.state);
  for (std::int32_t b = 0; b < model_.wheelsets; ++b) {
    const WheelsetModel& w = model_.wheelset[b];
    const WheelsetContacts own = contacts_of(model_, b);
    for (int k = 1; k < 5; ++k) {  // x and yaw are guided
      const int at = w.first + k;
      double force = w.rest[k] - w.mass[k] * s.g[at] + outer_force(model_, w, k, s);
      for (int n = 0; n < own.count; ++n)
        force += last_.contacts.contact[own.at[n]].body_row[k] * s.contact_force[own.at[n]];
      flow_.loss += .5 * force * (now.state.u[at] - s.u[at]);
    }
  }
}

void EnergyAccount::note() {
  const double sizes[] = {std::abs(stored_.total() - stored_.forward),
                          std::abs(flow_.loads),
                          std::abs(flow_.weight),
                          std::abs(flow_.forces),
                          std::abs(flow_.outside),
                          std::abs(flow_.guides - (stored_.forward - start_.forward)),
                          std::abs(flow_.carriers),
                          flow_.dissipated};
  for (const double size : sizes) turned_over_ = larger(turned_over_, size);
  largest_ = larger(largest_, std::abs(imbalance()));
  if (std::abs(flow_.loss) > std::abs(largest_loss_)) largest_loss_ = flow_.loss;
}

double EnergyAccount::imbalance() const {
  return stored_.total() - start_.total() - flow_.work() + flow_.dissipated;
}

double EnergyAccount::balance_error() const {
  return turned_over_ > 0. ? largest_ / turned_over_ : 0.;
}

double EnergyAccount::numerical_loss() const {
  return turned_over_ > 0. ? largest_loss_ / turned_over_ : 0.;
}

EnergyBalance balance_of(const PackedModel& packed, const Model& model, std::int64_t frames,
                         const std::function<void(std::int64_t)>& after,
                         const FrameInputs& inputs) {
  SingleSteps run(model);
  EnergyAccount account(packed, run.model(), run.state());
  run.make(frames, account, after, inputs);
  return {account.balance_error(), account.numerical_loss(), state_hash(run.model(), run.state())};
}

}  // namespace railstep
