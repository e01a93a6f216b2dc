#pragma once
#include <Eigen/Core>
#include <cmath>
#include <vector>

namespace railstep {

/// y' = f(y) by extrapolation of the explicit midpoint rule (Gragg, Bulirsch and Stoer; Hairer,
/// Norsett and Wanner, Solving Ordinary Differential Equations I, II.9): `rows` runs over one step
/// with 2, 4, 6 ... substeps, whose error goes with even powers of their length, give order
/// 2 rows. Oscillations are followed, without damping, while a step is below some rows / frequency.
class Extrapolation {
 public:
  explicit Extrapolation(int rows) : rows_(rows) {}

  /// One step of length h. slope(y, dy) writes f(y).
  template <typename Slope>
  void advance(Slope slope, double h, Eigen::VectorXd& y) {
    first_.resize(y.size());
    slope(y, first_);
    table_.resize(static_cast<std::size_t>(rows_));
    for (int j = 1; j <= rows_; ++j) {
      Eigen::VectorXd last = midpoint(slope, h, 2 * j, y);
      // Aitken and Neville in h^2, in place: table_[k] holds the row before.
      for (int k = 1; k <= j; ++k) {
        Eigen::VectorXd& before = table_[static_cast<std::size_t>(k - 1)];
        if (k == j) {
          before = last;
          break;
        }
        const double ratio = static_cast<double>(j) / (j - k);
        Eigen::VectorXd better = last + (last - before) / (ratio * ratio - 1.);
        before = last;
        last.swap(better);
      }
    }
    y = table_.back();
  }

 private:
  template <typename Slope>
  Eigen::VectorXd midpoint(Slope& slope, double h, int parts, const Eigen::VectorXd& y) {
    const double part = h / parts;
    Eigen::VectorXd before = y, now = y + part * first_;
    slope_.resize(y.size());
    for (int i = 1; i < parts; ++i) {
      slope(now, slope_);
      before += 2. * part * slope_;
      before.swap(now);
    }
    return now;
  }

  int rows_;
  Eigen::VectorXd first_, slope_;
  std::vector<Eigen::VectorXd> table_;
};

}  // namespace railstep
