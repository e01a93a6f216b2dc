#pragma once
#include <Eigen/SparseCholesky>
#include <stdexcept>
#include <utility>
#include <vector>

#include "linear_track.h"

namespace railstep {

/// The moving-load scene written with Eigen alone: generalised-alpha (Chung and Hulbert 1993, with
/// equilibrium at the step's end: Arnold and Bruls 2007), solved for the acceleration g at the end,
///   (M + dt gamma c D + dt^2 beta c K) g = f - D v* - K u*,   c = (1 - alpha_f)/(1 - alpha_m),
/// by a sparse Cholesky factor made once. A step allocates nothing: the unknowns are numbered
/// beforehand, so that the solver needs no permutation, and products go straight to their place.
class EigenPeer {
 public:
  EigenPeer(LinearTrack track, int passage_steps, double dt = kStep, int steps_per_frame = 1)
      : track_(std::move(track)),
        frames_(passage_steps),
        steps_per_frame_(steps_per_frame),
        dt_(dt) {
    const double alpha_m = (2. * kRhoInf - 1.) / (kRhoInf + 1.), alpha_f = kRhoInf / (kRhoInf + 1.);
    const double gamma = .5 - alpha_m + alpha_f;
    const double beta = .25 * (1. - alpha_m + alpha_f) * (1. - alpha_m + alpha_f);
    ag_ = (1. - alpha_f) / (1. - alpha_m);
    a_old_ = -alpha_m / (1. - alpha_m);
    g_old_ = alpha_f / (1. - alpha_m);
    ua_old_ = dt * dt * (.5 - beta);
    ua_ = dt * dt * beta;
    va_old_ = dt * (1. - gamma);
    va_ = dt * gamma;
    solver_.analyzePattern(lower(track_));
    solver_.factorize(lower(track_));
    if (solver_.info() != Eigen::Success) throw std::runtime_error("the step's matrix is singular");
    for (Eigen::VectorXd* x : {&u_, &v_, &a_, &g_, &rhs_}) x->setZero(track_.unknowns());
  }

  /// One frame of 1 ms from the last one's end; returns the deflection under the first load, m.
  double frame() {
    if (done_ == frames_ * steps_per_frame_) restart();
    LinearTrack::Place at{};
    for (int i = 0; i < steps_per_frame_; ++i) at = step();
    return track_.deflection(at, u_);
  }

  void restart() {
    for (Eigen::VectorXd* x : {&u_, &v_, &a_, &g_}) x->setZero();
    done_ = 0;
  }

  int frames() const { return frames_; }
  int unknowns() const { return track_.unknowns(); }
  /// Additions, subtractions, multiplications and divisions of a frame, without those at a load.
  double flops() const {
    const auto n = static_cast<double>(unknowns());
    const auto products =
        static_cast<double>(track_.stiffness.nonZeros() + track_.damping.nonZeros());
    return steps_per_frame_ * (2. * products + 4. * fill() + 20. * n);
  }
  /// Entries of the factor below its diagonal.
  double fill() const {
    return static_cast<double>(solver_.matrixL().nestedExpression().nonZeros());
  }

 private:
  using Solver =
      Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower, Eigen::NaturalOrdering<int>>;

  Eigen::SparseMatrix<double> lower(const LinearTrack& t) const {
    const LinearTrack::Matrix S = t.mass + ag_ * va_ * t.damping + ag_ * ua_ * t.stiffness;
    return Eigen::SparseMatrix<double>(S).triangularView<Eigen::Lower>();
  }

  LinearTrack::Place step() {
    const LinearTrack::Place at = track_.place(++done_ * dt_);
    // Computes a without this step's acceleration, then u* and v* in place of u and v.
    u_ += dt_ * v_ + ua_old_ * a_;
    v_ += va_old_ * a_;
    a_ = a_old_ * a_ + g_old_ * g_;
    u_ += ua_ * a_;
    v_ += va_ * a_;
    rhs_.setZero();
    track_.add_loads(at, rhs_);
    rhs_.noalias() -= track_.stiffness * u_;
    rhs_.noalias() -= track_.damping * v_;
    g_ = solver_.solve(rhs_);
    u_ += (ag_ * ua_) * g_;
    v_ += (ag_ * va_) * g_;
    a_ += ag_ * g_;
    return at;
  }

  LinearTrack track_;
  int frames_, steps_per_frame_, done_ = 0;
  double dt_, ag_, a_old_, g_old_, ua_old_, ua_, va_old_, va_;
  Solver solver_;
  Eigen::VectorXd u_, v_, a_, g_, rhs_;  // [unknowns] m, m/s, m/s2, m/s2, N and alike for slopes
};

}  // namespace railstep
