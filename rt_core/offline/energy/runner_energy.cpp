#include "offline/energy/runner_energy.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "offline/energy/line_work.h"
#include "online/model/progress.h"
#include "online/track/residual.h"
#include "online/track/travel.h"

namespace railstep {
namespace {

/// Power of a wheel's force on what the turning of its frame adds to its motion, W.
double power_on_frame(const RailsUnder& under, double radius, const double* u,
                      const double* force) {
  double rate[kMotions] = {}, power = 0.;
  add_frame_rates(under, radius, u, rate);
  for (int k = 0; k < kMotions; ++k) power += force[k] * rate[k];
  return power;
}

double along(const Model& model, const WheelSeatRow& seat, const Configuration& at) {
  double sum = 0.;
  for (std::int32_t l = 0; l < model.lines; ++l) sum += motion(model.line[l], seat.row, at);
  return sum;
}

/// The seat under a wheel: its rows, and how the lines have moved it.
void stand_on_seat(const Model& model, const RunnerModel& runner, int wheelset, int side,
                   const State& at, const std::vector<RailForce>& acting, StandingWheel& wheel) {
  const Configuration now{at.u, {at.u, at.v}, track_offset(model, at.steps)};
  SeatMotions seats;
  RailForce place[kWheelSeatRows];
  locate_wheel_seat(model, now, runner,
                    element_place(model, runner, wheelset, along_in(runner, at)), side, seats,
                    wheel.seat, place);
  std::fill_n(wheel.residual, kWheelSeatRows, 0.);
  std::fill_n(wheel.moved, kWheelSeatRows, 0.);
  if (!wheel.seat[0].on_rail) return;
  const int set = runner.first_wheelset + wheelset, own = WheelId{set, side}.number();
  const SeatFlexibility gives = seat_flexibility_beside(model, runner, side, place[1]);
  for (int k = 0; k < kWheelSeatRows; ++k)
    wheel.residual[k] = moved_by_wheel(gives.along[k], wheel_force_of(at, set, side));
  wheel.residual[1] +=
      residual_displacement(model, acting.data(), static_cast<int>(acting.size()), own);
  for (int k = 0; k < kWheelSeatRows; ++k)
    wheel.moved[k] = along(model, wheel.seat[k], now) + (wheel.seat[k].rise + wheel.residual[k]);
}

/// Vertical forces of all wheels of runners on the rails.
std::vector<RailForce> wheel_forces_on_rails(const Model& model, const State& at) {
  std::vector<RailForce> forces;
  for (std::int32_t r = 0; r < model.runners; ++r) {
    const RunnerModel& runner = model.runner[r];
    for (int i = 0; i < runner.wheelsets; ++i)
      for (int side = 0; side < 2; ++side)
        forces.push_back(rail_force(model, runner.load_point[side],
                                    element_place(model, runner, i, along_in(runner, at)),
                                    -wheel_force_of(at, runner.first_wheelset + i, side)[2]));
  }
  return forces;
}

/// Forces of the rails over all coordinates.
Eigen::VectorXd forces_of(const RunnerModel& runner, const StandingRunner& standing) {
  Eigen::VectorXd force = Eigen::VectorXd::Zero(runner.size);
  for (int i = 0; i < runner.wheelsets; ++i)
    for (const StandingWheel& wheel : standing.wheels[static_cast<std::size_t>(i)])
      for (int k = 0; k < kMotions; ++k)
        force[runner.wheelset[i].first + k] += wheel.force.generalised[k];
  return force;
}

/// Forces of the force elements over all coordinates.
Eigen::VectorXd element_forces(const Model& model, const RunnerModel& runner, const State& at) {
  Eigen::VectorXd force = Eigen::VectorXd::Zero(runner.size);
  const std::vector<StandingElement> all = standing_elements(model, runner, at);
  for (std::size_t j = 0; j < all.size(); ++j)
    force += all[j].force.force *
             BodiesVector(runner.element_row +
                              std::ptrdiff_t{runner.size} * runner.force_element[j].coordinate,
                          runner.size);
  return force;
}

/// Integral of a curve from 0 to a place.
double area_under(const RisingCurve& curve, double to) {
  double sum = 0., at = 0.;
  const double way = to < 0. ? -1. : 1.;
  const auto go = [&](double next) {
    // By the trapezoidal rule: the curve is straight in between.
    sum += .5 * (curve_at(curve, at).value + curve_at(curve, next).value) * (next - at);
    at = next;
  };
  std::vector<double> corners;
  for (std::int32_t i = 0; i < curve.points; ++i) {
    const double corner = curve.point[std::ptrdiff_t{3} * i];
    if (way * corner > 0. && way * corner < way * to) corners.push_back(corner);
  }
  if (way < 0.) std::reverse(corners.begin(), corners.end());
  for (const double corner : corners) go(corner);
  go(to);
  return sum;
}

/// Energy that a force element stores, J. Friction stores what its spring does.
double stored_by(const ForceElement& e, const StandingElement& at) {
  switch (e.law) {
    case ElementLaw::spring:
      return area_under(e.curve, at.z);
    case ElementLaw::damper:
    case ElementLaw::actuator:
    case ElementLaw::controlled:
      return 0.;
    case ElementLaw::slider:
      return .5 * e.stiffness * at.from_memory * at.from_memory;
    case ElementLaw::exponential:
    case ElementLaw::berg:
      break;
  }
  return .5 * at.force.force * at.force.force / e.stiffness;
}

double element_energy(const Model& model, const RunnerModel& runner, const State& at) {
  double sum = 0.;
  const std::vector<StandingElement> all = standing_elements(model, runner, at);
  for (std::size_t j = 0; j < all.size(); ++j) sum += stored_by(runner.force_element[j], all[j]);
  return sum;
}

/// Work of force elements on a vehicle in a step, J: what springs make by numerical loss, what
/// dampers and friction take, and what actuators give.
struct ElementWork {
  double loss = 0., dissipated = 0., friction = 0., given = 0.;
};
ElementWork element_work(const Model& model, const RunnerModel& runner, const State& from,
                         const State& to) {
  ElementWork sum;
  const std::vector<StandingElement> before = standing_elements(model, runner, from),
                                     after = standing_elements(model, runner, to);
  for (std::size_t j = 0; j < before.size(); ++j) {
    const StandingElement &a = before[j], &b = after[j];
    const ForceElement& e = runner.force_element[j];
    const double taken =
        .5 * (a.force.force + b.force.force) * (b.z - a.z) + (stored_by(e, b) - stored_by(e, a));
    if (is_friction(e.law))
      sum.friction -= taken;
    else if (e.law == ElementLaw::damper || e.law == ElementLaw::controlled)
      sum.dissipated -= taken;
    else if (e.law == ElementLaw::actuator)
      sum.given += taken;
    else
      sum.loss += taken;
  }
  return sum;
}

/// Work of the normal force of a patch up to a depth, by Simpson's rule, if at each depth it is
/// held as a step that finds it there does.
double work_of(StripPatch patch, double depth) {
  constexpr int kParts = 64;
  constexpr double kLeastHeld = 3e-6;  // m
  double sum = 0.;
  for (int i = 1; i <= kParts; ++i) {
    const double own = depth * i / kParts;
    patch.collocation = collocation_of(patch, std::max(own, kLeastHeld));
    sum += (i == kParts ? 1. : i % 2 == 1 ? 4. : 2.) * patch_force(patch, own).normal;
  }
  return sum * depth / (3. * kParts);
}

/// Energy of the patches of a wheel, J.
double strain_of(const RollingContact& c, double radius, double side, const OverRail& at,
                 const WheelForce& force) {
  if (!has_profiles(c)) return .4 * force.normal * std::max(force.depth, 0.);
  ProfileWheel wheel;
  find_profile_wheel(c, radius, side, at, wheel);
  double sum = 0.;
  for (std::int32_t i = 0; i < wheel.patches; ++i)
    sum += wheel.patch[i].zone.share *
           work_of(patch_of(wheel.patch[i].zone), std::max(wheel.patch[i].rows.depth, 0.));
  return sum;
}

double contact_energy(const StandingRunner& standing) {
  double sum = 0.;
  for (const auto& wheelset : standing.wheels)
    for (const StandingWheel& wheel : wheelset) sum += wheel.strain;
  return sum;
}

double residual_energy(const StandingRunner& standing) {
  double sum = 0.;
  for (const auto& wheelset : standing.wheels)
    for (const StandingWheel& wheel : wheelset)
      for (int k = 0; k < kWheelSeatRows; ++k) sum += .5 * wheel.on_seat(k) * wheel.residual[k];
  return sum;
}

/// Work of the contacts in a step, J.
struct ContactWork {
  double on_bodies;           // with the part of their spins that goes with the speed
  double on_lines, on_seats;  // the latter with what the seats' going along adds
  double drive, creep;
};
ContactWork contact_work(const Model& model, const RunnerModel& r, const StandingRunner& before,
                         const StandingRunner& after, const Eigen::VectorXd& moved,
                         const Configuration& lines_moved) {
  const double dt = model.scheme.dt, v0 = before.speed, v1 = after.speed;
  ContactWork sum{.5 * (forces_of(r, before) + forces_of(r, after)).dot(moved), 0., 0., 0., 0.};
  for (int i = 0; i < r.wheelsets; ++i)
    for (const std::size_t side : {0u, 1u}) {
      const StandingWheel &a = before.wheels[static_cast<std::size_t>(i)][side],
                          &b = after.wheels[static_cast<std::size_t>(i)][side];
      constexpr int spin = index_of(BodyMotion::pitch);
      const double *f = a.force.generalised, *g = b.force.generalised;
      sum.on_bodies += .5 * dt * (f[spin] * v0 + g[spin] * v1) / r.wheelset[i].radius;
      sum.drive -= .5 * dt * (f[0] * v0 + g[0] * v1);
      sum.drive -= .5 * dt * (a.frame_power + b.frame_power);
      sum.drive += .5 * (f[1] + g[1]) * (b.uneven_y - a.uneven_y) +
                   .5 * (f[2] + g[2]) * (b.uneven_z - a.uneven_z);
      sum.creep -= .5 * dt * (a.force.creep_power + b.force.creep_power);
      if (!a.seat[0].on_rail || !b.seat[0].on_rail) continue;
      for (int k = 0; k < kWheelSeatRows; ++k) {
        const double f0 = a.on_seat(k), f1 = b.on_seat(k);
        sum.on_seats += .5 * (f0 + f1) * (b.moved[k] - a.moved[k]);
        sum.on_lines += .5 * (f0 * along(model, a.seat[k], lines_moved) +
                              f1 * along(model, b.seat[k], lines_moved));
      }
    }
  return sum;
}

/// @param seat  State::seat
RailRate rail_rate(const double* seat) {
  return {seat[kWheelSeatRows], seat[kWheelSeatRows + 1], seat[kWheelSeatRows + 2]};
}

/// Adds the work of moments about the axles on the part of the spins that goes with the speed.
void add_spin_work(const Model& model, const RunnerModel& r, const StandingRunner& before,
                   const State& from, const StandingRunner& after, const State& to,
                   RunnerWork& work) {
  const Eigen::VectorXd f0 = outer_forces(model, r, from), f1 = outer_forces(model, r, to),
                        held = outer_forces(model, r, to, .5);
  for (int i = 0; i < r.wheelsets; ++i) {
    const std::int32_t spin = r.wheelset[i].first + index_of(BodyMotion::pitch);
    const double turn = model.scheme.dt / r.wheelset[i].radius;
    const double mean = .5 * turn * (f0[spin] * before.speed + f1[spin] * after.speed);
    work.forces += mean;
    if (model.form == Form::condensed)
      work.loss += mean - turn * held[spin] * .5 * (before.speed + after.speed);
  }
}

/// Rates of the lines' material, [unknowns] each. On condensed lines they are those of modes
/// without the part of the forces, which does not move the rails.
struct LineRates {
  std::vector<double> real, imaginary;
};
LineRates line_rates(const Model& model, const State& at) {
  const auto n = static_cast<std::size_t>(model.unknowns);
  LineRates rates{std::vector<double>(n), std::vector<double>(n)};
  for (std::int32_t l = 0; l < model.lines && model.form == Form::condensed; ++l) {
    const LineModel& line = model.line[l];
    modes_multiply(line.modal.rate, {at.u + line.first, at.v + line.first},
                   rates.real.data() + line.first, rates.imaginary.data() + line.first, line.size);
  }
  return rates;
}

}  // namespace

StandingRunner standing_runner(const Model& model, const RunnerModel& runner, const State& at) {
  StandingRunner standing;
  const double time = static_cast<double>(at.steps) * model.scheme.dt;
  standing.speed = travelled(runner.travel, time).speed;
  const std::vector<RailForce> acting = wheel_forces_on_rails(model, at);
  const LineRates rates = line_rates(model, at);
  const Configuration moving{at.v, {rates.real.data(), rates.imaginary.data()}};
  for (int i = 0; i < runner.wheelsets; ++i) {
    RailsUnder slope;
    const RailsUnder uneven = rails_under(model, runner, i, along_in(runner, at), &slope);
    const std::int32_t first = runner.first + runner.wheelset[i].first;
    auto& wheels = standing.wheels.emplace_back();
    for (int side = 0; side < 2; ++side) {
      StandingWheel& wheel = wheels[static_cast<std::size_t>(side)];
      wheel.uneven_y = uneven.y[side];
      wheel.uneven_z = uneven.z[side];
      stand_on_seat(model, runner, i, side, at, acting, wheel);
      RailsUnder under = uneven;
      under.y[side] += wheel.moved[0];
      under.z[side] += wheel.moved[1];
      RailRate rate{0., 0., 0.};
      if (wheel.seat[0].on_rail && keeps_seats(model))
        rate = rail_rate(seat_motion_of(at, runner.first_wheelset + i, side));
      else if (wheel.seat[0].on_rail)
        rate = {along(model, wheel.seat[0], moving), along(model, wheel.seat[1], moving),
                along(model, wheel.seat[2], moving)};
      rate.z += (standing.speed + ahead_of(runner, at.v + runner.first)) * slope.z[side];
      under.roll[side] = wheel.moved[2];
      double over[kMotions];
      place_over_rail(under, side, at.u + first, over);
      const OverRail place{over, under.roll[side]};
      const double radius = runner.wheelset[i].radius, sign = side == 0 ? 1. : -1.;
      Rolling rolling = rolling_of(runner, i, standing.speed, at.v + first,
                                   creepage_of(at, runner.first_wheelset + i, side), 0.);
      rolling.grip = under.grip[side];
      double material[kMotions];
      std::copy_n(at.v + first, kMotions, material);
      add_frame_rates(under, radius, at.u + first, material);
      wheel.force = force_on_wheel(runner.contact, radius, sign, rolling, place, material, rate);
      wheel.frame_power = power_on_frame(under, radius, at.u + first, wheel.force.generalised);
      wheel.strain = strain_of(runner.contact, radius, sign, place, wheel.force);
    }
  }
  return standing;
}

RunnerEnergy runner_energy(const Model& model, const RunnerModel& runner,
                           const StandingRunner& standing, const State& at) {
  SuspendedEnergy own = suspended_energy(runner, at);
  for (int i = 0; i < runner.wheelsets; ++i) {  // spins with the part that goes with the speed
    const RunnerWheelset& set = runner.wheelset[i];
    const double roll = standing.speed / set.radius,
                 beyond = at.v[runner.first + set.first + index_of(BodyMotion::pitch)];
    own.kinetic += set.spin_inertia * roll * (beyond + .5 * roll);
  }
  return {own.kinetic, own.strain + element_energy(model, runner, at), contact_energy(standing),
          residual_energy(standing)};
}

RunnerWork runner_work(const Model& model, const RunnerModel& runner, const StandingRunner& before,
                       const State& from, const StandingRunner& after, const State& to) {
  const double dt = model.scheme.dt;
  std::vector<double> lines_u(static_cast<std::size_t>(model.unknowns)), lines_v = lines_u;
  for (std::size_t i = 0; i < lines_u.size(); ++i) {
    lines_u[i] = to.u[i] - from.u[i];
    lines_v[i] = to.v[i] - from.v[i];
  }
  const Eigen::VectorXd du = part_of(runner, lines_u.data());
  const ContactWork contact = contact_work(model, runner, before, after, du,
                                           {lines_u.data(), {lines_u.data(), lines_v.data()}});
  const double residual = residual_energy(after) - residual_energy(before);
  RunnerWork work{suspended_work(model, runner, from, to), contact.drive, contact.creep};
  work.loss += (contact.on_bodies + contact.on_seats) +
               (contact_energy(after) - contact_energy(before)) + contact.creep - contact.drive;
  const ElementWork elements = element_work(model, runner, from, to);
  work.loss += elements.loss;
  work.dissipated += elements.dissipated;
  work.forces += elements.given;
  work.creep += elements.friction;
  work.drive -= contact.on_seats - contact.on_lines - residual;
  add_spin_work(model, runner, before, from, after, to, work);
  work.drive += frames_work(model, runner, from, to, du);
  // The frames accelerate.
  const double faster = (after.speed - before.speed) / dt;
  for (std::int32_t b = 0; b < runner.bodies; ++b)
    work.drive -= runner.mass[kMotions * b] * faster * du[kMotions * b];
  return work;
}

double runner_unbalanced(const Model& model, const RunnerModel& runner,
                         const StandingRunner& standing, const State& at, const State& after) {
  const Eigen::VectorXd force = forces_of(runner, standing) + element_forces(model, runner, at) +
                                line_forces(model, runner, at);
  return suspended_unbalanced(model, runner, force, at, after);
}

void add_seat_forces(const Model& model, const StandingRunner& standing, double* force) {
  for (const auto& wheelset : standing.wheels)
    for (const StandingWheel& wheel : wheelset)
      for (int k = 0; k < kWheelSeatRows && wheel.seat[0].on_rail; ++k)
        for (std::int32_t l = 0; l < model.lines; ++l)
          spread(model.line[l], wheel.seat[k].row, wheel.on_seat(k), force);
}

}  // namespace railstep
