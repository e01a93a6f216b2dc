#include "offline/analysis/critical_speed.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

namespace railstep {
namespace {

/// Waves e^(i k x) of the deflection w of a rail, the slope a of its sections and the sleepers' s:
/// rail w'' + (S k^2 + N k^2 + pad) w + S k a - pad s = 0, rotary a'' + (B k^2 + S) a + S k w = 0,
/// sleeper s'' + (pad + ballast) s - pad w = 0.
struct Waves {
  double rail, rotary, sleeper = 0.;             // kg/m, kg m, kg/m; no sleepers, or of no mass: 0
  double shear, bending, tension, pad, ballast;  // N, N m2, N, N/m2, N/m2

  Waves(const Track& track, int which) {
    const RailBar bar = track.bar(which);
    rail = bar.material.density * bar.section.area;
    rotary = bar.material.density * bar.section.inertia_y;
    shear = bar.section.shear_factor_z * bar.material.shear_modulus() * bar.section.area;
    bending = bar.material.young * bar.section.inertia_y;
    tension = bar.axial_force;
    pad = track.support.stiffness[2] / track.bay_length;
    ballast = track.sleeper ? track.sleeper->ballast_stiffness[2] / track.bay_length : 0.;
    if (track.sleeper) sleeper = .5 * track.sleeper->mass / track.bay_length;
    if (!track.sleeper || sleeper > 0.) return;
    pad = pad + ballast > 0. ? pad * ballast / (pad + ballast) : 0.;
  }

  [[nodiscard]] bool held() const { return pad > 0. && (sleeper == 0. || ballast > 0.); }
  [[nodiscard]] Eigen::Index branches() const { return sleeper > 0. ? 2 : 1; }

  /// omega^2 of every branch, ascending.
  [[nodiscard]] Eigen::VectorXd squares(double k) const {
    const Eigen::Index n = branches() + 1;
    Eigen::MatrixXd over_mass(n, n);
    over_mass(0, 0) = ((shear + tension) * k * k + pad) / rail;
    over_mass(1, 1) = (bending * k * k + shear) / rotary;
    over_mass(1, 0) = shear * k / std::sqrt(rail * rotary);
    if (n == 3) {
      over_mass(2, 0) = -pad / std::sqrt(rail * sleeper);
      over_mass(2, 1) = 0.;
      over_mass(2, 2) = (pad + ballast) / sleeper;
    }
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(over_mass, Eigen::EigenvaluesOnly)
        .eigenvalues();
  }

  /// omega / k; not a number where the waves grow.
  [[nodiscard]] double speed(double k, Eigen::Index branch) const {
    return std::sqrt(squares(k)[branch]) / k;
  }

  /// The least speed between two wave numbers around one least value.
  [[nodiscard]] double least(double low, double high, Eigen::Index branch) const {
    while (high / low > 1. + 1e-9) {
      const double a = std::cbrt(low * low * high), b = std::cbrt(low * high * high);
      (speed(a, branch) < speed(b, branch) ? high : low) =
          speed(a, branch) < speed(b, branch) ? b : a;
    }
    return speed(std::sqrt(low * high), branch);
  }
};

constexpr int kPoints = 400;
constexpr double kLong = 1e-3;  // 1/m: of waves so long that they are fast

}  // namespace

std::optional<double> critical_speed(const Track& track, int rail) {
  const Waves waves(track, rail);
  if (!waves.held()) return std::nullopt;
  std::optional<double> slowest;
  const double shortest = M_PI / track.bay_length;
  std::array<double, kPoints> k{}, speed{};
  for (Eigen::Index branch = 0; branch < waves.branches(); ++branch) {
    for (std::size_t i = 0; i < kPoints; ++i) {
      k[i] = kLong * std::pow(shortest / kLong, static_cast<double>(i) / (kPoints - 1));
      speed[i] = waves.speed(k[i], branch);
      if (!(speed[i] > 0.)) return std::nullopt;
    }
    for (std::size_t i = 1; i + 1 < kPoints; ++i) {
      if (speed[i] > speed[i - 1] || speed[i] >= speed[i + 1]) continue;
      const double found = waves.least(k[i - 1], k[i + 1], branch);
      slowest = std::min(slowest.value_or(found), found);
    }
  }
  return slowest;
}

}  // namespace railstep
