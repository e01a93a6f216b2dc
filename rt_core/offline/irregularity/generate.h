#pragma once
#include <cstdint>

#include "offline/irregularity/spectrum.h"
#include "offline/irregularity/spline.h"

namespace railstep {

/// Options of a generated irregularity.
struct GenerateOptions {
  double shortest = 3., longest = 25.;  // wavelengths, m
  double length = 1000.;                // m, after which it repeats; the longest wave or more
  double patch = 0.;                    // length of the contact patch it is averaged over, m
  std::uint64_t seed = 1;
};

/// Least number of samples in the shortest wave: the spline misses it by 6e-5 of its amplitude.
inline constexpr int kSamplesPerWave = 16;

/// Most samples times waves of one signal; a few seconds.
inline constexpr double kMostGenerated = 4e9;

/// A periodic signal with that spectrum: a cosine for each whole number of waves n in `length`
/// within the band, W = 2 pi n / length, of amplitude sqrt(2 S(W) 2 pi / length) and a random phase
/// (Shinozuka and Deodatis, Appl. Mech. Rev. 44, 1991), times sin(W patch / 2) / (W patch / 2).
/// Its periodogram is the spectrum, wave by wave. The same bits on every machine.
/// @param stream  distinguishes the signals of one seed
/// Throws Refused on a band without waves, and on more work than kMostGenerated.
Signal generate(const Spectrum& spectrum, const GenerateOptions& options, std::uint64_t stream);

}  // namespace railstep
