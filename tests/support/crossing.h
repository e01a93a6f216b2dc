#pragma once
#include <Eigen/LU>
#include <cmath>
#include <vector>

#include "offline/track/track.h"
#include "offline/vehicle/vehicle.h"
#include "online/model/signal.h"

namespace railstep {

/// A beam on pinned ends, one bay of a vertical track.
inline Track pinned_beam(const BeamSection& section, const Material& material, double length,
                         int elements) {
  Track t;
  t.section = section;
  t.material = material;
  t.unknowns = Unknowns::vertical;
  t.rails = 1;
  t.bay_length = length;
  t.elements_per_bay = elements;
  t.ends = {RailEnd::pinned, RailEnd::pinned};
  return t;
}

/// Vertical modes of the same Timoshenko beam in closed form: sin(n pi x/L), for each n a lower and
/// an upper branch (test_fryba.cpp has their equations).
struct PinnedModes {
  double length;
  std::vector<double> wave, natural, height;  // 1/m, 1/s, kg^-1/2: phi = height sin(wave x)

  PinnedModes(const Track& t, int count) : length(t.length()) {
    const double m = t.material.density * t.section.area;
    const double r = t.material.density * t.section.inertia_y;
    const double B = t.material.young * t.section.inertia_y;
    const double S = t.section.shear_factor_z * t.material.shear_modulus() * t.section.area;
    for (int n = 1; n <= count; ++n) {
      const double k = n * M_PI / length;
      const double a = S * k * k / m, d = (S + B * k * k) / r, b2 = S * S * k * k / (m * r);
      const double high = .5 * (a + d + std::sqrt((a - d) * (a - d) + 4. * b2));
      const double low = S * k * k * B * k * k / (m * r) / high;
      for (const double lambda : {low, high}) {
        const double turn = (d - lambda) * (d - lambda) / b2;
        wave.push_back(k);
        natural.push_back(std::sqrt(lambda));
        height.push_back(std::sqrt(2. / length * turn / (1. + turn) / m));
      }
    }
  }
  Eigen::Index count() const { return static_cast<Eigen::Index>(wave.size()); }
  /// All modes at x, or their first or second derivative; 0 off the beam.
  Eigen::VectorXd at(double x, int derivative = 0) const {
    Eigen::VectorXd phi = Eigen::VectorXd::Zero(count());
    if (x < 0. || x > length) return phi;
    for (Eigen::Index i = 0; i < count(); ++i) {
      const auto n = static_cast<std::size_t>(i);
      const double k = wave[n];
      phi[i] = height[n] * (derivative == 1   ? k * std::cos(k * x)
                            : derivative == 2 ? -k * k * std::sin(k * x)
                                              : std::sin(k * x));
    }
    return phi;
  }
  Eigen::VectorXd squares() const {
    Eigen::VectorXd s(count());
    for (Eigen::Index i = 0; i < count(); ++i)
      s[i] = natural[static_cast<std::size_t>(i)] * natural[static_cast<std::size_t>(i)];
    return s;
  }
};

/// Newmark's rule with constant mean acceleration for M a + C v + K u = f, whose matrices change
/// from step to step. It is of second order and has no damping of its own.
struct Newmark {
  Eigen::VectorXd u, v, a;
  void step(const Eigen::MatrixXd& M, const Eigen::MatrixXd& C, const Eigen::MatrixXd& K,
            const Eigen::VectorXd& f, double dt) {
    const Eigen::VectorXd u_star = u + dt * v + .25 * dt * dt * a, v_star = v + .5 * dt * a;
    const Eigen::MatrixXd A = M + .5 * dt * C + .25 * dt * dt * K;
    a = A.partialPivLu().solve(f - C * v_star - K * u_star);
    u = u_star + .25 * dt * dt * a;
    v = v_star + .5 * dt * a;
  }
};

/// A vehicle with springs under its wheels crosses a beam, from the ground before it to the ground
/// behind it. The beam's modes and the vehicle's coordinates are one system whose rows move.
struct ModalCrossing {
  PinnedModes modes;
  Vehicle vehicle;
  VehicleMatrices m;
  double start, speed, stiffness, damping;  // of each contact
  SignalModel rough{};                      // height of the beam's head over its line
  Newmark run;
  double time = 0.;
  int steps = 0;

  ModalCrossing(const Track& beam, int count, const Vehicle& what, double from, double v, double k,
                double c = 0.)
      : modes(beam, count),
        vehicle(what),
        m(vehicle_matrices(what)),
        start(from),
        speed(v),
        stiffness(k),
        damping(c) {
    // At rest on the ground: K u - B'(-k B u) = -weight.
    const Eigen::Index n = modes.count(), all = n + m.weight.size();
    run.u = run.v = run.a = Eigen::VectorXd::Zero(all);
    run.u.tail(m.weight.size()) =
        -(m.stiffness + k * m.wheels.transpose() * m.wheels).partialPivLu().solve(m.weight);
  }
  double place(Eigen::Index wheel) const {
    return start + speed * time + vehicle.wheels[static_cast<std::size_t>(wheel)].place;
  }
  /// Parts of the contacts' forces due to the head's height, N.
  Eigen::VectorXd rough_forces() const {
    Eigen::VectorXd f = Eigen::VectorXd::Zero(m.wheels.rows());
    for (Eigen::Index i = 0; i < f.size(); ++i) {
      if (place(i) < 0. || place(i) > modes.length) continue;
      const SignalValue at = signal_at(rough, place(i));
      f[i] = stiffness * at.value + damping * speed * at.slope;
    }
    return f;
  }
  /// Penetration rows of the wheels, [wheels][all], or their derivative along x.
  Eigen::MatrixXd rows(int derivative) const {
    const Eigen::Index n = modes.count();
    Eigen::MatrixXd r(m.wheels.rows(), n + m.weight.size());
    for (Eigen::Index i = 0; i < r.rows(); ++i) {
      r.row(i).head(n) = modes.at(place(i), derivative).transpose();
    }
    r.rightCols(m.weight.size()) = (derivative == 0 ? -1. : 0.) * m.wheels;
    return r;
  }
  void step(double dt) {
    time = ++steps * dt;
    const Eigen::Index n = modes.count(), own = m.weight.size();
    const Eigen::MatrixXd row = rows(0), along = rows(1);
    Eigen::MatrixXd M = Eigen::MatrixXd::Identity(n + own, n + own);
    M.bottomRightCorner(own, own) = m.mass;
    Eigen::MatrixXd C = damping * row.transpose() * row;
    C.bottomRightCorner(own, own) += m.damping;
    Eigen::MatrixXd K = row.transpose() * (stiffness * row + damping * speed * along);
    K.topLeftCorner(n, n).diagonal() += modes.squares();
    K.bottomRightCorner(own, own) += m.stiffness;
    Eigen::VectorXd f = -row.transpose() * rough_forces();
    f.tail(own) -= m.weight;
    run.step(M, C, K, f, dt);
  }
  /// Forces of the rail on the wheels, N.
  Eigen::VectorXd forces() const {
    return rough_forces() + stiffness * (rows(0) * run.u) +
           damping * (rows(0) * run.v + speed * rows(1) * run.u);
  }
  double midspan() const { return modes.at(.5 * modes.length).dot(run.u.head(modes.count())); }
  double body(int coordinate) const { return run.u[modes.count() + coordinate]; }
};

}  // namespace railstep
