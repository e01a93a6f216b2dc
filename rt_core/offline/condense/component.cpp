#include "offline/condense/component.h"

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <string>

#include "offline/analysis/massless.h"
#include "offline/math/refuse.h"
#include "offline/math/sparse.h"

namespace railstep {

namespace {

/// Splits rows and columns of a line's matrices into unknowns that are kept and those that follow.
struct Partition {
  std::vector<int> kept, following;  // unknowns, ascending
  Sparse pick_kept, pick_following;  // [unknowns][kept], [unknowns][following]

  Partition(const Line& line, const std::vector<int>& of_kept) : kept(of_kept) {
    const int n = line.unknowns();
    std::vector<bool> is_kept(static_cast<std::size_t>(n), false);
    for (const int unknown : kept) is_kept[static_cast<std::size_t>(unknown)] = true;
    following.reserve(static_cast<std::size_t>(n) - kept.size());
    for (int i = 0; i < n; ++i)
      if (!is_kept[static_cast<std::size_t>(i)]) following.push_back(i);
    pick_kept = picks(n, kept);
    pick_following = picks(n, following);
  }
};

/// The unknowns that follow, with those kept held.
class Held {
 public:
  Held(const Line& line, const Partition& parts)
      : line_(line),
        parts_(parts),
        stiffness_(parts.pick_following.transpose() * line.stiffness * parts.pick_following),
        factor_(stiffness_) {
    if (factor_.info() != Eigen::Success || !(factor_.vectorD().array() > 0.).all())
      refuse_free_mode(0.);
  }
  const Sparse& stiffness() const { return stiffness_; }
  /// Displacements under forces on the unknowns that follow; [unknowns][any].
  Eigen::MatrixXd under(const Eigen::MatrixXd& forces) const {
    const Eigen::MatrixXd moved = factor_.solve(Eigen::MatrixXd(forces));
    return parts_.pick_following * moved;
  }
  Eigen::MatrixXd guyan() const {
    const Sparse coupling = parts_.pick_following.transpose() * line_.stiffness * parts_.pick_kept;
    return Eigen::MatrixXd(parts_.pick_kept) - under(Eigen::MatrixXd(coupling));
  }

 private:
  const Line& line_;
  const Partition& parts_;
  Sparse stiffness_;
  Eigen::SimplicialLDLT<Sparse> factor_;
};

/// Connected part of a symmetric matrix's graph for each row, numbered by their first rows.
std::vector<std::vector<int>> connected(const Sparse& A) {
  std::vector<std::vector<int>> parts;
  std::vector<bool> visited(static_cast<std::size_t>(A.cols()), false);
  for (int start = 0; start < A.cols(); ++start) {
    if (visited[static_cast<std::size_t>(start)]) continue;
    std::vector<int> part = {start};
    visited[static_cast<std::size_t>(start)] = true;
    for (std::size_t next = 0; next < part.size(); ++next)
      for (Sparse::InnerIterator entry(A, part[next]); entry; ++entry) {
        const int row = static_cast<int>(entry.row());
        if (entry.value() == 0. || visited[static_cast<std::size_t>(row)]) continue;
        visited[static_cast<std::size_t>(row)] = true;
        part.push_back(row);
      }
    std::sort(part.begin(), part.end());
    parts.push_back(std::move(part));
  }
  return parts;
}

Eigen::MatrixXd block(const Sparse& A, const std::vector<int>& of) {
  const auto n = static_cast<Eigen::Index>(of.size());
  Eigen::MatrixXd result(n, n);
  for (Eigen::Index j = 0; j < n; ++j)
    for (Eigen::Index i = 0; i < n; ++i)
      result(i, j) = A.coeff(of[static_cast<std::size_t>(i)], of[static_cast<std::size_t>(j)]);
  return result;
}

/// Lowest modes of a part that is held around it, by 1/omega^2, which a massless unknown leaves
/// finite.
Eigen::MatrixXd lowest(const Eigen::MatrixXd& K, const Eigen::MatrixXd& M, int modes,
                       double highest_hz) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(M, K);
  if (solver.info() != Eigen::Success) refuse_free_mode(0.);
  const double least = std::isfinite(highest_hz) ? std::pow(2. * M_PI * highest_hz, -2) : 1e-30;
  const auto in_band = (solver.eigenvalues().array() > least).count();
  const Eigen::Index count = std::min<Eigen::Index>(in_band, modes);
  return solver.eigenvectors().rightCols(count);
}

}  // namespace

std::vector<int> kept_unknowns(const Track& track, const Line& line, int nodes_per_bay) {
  const int nodes = 2 * track.elements_per_bay;
  if (nodes_per_bay < 1 || nodes % nodes_per_bay != 0)
    refuse("E-CONDENSE-03", "condense.nodes_per_bay = " + std::to_string(nodes_per_bay) +
                                " does not divide the " + std::to_string(nodes) +
                                " nodes of a bay; expected a divisor of " + std::to_string(nodes));
  std::vector<int> kept;
  const auto add = [&](int unknown) {
    if (unknown >= 0 && line.mass.coeff(unknown, unknown) > 0.) kept.push_back(unknown);
  };
  for (const int rail : {0, 1})
    for (int node = 0; node <= nodes * track.bays; node += nodes / nodes_per_bay) {
      for (int k = 0; k < 9; ++k) {
        add(line.unknown(rail, node, k));
        add(line.unknown_ahead(rail, node, k));
      }
    }
  for (const auto& sleeper : line.sleeper_unknown_of)
    for (const int unknown : sleeper) add(unknown);
  std::sort(kept.begin(), kept.end());
  kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
  return kept;
}

Eigen::MatrixXd guyan_shapes(const Line& line, const std::vector<int>& kept) {
  const Partition parts(line, kept);
  return Held(line, parts).guyan();
}

Eigen::MatrixXd irs_shapes(const Line& line, const std::vector<int>& kept) {
  const Partition parts(line, kept);
  const Held held(line, parts);
  const Eigen::MatrixXd T = held.guyan();
  const Eigen::MatrixXd reduced_M = T.transpose() * (line.mass * T),
                        reduced_K = T.transpose() * (line.stiffness * T);
  const Eigen::LLT<Eigen::MatrixXd> mass(reduced_M);
  if (mass.info() != Eigen::Success)
    refuse("E-CONDENSE-04",
           "the kept unknowns of a line carry no mass; raise condense.nodes_per_bay");
  const Eigen::MatrixXd inertia = line.mass * (T * mass.solve(reduced_K));
  return T + held.under(parts.pick_following.transpose() * inertia);
}

Eigen::MatrixXd craig_bampton_shapes(const Line& line, const std::vector<int>& interface, int modes,
                                     double highest_hz) {
  const Partition parts(line, interface);
  const Held held(line, parts);
  const Sparse mass = parts.pick_following.transpose() * line.mass * parts.pick_following;
  std::vector<Eigen::VectorXd> found;
  for (const std::vector<int>& part : connected(held.stiffness())) {
    if (part.size() > static_cast<std::size_t>(kMostPartUnknowns))
      refuse("E-CONDENSE-05",
             "the seats do not cut the track into bays that move on their own: one part has " +
                 std::to_string(part.size()) + " unknowns; expected at most " +
                 std::to_string(kMostPartUnknowns) + ": raise condense.nodes_per_bay");
    const Eigen::MatrixXd shapes =
        lowest(block(held.stiffness(), part), block(mass, part), modes, highest_hz);
    for (const auto& shape : shapes.colwise()) {
      Eigen::VectorXd& all = found.emplace_back(Eigen::VectorXd::Zero(line.unknowns()));
      for (std::size_t i = 0; i < part.size(); ++i)
        all[parts.following[static_cast<std::size_t>(part[i])]] =
            shape[static_cast<Eigen::Index>(i)];
    }
  }
  const Eigen::MatrixXd guyan = held.guyan();
  Eigen::MatrixXd both(line.unknowns(), guyan.cols() + static_cast<Eigen::Index>(found.size()));
  both.leftCols(guyan.cols()) = guyan;
  for (std::size_t j = 0; j < found.size(); ++j)
    both.col(guyan.cols() + static_cast<Eigen::Index>(j)) = found[j];
  return both;
}

}  // namespace railstep
