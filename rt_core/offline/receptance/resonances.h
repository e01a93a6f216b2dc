#pragma once
#include <optional>
#include <string>
#include <vector>

#include "offline/receptance/receptance.h"

namespace railstep {

/// Resonances expected in a track's driving-point receptance, from one bay of rail and one seat.
struct ExpectedResonance {
  const char* name;
  double hz;
  bool peak;      // false: a dip
  double within;  // farthest ratio of frequencies at which an extremum is still taken for it
};

/// Rail of one bay on the pad, half a sleeper on the ballast. Both move in phase ("track on
/// ballast"), the sleeper is an absorber under a held rail ("sleeper anti-resonance", a dip), or
/// both move against each other ("rail on pads"). Where no sleeper has mass the rail moves on its
/// supports. Half a Timoshenko wave fits between two seats ("pinned-pinned"): a peak if the point
/// is nearer to the middle of a bay, else a dip.
/// @param x  of the driving point, m
std::vector<ExpectedResonance> expected_resonances(const Track& track, double x);

/// Frequency at which a beam swings in half waves of a length, Hz: the lower root of
/// EI k^4 - (m EI/(k_z G A) k^2 + rho I k^2 + m) w + rho I m/(k_z G A) w^2 = 0, w = omega^2,
/// k = pi/length.
double half_wave_hz(const Track& track, double length);

/// An extremum of |H| over frequency.
struct Extremum {
  bool peak;
  double hz, magnitude;  // Hz, m/N
};

/// Those of the first read between the frequencies, each found on the grid and then narrowed to
/// 1e-4 of its frequency by golden section. @param magnitude  |H| at the frequencies, m/N
std::vector<Extremum> extrema(Receptance& receptance, const std::vector<double>& hz,
                              const std::vector<double>& magnitude);

struct Resonance {
  const char* name;
  double expected_hz;
  std::optional<Extremum> found;  // empty: no extremum of its kind near
};

/// Names extrema: each expectation takes the nearest of its kind that is left.
std::vector<Resonance> name_resonances(const std::vector<ExpectedResonance>& expected,
                                       std::vector<Extremum> extrema);

}  // namespace railstep
