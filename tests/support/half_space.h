#pragma once
#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace railstep {

/// Normal contact of two like elastic half-spaces on a grid of rectangular elements, with constant
/// pressure in each: the reference of contact laws.
class HalfSpace {
 public:
  /// @param along, across  numbers of elements; their sizes, m
  /// @param modulus  E / (1 - nu^2), N/m2
  HalfSpace(int along, int across, double length, double width, double modulus)
      : along_(along),
        across_(across),
        length_(length),
        width_(width),
        influence_(static_cast<std::size_t>(along) * static_cast<std::size_t>(across)) {
    // Both bodies give way: u = 2 / (pi modulus) int p / r.
    for (int i = 0; i < along; ++i)
      for (int j = 0; j < across; ++j)
        influence_[at(i, j)] = 2. / (M_PI * modulus) * over_distance(i * length, j * width);
  }

  struct Answer {
    double force, pressure, area, centre;  // N, largest N/m2, m2, across from the grid's middle, m
  };
  /// Pressures that are nowhere below 0 and hold u = approach - gap where they are above it, by
  /// Polonsky and Keer's conjugate gradients (Wear 231, 1999).
  /// @param gap  over (x, y) from the grid's middle, m
  Answer solve(const std::function<double(double, double)>& gap, double approach) const {
    const std::size_t n = influence_.size();
    std::vector<double> p(n), target(n), residual(n), search(n, 0.), moved(n);
    for (int i = 0; i < along_; ++i)
      for (int j = 0; j < across_; ++j)
        target[at(i, j)] =
            approach - gap((i - .5 * (along_ - 1)) * length_, (j - .5 * (across_ - 1)) * width_);
    for (std::size_t k = 0; k < n; ++k)
      p[k] = target[k] > 0. ? target[k] / (30. * influence_[0]) : 0.;
    double last = 1., keep = 0.;
    for (int turn = 0; turn < 400; ++turn) {
      multiply(p, moved);
      double square = 0., most = 0.;
      for (std::size_t k = 0; k < n; ++k) {
        residual[k] = moved[k] - target[k];
        if (p[k] > 0.) square += residual[k] * residual[k];
        if (p[k] > 0.) most = std::max(most, std::abs(residual[k]));
      }
      if (turn > 0 && most < 1e-6 * approach) break;
      for (std::size_t k = 0; k < n; ++k)
        search[k] = p[k] > 0. ? residual[k] + keep * (square / last) * search[k] : 0.;
      last = square;
      multiply(search, moved);
      double above = 0., below = 0.;
      for (std::size_t k = 0; k < n; ++k)
        if (p[k] > 0.) {
          above += residual[k] * search[k];
          below += moved[k] * search[k];
        }
      const double step = above / below;
      keep = 1.;
      for (std::size_t k = 0; k < n; ++k) {
        if (p[k] > 0.) p[k] = std::max(p[k] - step * search[k], 0.);
        if (p[k] == 0. && residual[k] < 0.) {  // the bodies would overlap there
          p[k] = -step * residual[k];
          keep = 0.;
        }
      }
    }
    Answer a{0., 0., 0., 0.};
    for (int i = 0; i < along_; ++i)
      for (int j = 0; j < across_; ++j) {
        const double own = p[at(i, j)];
        a.force += own * length_ * width_;
        a.pressure = std::max(a.pressure, own);
        a.area += own > 0. ? length_ * width_ : 0.;
        a.centre += own * length_ * width_ * (j - .5 * (across_ - 1)) * width_;
      }
    a.centre /= a.force;
    return a;
  }

 private:
  std::size_t at(int i, int j) const {
    return static_cast<std::size_t>(i) * static_cast<std::size_t>(across_) +
           static_cast<std::size_t>(j);
  }
  /// Integral of 1/r over an element whose middle is at (x, y).
  double over_distance(double x, double y) const {
    const auto part = [](double a, double b) {
      return a * std::asinh(b / std::abs(a)) + b * std::asinh(a / std::abs(b));
    };
    const double x0 = x - .5 * length_, x1 = x + .5 * length_, y0 = y - .5 * width_,
                 y1 = y + .5 * width_;
    return part(x1, y1) - part(x1, y0) - part(x0, y1) + part(x0, y0);
  }
  void multiply(const std::vector<double>& p, std::vector<double>& u) const {
    std::fill(u.begin(), u.end(), 0.);
    for (int i = 0; i < along_; ++i)
      for (int j = 0; j < across_; ++j) {
        const double own = p[at(i, j)];
        if (own == 0.) continue;
        for (int k = 0; k < along_; ++k)
          for (int l = 0; l < across_; ++l)
            u[at(k, l)] += own * influence_[at(std::abs(i - k), std::abs(j - l))];
      }
  }

  int along_, across_;
  double length_, width_;
  std::vector<double> influence_;
};

}  // namespace railstep
