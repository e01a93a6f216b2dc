#pragma once
#include <Eigen/Core>
#include <vector>

namespace railstep {

/// Functions that share their poles, known at places x in rising order:
///   r(x) = sum_j w_j f_j / (x - x_j) / sum_j w_j / (x - x_j)
/// meets the values f_j at every second place, and fits those at the others by least squares: the
/// barycentric form of Nakatsukasa, Sete and Trefethen (the AAA algorithm, SIAM J. Sci. Comput. 40,
/// 2018), without their choice of places.
class RationalFit {
 public:
  /// @param values  [functions][places]
  /// @param first   0 or 1: the first place that is met
  RationalFit(const std::vector<double>& places, const Eigen::MatrixXcd& values, int first);
  Eigen::VectorXcd at(double x) const;

 private:
  std::vector<double> places_;  // those that are met
  Eigen::MatrixXcd values_;     // [functions][places]
  Eigen::VectorXcd weights_;
};

}  // namespace railstep
