#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <stdexcept>
#include <vector>

#include "offline/irregularity/generate.h"
#include "offline/irregularity/rails.h"
#include "offline/irregularity/random.h"
#include "offline/irregularity/sincos.h"
#include "online/math/pi.h"

using namespace railstep;

namespace {

/// Standard deviation of a band, by quadrature of the density over log W.
double deviation(const Spectrum& spectrum, double shortest, double longest) {
  const int steps = 20000;
  const double low = std::log(2. * kPi / longest), high = std::log(2. * kPi / shortest);
  double sum = 0.;
  for (int i = 0; i < steps; ++i) {
    const double w = std::exp(low + (i + .5) / steps * (high - low));
    sum += spectrum.at(w) * w * (high - low) / steps;
  }
  return std::sqrt(sum);
}

const Spectrum& named(const char* name, Geometry geometry) {
  return find_spectra(name)->of[static_cast<std::size_t>(geometry)];
}

/// The signal at the start of each of its intervals.
std::vector<double> sampled(const Signal& signal) {
  const SignalModel model = signal.model();
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(model.intervals));
  for (int k = 0; k < model.intervals; ++k)
    values.push_back(signal_at(model, k * signal.step).value);
  return values;
}

/// n samples of one period of a wave, starting at its phase (in periods).
std::vector<double> wave(int n, double phase) {
  std::vector<double> samples(static_cast<std::size_t>(n));
  for (int k = 0; k < n; ++k)
    samples[static_cast<std::size_t>(k)] =
        std::sin(2. * kPi * (k / static_cast<double>(n) + phase));
  return samples;
}

/// Amplitude of the wave that fits n times into a periodic signal, by a direct Fourier sum.
double amplitude(const Signal& signal, int n) {
  const int samples = 16 * signal.model().intervals;
  const double step = signal.step / 16.;
  std::complex<double> sum = 0.;
  for (int k = 0; k < samples; ++k)
    sum += signal_at(signal.model(), k * step).value *
           std::polar(1., -2. * kPi * n * k / static_cast<double>(samples));
  return 2. * std::abs(sum) / samples;
}

}  // namespace

TEST_CASE("cosine and sine of a turn agree with the library's to their last bits") {
  for (int i = -4000; i <= 4000; ++i) {
    const double t = i / 997.;
    const CosineSine own = cosine_sine(t);
    CHECK(std::fabs(own.cosine - std::cos(2. * kPi * t)) < 1e-14);  // 2 pi t errs by its own ulp
    CHECK(std::fabs(own.sine - std::sin(2. * kPi * t)) < 1e-14);
  }
  for (const double quarter : {-2., -1.75, -.5, -.25, 0., .25, .5, 1., 3.}) {
    const CosineSine own = cosine_sine(quarter);
    CHECK(own.cosine * own.cosine + own.sine * own.sine == 1.);
    CHECK(own.cosine * own.sine == 0.);
  }
}

TEST_CASE("random numbers are uniform and do not correlate") {
  const int n = 100000;
  double mean = 0., square = 0., next = 0., other = 0.;
  for (std::uint64_t i = 0; i < n; ++i) {
    const double u = uniform(7, 0, i) - .5;
    REQUIRE((u >= -.5 && u < .5));
    mean += u / n;
    square += u * u / n;
    next += u * (uniform(7, 0, i + 1) - .5) / n;
    other += u * (uniform(7, 1, i) - .5) / n;
  }
  // Each bound is four standard deviations of a mean: sqrt(1/12 n), sqrt(1/180 n), sqrt(1/144 n).
  CHECK(std::fabs(mean) < 4. * std::sqrt(1. / 12. / n));
  CHECK(std::fabs(square - 1. / 12.) < 4. * std::sqrt(1. / 180. / n));
  CHECK(std::fabs(next) < 4. / 12. / std::sqrt(n));
  CHECK(std::fabs(other) < 4. / 12. / std::sqrt(n));
}

TEST_CASE("named spectra have the published deviations in their bands") {
  // rail-data gives standard deviations of the one-sided densities to four digits.
  CHECK(deviation(named("ore_low", Geometry::vertical), 3., 25.) == Approx(.984e-3).epsilon(1e-3));
  CHECK(deviation(named("ore_high", Geometry::vertical), 3., 25.) ==
        Approx(1.611e-3).epsilon(1e-3));
  CHECK(deviation(named("ore_low", Geometry::vertical), 3., 70.) == Approx(1.922e-3).epsilon(1e-3));
  CHECK(deviation(named("ore_high", Geometry::vertical), 3., 70.) ==
        Approx(3.145e-3).epsilon(1e-3));
  CHECK(deviation(named("fra_4", Geometry::vertical), 3., 25.) == Approx(5.691e-3).epsilon(1e-3));
  CHECK(deviation(named("fra_5", Geometry::vertical), 3., 25.) == Approx(3.553e-3).epsilon(1e-3));
  CHECK(deviation(named("fra_6", Geometry::vertical), 3., 25.) == Approx(1.429e-3).epsilon(1e-3));
  // GENSYS prints the high level at 0.00318 1/m in m2/(1/m).
  CHECK(2. * kPi * named("ore_high", Geometry::vertical).at(.02) ==
        Approx(8.2268e-3).epsilon(2e-3));
  CHECK(2. * kPi * named("ore_high", Geometry::alignment).at(.02) ==
        Approx(4.6657e-3).epsilon(2e-3));
  // Far above all corners the cross level has 4 Av Wc2 / W4 of heights over 1.5 m.
  CHECK(named("ore_low", Geometry::cross_level).at(1e3) ==
        Approx(4. * 4.032e-7 * .8246 * .8246 / 1e12).epsilon(1e-5));
  CHECK(find_spectra("ore_middle") == nullptr);
}

TEST_CASE("a signal passes its samples, is twice differentiable and is constant beyond its ends") {
  std::vector<double> samples;
  for (std::uint64_t k = 0; k < 40; ++k) samples.push_back(uniform(3, 0, k));
  for (const bool periodic : {false, true}) {
    const Signal signal = fit_signal(samples, -2., .25, periodic);
    const SignalModel model = signal.model();
    for (int k = 0; k < 40; ++k)
      CHECK(std::fabs(signal_at(model, -2. + .25 * k).value -
                      samples[static_cast<std::size_t>(k)]) < 1e-14);
    for (int k = -8; k < 48; ++k) {  // both sides of every knot
      const double at = -2. + .25 * k, h = 1e-9;
      const SignalValue before = signal_at(model, at - h), after = signal_at(model, at + h);
      CHECK(std::fabs(after.value - before.value) < 3. * h * 20.);
      CHECK(std::fabs(after.slope - before.slope) < 3. * h * 400.);
      CHECK(std::fabs(after.curvature - before.curvature) < 3. * h * 5000.);
      const SignalValue here = signal_at(model, at + .1);
      const double d = 1e-5;
      const SignalValue up = signal_at(model, at + .1 + d), down = signal_at(model, at + .1 - d);
      CHECK(std::fabs((up.value - down.value) / (2. * d) - here.slope) < 1e-6);
      CHECK(std::fabs((up.slope - down.slope) / (2. * d) - here.curvature) < 1e-4);
    }
    if (periodic) {
      CHECK(std::fabs(signal_at(model, 1.37).value - signal_at(model, 1.37 + 7e6 * 10.).value) <
            1e-6);  // a position of 7e7 m is known to 1.5e-8
    } else {
      CHECK(std::fabs(signal_at(model, -100.).value - samples.front()) < 1e-14);
      CHECK(std::fabs(signal_at(model, 1e9).value - samples.back()) < 1e-14);
      CHECK(signal_at(model, -100.).slope == Approx(0.).margin(1e-13));
    }
  }
}

TEST_CASE("the spline of a wave converges with the fourth order of the sample distance") {
  double before = 0.;
  for (const int n : {8, 16, 32, 64}) {
    const Signal signal = fit_signal(wave(n, 0.), 0., 1. / n, true);
    double error = 0.;
    for (int k = 0; k < 1000; ++k)
      error = std::max(error, std::fabs(signal_at(signal.model(), k / 1000.).value -
                                        std::sin(2. * kPi * k / 1000.)));
    CHECK(error < 1.2 * std::pow(2. * kPi / n, 4) / 384.);
    if (before > 0.) CHECK(std::log2(before / error) == Approx(4.).margin(.2));
    before = error;
  }
}

TEST_CASE("a mean over the contact patch multiplies a wave by sin(x) / x") {
  const int n = 64;
  const double length = .3, x = kPi * length;
  const Signal mean = averaged(fit_signal(wave(n, .25), 0., 1. / n, true), length);
  CHECK(amplitude(mean, 1) == Approx(std::sin(x) / x).epsilon(1e-6));
  // A step of one sample becomes a ramp of the patch's length.
  std::vector<double> step(200, 0.);
  std::fill(step.begin() + 100, step.end(), 1e-3);
  const Signal ramp = averaged(fit_signal(step, 0., .01, false), .4);
  const auto at = [&](double s) { return signal_at(ramp.model(), s).value; };
  CHECK(at(.79) == Approx(0.).margin(1e-5));
  CHECK(at(.995) == Approx(.5e-3).epsilon(1e-9));
  CHECK(at(1.095) == Approx(.75e-3).epsilon(1e-3));
  CHECK(at(1.2) == Approx(1e-3).epsilon(1e-2));
  CHECK(at(40.) == Approx(1e-3).epsilon(1e-12));
}

TEST_CASE(
    "a generated signal has the spectrum asked for in every wave, and the variance of the band") {
  GenerateOptions options;
  options.length = 200.;
  options.seed = 42;
  for (const double patch : {0., .012}) {
    options.patch = patch;
    const Spectrum& spectrum = named("ore_high", Geometry::vertical);
    const Signal signal = generate(spectrum, options, 0);
    const double step = 2. * kPi / options.length;
    for (const int n : {8, 9, 20, 41, 66}) {
      const double got = amplitude(signal, n);
      // The spline errs by 6e-5 at 16 samples per shortest wave.
      CHECK(got * got / (2. * step) == Approx(spectrum.at(n * step)).epsilon(2e-4));
    }
    CHECK(amplitude(signal, 7) < 1e-7);   // longer than 25 m
    CHECK(amplitude(signal, 67) < 1e-7);  // shorter than 3 m
    double square = 0.;
    const int samples = signal.model().intervals;
    for (const double z : sampled(signal)) square += z * z / samples;
    // Whole waves fill the band: at both ends one more or less of 59.
    CHECK(std::sqrt(square) == Approx(deviation(spectrum, 3., 25.)).epsilon(.05));
  }
}

TEST_CASE("a generated signal depends on its seed and its stream only") {
  const Spectrum& spectrum = named("fra_5", Geometry::alignment);
  GenerateOptions options;
  options.length = 100.;
  const Signal first = generate(spectrum, options, 0);
  CHECK(first.coefficient == generate(spectrum, options, 0).coefficient);
  const auto correlation = [&](const Signal& other) {
    const std::vector<double> a = sampled(first), b = sampled(other);
    double ab = 0., aa = 0., bb = 0.;
    for (std::size_t k = 0; k < a.size(); ++k) {
      ab += a[k] * b[k];
      aa += a[k] * a[k];
      bb += b[k] * b[k];
    }
    return ab / std::sqrt(aa * bb);
  };
  CHECK(correlation(first) == Approx(1.));
  CHECK(std::fabs(correlation(generate(spectrum, options, 1))) < .7);
  options.seed = 2;
  CHECK(std::fabs(correlation(generate(spectrum, options, 0))) < .7);
}

TEST_CASE("rails lie where the track geometry places them") {
  std::array<Signal, kGeometries> geometry;
  GenerateOptions options;
  options.length = 100.;
  for (const Geometry g : {Geometry::vertical, Geometry::cross_level, Geometry::gauge})
    geometry[static_cast<std::size_t>(g)] =
        generate(named("german_high", g), options, static_cast<std::uint64_t>(g));
  const RailSignals rails = rails_of(geometry);
  const auto value = [](const Signal& s, double x) { return signal_at(s.model(), x).value; };
  for (int k = 0; k < 20; ++k) {
    const double x = 4.3 * k;
    const double left = value(rails.z[0], x), right = value(rails.z[1], x);
    CHECK(.5 * (left + right) == Approx(value(geometry[0], x)).margin(1e-16));
    CHECK(left - right == Approx(value(geometry[2], x)).margin(1e-16));
    CHECK(value(rails.y[0], x) == Approx(.5 * value(geometry[3], x)).margin(1e-16));
    CHECK(value(rails.y[1], x) == -value(rails.y[0], x));
  }
  options.length = 50.;
  geometry[1] = generate(named("german_high", Geometry::alignment), options, 1);
  CHECK_THROWS_WITH(rails_of(geometry), Catch::Contains("E-IRREGULARITY-09"));
}

TEST_CASE("bands without a whole wave, or with too many samples, are refused") {
  const Spectrum& spectrum = named("fra_5", Geometry::vertical);
  GenerateOptions options;
  options.shortest = 24.;
  options.longest = 24.5;
  options.length = 25.;
  CHECK_THROWS_WITH(generate(spectrum, options, 0), Catch::Contains("E-IRREGULARITY-08"));
  options = {};
  options.shortest = 1e-3;
  CHECK_THROWS_AS(generate(spectrum, options, 0), std::invalid_argument);
  options = {};
  options.length = 20.;
  CHECK_THROWS_AS(generate(spectrum, options, 0), std::invalid_argument);
  CHECK_THROWS_AS(fit_signal({}, 0., 1., false), std::invalid_argument);
  CHECK_THROWS_AS(fit_signal({1.}, 0., 0., false), std::invalid_argument);
}
