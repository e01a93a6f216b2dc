#include "offline/beam/structure.h"

#include <algorithm>

namespace railstep {
namespace {

using Vector27 = Eigen::Matrix<double, 27, 1>;

std::size_t as_index(int i) { return static_cast<std::size_t>(i); }

Vector27 gathered(const Structure::Element& element, const Eigen::VectorXd& q) {
  Vector27 local;
  for (int i = 0; i < 3; ++i) local.segment<9>(9 * i) = q.segment<9>(9 * element.node[as_index(i)]);
  return local;
}

int place(const Structure::Element& element, int i) {
  return 9 * element.node[as_index(i / 9)] + i % 9;
}

/// Number of each unknown among those that are not held, -1 for these.
std::vector<int> numbering(const Structure& s) {
  std::vector<int> number(s.held.size(), -1);
  int count = 0;
  for (std::size_t i = 0; i < number.size(); ++i)
    if (!s.held[i]) number[i] = count++;
  return number;
}

}  // namespace

int Structure::nodes() const {
  int last = -1;
  for (const Element& e : elements)
    last = std::max(last, *std::max_element(e.node.begin(), e.node.end()));
  return last + 1;
}

std::vector<Structure::Element> chain(int elements, int first_node, int law) {
  std::vector<Structure::Element> all;
  for (int e = 0; e < elements; ++e) {
    const int node = first_node + 2 * e;
    all.push_back({law, {node, node + 1, node + 2}});
  }
  return all;
}

Eigen::VectorXd internal_force(const Structure& s, const Eigen::VectorXd& q) {
  Eigen::VectorXd force = Eigen::VectorXd::Zero(s.unknowns());
  Vector27 local;
  for (const Structure::Element& e : s.elements) {
    beam_force(s.laws[as_index(e.law)], gathered(e, q).data(), local.data());
    for (int i = 0; i < 27; ++i) force[place(e, i)] += local[i];
  }
  for (const Structure::Spring& spring : s.springs)
    force += spring.stiffness * spring.row.dot(q - s.rest) * spring.row;
  return force;
}

Eigen::SparseMatrix<double> tangent(const Structure& s, const Eigen::VectorXd& q) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(s.elements.size() * 27 * 27);
  Vector27 force;
  Eigen::Matrix<double, 27, 27> K;
  for (const Structure::Element& e : s.elements) {
    beam_tangent(s.laws[as_index(e.law)], gathered(e, q).data(), force.data(), K.data());
    for (int j = 0; j < 27; ++j)
      for (int i = 0; i < 27; ++i) entries.emplace_back(place(e, i), place(e, j), K(i, j));
  }
  using Entry = Eigen::SparseVector<double>::InnerIterator;
  for (const Structure::Spring& spring : s.springs)
    for (Entry i(spring.row); i; ++i)
      for (Entry j(spring.row); j; ++j)
        entries.emplace_back(static_cast<int>(i.index()), static_cast<int>(j.index()),
                             spring.stiffness * i.value() * j.value());
  Eigen::SparseMatrix<double> result(s.unknowns(), s.unknowns());
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

Eigen::SparseMatrix<double> free_part(const Structure& s,
                                      const Eigen::SparseMatrix<double>& matrix) {
  const std::vector<int> number = numbering(s);
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(static_cast<std::size_t>(matrix.nonZeros()));
  for (int column = 0; column < matrix.outerSize(); ++column)
    for (Eigen::SparseMatrix<double>::InnerIterator it(matrix, column); it; ++it) {
      const int i = number[as_index(static_cast<int>(it.row()))], j = number[as_index(column)];
      if (i >= 0 && j >= 0) entries.emplace_back(i, j, it.value());
    }
  const int n = static_cast<int>(std::count(s.held.begin(), s.held.end(), false));
  Eigen::SparseMatrix<double> result(n, n);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

Eigen::VectorXd free_part(const Structure& s, const Eigen::VectorXd& vector) {
  const std::vector<int> number = numbering(s);
  Eigen::VectorXd result(std::count(s.held.begin(), s.held.end(), false));
  for (int i = 0; i < s.unknowns(); ++i)
    if (number[as_index(i)] >= 0) result[number[as_index(i)]] = vector[i];
  return result;
}

}  // namespace railstep
