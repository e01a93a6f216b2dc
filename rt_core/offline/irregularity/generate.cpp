#include "offline/irregularity/generate.h"

#include <cmath>

#include "offline/irregularity/random.h"
#include "offline/irregularity/sincos.h"
#include "offline/math/refuse.h"

namespace railstep {

namespace {

struct Waves {
  std::int64_t first, last, samples;
};

Waves waves_of(const GenerateOptions& o) {
  if (!(o.shortest > 0.) || !(o.longest >= o.shortest) || !(o.length >= o.longest) ||
      !(o.patch >= 0.))
    refuse("E-IRREGULARITY-06",
           "the wavelengths are out of order; expected 0 < shortest <= longest <= length, and a "
           "contact patch of 0 m or more");
  // A quotient that rounding moves off a whole number of waves still counts as that number.
  const double low = o.length / o.longest, high = o.length / o.shortest;
  if (!(high * kSamplesPerWave * (high - low) < kMostGenerated))
    refuse("E-IRREGULARITY-07",
           "the irregularity has more waves and samples than can be generated in seconds; use a "
           "shorter period or a longer shortest wavelength");
  const Waves waves = {static_cast<std::int64_t>(std::ceil(low * (1. - 1e-12))),
                       static_cast<std::int64_t>(std::floor(high * (1. + 1e-12))),
                       kSamplesPerWave * static_cast<std::int64_t>(std::ceil(high))};
  if (waves.last < waves.first)
    refuse("E-IRREGULARITY-08",
           "no whole number of waves lies between the shortest and the longest wavelength; "
           "expected a wider band");
  return waves;
}

/// Factor by which the mean over the patch reduces a wave.
double patch_factor(double wave_number, double patch) {
  const double half = .5 * wave_number * patch;
  return half > 0. ? cosine_sine(half / kTwoPi).sine / half : 1.;
}

}  // namespace

Signal generate(const Spectrum& spectrum, const GenerateOptions& options, std::uint64_t stream) {
  const Waves waves = waves_of(options);
  const std::int64_t n = waves.samples;
  std::vector<CosineSine> circle;  // of k / n
  for (std::int64_t k = 0; k < n; ++k)
    circle.push_back(cosine_sine(static_cast<double>(k) / static_cast<double>(n)));
  std::vector<double> value(static_cast<std::size_t>(n), 0.);
  const double step = kTwoPi / options.length;
  for (std::int64_t wave = waves.first; wave <= waves.last; ++wave) {
    const double number = static_cast<double>(wave) * step;
    const double amplitude =
        std::sqrt(2. * spectrum.at(number) * step) * patch_factor(number, options.patch);
    const CosineSine phase =
        cosine_sine(uniform(options.seed, stream, static_cast<std::uint64_t>(wave)));
    const double c = amplitude * phase.cosine, s = amplitude * phase.sine;
    for (std::int64_t k = 0, at = 0; k < n; ++k, at = (at + wave) % n) {
      const CosineSine& t = circle[static_cast<std::size_t>(at)];
      value[static_cast<std::size_t>(k)] += c * t.cosine - s * t.sine;
    }
  }
  return fit_signal(value, 0., options.length / static_cast<double>(n), true);
}

}  // namespace railstep
