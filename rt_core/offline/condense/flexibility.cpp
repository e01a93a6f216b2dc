#include "offline/condense/flexibility.h"

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>
#include <stdexcept>

namespace railstep {

namespace {

using Factor = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>;

/// An element seen from its two end nodes: stiffness between them, and for the loaded point at each
/// sampled place its displacement under unit end displacements and its flexibility with ends held.
struct Condensed {
  Eigen::MatrixXd stiffness;  // [2d][2d]
  Eigen::MatrixXd shapes;     // [places][2d]
  Eigen::VectorXd held;       // [places], m/N
};

/// Unknowns of a node that a line carries, from the first node that carries any.
std::vector<int> carried(const Line& line) {
  for (const auto& node : line.unknown_of) {
    std::vector<int> found;
    for (int k = 0; k < 9; ++k)
      if (node[static_cast<std::size_t>(k)] >= 0) found.push_back(k);
    if (!found.empty()) return found;
  }
  return {};
}

/// Stiffness of `parts` elements in a row over d unknowns per node, nodes in order.
Eigen::MatrixXd chain_stiffness(const Track& track, const std::vector<int>& unknowns, int parts) {
  const Matrix27 K = element_matrices(track.section, track.material, track.element_length() / parts,
                                      track.law, track.axial_points)
                         .stiffness;
  const int d = static_cast<int>(unknowns.size());
  Eigen::MatrixXd chain = Eigen::MatrixXd::Zero((2 * parts + 1) * d, (2 * parts + 1) * d);
  for (int part = 0; part < parts; ++part)
    for (int j = 0; j < 3 * d; ++j)
      for (int i = 0; i < 3 * d; ++i)
        chain(2 * part * d + i, 2 * part * d + j) +=
            K(9 * (i / d) + unknowns[static_cast<std::size_t>(i % d)],
              9 * (j / d) + unknowns[static_cast<std::size_t>(j % d)]);
  return chain;
}

/// Condenses a chain to its end nodes; `rows` [places][all unknowns] give the loaded point.
Condensed condense(const Eigen::MatrixXd& chain, const Eigen::MatrixXd& rows, int d) {
  const auto n = chain.rows();
  std::vector<int> ends, inner;
  for (int i = 0; i < n; ++i) (i < d || i >= n - d ? ends : inner).push_back(i);
  const Eigen::MatrixXd inner_K = chain(inner, inner), mixed = chain(inner, ends);
  const Eigen::LDLT<Eigen::MatrixXd> factor(inner_K);
  const Eigen::MatrixXd follow = -factor.solve(mixed);  // [inner][2d]
  const Eigen::MatrixXd inner_rows = rows(Eigen::all, inner);
  Condensed result{chain(ends, ends) + mixed.transpose() * follow,
                   rows(Eigen::all, ends) + inner_rows * follow, Eigen::VectorXd(rows.rows())};
  for (int p = 0; p < rows.rows(); ++p) {
    const Eigen::VectorXd row = inner_rows.row(p).transpose();
    result.held[p] = row.dot(factor.solve(row));
  }
  return result;
}

/// Rows of the loaded point at `points` + 1 equal places over a chain of `parts` elements.
Eigen::MatrixXd place_rows(const std::vector<int>& unknowns, const RailPoint& at, int parts,
                           int points) {
  const int d = static_cast<int>(unknowns.size());
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(points + 1, (2 * parts + 1) * d);
  for (int p = 0; p <= points; ++p) {
    const double place = static_cast<double>(p) * parts / points;
    const int part = std::min(static_cast<int>(place), parts - 1);
    const Vector27 local = point_row(2. * (place - part) - 1., at.y, at.z, 2);
    for (int i = 0; i < 3 * d; ++i)
      rows(p, 2 * part * d + i) = local[9 * (i / d) + unknowns[static_cast<std::size_t>(i % d)]];
  }
  return rows;
}

/// Unknowns of the end nodes of an element in the line, -1 where clamped.
std::vector<int> end_unknowns(const Line& line, const std::vector<int>& unknowns, int element) {
  std::vector<int> result;
  for (const int node : {2 * element, 2 * element + 2})
    for (const int k : unknowns) result.push_back(line.unknown(node, k));
  return result;
}

/// The line's stiffness with every element's end-node stiffness changed by `change`.
Eigen::SparseMatrix<double> with_change(const Track& track, const Line& line,
                                        const std::vector<int>& unknowns,
                                        const Eigen::MatrixXd& change) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int e = 0; e < track.elements(); ++e) {
    const std::vector<int> place = end_unknowns(line, unknowns, e);
    for (std::size_t j = 0; j < place.size(); ++j)
      for (std::size_t i = 0; i < place.size(); ++i)
        if (place[i] >= 0 && place[j] >= 0)
          entries.emplace_back(place[i], place[j],
                               change(static_cast<int>(i), static_cast<int>(j)));
  }
  Eigen::SparseMatrix<double> result(line.unknowns(), line.unknowns());
  result.setFromTriplets(entries.begin(), entries.end());
  return result + line.stiffness;
}

/// Flexibility between the end unknowns of one element in the whole line.
Eigen::MatrixXd end_flexibility(const Factor& factor, int n, const std::vector<int>& place) {
  const auto size = static_cast<Eigen::Index>(place.size());
  Eigen::MatrixXd G = Eigen::MatrixXd::Zero(size, size);
  for (Eigen::Index j = 0; j < size; ++j) {
    if (place[static_cast<std::size_t>(j)] < 0) continue;
    Eigen::VectorXd unit = Eigen::VectorXd::Zero(n);
    unit[place[static_cast<std::size_t>(j)]] = 1.;
    const Eigen::VectorXd column = factor.solve(unit);
    for (Eigen::Index i = 0; i < size; ++i)
      if (place[static_cast<std::size_t>(i)] >= 0)
        G(i, j) = column[place[static_cast<std::size_t>(i)]];
  }
  return G;
}

double total(const Condensed& element, const Eigen::MatrixXd& ends, int p) {
  return element.shapes.row(p).dot(ends * element.shapes.row(p).transpose()) + element.held[p];
}

void factor_held(const Eigen::SparseMatrix<double>& K, Factor& factor) {
  factor.compute(K);
  if (factor.info() != Eigen::Success || factor.vectorD().minCoeff() <= 0.)
    throw std::invalid_argument(
        "residual flexibility needs a track that is held: it has a free rigid mode");
}

void add_line(const Track& track, const Line& line, const RailPoint& at, int points,
              std::vector<double>& table) {
  const std::vector<int> unknowns = carried(line);
  const int d = static_cast<int>(unknowns.size());
  const double factor = line.rail_factor[static_cast<std::size_t>(at.rail)];
  const Eigen::MatrixXd model_rows = place_rows(unknowns, at, 1, points);
  if (factor == 0. || model_rows.isZero(0.)) return;  // this line does not feel the force
  const Condensed model = condense(chain_stiffness(track, unknowns, 1), model_rows, d);
  const Condensed exact = condense(chain_stiffness(track, unknowns, points),
                                   place_rows(unknowns, at, points, points), d);
  Factor model_K, exact_K;
  factor_held(line.stiffness, model_K);
  factor_held(with_change(track, line, unknowns, exact.stiffness - model.stiffness), exact_K);
  for (int e = 0; e < track.elements(); ++e) {
    const std::vector<int> place = end_unknowns(line, unknowns, e);
    const Eigen::MatrixXd G_exact = end_flexibility(exact_K, line.unknowns(), place);
    const Eigen::MatrixXd G_model = end_flexibility(model_K, line.unknowns(), place);
    const std::size_t first = static_cast<std::size_t>(e) * static_cast<std::size_t>(points + 1);
    for (int p = 0; p <= points; ++p)
      table[first + static_cast<std::size_t>(p)] +=
          factor * factor * (total(exact, G_exact, p) - total(model, G_model, p));
  }
}

}  // namespace

std::vector<double> residual_flexibility(const Track& track, const std::vector<Line>& lines,
                                         const RailPoint& point, int points) {
  if (points < 3) throw std::invalid_argument("residual flexibility needs 3 intervals or more");
  if (point.y != 0.)
    throw std::invalid_argument("residual flexibility is tabled for forces over the rail's middle");
  std::vector<double> table(static_cast<std::size_t>(track.elements() * (points + 1)), 0.);
  for (const Line& line : lines) add_line(track, line, point, points, table);
  return table;
}

}  // namespace railstep
