#include "hard/spinning_bar.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "hard/hard_run.h"

namespace railstep {
namespace {

/// The bar from frame to frame.
struct Spin {
  std::vector<double> stretch, rate;  // m, rad/s: of the frame that ends here
};

Spin spin_of(const HardRun& run) {
  const auto x0 = run.column("left.x_m"), z0 = run.column("left.z_m"), x1 = run.column("right.x_m"),
             z1 = run.column("right.z_m"), time = run.time();
  Spin spin;
  double before = 0.;
  for (std::size_t i = 0; i < time.size(); ++i) {
    const double dx = x1[i] - x0[i], dz = z1[i] - z0[i], angle = std::atan2(-dz, dx);
    spin.stretch.push_back(std::hypot(dx, dz) - 1.);
    if (i > 0)
      spin.rate.push_back(std::remainder(angle - before, 2. * M_PI) / (time[i] - time[i - 1]));
    before = angle;
  }
  return spin;
}

/// Mean of the k-th tenth.
double tenth(const std::vector<double>& values, std::size_t k) {
  const std::size_t n = values.size() / 10;
  double sum = 0.;
  for (std::size_t i = k * n; i < (k + 1) * n; ++i) sum += values[i];
  return sum / static_cast<double>(n);
}

constexpr double kSpin = 300., kSteel = 7850., kYoung = 210e9;
// The bar's inertia grows by rho w^2 L^2/5E, and as its momentum stays, so much slower it turns.
constexpr double kRate = kSpin * (1. - kSteel * kSpin * kSpin / (5. * kYoung));
constexpr double kStretch = kSteel * kRate * kRate / (12. * kYoung);  // m, of 1 m

HardRun spun(const std::filesystem::path& scene, const char* scheme, double dt) {
  return HardRun(scene,
                 {fmt::format("step.scheme=\"{}\"", scheme), fmt::format("step.dt_s={}", dt)});
}

/// Distance of the middle from its place, m.
double off_middle(const HardRun& run) {
  double off = 0.;
  for (const char* column : {"middle.x_m", "middle.z_m"})
    off = std::max({off, run.largest(column), -run.smallest(column)});
  return off;
}

/// A scheme that keeps energies has to keep them, and the rate and the ringing too.
void add_kept(const HardRun& run, HardResult& result) {
  const Spin spin = spin_of(run);
  const auto energy = run.energy();
  double mean = 0.;
  for (std::size_t k = 0; k < 10; ++k) mean += .1 * tenth(spin.stretch, k);
  const std::string at = "energy-momentum: ";
  result.checks.push_back(off_by(at + "stretch, mean of the run", mean, kStretch, 2e-3));
  result.checks.push_back(off_by(at + "rate of the spin", tenth(spin.rate, 9), kRate, 1e-4));
  result.checks.push_back(off_by(at + "rate, last tenth against the second", tenth(spin.rate, 9),
                                 tenth(spin.rate, 1), 1e-6));
  result.checks.push_back({at + "energy lost or made", energy ? energy->error : HUGE_VAL, 1e-9});
  result.checks.push_back({at + "the middle leaves its place by, m", off_middle(run), 1e-9});
  result.checks.push_back(holds(at + "no status bit", run.status().empty()));
}

/// A scheme that damps has to lose the ringing, and the part of the spin that its order says.
void add_damped(const HardRun& run, const HardRun& coarse, HardResult& result) {
  const Spin spin = spin_of(run), wide = spin_of(coarse);
  const auto off = [](const Spin& of) { return std::abs(tenth(of.rate, 9) - kRate) / kRate; };
  const auto drift = [](const Spin& of) { return std::abs(tenth(of.rate, 9) - tenth(of.rate, 1)); };
  const std::string at = "generalised-alpha: ";
  result.checks.push_back(
      off_by(at + "stretch, mean of the last tenth", tenth(spin.stretch, 9), kStretch, 2e-3));
  result.checks.push_back(
      {at + "rate of the spin, over (w dt)^2", off(spin) / std::pow(kSpin * 5e-5, 2), 1.});
  result.checks.push_back(
      {at + "its error over that of twice the step (second order)", off(spin) / off(wide), .3});
  result.checks.push_back(
      {at + "its drift over that of twice the step (third order)", drift(spin) / drift(wide), .2});
  result.checks.push_back({at + "the middle leaves its place by, m", off_middle(run), 1e-9});
  result.checks.push_back(holds(at + "no status bit", run.status().empty()));
}

}  // namespace

HardResult spinning(const std::filesystem::path& scene) {
  const HardRun kept = spun(scene, "energy-momentum", 5e-5);
  const HardRun damped = spun(scene, "generalised-alpha", 5e-5);
  HardResult result;
  add_kept(kept, result);
  add_damped(damped, spun(scene, "generalised-alpha", 1e-4), result);
  result.picture = {"time, s", "stretch of the bar, mm", {}};
  for (const auto& [name, run] :
       {std::pair{"energy-momentum", &kept}, {"generalised-alpha", &damped}}) {
    HardCurve curve{name, run->time(), spin_of(*run).stretch};
    for (double& value : curve.y) value *= 1e3;
    result.picture.curves.push_back(curve);
  }
  result.picture.curves.push_back({"rho w^2 L^3/12E", {0., 1.}, {1e3 * kStretch, 1e3 * kStretch}});
  result.frame_us = damped.frame_us();
  return result;
}

}  // namespace railstep
