#pragma once
#include <catch2/catch.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "answer/rules_beam.h"
#include "support/program.h"

namespace railstep {

// An error of 0 still has round-off. The stress at rest is eps of Lame's lambda (167 E at nu =
// .499). It acts as a spring against rotation of eps lambda A along the beam: 1e-11 of 3 E Iy/L^2.
// Measured: 2e-11.
inline constexpr double kRoundOff = 1e-9;

inline constexpr double kInertiaY = 39.0e-6, kInertiaZ = 6.0e-6, kArea = 8700e-6, kShearZ = .4721;
// Errors from the rectangles' printed digits are smaller.
inline constexpr double kPrinted = 1e-9;

/// The program's rows of a family, the default first.
inline const nlohmann::json& rows_of(const std::string& family) {
  static std::map<std::string, nlohmann::json> known;
  if (known.count(family) == 0) {
    const Ran ran = railstep_program("rules --json --family " + family);
    REQUIRE(ran.code == 0);
    known[family] = nlohmann::json::parse(ran.out).at("rows");
  }
  return known[family];
}

inline nlohmann::json row(const nlohmann::json& rows, const std::string& rule, double poisson,
                          int elements, const std::string& load) {
  for (const nlohmann::json& r : rows)
    if (r["rule"] == rule && r["poisson"] == poisson && r["elements"] == elements &&
        r["load"] == load)
      return r;
  FAIL("no row of " << rule << ", " << poisson << ", " << elements << ", " << load);
  return {};
}

/// Deflection under a unit load at x of a cantilever, m/N.
inline double timoshenko(const Material& m, double bending, double shear_factor, double x) {
  return x * x * x / (3. * bending) + x / (shear_factor * m.shear_modulus() * kArea);
}

}  // namespace railstep
