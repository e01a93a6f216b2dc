#include "offline/condense/mode_groups.h"

#include <utility>

namespace railstep {
namespace {

/// The groups' own matrices along the diagonal of one.
template <typename Scalar, typename Own>
Eigen::SparseMatrix<Scalar> along_diagonal(const std::vector<DampedModes>& groups, const Own& own) {
  std::vector<Eigen::Triplet<Scalar>> entries;
  int row = 0, column = 0;
  for (const DampedModes& group : groups) {
    const auto& block = own(group);
    const auto rows = static_cast<int>(block.rows()), columns = static_cast<int>(block.cols());
    for (int j = 0; j < columns; ++j)
      for (int i = 0; i < rows; ++i)
        if (block(i, j) != Scalar(0.)) entries.emplace_back(row + i, column + j, block(i, j));
    row += rows;
    column += columns;
  }
  Eigen::SparseMatrix<Scalar> result(row, column);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

}  // namespace

ModeGroups::ModeGroups(std::vector<DampedModes> groups) : groups_(std::move(groups)) {
  Eigen::Index modes = 0;
  for (const DampedModes& group : groups_) {
    modes += group.rate.size();
    coordinates_ += group.shape.rows();
  }
  rate_.resize(modes);
  modes = 0;
  for (const DampedModes& group : groups_) {
    rate_.segment(modes, group.rate.size()) = group.rate;
    modes += group.rate.size();
  }
}

Eigen::VectorXcd ModeGroups::project(const Eigen::VectorXd& force) const {
  Eigen::VectorXcd result(rate_.size());
  Eigen::Index mode = 0, at = 0;
  for (const DampedModes& group : groups_) {
    result.segment(mode, group.rate.size()) =
        group.shape.transpose() * force.segment(at, group.shape.rows());
    mode += group.rate.size();
    at += group.shape.rows();
  }
  return result;
}

Eigen::VectorXd ModeGroups::displacement(const Eigen::VectorXcd& z) const {
  Eigen::VectorXd result(coordinates_);
  Eigen::Index mode = 0, at = 0;
  for (const DampedModes& group : groups_) {
    result.segment(at, group.shape.rows()) =
        (group.shape * z.segment(mode, group.rate.size())).real();
    mode += group.rate.size();
    at += group.shape.rows();
  }
  return result;
}

Eigen::VectorXcd ModeGroups::from(const Eigen::VectorXd& force,
                                  const Eigen::VectorXd& velocity) const {
  Eigen::VectorXcd result(rate_.size());
  Eigen::Index mode = 0, at = 0;
  for (const DampedModes& group : groups_) {
    const Eigen::Index n = group.shape.rows();
    result.segment(mode, group.rate.size()) =
        group.from(force.segment(at, n), velocity.segment(at, n));
    mode += group.rate.size();
    at += n;
  }
  return result;
}

Eigen::SparseMatrix<std::complex<double>> ModeGroups::shape() const {
  return along_diagonal<std::complex<double>>(
      groups_, [](const DampedModes& group) -> const Eigen::MatrixXcd& { return group.shape; });
}

Eigen::SparseMatrix<double> ModeGroups::damping() const {
  return along_diagonal<double>(
      groups_, [](const DampedModes& group) -> const Eigen::MatrixXd& { return group.damping; });
}

}  // namespace railstep
