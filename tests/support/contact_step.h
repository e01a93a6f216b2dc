#pragma once
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "offline/pack/time_schemes.h"
#include "offline/vehicle/kinds.h"
#include "support/model_run.h"
#include "support/sections.h"

namespace railstep {

/// A wheel of 600 kg that stands on one rail of section F over pads. Its contact also pulls: it is
/// the Hertz contact of hard-cases.md, 9.412508e10 N/m^1.5, linearised under 60 kN.
inline constexpr double kStandingWheel = 600.;                                             // kg
inline const double kStandingContact = 1.5 * std::cbrt(9.412508e10 * 9.412508e10 * 60e3);  // N/m

struct PadCase {
  double stiffness, damping;  // N/m, N s/m
  bool over_seat;
};

inline Track pad_track(const PadCase& pad) {
  Track t;
  t.section = section_f();
  t.unknowns = Unknowns::vertical;
  t.rails = 1;
  t.bays = 3;
  t.elements_per_bay = 1;
  t.support.stiffness = {0., 0., pad.stiffness};
  t.support.damping = {0., 0., pad.damping};
  return t;
}

/// Matrix of the coupled step, which is linear: a column for every number of the state, each from
/// one frame of the program's own step. The units of the numbers make a state's size nearly its
/// energy: accelerations times dt^2, velocities times dt; in condensed lines modes times their
/// rate.
inline Eigen::MatrixXd contact_step(const PadCase& pad, const PackOptions& options) {
  RunningVehicle wheel;
  wheel.vehicle = point_mass(kStandingWheel).vehicle;
  wheel.start = pad.over_seat ? 1.2 : .9;
  wheel.gravity = 0.;
  wheel.contact = WheelContactKind::linear;
  wheel.stiffness = kStandingContact;
  ModelRun run(pad_track(pad), {.vehicles = {wheel}}, options);
  const Model& model = run.model();
  const double dt = model.scheme.dt;
  const auto n = static_cast<Eigen::Index>(model.unknowns), all = 4 * n + contact_count(model);
  Eigen::VectorXd unit = Eigen::VectorXd::Ones(all);
  unit.segment(n, n).setConstant(1. / dt);
  unit.segment(2 * n, 2 * n).setConstant(1. / (dt * dt));
  unit.tail(contact_count(model)).setConstant(kStandingContact);
  for (Eigen::Index i = 0; model.form == Form::condensed && i < model.line_unknowns; ++i)
    for (const Eigen::Index of : {Eigen::Index{0}, n, 2 * n, 3 * n}) unit[of + i] = 1.;
  Eigen::MatrixXd step(all, all);
  for (Eigen::Index i = 0; i < all; ++i) {
    std::fill(run.memory.begin(), run.memory.end(), 0.);
    run.state.steps = 0;
    run.state.numbers[i] = unit[i];
    run.step();
    step.col(i) = Eigen::Map<const Eigen::VectorXd>(run.state.numbers, all).cwiseQuotient(unit);
  }
  // In condensed lines a and g hold the loads' last forces. There are no loads, so they stay.
  const Eigen::Index lines = modal_unknowns(model);
  for (const Eigen::Index of : {2 * n, 3 * n}) {
    step.middleRows(of, lines).setZero();
    step.middleCols(of, lines).setZero();
  }
  return step;
}

inline double spectral_radius(const Eigen::MatrixXd& step) {
  return step.eigenvalues().cwiseAbs().maxCoeff();
}

inline PackOptions full_contact(const Scheme& scheme) { return {.scheme = scheme}; }

inline PackOptions held_contact(double dt, double rho_inf, int modes = 1'000'000) {
  return {.scheme = held_force(dt, rho_inf),
          .reduction = Reduction{.limit = {modes, std::numeric_limits<double>::infinity()}}};
}

}  // namespace railstep
