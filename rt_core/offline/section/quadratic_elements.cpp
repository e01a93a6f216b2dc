#include "offline/section/quadratic_elements.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <map>
#include <utility>

#include "offline/math/refuse.h"

namespace railstep {
namespace {

struct SharedEdge {
  int node;   // its middle
  int count;  // triangles that own it: one on the border, two inside
};

using Edges = std::map<std::pair<int, int>, SharedEdge>;

std::pair<int, int> key(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

Edges number_edges(const SectionMesh& mesh) {
  Edges edges;
  int next = static_cast<int>(mesh.points.size());
  for (const std::array<int, 3>& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [at, added] = edges.try_emplace(key(t[i], t[(i + 1) % 3]), SharedEdge{next, 0});
      if (added) ++next;
      ++at->second.count;
    }
  return edges;
}

}  // namespace

QuadraticElements make_quadratic(const SectionMesh& mesh) {
  const Edges edges = number_edges(mesh);
  const std::size_t count = mesh.points.size() + edges.size();
  QuadraticElements out{Eigen::Matrix2Xd(2, static_cast<Eigen::Index>(count)),
                        {},
                        std::vector<bool>(count, false),
                        std::vector<bool>(count, false)};
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
    out.nodes.col(static_cast<Eigen::Index>(i)) << mesh.points[i][0], mesh.points[i][1];
  for (const auto& [ends, edge] : edges) {
    out.nodes.col(edge.node) = 0.5 * (out.nodes.col(ends.first) + out.nodes.col(ends.second));
    const bool axis = out.nodes(0, ends.first) == 0.0 && out.nodes(0, ends.second) == 0.0;
    if (edge.count != 1) continue;
    for (const int node : {ends.first, ends.second, edge.node})
      (axis ? out.on_axis : out.on_outline)[static_cast<std::size_t>(node)] = true;
  }
  for (const std::array<int, 3>& t : mesh.triangles)
    out.elements.push_back({t[0], t[1], t[2], edges.at(key(t[0], t[1])).node,
                            edges.at(key(t[1], t[2])).node, edges.at(key(t[2], t[0])).node});
  return out;
}

std::array<QuadraturePoint, 6> quadrature(const QuadraticElements& mesh, std::size_t element) {
  constexpr double kInner = 0.44594849091596488632, kInnerWeight = 0.22338158967801146570;
  constexpr double kOuter = 0.091576213509770743460, kOuterWeight = 0.10995174365532186764;
  const std::array<int, 6>& e = mesh.elements[element];
  const Eigen::Vector2d a = mesh.nodes.col(e[0]), b = mesh.nodes.col(e[1]),
                        c = mesh.nodes.col(e[2]);
  const double twice = (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
  Eigen::Matrix<double, 3, 2> slope;  // of the area coordinates
  slope << b.y() - c.y(), c.x() - b.x(), c.y() - a.y(), a.x() - c.x(), a.y() - b.y(), b.x() - a.x();
  slope /= twice;
  std::array<QuadraturePoint, 6> points{};
  for (int k = 0; k < 6; ++k) {
    const double side = k < 3 ? kInner : kOuter;
    Eigen::Vector3d L = Eigen::Vector3d::Constant(side);
    L[k % 3] = 1.0 - 2.0 * side;
    QuadraturePoint& q = points[static_cast<std::size_t>(k)];
    q.area = 0.5 * twice * (k < 3 ? kInnerWeight : kOuterWeight);
    q.y = L[0] * a.x() + L[1] * b.x() + L[2] * c.x();
    q.z = L[0] * a.y() + L[1] * b.y() + L[2] * c.y();
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      q.shape[i] = L[i] * (2.0 * L[i] - 1.0);
      q.slope.row(i) = (4.0 * L[i] - 1.0) * slope.row(i);
      q.shape[3 + i] = 4.0 * L[i] * L[j];
      q.slope.row(3 + i) = 4.0 * (L[i] * slope.row(j) + L[j] * slope.row(i));
    }
  }
  return points;
}

Eigen::SparseMatrix<double> laplacian(const QuadraticElements& mesh) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(36 * mesh.elements.size());
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    Eigen::Matrix<double, 6, 6> k = Eigen::Matrix<double, 6, 6>::Zero();
    for (const QuadraturePoint& q : quadrature(mesh, e))
      k += q.area * q.slope * q.slope.transpose();
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j)
        entries.emplace_back(mesh.elements[e][static_cast<std::size_t>(i)],
                             mesh.elements[e][static_cast<std::size_t>(j)], k(i, j));
  }
  Eigen::SparseMatrix<double> K(mesh.nodes.cols(), mesh.nodes.cols());
  K.setFromTriplets(entries.begin(), entries.end());
  return K;
}

Eigen::MatrixXd solve_fixed(const Eigen::SparseMatrix<double>& K, const std::vector<bool>& fixed,
                            const Eigen::MatrixXd& load) {
  std::vector<int> row(fixed.size(), -1);
  int free = 0;
  for (std::size_t i = 0; i < fixed.size(); ++i)
    if (!fixed[i]) row[i] = free++;
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index c = 0; c < K.outerSize(); ++c)
    for (Eigen::SparseMatrix<double>::InnerIterator at(K, c); at; ++at) {
      const int i = row[static_cast<std::size_t>(at.row())];
      const int j = row[static_cast<std::size_t>(at.col())];
      if (i >= 0 && j >= 0) entries.emplace_back(i, j, at.value());
    }
  Eigen::SparseMatrix<double> reduced(free, free);
  reduced.setFromTriplets(entries.begin(), entries.end());
  Eigen::MatrixXd right(free, load.cols());
  for (std::size_t i = 0; i < fixed.size(); ++i)
    if (!fixed[i]) right.row(row[i]) = load.row(static_cast<Eigen::Index>(i));
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(reduced);
  if (solver.info() != Eigen::Success)
    refuse("E-SECTION-24",
           "the section is too thin or ragged for its Saint-Venant solution; use fewer points and "
           "remove slivers");
  const Eigen::MatrixXd solved = solver.solve(right);
  Eigen::MatrixXd u = Eigen::MatrixXd::Zero(load.rows(), load.cols());
  for (std::size_t i = 0; i < fixed.size(); ++i)
    if (!fixed[i]) u.row(static_cast<Eigen::Index>(i)) = solved.row(row[i]);
  return u;
}

}  // namespace railstep
