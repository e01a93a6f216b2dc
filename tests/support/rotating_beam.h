#pragma once
#include <Eigen/SparseCholesky>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "support/planar_beam.h"
#include "support/time_integration.h"

namespace railstep {

/// The hub's angle, rad: from rest to a steady speed within `duration`,
/// th = w/T (t^2/2 + (T/2pi)^2 (cos(2 pi t/T) - 1)), then w (t - T/2).
struct SpinUp {
  double speed;           // w, rad/s
  double duration = 15.;  // T, s

  double omega() const { return 8. * std::atan(1.) / duration; }
  double angle(double t) const {
    if (t >= duration) return speed * (t - duration / 2.);
    return speed / duration * (t * t / 2. + (std::cos(omega() * t) - 1.) / (omega() * omega()));
  }
  double rate(double t) const {
    if (t >= duration) return speed;
    return speed / duration * (t - std::sin(omega() * t) / omega());
  }
  double acceleration(double t) const {
    return t >= duration ? 0. : speed / duration * (1. - std::cos(omega() * t));
  }
};

/// Drives the first node's section, and the other held unknowns of a planar beam.
inline std::function<void(Moving&)> drive_section(const SpinUp& hub) {
  return [hub](Moving& m) {
    const double angle = hub.angle(m.time), rate = hub.rate(m.time);
    const Eigen::Vector2d across(-std::sin(angle), std::cos(angle)), back(-across[1], across[0]);
    const Eigen::Vector2d speed = rate * back;
    const Eigen::Vector2d change = hub.acceleration(m.time) * back - rate * rate * across;
    for (const int k : {0, 1}) {
      m.q[6 + 2 * k] = across[k];
      m.v[6 + 2 * k] = speed[k];
      m.a[6 + 2 * k] = change[k];
    }
  };
}

/// Drives a floating frame that is fixed to the hub.
inline std::function<void(Moving&)> drive_frame(const SpinUp& hub) {
  return [hub](Moving& m) {
    m.q[2] = hub.angle(m.time);
    m.v[2] = hub.rate(m.time);
    m.a[2] = hub.acceleration(m.time);
  };
}

/// The tip in axes that rotate with the hub, less the beam's length: [along, across], m.
inline Eigen::Vector2d in_hub(const Eigen::Vector2d& tip, double angle, double length) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * tip[0] + s * tip[1] - length, c * tip[1] - s * tip[0]};
}

/// ANCF: M a + f(q) = load, M constant. The sparsity is constant too, so tangents are added at
/// places found once at the start.
class AncfBody : public MovingBody {
 public:
  AncfBody(PlanarBeam beam, std::function<void(Moving&)> drive, Eigen::VectorXd load)
      : beam_(std::move(beam)),
        drive_(std::move(drive)),
        load_(std::move(load)),
        free_(free_list(beam_.structure)) {
    const Structure& s = beam_.structure;
    system_ = free_part(s, tangent(s, s.rest));
    system_ *= 0.;
    mass_values_ = values(system_ + free_part(s, beam_.mass));
    find_places();
    solver_.analyzePattern(system_);
  }

  const PlanarBeam& beam() const { return beam_; }
  const Eigen::VectorXd& mass_values() const { return mass_values_; }
  const std::vector<int>& free_unknowns() const override { return free_; }
  void prescribe(Moving& m) const override { drive_(m); }

  Eigen::VectorXd residual(const Moving& m) override {
    return picked(beam_.mass * m.a + internal_force(beam_.structure, m.q) - load_, free_);
  }

  Eigen::VectorXd solve(const Moving& m, double, double by_q,
                        const Eigen::VectorXd& residual) override {
    Eigen::Map<Eigen::VectorXd>(system_.valuePtr(), system_.nonZeros()) = mass_values_;
    Vector27 q, force;
    Matrix27 K;
    std::size_t at = 0;
    for (const Structure::Element& e : beam_.structure.elements) {
      q = m.q.segment<27>(9 * e.node[0]);
      beam_tangent(beam_.structure.laws[0], q.data(), force.data(), K.data());
      for (; at < places_.size() && places_[at].element == &e; ++at)
        system_.valuePtr()[places_[at].value] += by_q * K(places_[at].row, places_[at].column);
    }
    solver_.factorize(system_);
    return solver_.solve(residual);
  }

 private:
  struct Place {
    const Structure::Element* element;
    int row, column;
    Eigen::Index value;
  };

  static Eigen::VectorXd values(const Eigen::SparseMatrix<double>& A) {
    return Eigen::Map<const Eigen::VectorXd>(A.valuePtr(), A.nonZeros());
  }

  void find_places() {
    std::vector<int> number(index_of(beam_.structure.unknowns()), -1);
    for (std::size_t i = 0; i < free_.size(); ++i) number[index_of(free_[i])] = static_cast<int>(i);
    const double* first = system_.valuePtr();
    for (const Structure::Element& e : beam_.structure.elements)
      for (int i = 0; i < 27; ++i)
        for (int j = 0; j < 27; ++j) {
          const int row = number[index_of(9 * e.node[0] + i)];
          const int column = number[index_of(9 * e.node[0] + j)];
          if (row >= 0 && column >= 0)
            places_.push_back({&e, i, j, &system_.coeffRef(row, column) - first});
        }
  }

  PlanarBeam beam_;
  std::function<void(Moving&)> drive_;
  Eigen::VectorXd load_;
  std::vector<int> free_;
  Eigen::SparseMatrix<double> system_;
  Eigen::VectorXd mass_values_;
  std::vector<Place> places_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver_;
};

/// ANCF linearised at rest (Eq. 24): M a + K (q - rest) = load. One factorisation for all steps.
class LinearBody : public MovingBody {
 public:
  LinearBody(PlanarBeam beam, std::function<void(Moving&)> drive, Eigen::VectorXd load)
      : beam_(std::move(beam)),
        drive_(std::move(drive)),
        load_(std::move(load)),
        free_(free_list(beam_.structure)),
        stiffness_(tangent(beam_.structure, beam_.structure.rest)) {}

  const std::vector<int>& free_unknowns() const override { return free_; }
  void prescribe(Moving& m) const override { drive_(m); }
  bool linear() const override { return true; }

  Eigen::VectorXd residual(const Moving& m) override {
    return picked(beam_.mass * m.a + stiffness_ * (m.q - beam_.structure.rest) - load_, free_);
  }

  Eigen::VectorXd solve(const Moving&, double, double by_q,
                        const Eigen::VectorXd& residual) override {
    if (by_q != factored_)
      solver_.compute(
          free_part(beam_.structure, Eigen::SparseMatrix<double>(beam_.mass + by_q * stiffness_)));
    factored_ = by_q;
    return solver_.solve(residual);
  }

 private:
  PlanarBeam beam_;
  std::function<void(Moving&)> drive_;
  Eigen::VectorXd load_;
  std::vector<int> free_;
  Eigen::SparseMatrix<double> stiffness_;
  double factored_ = -1.;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver_;
};

}  // namespace railstep
