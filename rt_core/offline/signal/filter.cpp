#include "offline/signal/filter.h"

#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <unsupported/Eigen/MatrixFunctions>
#include <utility>

namespace railstep {
namespace {

double rad_per_s(double hz) { return 2. * std::numbers::pi * hz; }

/// 1 + s / (quality w) + s^2 / w^2.
std::vector<double> quadratic(double hz, double quality) {
  const double w = rad_per_s(hz);
  return {1., 1. / (quality * w), 1. / (w * w)};
}
FilterSection second_low_pass(double hz, double quality) { return {{1.}, quadratic(hz, quality)}; }
FilterSection second_high_pass(double hz, double quality) {
  std::vector<double> denominator = quadratic(hz, quality);
  return {{0., 0., denominator[2]}, denominator};
}

/// Qualities of the two pairs of poles of a Butterworth filter of fourth order.
double first_quality() { return .5 / std::cos(std::numbers::pi / 8.); }
double second_quality() { return .5 / std::cos(3. * std::numbers::pi / 8.); }

/// Both ends of the band that EN 12299 weights, and the part after which a weighting falls with
/// the frequency.
AnalogueFilter comfort(double falls_from_hz) {
  const double band = 1. / std::numbers::sqrt2;
  return {second_high_pass(.4, band),
          second_low_pass(100., band),
          {{1., 1. / rad_per_s(falls_from_hz)}, quadratic(falls_from_hz, .63)}};
}

AnalogueFilter ride_index(double factor) {
  const double w = rad_per_s(1.);
  return {{{0., factor * std::sqrt(1.911) / w, factor * .25 / (w * w)},
           {1., 1.563 / w, .277 / (w * w), .0368 / (w * w * w)}}};
}

/// A section in the form x' = A x + b u, y = c x + d u, and its motion over a sample: x goes to
/// F x + first u(0) + second u(dt) as u goes straight.
struct SteppedSection {
  Eigen::MatrixXd F;
  Eigen::VectorXd first, second, rest;  // rest: x under u = 1 that lasts
  Eigen::RowVectorXd c;
  double d;
};

SteppedSection stepped(const FilterSection& section, double dt) {
  const std::vector<double>& a = section.denominator;
  const auto n = static_cast<Eigen::Index>(a.size()) - 1;
  const auto at = [](const std::vector<double>& of, Eigen::Index k) {
    return k < static_cast<Eigen::Index>(of.size()) ? of[static_cast<std::size_t>(k)] : 0.;
  };
  // Time is counted so that the first and the last coefficient are of one size.
  const double last = at(a, n), w = std::pow(a.front() / last, 1. / static_cast<double>(n));
  SteppedSection own;
  own.d = at(section.numerator, n) / last;
  own.c.resize(n);
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n + 2, n + 2);  // over x, u and its change in a sample
  for (Eigen::Index k = 0; k < n; ++k) {
    const double scale = std::pow(w, static_cast<double>(k - n)) / last;
    own.c[k] = (at(section.numerator, k) - own.d * at(a, k)) * scale;
    A(n - 1, k) = -at(a, k) * scale;
    if (k + 1 < n) A(k, k + 1) = 1.;
  }
  A(n - 1, n) = 1.;
  own.rest = A.topLeftCorner(n, n).lu().solve(-A.col(n).head(n));
  A *= w * dt;
  A(n, n + 1) = 1.;
  const Eigen::MatrixXd moved = A.exp();
  own.F = moved.topLeftCorner(n, n);
  own.second = moved.col(n + 1).head(n);
  own.first = moved.col(n).head(n) - own.second;
  return own;
}

}  // namespace

AnalogueFilter low_pass(double hz) {
  return {second_low_pass(hz, first_quality()), second_low_pass(hz, second_quality())};
}
AnalogueFilter high_pass(double hz) {
  return {second_high_pass(hz, first_quality()), second_high_pass(hz, second_quality())};
}
AnalogueFilter band_pass(double from_hz, double to_hz) {
  AnalogueFilter filter = high_pass(from_hz);
  for (FilterSection& section : low_pass(to_hz)) filter.push_back(std::move(section));
  return filter;
}

AnalogueFilter comfort_lateral() { return comfort(2.); }
AnalogueFilter comfort_vertical() {
  AnalogueFilter filter = comfort(16.);
  std::vector<double> rises = quadratic(2.5, .8);
  for (double& coefficient : rises) coefficient *= .4;
  filter.push_back({rises, quadratic(4., .8)});
  return filter;
}

AnalogueFilter ride_index_lateral() { return ride_index(.737); }
AnalogueFilter ride_index_vertical() { return ride_index(.588); }

std::complex<double> response(const AnalogueFilter& filter, double hz) {
  const std::complex<double> s(0., rad_per_s(hz));
  const auto value = [&](const std::vector<double>& of) {
    std::complex<double> sum = 0.;
    for (std::size_t k = of.size(); k-- > 0;) sum = sum * s + of[k];
    return sum;
  };
  std::complex<double> product = 1.;
  for (const FilterSection& own : filter) product *= value(own.numerator) / value(own.denominator);
  return product;
}

std::vector<double> filtered(const AnalogueFilter& filter, std::vector<double> values, double dt) {
  if (values.empty()) return values;
  for (const FilterSection& section : filter) {
    const SteppedSection own = stepped(section, dt);
    Eigen::VectorXd x = own.rest * values.front();
    double before = values.front();
    for (double& value : values) {
      const double now = value;
      if (&value != &values.front()) x = own.F * x + own.first * before + own.second * now;
      value = own.c * x + own.d * now;
      before = now;
    }
  }
  return values;
}

}  // namespace railstep
