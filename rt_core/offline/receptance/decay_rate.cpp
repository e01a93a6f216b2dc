#include "offline/receptance/decay_rate.h"

#include <cmath>

#include "offline/math/refuse.h"

namespace railstep {

namespace {

constexpr std::array<int, 18> kNominal = {100, 125,  160,  200,  250,  315,  400,  500,  630,
                                          800, 1000, 1250, 1600, 2000, 2500, 3150, 4000, 5000};
constexpr int kFirstBand = -10;  // 100 Hz = 1000 Hz 10^(-10/10)

/// Mean |omega^2 H|^2 of each read over the lines of a band.
Eigen::VectorXd band_energy(Receptance& along, const ThirdOctave& band) {
  Eigen::VectorXd sum;
  for (int line = 0; line < kLinesPerBand; ++line) {
    const double hz = band.from + (band.to - band.from) * (line + .5) / kLinesPerBand;
    const Eigen::VectorXd energy = std::pow(hz, 4) * along.at(hz).cwiseAbs2();
    if (line == 0)
      sum = energy;
    else
      sum += energy;
  }
  return sum / kLinesPerBand;
}

}  // namespace

double decay_rate(const std::vector<double>& distance, const std::vector<double>& energy) {
  const std::size_t n = distance.size();
  if (n < 2 || energy.size() != n || distance[0] != 0.)
    refuse("E-RECEPTANCE-01",
           "a decay rate has too few positions or energies; expected two positions or more, the "
           "first at 0, and an energy at each");
  double sum = 0.;
  for (std::size_t i = 0; i < n; ++i) {
    const double before = i == 0 ? 0. : distance[i] - distance[i - 1];
    const double after = i + 1 == n ? before : distance[i + 1] - distance[i];
    sum += energy[i] / energy[0] * .5 * (before + after);
  }
  return kDecayFactor / sum;
}

std::vector<ThirdOctave> third_octaves(double from_hz, double to_hz) {
  std::vector<ThirdOctave> bands;
  for (std::size_t i = 0; i < kNominal.size(); ++i) {
    const double centre = 1e3 * std::pow(10., (static_cast<int>(i) + kFirstBand) / 10.);
    const double half = std::pow(10., .05);
    const ThirdOctave band{kNominal[i], centre / half, centre * half};
    if (band.from >= from_hz && band.to <= to_hz) bands.push_back(band);
  }
  return bands;
}

std::vector<double> decay_distances(const Track& track, double x) {
  const double room = std::max(x, track.length() - x);
  std::vector<double> distance;
  for (const double bays : kDecayBays)
    if (bays * track.bay_length <= room * (1. + 1e-12)) distance.push_back(bays * track.bay_length);
  return distance;
}

std::vector<DecayRate> decay_rates(Receptance& along, const std::vector<double>& distance,
                                   const std::vector<ThirdOctave>& bands) {
  std::vector<DecayRate> rates;
  for (const ThirdOctave& band : bands) {
    const Eigen::VectorXd energy = band_energy(along, band);
    const double rate = decay_rate(distance, {energy.begin(), energy.end()});
    const double drop = 10. * std::log10(energy[0] / energy[energy.size() - 1]);
    const bool far_enough = rate >= 2. * kDecayFactor / distance.back() && drop >= 10.;
    rates.push_back({band, rate, drop, far_enough});
  }
  return rates;
}

}  // namespace railstep
