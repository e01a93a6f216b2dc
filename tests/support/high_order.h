#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace railstep {

/// y' = f(t, y).
using OdeSlope = std::function<Eigen::VectorXd(double, const Eigen::VectorXd&)>;

/// One step of Gragg, Bulirsch and Stoer at a fixed order of 2 rows: the modified midpoint rule
/// with 2, 4, ... parts, extrapolated in the square of the part (Hairer, Norsett, Wanner, Solving
/// Ordinary Differential Equations I, section II.9).
inline Eigen::VectorXd extrapolated_step(const OdeSlope& f, double t, const Eigen::VectorXd& y,
                                         double step, int rows = 8) {
  const Eigen::VectorXd first = f(t, y);
  std::vector<Eigen::VectorXd> T(static_cast<std::size_t>(rows));
  for (int row = 0; row < rows; ++row) {
    const int parts = 2 * (row + 1);
    const double h = step / parts;
    Eigen::VectorXd before = y, now = y + h * first;
    for (int i = 1; i < parts; ++i) {
      const Eigen::VectorXd next = before + 2. * h * f(t + i * h, now);
      before = now;
      now = next;
    }
    T[static_cast<std::size_t>(row)] = .5 * (before + now + h * f(t + step, now));
    // T[k] of this row from T[k + 1] and that of the row above.
    for (int k = row - 1; k >= 0; --k) {
      const double ratio = static_cast<double>(row + 1) / (k + 1);
      const auto at = static_cast<std::size_t>(k);
      const Eigen::VectorXd change = (T[at + 1] - T[at]) / (ratio * ratio - 1.);
      T[at] = T[at + 1] + change;
    }
  }
  return T[0];
}

/// y at each of `times` (s, rising; y0 is at the first), with steps of at most `step`.
inline std::vector<Eigen::VectorXd> integrate(const OdeSlope& f, const Eigen::VectorXd& y0,
                                              const std::vector<double>& times, double step) {
  std::vector<Eigen::VectorXd> result = {y0};
  for (std::size_t i = 1; i < times.size(); ++i) {
    const double span = times[i] - times[i - 1];
    const int steps = std::max(1, static_cast<int>(std::ceil(span / step - 1e-9)));
    Eigen::VectorXd y = result.back();
    for (int k = 0; k < steps; ++k)
      y = extrapolated_step(f, times[i - 1] + span * k / steps, y, span / steps);
    result.push_back(y);
  }
  return result;
}

/// A solution, and its change when the step is halved, which is its stated error.
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
