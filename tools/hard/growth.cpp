#include "hard/growth.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <vector>

#include "offline/contact/hertz.h"
#include "online/step/step.h"

namespace railstep {
namespace {

/// A number of the state that a step makes from the last state, and a small change of it: of all in
/// the same unit, so that no eigenvalue drowns in the rounding of large numbers.
struct Change {
  Eigen::Index at;
  double by;
};

double pressed(const State& state, int wheel) { return std::max(0., state.contact_force[wheel]); }

/// m: where a contact follows Hertz's law, a part of its depth (f / C)^(2/3), so that the law's
/// fifth derivative adds part^4 / 30 to its slope, 2e-11.
double small_change(const Model& model, const State& state) {
  double small = HUGE_VAL;
  for (int i = 0; i < model.vehicle_wheels; ++i) {
    const ContactLaw& contact = model.contact[vehicle_contact(model, i)].law;
    const double force = pressed(state, vehicle_contact(model, i));
    if (contact.hertz > 0. && force > 0.)
      small = std::min(small, 5e-3 * contact_depth(contact, force));
  }
  return small < HUGE_VAL ? small : 1e-8;
}

/// N/m of a wheel's contact; 0 where it stands free.
double slope(const ContactLaw& contact, double force) {
  return contact.hertz > 0. ? 1.5 * std::cbrt(contact.hertz * contact.hertz * force)
                            : contact.stiffness;
}

/// Displacement, velocity and both accelerations of unknowns [first, last).
void add_motion(std::vector<Change>& changes, const Model& model, double small, Eigen::Index first,
                Eigen::Index last) {
  const double per_step = 1. / model.scheme.dt;
  const double size[4] = {small, small * per_step, small * per_step * per_step,
                          small * per_step * per_step};
  for (Eigen::Index field = 0; field < 4; ++field)
    for (Eigen::Index i = first; i < last; ++i)
      changes.push_back({field * model.unknowns + i, size[field]});
}

/// Real and imaginary part of every mode; those that pad a panel have no rate.
void add_modes(std::vector<Change>& changes, const Model& model, double small,
               const LineModel& line) {
  for (int k = 0; k < line.modal.count; ++k) {
    if (std::hypot(line.modal.rate.re[k], line.modal.rate.im[k]) == 0.) continue;
    changes.push_back({line.first + k, small});
    changes.push_back({model.unknowns + line.first + k, small});
  }
}

std::vector<Change> changes_of(const Model& model, const State& state) {
  const double small = small_change(model, state);
  std::vector<Change> changes;
  if (model.form == Form::banded) add_motion(changes, model, small, 0, model.line_unknowns);
  for (int l = 0; model.form == Form::condensed && l < model.lines; ++l)
    add_modes(changes, model, small, model.line[l]);
  for (int i = 0; i < model.vehicles; ++i) {
    const SuspendedModel& vehicle = model.vehicle[i];
    add_motion(changes, model, small, vehicle.first, vehicle.first + vehicle.size);
  }
  for (int i = 0; i < model.vehicle_wheels; ++i) {
    const int wheel = vehicle_contact(model, i);
    const double stiffness = slope(model.contact[wheel].law, pressed(state, wheel));
    if (stiffness > 0.)
      changes.push_back({Eigen::Index{4} * model.unknowns + wheel, stiffness * small});
  }
  return changes;
}

/// One frame from `start`.
Eigen::VectorXd frame_from(Simulation& run, const Eigen::VectorXd& start, std::int64_t steps) {
  std::copy(start.data(), start.data() + start.size(), run.state.u);
  run.state.steps = steps;
  Outputs outputs{};
  static_cast<void>(advance_frame(run.model(), run.state, run.workspace, outputs));
  return Eigen::Map<const Eigen::VectorXd>(run.state.u, start.size());
}

}  // namespace

double growth_of(Simulation& run) {
  const Model& model = run.model();
  const std::int64_t steps = run.state.steps;
  const Eigen::VectorXd start =
      Eigen::Map<const Eigen::VectorXd>(run.state.numbers, state_doubles(model));
  const std::vector<Change> changes = changes_of(model, run.state);
  const auto n = static_cast<Eigen::Index>(changes.size());
  Eigen::MatrixXd map(n, n);
  Eigen::VectorXd from = start;
  for (Eigen::Index i = 0; i < n; ++i) {
    const Change& change = changes[static_cast<std::size_t>(i)];
    const auto across = [&](double times) {  // the state ahead less that behind
      from[change.at] = start[change.at] + times * change.by;
      const Eigen::VectorXd ahead = frame_from(run, from, steps);
      from[change.at] = start[change.at] - times * change.by;
      return Eigen::VectorXd(ahead - frame_from(run, from, steps));
    };
    const Eigen::VectorXd moved = (8. * across(1.) - across(2.)) / 12.;
    from[change.at] = start[change.at];
    for (Eigen::Index k = 0; k < n; ++k) {
      const Change& row = changes[static_cast<std::size_t>(k)];
      map(k, i) = moved[row.at] / row.by;
    }
  }
  std::copy(start.data(), start.data() + start.size(), run.state.u);
  run.state.steps = steps;
  // The complex solver: the real one divides by zero at some pairs of equal roots.
  const Eigen::ComplexEigenSolver<Eigen::MatrixXcd> solver(map.cast<std::complex<double>>(), false);
  if (solver.info() != Eigen::Success) return std::numeric_limits<double>::quiet_NaN();
  return solver.eigenvalues().cwiseAbs().maxCoeff();
}

}  // namespace railstep
