#include "offline/receptance/resonances.h"

#include <cmath>

#include "offline/math/golden_section.h"
#include "offline/receptance/beam_waves.h"

namespace railstep {

namespace {

double to_hz(double square) { return std::sqrt(square) / (2. * M_PI); }

/// The smaller and the larger root of a w^2 - b w + c = 0.
std::pair<double, double> roots(double a, double b, double c) {
  const double sum = .5 * (b + std::sqrt(b * b - 4. * a * c));
  return {c / sum, sum / a};
}

/// A maximum of sign * |H| between two frequencies.
Extremum narrowed(Receptance& receptance, double low, double high, bool peak) {
  const auto height = [&](double hz) {
    const double magnitude = std::abs(receptance.at(hz)[0]);
    return peak ? magnitude : -magnitude;
  };
  const auto [hz, top] = golden_section(height, low, high, 1e-4 * high);
  return {peak, hz, std::abs(top)};
}

}  // namespace

double half_wave_hz(const Track& track, double length) {
  const BendingBeam beam = bending_beam(track, BeamTheory::timoshenko);
  const double k = std::pow(M_PI / length, 2);
  return to_hz(roots(beam.rotary_inertia * beam.mass * beam.shear_softness,
                     beam.mass * beam.stiffness * beam.shear_softness * k +
                         beam.rotary_inertia * k + beam.mass,
                     beam.stiffness * k * k)
                   .first);
}

std::vector<ExpectedResonance> expected_resonances(const Track& track, double x) {
  const double pad = track.support.stiffness[2];
  const double rail = track.material.density * track.section.area * track.bay_length;
  std::vector<ExpectedResonance> expected;
  if (track.sleeper && track.sleeper->mass > 0.) {
    const double sleeper = track.sleeper->mass / 2., ballast = track.sleeper->ballast_stiffness[2];
    const auto [low, high] =
        roots(rail * sleeper, rail * (pad + ballast) + sleeper * pad, pad * ballast);
    expected = {{"track on ballast", to_hz(low), true, 1.5},
                {"sleeper anti-resonance", to_hz((pad + ballast) / sleeper), false, 1.3},
                {"rail on pads", to_hz(high), true, 1.3}};
  } else if (pad > 0.) {
    const double ballast = track.sleeper ? track.sleeper->ballast_stiffness[2] : 0.;
    const double support = track.sleeper ? pad * ballast / (pad + ballast) : pad;
    expected = {{"rail on supports", to_hz(support / rail), true, 1.3}};
  }
  const double from_seat = std::abs(x / track.bay_length - std::round(x / track.bay_length));
  expected.push_back(
      {"pinned-pinned", half_wave_hz(track, track.bay_length), from_seat > .25, 1.1});
  return expected;
}

std::vector<Extremum> extrema(Receptance& receptance, const std::vector<double>& hz,
                              const std::vector<double>& magnitude) {
  std::vector<Extremum> found;
  for (std::size_t i = 1; i + 1 < hz.size(); ++i) {
    const double before = magnitude[i - 1], here = magnitude[i], after = magnitude[i + 1];
    const bool peak = here > before && here >= after, dip = here < before && here <= after;
    if (peak || dip) found.push_back(narrowed(receptance, hz[i - 1], hz[i + 1], peak));
  }
  return found;
}

std::vector<Resonance> name_resonances(const std::vector<ExpectedResonance>& expected,
                                       std::vector<Extremum> extrema) {
  std::vector<Resonance> named;
  for (const ExpectedResonance& one : expected) {
    named.push_back({one.name, one.hz, std::nullopt});
    std::size_t best = extrema.size();
    double least = std::log(one.within);
    for (std::size_t i = 0; i < extrema.size(); ++i) {
      const double away = std::abs(std::log(extrema[i].hz / one.hz));
      if (extrema[i].peak != one.peak || away > least) continue;
      least = away;
      best = i;
    }
    if (best == extrema.size()) continue;
    named.back().found = extrema[best];
    extrema.erase(extrema.begin() + static_cast<std::ptrdiff_t>(best));
  }
  return named;
}

}  // namespace railstep
