#pragma once
#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <array>

#include "support/beam_energy.h"
#include "support/pendulum_reference.h"
#include "support/planar_beam.h"

namespace railstep {

/// The double pendulum of ANCF beams as an ordinary differential equation, M q'' + f(q) = g with M
/// constant; y = (q, q'). Unknowns are planar, node after node along both links: r_x r_z a_y b_x
/// b_z. A has no r, and both nodes of the hinge share theirs. Unknowns out of the plane stay 0.
class AncfPendulum {
 public:
  AncfPendulum(const DoublePendulum& scene, int elements) {
    const PlanarBeam one =
        planar_beam(scene.section(), scene.material, scene.link / elements, 1);  // one element
    law_ = one.structure.laws[0];
    number_nodes(elements);
    number_elements(elements);
    rest_ = Eigen::VectorXd::Zero(unknowns_);
    Eigen::VectorXd uniform = rest_;
    for (int n = 0; n < 2 * nodes_; ++n) {
      const double x = .5 * one.length * (n < nodes_ ? n : n - 1);
      const double at_rest[5] = {x, 0., 1., 0., 1.};
      for (int k = 0; k < 5; ++k)
        if (place(n, k) >= 0) rest_[place(n, k)] = at_rest[k];
      for (int k = 0; k < 2; ++k)
        if (place(n, k) >= 0) uniform[place(n, k)] = scene.gravity[k];
    }
    assemble_mass(Eigen::MatrixXd(one.mass));
    weight_ = mass_ * uniform;
    solver_.compute(mass_);
    find_frequency(one);
  }

  int unknowns() const { return unknowns_; }
  /// Largest index difference of two unknowns of one element.
  int half_band() const { return half_band_; }
  /// Upper bound of the frequencies about rest, rad/s: the highest of one free element (Irons and
  /// Treharne).
  double highest_frequency() const { return highest_; }
  const Eigen::SparseMatrix<double>& mass() const { return mass_; }

  Eigen::VectorXd start() const {
    Eigen::VectorXd y = Eigen::VectorXd::Zero(2 * unknowns_);
    y.head(unknowns_) = rest_;
    return y;
  }

  /// f(q) - g with q the first half of y.
  void residual_force(const Eigen::VectorXd& y, Eigen::VectorXd& force) const {
    force = -weight_;
    Local local, f;
    for (const Places& e : elements_) {
      gather(e, y, local);
      beam_force(law_, local.data(), f.data());
      for (std::size_t i = 0; i < 27; ++i)
        if (e[i] >= 0) force[e[i]] += f[i];
    }
  }

  void slope(const Eigen::VectorXd& y, Eigen::VectorXd& dy) const {
    Eigen::VectorXd force;
    residual_force(y, force);
    dy.head(unknowns_) = y.tail(unknowns_);
    dy.tail(unknowns_) = -solver_.solve(force);
  }

  /// Calls add(row, column, value) for every entry of each element's d2U/dq2.
  template <typename Add>
  void tangent(const Eigen::VectorXd& y, Add add) const {
    Local local, f;
    std::array<double, 27 * 27> K;
    for (const Places& e : elements_) {
      gather(e, y, local);
      beam_tangent(law_, local.data(), f.data(), K.data());
      for (std::size_t i = 0; i < 27; ++i)
        for (std::size_t j = 0; j < 27; ++j)
          if (e[i] >= 0 && e[j] >= 0) add(e[i], e[j], K[27 * i + j]);
    }
  }

  /// Kinetic, strain and gravitational energy, J; the last is 0 at A's height.
  double energy(const Eigen::VectorXd& y) const {
    const Eigen::VectorXd v = y.tail(unknowns_);
    double sum = .5 * v.dot(mass_ * v) - weight_.dot(y.head(unknowns_));
    Local local;
    for (const Places& e : elements_) {
      gather(e, y, local);
      sum += beam_energy(law_, local.data());
    }
    return sum;
  }

  HingeAndEnd seen(const Eigen::VectorXd& y) const {
    const int end = 2 * nodes_ - 1;
    return {y[place(nodes_, 0)], y[place(nodes_, 1)], y[place(end, 0)], y[place(end, 1)]};
  }

 private:
  using Places = std::array<int, 27>;  // of an element's unknowns; -1: held at 0
  using Local = std::array<double, 27>;

  int place(int node, int k) const { return places_[index_of(node)][index_of(k)]; }

  void number_nodes(int elements) {
    nodes_ = 2 * elements + 1;  // of a link
    for (int n = 0; n < 2 * nodes_; ++n) {
      std::array<int, 5> at{};
      for (int k = 0; k < 5; ++k) {
        const bool pinned = n == 0 && k < 2, shared = n == nodes_ && k < 2;
        at[index_of(k)] = pinned ? -1 : shared ? place(n - 1, k) : unknowns_++;
      }
      places_.push_back(at);
    }
  }

  void number_elements(int elements) {
    constexpr int kPlanar[5] = {0, 2, 4, 6, 8};  // among the nine unknowns of a node in space
    for (int e = 0; e < 2 * elements; ++e) {
      const int first = e < elements ? 2 * e : nodes_ + 2 * (e - elements);
      Places of;
      of.fill(-1);
      for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 5; ++k) of[index_of(9 * i + kPlanar[k])] = place(first + i, k);
      elements_.push_back(of);
      for (const int i : of)
        for (const int j : of)
          if (i >= 0 && j >= 0) half_band_ = std::max(half_band_, std::abs(i - j));
    }
  }

  void assemble_mass(const Eigen::MatrixXd& one) {
    std::vector<Eigen::Triplet<double>> entries;
    for (const Places& e : elements_)
      for (int i = 0; i < 27; ++i)
        for (int j = 0; j < 27; ++j)
          if (e[index_of(i)] >= 0 && e[index_of(j)] >= 0 && one(i, j) != 0.)
            entries.emplace_back(e[index_of(i)], e[index_of(j)], one(i, j));
    mass_.resize(unknowns_, unknowns_);
    mass_.setFromTriplets(entries.begin(), entries.end());
  }

  void find_frequency(const PlanarBeam& one) {
    const Structure& s = one.structure;
    const Eigen::MatrixXd M(free_part(s, one.mass)), K(free_part(s, railstep::tangent(s, s.rest)));
    highest_ = std::sqrt(
        Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(K, M, Eigen::EigenvaluesOnly)
            .eigenvalues()
            .maxCoeff());
  }

  static void gather(const Places& e, const Eigen::VectorXd& y, Local& local) {
    for (std::size_t i = 0; i < 27; ++i) local[i] = e[i] < 0 ? 0. : y[e[i]];
  }

  int nodes_ = 0, unknowns_ = 0, half_band_ = 0;
  double highest_ = 0.;
  Beam law_{};
  std::vector<std::array<int, 5>> places_;  // of each node's planar unknowns
  std::vector<Places> elements_;
  Eigen::VectorXd rest_, weight_;
  Eigen::SparseMatrix<double> mass_;
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> solver_;
};

}  // namespace railstep
