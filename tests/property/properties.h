#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "document.h"
#include "runs.h"

namespace railstep::property {

/// Result of a property on a scene.
struct Outcome {
  enum class Kind { holds, fails, does_not_apply };
  Kind kind = Kind::holds;
  std::string figures;  // found and allowed values

  static Outcome none(const std::string& why) { return {Kind::does_not_apply, why}; }
  static Outcome of(bool holds, const std::string& figures) {
    return {holds ? Kind::holds : Kind::fails, figures};
  }
};

/// A law that every scene obeys. `check` throws InputError if the scene itself is refused.
struct Property {
  const char* name;
  const char* law;
  Outcome (*check)(const Document& scene, std::uint64_t seed);
};
const std::vector<Property>& all_properties();

// The same laws by themselves.
Outcome mirror(const Document& scene, std::uint64_t seed);
Outcome reversal(const Document& scene, std::uint64_t seed);
Outcome mass_scale(const Document& scene, std::uint64_t seed);
Outcome all_scales(const Document& scene, std::uint64_t seed);
Outcome translation(const Document& scene, std::uint64_t seed);
Outcome superposition(const Document& scene, std::uint64_t seed);
Outcome rest(const Document& scene, std::uint64_t seed);
Outcome model_file(const Document& scene, std::uint64_t seed);
Outcome snapshot(const Document& scene, std::uint64_t seed);
Outcome frames(const Document& scene, std::uint64_t seed);
Outcome statics(const Document& scene, std::uint64_t seed);
Outcome stated_error(const Document& scene, std::uint64_t seed);
Outcome energy(const Document& scene, std::uint64_t seed);
Outcome status(const Document& scene, std::uint64_t seed);
Outcome provoked(const Document& scene, std::uint64_t seed);

// Features of a scene.
bool is_track_alone(const Document& scene);
bool is_condensed(const Document& scene);
bool is_endless(const Document& scene);
bool has_one_sided(const Document& scene);
bool has_hertz(const Document& scene);
bool has_bonded(const Document& scene);  // on a spring of 1e15 N/m, for which there is no key

/// Allowed distance of two runs that should agree: `floor`, or kJiggles times the change of the
/// trace when each number of the scene is changed by kJiggle of it, if that is larger. A solve of
/// condition 1e7 leaves that part of 16 digits.
inline constexpr double kJiggle = 1e-9, kJiggles = 10.;
double allowed(const Document& scene, const Trace& trace, double floor);

/// Rounding of a banded solve whose condition is 1e7 (docs/supports.md: 1e-8, condensed 1e-6); 1e-5
/// with a bonded wheel, whose force is 1e15 N/m times a difference of displacements.
double rounding_of(const Document& scene);

/// Compares a scene's trace with that of its image.
Outcome compared(const Document& scene, const Trace& trace, const Document& other,
                 const ImageOf& image, double floor);

}  // namespace railstep::property
