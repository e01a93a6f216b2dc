#pragma once
#include <Eigen/Core>
#include <stdexcept>
#include <vector>

namespace railstep {

/// A mechanical system at one time. Some unknowns may be prescribed; the others are free.
struct Moving {
  Eigen::VectorXd q, v, a;  // [unknowns]; a is the true acceleration
  Eigen::VectorXd carried;  // [unknowns], the scheme's own acceleration
  double time = 0.;         // s
};

/// The entries, or rows and columns, of a list. (g++ 12 warns of Eigen's own indexing by a vector.)
inline Eigen::VectorXd picked(const Eigen::VectorXd& v, const std::vector<int>& list) {
  Eigen::VectorXd result(static_cast<Eigen::Index>(list.size()));
  for (std::size_t i = 0; i < list.size(); ++i) result[static_cast<Eigen::Index>(i)] = v[list[i]];
  return result;
}
inline Eigen::MatrixXd picked_square(const Eigen::MatrixXd& A, const std::vector<int>& list) {
  const auto n = static_cast<Eigen::Index>(list.size());
  Eigen::MatrixXd result(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      result(i, j) = A(list[static_cast<std::size_t>(i)], list[static_cast<std::size_t>(j)]);
  return result;
}

/// Motion at rest at q: v = a = 0 at time 0.
inline Moving at_rest(const Eigen::VectorXd& q) {
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(q.size());
  return {q, zero, zero, zero};
}

/// Equations of motion R(q, v, a, t) = M a + forces = 0, as the time scheme uses them.
class MovingBody {
 public:
  MovingBody() = default;
  MovingBody(const MovingBody&) = delete;
  MovingBody& operator=(const MovingBody&) = delete;
  virtual ~MovingBody() = default;
  /// Unknowns that are solved for.
  virtual const std::vector<int>& free_unknowns() const = 0;
  /// Sets q, v, a of the prescribed unknowns at motion.time.
  virtual void prescribe(Moving& motion) const = 0;
  virtual Eigen::VectorXd residual(const Moving& motion) = 0;  // [free]
  /// (dR/da + by_v dR/dv + by_q dR/dq)^-1 residual, [free].
  virtual Eigen::VectorXd solve(const Moving& motion, double by_v, double by_q,
                                const Eigen::VectorXd& residual) = 0;
  /// Whether R is linear and its matrix exact: one solve then ends the step.
  virtual bool linear() const { return false; }
};

/// Sets the acceleration that the equations give at the start.
inline void start(MovingBody& body, Moving& m) {
  body.prescribe(m);
  const Eigen::VectorXd change = body.solve(m, 0., 0., body.residual(m));
  const std::vector<int>& free = body.free_unknowns();
  for (std::size_t i = 0; i < free.size(); ++i) m.a[free[i]] -= change[static_cast<int>(i)];
  m.carried = m.a;
}

/// Generalised-alpha (Chung and Hulbert 1993) in the form of Arnold and Bruels (2007), which keeps
/// equilibrium at the end of the step: second order for mass matrices that change, and for
/// prescribed motion without a lag.
class GeneralisedAlpha {
 public:
  /// @param step     h, s
  /// @param rho_inf  0 to 1; 1 does not damp
  GeneralisedAlpha(double step, double rho_inf)
      : h_(step),
        alpha_m_((2. * rho_inf - 1.) / (rho_inf + 1.)),
        alpha_f_(rho_inf / (rho_inf + 1.)) {
    gamma_ = .5 + alpha_f_ - alpha_m_;
    beta_ = .25 * (gamma_ + .5) * (gamma_ + .5);
  }

  /// One step. Newton ends when the last change of every unknown is below `tolerance` (units of q)
  /// or is only round-off.
  /// @return number of solves
  /// @throws std::runtime_error after 40 solves
  int advance(MovingBody& body, Moving& m, double tolerance) const {
    const Moving old = m;
    const double share = (1. - alpha_f_) / (1. - alpha_m_);
    m.time = old.time + h_;
    set(old, m);
    for (int solves = 1; solves <= 40; ++solves) {
      body.prescribe(m);
      const Eigen::VectorXd change =
          body.solve(m, h_ * gamma_ * share, h_ * h_ * beta_ * share, body.residual(m));
      const std::vector<int>& free = body.free_unknowns();
      for (std::size_t i = 0; i < free.size(); ++i) m.a[free[i]] -= change[static_cast<int>(i)];
      set(old, m);
      body.prescribe(m);
      const double moved = change.cwiseAbs().maxCoeff() * h_ * h_ * beta_ * share;
      if (body.linear() || moved <= tolerance) return solves;
    }
    throw std::runtime_error("a time step of a moving body does not converge");
  }

 private:
  /// q, v and the carried acceleration that belong to m.a.
  void set(const Moving& old, Moving& m) const {
    m.carried =
        ((1. - alpha_f_) * m.a + alpha_f_ * old.a - alpha_m_ * old.carried) / (1. - alpha_m_);
    m.v = old.v + h_ * ((1. - gamma_) * old.carried + gamma_ * m.carried);
    m.q = old.q + h_ * old.v + h_ * h_ * ((.5 - beta_) * old.carried + beta_ * m.carried);
  }

  double h_, alpha_m_, alpha_f_, gamma_, beta_;
};

}  // namespace railstep
