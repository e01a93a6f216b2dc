#include "offline/irregularity/spline.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "offline/math/refuse.h"

namespace railstep {

namespace {

/// Samples beyond each end: a sample moves coefficients n away by (2 - sqrt 3)^n, 1e-18 at 32.
constexpr int kBeyond = 32;

/// (c[k - 1] + 4 c[k] + c[k + 1]) / 6 = value[k], with c[-1] = c[0] and c[n] = c[n - 1].
std::vector<double> coefficients(std::vector<double> value) {
  const std::size_t n = value.size();
  std::vector<double> upper(n);
  double pivot = n == 1 ? 6. : 5.;
  value[0] *= 6. / pivot;
  for (std::size_t k = 1; k < n; ++k) {
    upper[k - 1] = 1. / pivot;
    pivot = (k == n - 1 ? 5. : 4.) - upper[k - 1];
    value[k] = (6. * value[k] - value[k - 1]) / pivot;
  }
  for (std::size_t k = n - 1; k-- > 0;) value[k] -= upper[k] * value[k + 1];
  return value;
}

/// The spline's integral from its start to a place; of a periodic signal over whole periods too.
class Integral {
 public:
  explicit Integral(const Signal& signal) : model_(signal.model()), whole_{0.} {
    for (std::int32_t i = 0; i < model_.intervals; ++i) {
      const double* c = model_.coefficient + i;
      whole_.push_back(whole_.back() + model_.step / 24. * ((c[0] + c[3]) + 11. * (c[1] + c[2])));
    }
  }
  double operator()(double place) const {
    const double n = model_.intervals, at = (place - model_.start) / model_.step;
    if (model_.periodic == 0 && at <= 0.) return at * model_.step * end_value(0.);
    if (model_.periodic == 0 && at >= n)
      return whole_.back() + (at - n) * model_.step * end_value(n);
    const double periods = model_.periodic != 0 ? std::floor(at / n) : 0.;
    return periods * whole_.back() + within(at - periods * n);
  }

 private:
  double end_value(double at) const {
    return signal_at(model_, model_.start + at * model_.step).value;
  }
  /// Simpson's rule is exact for the cubic from the interval's start.
  double within(double at) const {
    const auto i = std::min(static_cast<std::int32_t>(at), model_.intervals - 1);
    const double first = model_.start + i * model_.step, length = (at - i) * model_.step;
    const auto value = [&](double part) { return signal_at(model_, first + part * length).value; };
    return whole_[static_cast<std::size_t>(i)] +
           length / 6. * (value(0.) + 4. * value(.5) + value(1.));
  }
  SignalModel model_;
  std::vector<double> whole_;  // [intervals + 1]
};

}  // namespace

SignalModel Signal::model() const {
  const auto intervals =
      coefficient.empty() ? 0 : static_cast<std::int32_t>(coefficient.size()) - 3;
  return {start, step, intervals, periodic ? 1 : 0, coefficient.data()};
}

Signal fit_signal(const std::vector<double>& samples, double start, double step, bool periodic) {
  if (samples.empty())
    refuse("E-IRREGULARITY-10", "the signal is empty; expected one sample or more");
  if (!(step > 0.))
    refuse("E-IRREGULARITY-11",
           "the step of a signal is " + std::to_string(step) + "; expected above 0");
  const int n = static_cast<int>(samples.size());
  std::vector<double> longer;
  for (int k = -kBeyond; k < n + kBeyond; ++k) {
    const int place = periodic ? ((k % n) + n) % n : std::clamp(k, 0, n - 1);
    longer.push_back(samples[static_cast<std::size_t>(place)]);
  }
  std::vector<double> c = coefficients(std::move(longer));
  if (!periodic) return {start - (kBeyond - 1) * step, step, false, std::move(c)};
  const auto first = c.begin() + kBeyond - 1;
  return {start, step, true, {first, first + n + 3}};
}

Signal averaged(const Signal& signal, double length) {
  if (!(length > 0.) || signal.coefficient.empty()) return signal;
  const Integral integral(signal);
  const int intervals = signal.model().intervals;
  std::vector<double> samples;
  for (int k = 0; k < intervals + (signal.periodic ? 0 : 1); ++k) {
    const double at = signal.start + k * signal.step;
    samples.push_back((integral(at + .5 * length) - integral(at - .5 * length)) / length);
  }
  return fit_signal(samples, signal.start, signal.step, signal.periodic);
}

}  // namespace railstep
