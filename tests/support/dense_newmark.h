#pragma once
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "offline/track/track.h"
#include "support/random_scene.h"

// Doubles enter long double arithmetic here on purpose.
#pragma GCC diagnostic ignored "-Wdouble-promotion"

namespace railstep {

/// Numbers of a dense matrix or vector, row after row.
using Dense = std::vector<long double>;

/// Gauss's elimination with partial pivots.
class Eliminated {
 public:
  explicit Eliminated(Dense A, std::size_t n) : n_(n), A_(std::move(A)), row_(n) {
    for (std::size_t i = 0; i < n; ++i) row_[i] = i;
    for (std::size_t k = 0; k < n; ++k) {
      std::size_t p = k;
      for (std::size_t i = k + 1; i < n; ++i)
        if (std::fabs(at(i, k)) > std::fabs(at(p, k))) p = i;
      std::swap(row_[k], row_[p]);
      for (std::size_t i = k + 1; i < n; ++i) {
        if (at(i, k) == 0.L) continue;
        const long double factor = at(i, k) /= at(k, k);
        for (std::size_t j = k + 1; j < n; ++j) at(i, j) -= factor * at(k, j);
      }
    }
  }
  Dense solve(const Dense& b) const {
    Dense x(n_);
    for (std::size_t i = 0; i < n_; ++i) {
      x[i] = b[row_[i]];
      for (std::size_t j = 0; j < i; ++j) x[i] -= at(i, j) * x[j];
    }
    for (std::size_t i = n_; i-- > 0;) {
      for (std::size_t j = i + 1; j < n_; ++j) x[i] -= at(i, j) * x[j];
      x[i] /= at(i, i);
    }
    return x;
  }

 private:
  long double& at(std::size_t i, std::size_t j) { return A_[row_[i] * n_ + j]; }
  const long double& at(std::size_t i, std::size_t j) const { return A_[row_[i] * n_ + j]; }
  std::size_t n_;
  Dense A_;
  std::vector<std::size_t> row_;
};

/// The vertical force of a load at a time, N.
inline long double force_of(const RandomLoad& load, long double t) {
  const auto& rows = load.table;
  long double factor = 1.L;
  if (!rows.empty()) {
    factor = t < rows.front().first ? 0.L : rows.back().second;
    for (std::size_t i = 0; i + 1 < rows.size(); ++i)
      if (t >= rows[i].first && t < rows[i + 1].first)
        factor = rows[i].second + (rows[i + 1].second - rows[i].second) * (t - rows[i].first) /
                                      (rows[i + 1].first - rows[i].first);
  }
  return load.force * factor +
         load.amplitude * std::sin(2.L * std::numbers::pi_v<long double> * load.frequency * t);
}

/// One line of a track with dense matrices: M a + C v + K u = f by the trapezoidal rule (Newmark
/// 1959, gamma 1/2 and beta 1/4).
class DenseNewmark {
 public:
  struct Motion {
    Dense u, v, a;
  };

  DenseNewmark(const Track& track, const Line& line, std::vector<RandomLoad> loads)
      : track_(track),
        line_(line),
        loads_(std::move(loads)),
        n_(static_cast<std::size_t>(line.unknowns())),
        M_(dense(line.mass)),
        C_(dense(line.damping)),
        K_(dense(line.stiffness)) {}

  std::size_t unknowns() const { return n_; }
  Motion at_rest() const { return {Dense(n_, 0.L), Dense(n_, 0.L), Dense(n_, 0.L)}; }

  /// Forces of the loads on the unknowns, each by the row of its point.
  Dense force(long double t) const {
    Dense f(n_, 0.L);
    for (const RandomLoad& load : loads_) {
      const double x = static_cast<double>(load.start + load.speed * t);
      const Eigen::VectorXd row = point_row(track_, line_, {0, x, 0., 0., 2});
      for (std::size_t i = 0; i < n_; ++i)
        f[i] += force_of(load, t) * row[static_cast<Eigen::Index>(i)];
    }
    return f;
  }

  /// Displacements after every step. Each step is taken in `parts`, over which forces are linear.
  std::vector<Dense> run(Motion m, double dt, int steps, int parts) const {
    const long double h = static_cast<long double>(dt) / parts;
    const Eliminated S(matrix(h), n_);
    std::vector<Dense> all;
    Dense before = force(0.L);
    for (int n = 1; n <= steps; ++n) {
      const Dense after = force(static_cast<long double>(dt) * n);
      for (int k = 1; k <= parts; ++k) {
        Dense f(n_);
        for (std::size_t i = 0; i < n_; ++i) f[i] = before[i] + (after[i] - before[i]) * k / parts;
        step(S, h, f, m);
      }
      before = after;
      all.push_back(m.u);
    }
    return all;
  }

  /// K + 2/h C + 4/h^2 M.
  Dense matrix(long double h) const {
    Dense S(n_ * n_);
    for (std::size_t i = 0; i < S.size(); ++i)
      S[i] = K_[i] + 2.L / h * C_[i] + 4.L / (h * h) * M_[i];
    return S;
  }

  /// Condition of that matrix, scaled to a diagonal of 1.
  double condition(double h) const {
    const Dense S = matrix(h);
    const auto n = static_cast<Eigen::Index>(n_);
    Eigen::MatrixXd scaled(n, n);
    for (std::size_t i = 0; i < n_; ++i)
      for (std::size_t j = 0; j < n_; ++j)
        scaled(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
            static_cast<double>(S[i * n_ + j] / std::sqrt(S[i * n_ + i] * S[j * n_ + j]));
    const Eigen::VectorXd values =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled, Eigen::EigenvaluesOnly)
            .eigenvalues();
    return values[n - 1] / values[0];
  }

 private:
  Dense dense(const Eigen::SparseMatrix<double>& A) const {
    const Eigen::MatrixXd all(A);
    Dense to(n_ * n_);
    for (std::size_t i = 0; i < n_; ++i)
      for (std::size_t j = 0; j < n_; ++j)
        to[i * n_ + j] = all(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
    return to;
  }

  void step(const Eliminated& S, long double h, Dense f, Motion& m) const {
    for (std::size_t i = 0; i < n_; ++i)
      for (std::size_t j = 0; j < n_; ++j) {
        const std::size_t at = i * n_ + j;
        if (M_[at] != 0.L) f[i] += M_[at] * (4.L / (h * h) * m.u[j] + 4.L / h * m.v[j] + m.a[j]);
        if (C_[at] != 0.L) f[i] += C_[at] * (2.L / h * m.u[j] + m.v[j]);
      }
    const Dense u = S.solve(f);
    for (std::size_t i = 0; i < n_; ++i) {
      const long double v = 2.L / h * (u[i] - m.u[i]) - m.v[i];
      m.a[i] = 2.L / h * (v - m.v[i]) - m.a[i];
      m.v[i] = v;
    }
    m.u = u;
  }

  const Track& track_;
  const Line& line_;
  std::vector<RandomLoad> loads_;
  std::size_t n_;
  Dense M_, C_, K_;
};

}  // namespace railstep
