#pragma once
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "offline/energy/line_energy.h"
#include "offline/energy/suspended_energy.h"
#include "online/contact/vehicle_contact.h"
#include "online/step/step.h"
#include "online/track/closing.h"
#include "online/track/residual.h"
#include "run/simulation.h"
#include "support/random_scene.h"

namespace railstep {

/// Wheels at the places of a step: approach a of lines and vehicles, and the places for G.
struct StandingWheels {
  std::vector<double> approach;  // m; negative is a gap
  std::vector<RailForce> place;
};

/// Energies before and after a step, J: after - before <= bound.
struct StepEnergies {
  double before, after, bound;
};

/// A random scene's run with vehicles only, and the energies of each step in the step's own
/// geometry: E = kinetic and strain energy of lines and vehicle, its weight's potential, one-sided
/// springs, V(a - G f) and f' G f / 2. Between two steps the drive moves the wheels over a track
/// that stands still. The change of E is its work; it is left out, as E before and after a step is
/// taken at that step's wheel places. Places, rows and G are the step's own: other tests check
/// them, this one accepts any that agree with each other.
class PassiveRun {
 public:
  explicit PassiveRun(const RandomScene& scene)
      : run_(read(scene)), model_(run_.model()), dt_(model_.scheme.dt) {
    for (std::size_t l = 0; l < run_.packed()->lines().size(); ++l) {
      const PackedLine& own = run_.packed()->lines()[l];
      lines_.emplace_back(own, model_, model_.line[l]);
      damping_.push_back(own.line.damping);
      // Sizes of the parts of a step's matrix.
      sizes_.push_back(own.line.stiffness.cwiseAbs() + own.line.damping.cwiseAbs() * (2. / dt_) +
                       own.line.mass.cwiseAbs() * (4. / (dt_ * dt_)));
    }
    const auto doubles = static_cast<std::size_t>(state_doubles(model_));
    memory_.assign(doubles, 0.);
    old_ = state_on(model_, memory_.data());
  }

  const Model& model() const { return model_; }
  const State& state() const { return run_.state; }
  const State& old() const { return old_; }
  const Outputs& outputs() const { return outputs_; }
  Status seen() const { return seen_; }
  double reference() const { return reference_; }

  void step() {
    old_ = copied_state(model_, run_.state, memory_.data());
    seen_ = seen_ | advance_frame(model_, run_.state, run_.workspace, outputs_);
  }

  /// Wheels at the places of the last step or of a later one. Forces held over a step act in its
  /// middle.
  StandingWheels wheels(const State& at, std::int64_t step) const {
    const double before = model_.form == Form::condensed ? .5 * dt_ : 0.;
    WheelContact contact[kMaxWheels];
    find_vehicle_contacts(model_, step, before, {at.u, {at.u, at.v}}, contact);
    StandingWheels found;
    for (int i = 0; i < wheel_count(model_); ++i) {
      found.approach.push_back(contact[i].penetration);
      found.place.push_back(
          {model_, model_.contact[i].load_point, contact[i].row.element, contact[i].xi, 0.});
    }
    return found;
  }

  /// Displacement of the rail under wheel i by forces and the residual flexibility, down, m.
  double moved(const StandingWheels& at, const double* force, std::size_t i) const {
    double sum = 0.;
    for (std::size_t j = 0; j < at.place.size(); ++j)
      sum += force[j] * (i == j ? residual_under(model_, at.place[i])
                                : residual_between(model_, at.place[j], at.place[i]));
    return sum;
  }

  /// Energy of the contacts' springs and of their residual flexibility, J.
  double of_contacts(const StandingWheels& at, const double* force) const {
    double sum = 0.;
    for (std::size_t i = 0; i < at.place.size(); ++i) {
      const ContactLaw& law = model_.contact[i].law;
      const double w = moved(at, force, i), d = at.approach[i] - w, in = std::max(0., d);
      sum += law.hertz > 0. ? .4 * law.hertz * in * in * std::sqrt(in) : .5 * law.stiffness * d * d;
      sum += .5 * force[i] * w;
    }
    return sum;
  }

  /// Energy of lines, vehicle and one-sided springs, J.
  double of_bodies(const State& at) const {
    double sum = 0.;
    for (const LineEnergy& line : lines_) {
      const LineMotion m = line.motion(at);
      sum += m.kinetic + m.strain;
    }
    for (std::int32_t i = 0; i < model_.vehicles; ++i) {
      const SuspendedModel& v = model_.vehicle[i];
      const SuspendedEnergy own = suspended_energy(v, at);
      sum += own.kinetic + own.strain;
    }
    for (std::int32_t j = 0; j < model_.fixed.count; ++j) {
      const double d = std::max(0., closing(model_, j, at.u, at.v) - model_.fixed.gap[j]);
      sum += .5 * model_.fixed.stiffness[j] * d * d;
    }
    return sum;
  }

  /// Potential of the vehicle's weight, relative to the start, J.
  double of_weight(const State& at) const {
    double sum = 0.;
    for (std::int32_t i = 0; i < model_.vehicles; ++i)
      for (int k = 0; k < model_.vehicle[i].size; ++k)
        sum -= model_.vehicle[i].rest[k] * at.u[model_.vehicle[i].first + k];
    return sum;
  }

  /// Whole energy with the wheels at the places of a step, J.
  double of_all(const State& at, std::int64_t step) const {
    return of_bodies(at) + of_weight(at) + of_contacts(wheels(at, step), at.contact_force);
  }

  /// Energy that dampers of lines and vehicles take in a step of the trapezoidal rule, which moves
  /// at the mean velocity v: h v' C v, J.
  double damped() const {
    double sum = 0.;
    for (std::size_t l = 0; l < damping_.size(); ++l) {
      const auto n = damping_[l].rows();
      const Eigen::Map<const Eigen::VectorXd> v0(old_.v + model_.line[l].first, n);
      const Eigen::Map<const Eigen::VectorXd> v1(run_.state.v + model_.line[l].first, n);
      const Eigen::VectorXd mean = .5 * (v0 + v1);
      sum += mean.dot(damping_[l] * mean);
    }
    for (std::int32_t i = 0; i < model_.vehicles; ++i) {
      const SuspendedModel& own = model_.vehicle[i];
      for (int j = 0; j < own.size; ++j)
        for (int k = 0; k < own.size; ++k) {
          const int a = own.first + j, b = own.first + k;
          sum += .25 * own.damping[j * own.size + k] * (old_.v[a] + run_.state.v[a]) *
                 (old_.v[b] + run_.state.v[b]);
        }
    }
    return dt_ * sum;
  }

  /// Energies of the last step.
  StepEnergies energies() {
    const std::int64_t step = run_.state.steps;
    StepEnergies e{of_all(old_, step), of_all(run_.state, step), 0.};
    e.bound = bound(e);
    return e;
  }

  /// Bound of the energy that round-off makes in the last step, J.
  ///
  /// Full order: a step solves S u1 = b, S = K + kv C + kg M, backward stably. Its residual is eps
  /// (|S| |u|) times the number of terms of a row, 27 and a few more; the residual's work is that
  /// times |du|. The energies' own products err by less. A weight's potential is a difference of
  /// places. Condensed: modes keep their energy to the eigen solver's 1e-10, with as much again for
  /// shapes and rates that share it.
  /// Contacts: f times the residual of the solve, 1e-12 of d_free; f d_free is at most four times
  /// the energy that a step can bring to a contact.
  double bound(const StepEnergies& e) {
    reference_ =
        std::max({reference_, e.before - of_weight(old_), e.after - of_weight(run_.state)});
    if (model_.form == Form::condensed) return 1e-9 * reference_;
    double size = 0.;
    for (std::size_t l = 0; l < sizes_.size(); ++l) {
      const auto n = sizes_[l].rows();
      const Eigen::Map<const Eigen::VectorXd> u0(old_.u + model_.line[l].first, n);
      const Eigen::Map<const Eigen::VectorXd> u1(run_.state.u + model_.line[l].first, n);
      const Eigen::VectorXd all = u0.cwiseAbs() + u1.cwiseAbs(), way = (u1 - u0).cwiseAbs();
      size += way.dot(sizes_[l] * all);
    }
    for (std::int32_t i = 0; i < model_.vehicles; ++i) {
      const SuspendedModel& v = model_.vehicle[i];
      for (int k = 0; k < v.size; ++k) {
        const double u0 = old_.u[v.first + k], u1 = run_.state.u[v.first + k];
        const double way = std::abs(u1 - u0), all = std::abs(u0) + std::abs(u1);
        size += 4. / (dt_ * dt_) * v.mass[k] * way * all - v.rest[k] * all;
        size += std::abs(v.stiffness[k * v.size + k]) * all * all;
      }
    }
    return 100. * std::numeric_limits<double>::epsilon() * size + 4e-12 * reference_;
  }

 private:
  Simulation run_;
  const Model& model_;
  double dt_;
  std::vector<LineEnergy> lines_;
  std::vector<Eigen::SparseMatrix<double>> damping_;
  std::vector<Eigen::SparseMatrix<double>> sizes_;  // |K| + |C| 2/dt + |M| 4/dt^2
  std::vector<double> memory_;
  State old_{};
  Outputs outputs_{};
  Status seen_ = Status::ok;
  double reference_ = 0.;  // largest energy so far, without that of the weight, J
};

}  // namespace railstep
