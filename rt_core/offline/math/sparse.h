#pragma once
#include <Eigen/SparseCore>

namespace railstep {

using Sparse = Eigen::SparseMatrix<double>;

}  // namespace railstep
