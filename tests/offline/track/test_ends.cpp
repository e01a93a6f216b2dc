// The motions that the ends of a rail hold: beams with closed forms.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "offline/analysis/modes.h"
#include "offline/analysis/statics.h"
#include "online/math/pi.h"
#include "support/sections.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

Track beam(RailEnds ends) {
  Track t;
  t.section = peers_rectangle();
  t.rails = 1;
  t.bays = 1;
  t.bay_length = 3.;
  t.elements_per_bay = 32;
  t.ends = ends;
  return t;
}

/// Lower root of Timoshenko's characteristic equation for n half waves, Hz.
double timoshenko(double inertia, double shear_factor, const Track& t, int n) {
  const Material& steel = t.material;
  const double k = n * kPi / t.length(), m = steel.density * t.section.area;
  const double r = steel.density * inertia, B = steel.young * inertia;
  const double S = shear_factor * steel.shear_modulus() * t.section.area;
  const double b = m * (S + B * k * k) + r * S * k * k, c = S * B * k * k * k * k;
  return std::sqrt(2. * c / (b + std::sqrt(b * b - 4. * m * r * c))) / (2. * kPi);
}

/// Torsion over n half waves, Hz, with the twist t = (a_z - b_y)/2 and m = (a_z + b_y)/2: G [J k^2,
/// 0; 0, 4 A + Ip k^2] against rho w^2 [Ip, Iz - Iy; Iz - Iy, Ip].
double twisting(const Track& t, int n) {
  const BeamSection& s = t.section;
  const double k = n * kPi / t.length(), Ip = s.inertia_y + s.inertia_z;
  const double D = s.inertia_z - s.inertia_y;
  const double a = s.torsion * k * k, b = 4. * s.area + Ip * k * k;
  // (Ip^2 - D^2) x^2 - Ip (a + b) x + a b = 0, x = rho w^2/G
  const double p = Ip * (a + b), q = (Ip * Ip - D * D) * a * b;
  const double x = 2. * a * b / (p + std::sqrt(p * p - 4. * q));
  return std::sqrt(x * t.material.shear_modulus() / t.material.density) / (2. * kPi);
}

std::vector<double> lowest(const Track& track) {
  std::vector<double> all;
  for (const Line& line : assemble(track))
    for (const double f : lowest_modes(line, 10).frequency) all.push_back(f);
  std::sort(all.begin(), all.end());
  return all;
}

bool has(const std::vector<double>& all, double wanted, double tolerance) {
  return std::any_of(all.begin(), all.end(),
                     [&](double f) { return std::abs(f - wanted) < tolerance * wanted; });
}

/// Deflection of the tip or the middle per newton in one direction.
double flexibility(const Track& track, double x, int direction) {
  const RailPoint at{0, x, 0., 0., direction};
  return Statics(track).flexibility(at, at);
}

}  // namespace

TEST_CASE("between pins a beam bends, twists and stretches in sines", "[ends]") {
  const Track track = beam({RailEnd::pinned, RailEnd::pinned});
  const std::vector<double> all = lowest(track);
  const BeamSection& s = track.section;
  const Material& steel = track.material;
  CHECK(all.front() > 1.);  // nothing is free
  // The quadratic element errs by (k h)^4/720 or less, k h = n pi/32: 1.3e-7 n^4, allowed twice.
  for (int n = 1; n <= 3; ++n) {
    const double tolerance = 2.6e-7 * std::pow(n, 4);
    CHECK(has(all, timoshenko(s.inertia_y, s.shear_factor_z, track, n), tolerance));
    CHECK(has(all, timoshenko(s.inertia_z, s.shear_factor_y, track, n), tolerance));
    const double torsion = twisting(track, n);
    CHECK(has(all, torsion, tolerance));
  }
  // Along x, the section contracts by -nu r_x', with its inertia (Love) and its own shear. The next
  // order is left out, nu^2 (k^2 I/A)^2 = .09 (5.1e-3)^2.
  const double k = kPi / track.length(), nu = steel.poisson, I = s.inertia_y + s.inertia_z;
  const double stiff = steel.young * s.area + steel.shear_modulus() * I * nu * nu * k * k;
  const double heavy = steel.density * (s.area + I * nu * nu * k * k);
  CHECK(has(all, std::sqrt(stiff / heavy) / (2. * track.length()), 2.4e-6));
}

TEST_CASE("each end is held independently", "[ends]") {
  // Cantilever and propped cantilever of Timoshenko's beam, under a force at the end or middle. The
  // element is exact at its nodes; 1e-7 covers a factorisation's rounding, 1e-16 times (L/h)^4.
  const Track left = beam({RailEnd::clamped, RailEnd::free});
  const Track right = beam({RailEnd::free, RailEnd::clamped});
  const double L = left.length(), B = left.material.young * left.section.inertia_y;
  const double S = left.section.shear_factor_z * left.material.shear_modulus() * left.section.area;
  const double tip = L * L * L / (3. * B) + L / S;
  CHECK_THAT(flexibility(left, L, 2), WithinRel(tip, 1e-7));
  CHECK_THAT(flexibility(right, 0., 2), WithinRel(tip, 1e-7));
  // A beam on two pins has L^3/(48 B) + L/(4 S) at its middle.
  const Track pins = beam({RailEnd::pinned, RailEnd::pinned});
  CHECK_THAT(flexibility(pins, L / 2, 2), WithinRel(L * L * L / (48. * B) + L / (4. * S), 1e-7));
  // Clamped and pinned: without the prop a force in the middle moves the tip by w = F (5 L^3/(48 B)
  // + L/(2 S)), and the prop brings it back.
  const Track propped = beam({RailEnd::clamped, RailEnd::pinned});
  const double own = L * L * L / (24. * B) + L / (2. * S);
  const double across = 5. * L * L * L / (48. * B) + L / (2. * S);
  CHECK_THAT(flexibility(propped, L / 2, 2), WithinRel(own - across * across / tip, 1e-7));
  // A pinned end holds the rail's roll, so a torque does not turn it there.
  CHECK_THAT(flexibility(pins, 0., 2), WithinAbs(0., 0.));
}

TEST_CASE("a rail that is pinned at one end only can rotate", "[ends]") {
  CHECK_THROWS_WITH(Statics(beam({RailEnd::pinned, RailEnd::free})), Catch::Contains("E-TRACK-35"));
  // It rotates about y and about z there, and in no other way.
  const std::vector<double> all = lowest(beam({RailEnd::pinned, RailEnd::free}));
  CHECK(std::count(all.begin(), all.end(), 0.) == 2);
}
