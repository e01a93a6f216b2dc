#include "offline/energy/suspended_energy.h"

#include "online/runner/body_force.h"

namespace railstep {
namespace {

struct BodiesMaps {
  BodiesVector mass, rest;
  Eigen::Map<const Eigen::MatrixXd> damping, stiffness;  // symmetric
  explicit BodiesMaps(const SuspendedModel& b)
      : mass(b.mass, b.size),
        rest(b.rest, b.size),
        damping(b.damping, b.size, b.size),
        stiffness(b.stiffness, b.size, b.size) {}
};

}  // namespace

Eigen::VectorXd outer_forces(const Model& model, const SuspendedModel& bodies, const State& at,
                             double before) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(bodies.size);
  const double time = (static_cast<double>(at.steps) - before) * model.scheme.dt;
  add_forces(bodies, time, at.input, sum.data());
  return sum;
}

SuspendedEnergy suspended_energy(const SuspendedModel& bodies, const State& at) {
  const BodiesMaps m(bodies);
  const BodiesVector u = part_of(bodies, at.u), v = part_of(bodies, at.v);
  return {.5 * v.dot(m.mass.cwiseProduct(v)), .5 * u.dot(m.stiffness * u)};
}

SuspendedWork suspended_work(const Model& model, const SuspendedModel& bodies, const State& before,
                             const State& after) {
  const BodiesMaps m(bodies);
  const double dt = model.scheme.dt;
  const BodiesVector v0 = part_of(bodies, before.v), v1 = part_of(bodies, after.v);
  const Eigen::VectorXd du = part_of(bodies, after.u) - part_of(bodies, before.u), dv = v1 - v0;
  const Eigen::VectorXd f0 = outer_forces(model, bodies, before),
                        f1 = outer_forces(model, bodies, after);
  SuspendedWork work{m.rest.dot(du), .5 * (f0 + f1).dot(du), 0., 0.};
  if (model.form == Form::condensed) {
    work.dissipated = du.dot(m.damping * du) / dt;
    work.loss = (.5 * (f0 + f1) - outer_forces(model, bodies, after, .5)).dot(du);
    return work;
  }
  const Eigen::VectorXd v = .5 * (v0 + v1);
  const Eigen::VectorXd g = .5 * (part_of(bodies, before.g) + part_of(bodies, after.g));
  const Eigen::VectorXd eu = du - dt * v, ev = dv - dt * g;
  work.dissipated = .5 * dt * (v0.dot(m.damping * v0) + v1.dot(m.damping * v1));
  work.loss = eu.dot(m.mass.cwiseProduct(g) + m.damping * v) - v.dot(m.mass.cwiseProduct(ev)) -
              .25 * dt * dv.dot(m.damping * dv);
  return work;
}

double suspended_unbalanced(const Model& model, const SuspendedModel& bodies,
                            const Eigen::VectorXd& force, const State& at, const State& after) {
  const BodiesMaps m(bodies);
  const Eigen::VectorXd left = force + outer_forces(model, bodies, at) + m.rest -
                               m.mass.cwiseProduct(part_of(bodies, at.g)) -
                               m.damping * part_of(bodies, at.v) -
                               m.stiffness * part_of(bodies, at.u);
  return left.dot(part_of(bodies, after.u) - part_of(bodies, at.u));
}

}  // namespace railstep
