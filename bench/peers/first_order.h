#pragma once
#include <nvector/nvector_serial.h>
#include <sunmatrix/sunmatrix_band.h>

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <utility>

#include "linear_track.h"

namespace railstep {

inline void check_sundials(int code, const char* name) {
  if (code < 0) throw std::runtime_error(std::string(name) + ": " + std::to_string(code));
}

/// Settings of SUNDIALS.
struct SundialsSettings {
  double tolerance = 1e-6;  // relative; absolute: this part of 1 mm for u, of 1 m/s for v
  int order = 3;            // for IDA the largest
};

/// The moving-load scene as SUNDIALS takes it: y = (u_0, v_0, u_1, v_1 ...), numbered along x so
/// that all matrices are banded:  u' = v,  M v' = f(t) - D v - K u.
class FirstOrderTrack {
 public:
  explicit FirstOrderTrack(LinearTrack track) : track_(std::move(track)), n_(track_.unknowns()) {
    for (Eigen::VectorXd* x : {&u_, &v_, &rate_of_v_, &force_}) x->setZero(n_);
  }

  int unknowns() const { return n_; }
  /// Diagonals of a matrix over y on each side of the main one.
  int half_band() const {
    int widest = 0;
    for (const LinearTrack::Matrix* A : {&track_.mass, &track_.damping, &track_.stiffness})
      for (int i = 0; i < n_; ++i)
        for (LinearTrack::Matrix::InnerIterator it(*A, i); it; ++it)
          widest = std::max(widest, std::abs(i - static_cast<int>(it.col())));
    return 2 * widest + 1;
  }

  /// Sets y [2 unknowns] to rest.
  static void rest(N_Vector y) { N_VConst(0., y); }
  /// Sets y' [2 unknowns] at rest under the loads at their start.
  void start_rate(N_Vector rate) {
    u_.setZero();
    v_.setZero();
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> mass(
        Eigen::SparseMatrix<double>(track_.mass));
    const Eigen::VectorXd acceleration = mass.solve(pull(0.));
    N_VConst(0., rate);
    for (int i = 0; i < n_; ++i) at(rate, 2 * i + 1) = acceleration[i];
  }
  /// Sets the absolute tolerances of u and v, [2 unknowns].
  void allowed(double tolerance, N_Vector to) const {
    for (int i = 0; i < n_; ++i) {
      at(to, 2 * i) = 1e-3 * tolerance;
      at(to, 2 * i + 1) = tolerance;
    }
  }

  void take(N_Vector y) {
    for (int i = 0; i < n_; ++i) {
      u_[i] = at(y, 2 * i);
      v_[i] = at(y, 2 * i + 1);
    }
  }
  /// f - D v - K u at the y of take(), N.
  const Eigen::VectorXd& pull(double time) {
    force_.setZero();
    track_.add_loads(track_.place(time), force_);
    force_.noalias() -= track_.damping * v_;
    force_.noalias() -= track_.stiffness * u_;
    return force_;
  }
  /// The right-hand sides of u' and M v'.
  void slope(double time, N_Vector y, N_Vector to) {
    take(y);
    pull(time);
    for (int i = 0; i < n_; ++i) {
      at(to, 2 * i) = v_[i];
      at(to, 2 * i + 1) = force_[i];
    }
  }
  /// v - u' and M v' less its right-hand side.
  void residual(double time, N_Vector y, N_Vector rate, N_Vector to) {
    take(y);
    pull(time);
    for (int i = 0; i < n_; ++i) rate_of_v_[i] = at(rate, 2 * i + 1);
    force_ = -force_;
    force_.noalias() += track_.mass * rate_of_v_;
    for (int i = 0; i < n_; ++i) {
      at(to, 2 * i) = v_[i] - at(rate, 2 * i);
      at(to, 2 * i + 1) = force_[i];
    }
  }

  /// Adds sign (D v + K u) to the rows of M v', and to those of u' their v.
  void add_jacobian(SUNMatrix J, double sign) const {
    add(track_.damping, sign, 1, J);
    add(track_.stiffness, sign, 0, J);
    for (int i = 0; i < n_; ++i) entry(J, 2 * i, 2 * i + 1) += 1.;
  }
  /// Adds the factors of y': `of_u` in the rows of u', `of_v` M in those of v'.
  void add_mass(SUNMatrix to, double of_u, double of_v) const {
    add(track_.mass, of_v, 1, to);
    for (int i = 0; i < n_; ++i) entry(to, 2 * i, 2 * i) += of_u;
  }

  /// The first time from `time` on at which the loads stand on an element's border, s.
  double next_border(double time) const {
    const double passed = std::ceil(load_place(time) / track_.element_length - 1e-9);
    return (passed * track_.element_length - load_place(0.)) / kSpeed;
  }
  /// Deflection under the first load at the y of take(), m.
  double deflection(double time) const { return track_.deflection(track_.place(time), u_); }

 private:
  static double& at(N_Vector v, int i) { return N_VGetArrayPointer(v)[i]; }
  static double& entry(SUNMatrix J, int i, int j) { return SUNBandMatrix_Column(J, j)[i - j]; }
  void add(const LinearTrack::Matrix& A, double factor, int of_v, SUNMatrix J) const {
    for (int i = 0; i < n_; ++i)
      for (LinearTrack::Matrix::InnerIterator it(A, i); it; ++it)
        entry(J, 2 * i + 1, 2 * static_cast<int>(it.col()) + of_v) += factor * it.value();
  }

  LinearTrack track_;
  int n_;
  Eigen::VectorXd u_, v_, rate_of_v_, force_;  // [unknowns] m, m/s, m/s2, N; and alike for slopes
};

}  // namespace railstep
