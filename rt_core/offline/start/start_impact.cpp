#include "offline/start/start_impact.h"

#include <Eigen/SparseCholesky>
#include <algorithm>

#include "offline/start/static_lines.h"
#include "online/model/progress.h"
#include "online/track/moving_load.h"

namespace railstep {
namespace {

/// Motion of a line from rest under a force, by backward Euler.
struct Motion {
  Eigen::VectorXd u, v, a;
};

Motion moved(const Line& line, const Eigen::VectorXd& force, double dt, const Motion& from) {
  const Eigen::SparseMatrix<double> A = line.mass / (dt * dt) + line.damping / dt + line.stiffness;
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(A);
  const Eigen::VectorXd held = force - line.stiffness * from.u;
  const Eigen::VectorXd way =
      factor.solve(Eigen::VectorXd(held + line.mass * (from.v / dt)));  // u1 - u0
  const Eigen::VectorXd v = way / dt;
  return {from.u + way, v, (v - from.v) / dt};
}

/// Forces at step 0 over a line's unknowns, N.
Eigen::VectorXd force_on(const Track& track, const PackedModel& packed, const Line& line,
                         double gravity) {
  const Model& model = packed.model();
  Eigen::VectorXd force = Eigen::VectorXd::Zero(line.unknowns());
  if (gravity != 0.) force += weight(track, line, gravity);
  for (std::int32_t i = 0; i < model.loads; ++i) {
    const PlacedLoad at = place(model, model.load[i], 0);
    if (at.on_rail && at.force != 0.)
      force += at.force *
               point_row(track, line, point_of(packed, model.load[i].load_point, at.place), true);
  }
  return force;
}

}  // namespace

std::vector<double> start_under_impact(const Track& track, const PackedModel& packed,
                                       double gravity) {
  const Model& model = packed.model();
  std::vector<double> memory(model.start, model.start + state_doubles(model));
  if (model.form == Form::condensed || model.fixed.count > 0) return memory;
  State state = state_on(model, memory.data());
  const double dt = model.scheme.dt;
  for (std::size_t l = 0; l < packed.lines().size(); ++l) {
    const Line& line = packed.lines()[l].line;
    const Eigen::VectorXd force = force_on(track, packed, line, gravity);
    if (force.isZero(0.)) continue;
    const Eigen::VectorXd rest = Eigen::VectorXd::Zero(force.size());
    Motion at{rest, rest, rest};
    for (int i = 0; i < 3; ++i) at = moved(line, force, dt, at);
    const Eigen::VectorXd a = at.a, v = at.v - 3. * dt * a;
    const std::int32_t first = model.line[l].first;
    std::copy(v.begin(), v.end(), state.v + first);
    std::copy(a.begin(), a.end(), state.a + first);
    std::copy(a.begin(), a.end(), state.g + first);
  }
  return memory;
}

}  // namespace railstep
