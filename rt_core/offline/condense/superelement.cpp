#include "offline/condense/superelement.h"

#include <algorithm>
#include <utility>

namespace railstep {

namespace {

/// Coefficients over nodes whose sections do not strain: b_y = -a_z.
void tie_sections(Eigen::Ref<Vector27, 0, Eigen::InnerStride<>> row) {
  for (int node = 0; node < 27; node += 9) row[node + 5] -= row[node + 7];
}

Vector27 carried_row(const Track& track, const Cant& cant, double xi, double y, double z,
                     int direction) {
  Vector27 row = rail_row(cant, xi, y, z, direction);
  if (track.unknowns == Unknowns::rigid_section) tie_sections(row);
  return row;
}

/// Over what an element of the track carries.
Matrix27 stiffness(const Track& track, int rail, double length) {
  Matrix27 K = element_matrices(track.bar(rail).section, track.law(rail), length).stiffness;
  if (track.unknowns != Unknowns::rigid_section) return K;
  for (int i = 0; i < 27; ++i) tie_sections(K.col(i));
  for (int i = 0; i < 27; ++i) tie_sections(K.row(i).transpose());
  return K;
}

/// Stiffness of `parts` elements in a row over the carried unknowns, nodes in order.
Eigen::MatrixXd chain_stiffness(const Track& track, int rail, const std::vector<int>& carried,
                                int parts) {
  const Matrix27 K = stiffness(track, rail, track.element_length() / parts);
  const int d = static_cast<int>(carried.size());
  Eigen::MatrixXd chain = Eigen::MatrixXd::Zero((2 * parts + 1) * d, (2 * parts + 1) * d);
  for (int part = 0; part < parts; ++part)
    for (int j = 0; j < 3 * d; ++j)
      for (int i = 0; i < 3 * d; ++i)
        chain(2 * part * d + i, 2 * part * d + j) +=
            K(9 * (i / d) + carried[static_cast<std::size_t>(i % d)],
              9 * (j / d) + carried[static_cast<std::size_t>(j % d)]);
  return chain;
}

}  // namespace

Superelement::Superelement(const Track& track, int rail, std::vector<int> carried, int parts)
    : track_(track), parts_(parts), carried_(std::move(carried)) {
  const Eigen::MatrixXd chain = chain_stiffness(track, rail, carried_, parts);
  const int n = static_cast<int>(chain.rows()), d = static_cast<int>(carried_.size());
  for (int i = 0; i < n; ++i) (i < d || i >= n - d ? ends_ : inner_).push_back(i);
  const Eigen::MatrixXd inner_K = chain(inner_, inner_), mixed = chain(inner_, ends_);
  factor_.compute(inner_K);
  follow_ = -factor_.solve(mixed);
  stiffness_ = chain(ends_, ends_) + mixed.transpose() * follow_;
}

Eigen::VectorXd Superelement::row(double place, const Cant& cant, double y, double z,
                                  int direction) const {
  const int d = static_cast<int>(carried_.size());
  const int part = std::min(static_cast<int>(place), parts_ - 1);
  const Vector27 local = carried_row(track_, cant, 2. * (place - part) - 1., y, z, direction);
  Eigen::VectorXd result = Eigen::VectorXd::Zero((2 * parts_ + 1) * d);
  for (int i = 0; i < 3 * d; ++i)
    result[2 * part * d + i] = local[9 * (i / d) + carried_[static_cast<std::size_t>(i % d)]];
  return result;
}

Superelement::Rows Superelement::condense(const Eigen::MatrixXd& rows) const {
  const Eigen::MatrixXd inner = rows(Eigen::all, inner_);
  return {rows(Eigen::all, ends_) + inner * follow_, inner};
}

Eigen::MatrixXd Superelement::held(const Rows& a, const Rows& b) const {
  Eigen::MatrixXd result(a.inner.rows(), b.inner.rows());
  for (Eigen::Index q = 0; q < b.inner.rows(); ++q) {
    const Eigen::VectorXd row = b.inner.row(q).transpose();
    const Eigen::VectorXd displacement = factor_.solve(row);
    for (Eigen::Index p = 0; p < a.inner.rows(); ++p) {
      const Eigen::VectorXd read = a.inner.row(p).transpose();
      result(p, q) = read.dot(displacement);
    }
  }
  return result;
}

}  // namespace railstep
