#include "online/runner/suspended.h"

#include "online/math/dense.h"
#include "online/runner/body_force.h"

namespace railstep {

void move_freely(const Model& model, const SuspendedModel& bodies, double time, const State& s,
                 const Workspace& w, const double* from, double* force, double* u) noexcept {
  const Scheme& c = model.scheme;
  const double held = held_fraction(model);
  const std::int32_t n = bodies.size;
  const double *u_star = w.u_star + bodies.first, *v_star = w.v_star + bodies.first;
  const double *u0 = s.u + bodies.first, *v0 = s.v + bodies.first;
  double other[kMaxRunnerUnknowns];
  for (std::int32_t k = 0; k < n; ++k) {
    const double u_own = from == nullptr ? u_star[k] : u_star[k] - from[k];
    force[k] += bodies.mass[k] * (c.kg * u_own) + bodies.rest[k];
    other[k] = held * (c.kv * u_own - v_star[k]) - (1. - held) * v0[k];
    u[k] = 0.;
  }
  add_forces(bodies, time, s.input, force);
  symmetric_multiply_add(bodies.damping, other, force, n);
  if (held < 1.) {
    for (std::int32_t k = 0; k < n; ++k)
      other[k] = -(1. - held) * (from == nullptr ? u0[k] : u0[k] - from[k]);
    symmetric_multiply_add(bodies.stiffness, other, force, n);
  }
  symmetric_multiply_add(bodies.inverse, force, u, n);
  for (std::int32_t k = 0; k < n && from != nullptr; ++k) u[k] += from[k];
}

}  // namespace railstep
