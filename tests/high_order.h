#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "extrapolation.h"

namespace railstep {

/// y' = f(y).
using OdeSlope = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;

/// y at each of `times` (s, rising, the first is where y0 stands), by an extrapolation of order 16
/// with steps of at most `step`.
inline std::vector<Eigen::VectorXd> integrate(const OdeSlope& f, const Eigen::VectorXd& y0,
                                              const std::vector<double>& times, double step) {
  Extrapolation method(8);
  const auto slope = [&](const Eigen::VectorXd& y, Eigen::VectorXd& dy) { dy = f(y); };
  std::vector<Eigen::VectorXd> result = {y0};
  for (std::size_t i = 1; i < times.size(); ++i) {
    const double span = times[i] - times[i - 1];
    const int steps = std::max(1, static_cast<int>(std::ceil(span / step - 1e-9)));
    Eigen::VectorXd y = result.back();
    for (int k = 0; k < steps; ++k) method.advance(slope, span / steps, y);
    result.push_back(y);
  }
  return result;
}

/// A solution and what halving its step changed of it: the error that it owns up to.
struct HighOrder {
  std::vector<Eigen::VectorXd> y;
  double own_error;
};
inline HighOrder high_order(const OdeSlope& f, const Eigen::VectorXd& y0,
                            const std::vector<double>& times, double step) {
  const std::vector<Eigen::VectorXd> coarse = integrate(f, y0, times, step);
  HighOrder result{integrate(f, y0, times, step / 2.), 0.};
  for (std::size_t i = 0; i < times.size(); ++i)
    result.own_error = std::max(result.own_error, (result.y[i] - coarse[i]).cwiseAbs().maxCoeff());
  return result;
}

}  // namespace railstep
