#pragma once
#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "offline/track/track.h"

namespace railstep {

/// A line of a track with dense matrices, M u'' + C u' + K u = b f(t), from rest.
struct DenseLine {
  Eigen::MatrixXd M, C, K;
  Eigen::VectorXd b;

  DenseLine(const Track& track, const Line& line, const RailPoint& at)
      : M(line.mass), C(line.damping), K(line.stiffness), b(point_row(track, line, at)) {}
};

/// Generalised-alpha as printed by Chung and Hulbert 1993, eqs. 1 to 5. Its members are Newmark
/// (alpha_m = alpha_f = 0) and HHT (Hughes 2000, eqs. 9.3.1 to 9.3.3: alpha_m = 0):
///   M a_m + C v_f + K d_f = F_f,  x_m = (1 - alpha_m) x1 + alpha_m x0,  x_f alike with alpha_f,
///   d1 = d0 + h v0 + h^2 [(1/2 - beta) a0 + beta a1],   v1 = v0 + h [(1 - gamma) a0 + gamma a1].
struct Textbook {
  double alpha_m, alpha_f, beta, gamma;
};

struct DenseMotion {
  Eigen::VectorXd u, v, a;
};

/// Solves these for a1, step by step. f(n) is the force at step n; f(0) = 0, so a0 = 0.
template <typename Force>
std::vector<DenseMotion> by_textbook(const DenseLine& line, const Textbook& t, double h, int steps,
                                     const Force& f) {
  const Eigen::MatrixXd S = (1. - t.alpha_m) * line.M +
                            (1. - t.alpha_f) * (h * t.gamma * line.C + h * h * t.beta * line.K);
  const Eigen::LDLT<Eigen::MatrixXd> solver(S);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(line.b.size());
  std::vector<DenseMotion> all{{zero, zero, zero}};
  for (int n = 1; n <= steps; ++n) {
    const DenseMotion& old = all.back();
    const Eigen::VectorXd u = old.u + h * old.v + h * h * (.5 - t.beta) * old.a;
    const Eigen::VectorXd v = old.v + h * (1. - t.gamma) * old.a;
    const double force = (1. - t.alpha_f) * f(n) + t.alpha_f * f(n - 1);
    const Eigen::VectorXd a = solver.solve(line.b * force - t.alpha_m * (line.M * old.a) -
                                           line.C * ((1. - t.alpha_f) * v + t.alpha_f * old.v) -
                                           line.K * ((1. - t.alpha_f) * u + t.alpha_f * old.u));
    all.push_back({u + h * h * t.beta * a, v + h * t.gamma * a, a});
  }
  return all;
}

/// TR-BDF2 as Bank et al. 1985 print it, on y = [u, v]: y' = A y + b f(t).
///   y_g = y0 + gamma h/2 (y0' + y_g'),
///   y1 = [y_g - (1 - gamma)^2 y0] / [gamma (2 - gamma)] + (1 - gamma)/(2 - gamma) h y1'.
/// @param f  of time, s
template <typename Force>
std::vector<DenseMotion> by_tr_bdf2(const DenseLine& line, double h, int steps, const Force& f) {
  const double gamma = 2. - std::sqrt(2.);
  const Eigen::Index n = line.b.size();
  const Eigen::LDLT<Eigen::MatrixXd> heavy(line.M);
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  A.topRightCorner(n, n).setIdentity();
  A.bottomLeftCorner(n, n) = -heavy.solve(line.K);
  A.bottomRightCorner(n, n) = -heavy.solve(line.C);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(2 * n), y = b;
  b.tail(n) = heavy.solve(line.b);
  const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(2 * n, 2 * n);
  const Eigen::PartialPivLU<Eigen::MatrixXd> first(I - .5 * gamma * h * A);
  const Eigen::PartialPivLU<Eigen::MatrixXd> second(I - (1. - gamma) / (2. - gamma) * h * A);
  std::vector<DenseMotion> all{{y.head(n), y.tail(n), y.tail(n)}};
  for (int i = 0; i < steps; ++i) {
    const double t = i * h;
    const Eigen::VectorXd stage =
        first.solve(y + .5 * gamma * h * (A * y + b * (f(t) + f(t + gamma * h))));
    const Eigen::VectorXd past = (stage - (1. - gamma) * (1. - gamma) * y) / (gamma * (2. - gamma));
    y = second.solve(past + (1. - gamma) / (2. - gamma) * h * (b * f(t + h)));
    const Eigen::VectorXd rate = A * y + b * f(t + h);
    all.push_back({y.head(n), y.tail(n), rate.tail(n)});
  }
  return all;
}

/// e^A by the series of A / 2^n and n squarings.
inline Eigen::MatrixXd exponential(const Eigen::MatrixXd& A) {
  int squarings = 0;
  double size = A.cwiseAbs().rowwise().sum().maxCoeff();
  for (; size > .5; size *= .5) ++squarings;
  const Eigen::MatrixXd small = A * std::pow(2., -squarings);
  Eigen::MatrixXd term = Eigen::MatrixXd::Identity(A.rows(), A.cols()), sum = term;
  for (int k = 1; k < 16; ++k) sum += term = term * small / k;
  for (int n = 0; n < squarings; ++n) sum = sum * sum;
  return sum;
}

/// Exact u under f(t) = 1 - cos(omega t) at every h: the force's own three states are added to the
/// equation of motion. In the energy's coordinates [L' u, R' v], K = L L', M = R R', it is a
/// rotation and a decay, so squaring does not lose digits.
inline std::vector<Eigen::VectorXd> exact_response(const DenseLine& line, double omega, double h,
                                                   int steps) {
  const Eigen::Index n = line.b.size();
  const Eigen::LLT<Eigen::MatrixXd> stiff(line.K), heavy(line.M);
  const Eigen::MatrixXd L = stiff.matrixL(), R = heavy.matrixL();
  const Eigen::MatrixXd R_inverse = R.inverse();
  const Eigen::MatrixXd turn = L.transpose() * R_inverse.transpose();  // (L' u)' = turn (R' v)
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2 * n + 3, 2 * n + 3);
  A.topRightCorner(n, n + 3).leftCols(n) = turn;
  A.block(n, 0, n, n) = -turn.transpose();
  A.block(n, n, n, n) = -R_inverse * line.C * R_inverse.transpose();
  A.block(n, 2 * n, n, 1) = R_inverse * line.b;
  A.block(n, 2 * n + 1, n, 1) = -R_inverse * line.b;
  A(2 * n + 1, 2 * n + 2) = -omega;  // of cos, sin
  A(2 * n + 2, 2 * n + 1) = omega;
  const Eigen::MatrixXd step = exponential(h * A);
  Eigen::VectorXd y = Eigen::VectorXd::Zero(2 * n + 3);
  y[2 * n] = y[2 * n + 1] = 1.;
  std::vector<Eigen::VectorXd> all;
  for (int i = 0; i <= steps; ++i, y = step * y)
    all.push_back(stiff.matrixU().solve(Eigen::VectorXd(y.head(n))));
  return all;
}

}  // namespace railstep
