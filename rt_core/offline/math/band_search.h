#pragma once
#include <Eigen/Core>
#include <array>
#include <functional>
#include <optional>
#include <vector>

namespace railstep {

/// Functions of a frequency, [functions][groups]; each call costs a solve.
using Responses = std::function<Eigen::MatrixXcd(double hz)>;

/// The largest magnitude of any function of a group over a band.
struct Largest {
  double hz = 0., size = 0.;
};

/// The result of a search, of one group. A response without damping grows without limit at its
/// resonance, so that it has no largest magnitude.
struct BandSearch {
  std::vector<Largest> largest;       // [groups]
  std::optional<double> undamped_hz;  // a peak narrower than kNarrowest: `largest` has no meaning
  double unresolved = 0.;  // uncertainty of the search, over the largest; of the worst group
  int solves = 0;
};

/// Finds the largest magnitudes in a band, beginning with a grid of logarithmic steps.
///
/// Two rational functions fit the samples of a group: one passes through every second sample, the
/// other through those between, and each fits the rest by least squares. Both find a peak between
/// two samples from its flanks. Where they disagree, or exceed all samples, the next samples are
/// taken, until they agree to kAgree of the largest and it is met to kMet. At most kMostSolves
/// solves.
BandSearch largest_over(const Responses& responses, const std::array<double, 2>& band);

inline constexpr int kFirstSolves = 40, kMostSolves = 800;
inline constexpr double kMet = 1e-3, kAgree = 1e-4;
/// Width of a peak over its frequency. A peak that is narrower belongs to a motion that nothing
/// damps.
inline constexpr double kNarrowest = 1e-8;

}  // namespace railstep
