#pragma once
#include "offline/section/moments.h"

namespace railstep {

/// A polynomial in y and z of total degree 4; products drop higher terms.
struct Polynomial {
  double of[kMomentDegree + 1][kMomentDegree + 1] = {};  // of y^i z^j, i + j <= 4

  static Polynomial term(int i, int j, double factor) {
    Polynomial p;
    p.of[i][j] = factor;
    return p;
  }
  Polynomial& operator+=(const Polynomial& other) {
    for (int i = 0; i <= kMomentDegree; ++i)
      for (int j = 0; i + j <= kMomentDegree; ++j) of[i][j] += other.of[i][j];
    return *this;
  }
  double value(double y, double z) const {
    double sum = 0., y_power = 1.;
    for (int i = 0; i <= kMomentDegree; ++i, y_power *= y) {
      double z_power = y_power;
      for (int j = 0; i + j <= kMomentDegree; ++j, z_power *= z) sum += of[i][j] * z_power;
    }
    return sum;
  }
  /// Derivative by y (axis 0) or z (axis 1).
  Polynomial slope(int axis) const {
    Polynomial p;
    for (int i = 0; i <= kMomentDegree; ++i)
      for (int j = 0; i + j <= kMomentDegree; ++j) {
        if (axis == 0 && i > 0) p.of[i - 1][j] = i * of[i][j];
        if (axis == 1 && j > 0) p.of[i][j - 1] = j * of[i][j];
      }
    return p;
  }
  /// Integral over the section.
  double over(const SectionMoments& m) const {
    double sum = 0.;
    for (int i = 0; i <= kMomentDegree; ++i)
      for (int j = 0; i + j <= kMomentDegree; ++j)
        sum += of[i][j] * m.of[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
    return sum;
  }
};

inline Polynomial operator*(const Polynomial& a, const Polynomial& b) {
  Polynomial p;
  for (int i = 0; i <= kMomentDegree; ++i)
    for (int j = 0; i + j <= kMomentDegree; ++j) {
      if (a.of[i][j] == 0.) continue;
      for (int k = 0; i + j + k <= kMomentDegree; ++k)
        for (int l = 0; i + j + k + l <= kMomentDegree; ++l)
          p.of[i + k][j + l] += a.of[i][j] * b.of[k][l];
    }
  return p;
}

inline Polynomial operator*(double factor, const Polynomial& a) {
  Polynomial p;
  for (int i = 0; i <= kMomentDegree; ++i)
    for (int j = 0; i + j <= kMomentDegree; ++j) p.of[i][j] = factor * a.of[i][j];
  return p;
}

}  // namespace railstep
