// The pinned-pinned frequency: half a bending wave fits between two seats.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "offline/analysis/modes.h"
#include "offline/analysis/statics.h"
#include "support/sections.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

/// Seats that hold the rail's height and leave its slope free.
Track pinned(int bays, int elements_per_bay) {
  Track t;
  t.section = section_f();
  t.section.shear_factor_z = .472;  // as in reference.md's row
  t.unknowns = Unknowns::vertical;
  t.rails = 1;
  t.bays = bays;
  t.elements_per_bay = elements_per_bay;
  t.support.stiffness = {0., 0., 1e15};
  return t;
}

/// Lower root of Timoshenko's characteristic equation for n half waves over `length`, Hz:
///   m r w^4 - [m (S + EI k^2) + r S k^2] w^2 + S EI k^4 = 0,  k = n pi/length,
/// m = rho A, r = rho I, S = kappa G A.
double timoshenko(const BeamSection& s, const Material& steel, double length, int n) {
  const double pi = 3.14159265358979323846, k = n * pi / length;
  const double m = steel.density * s.area, r = steel.density * s.inertia_y;
  const double B = steel.young * s.inertia_y;
  const double S = s.shear_factor_z * steel.shear_modulus() * s.area;
  const double b = m * (S + B * k * k) + r * S * k * k, c = S * B * k * k * k * k;
  return std::sqrt(2. * c / (b + std::sqrt(b * b - 4. * m * r * c))) / (2. * pi);
}

double exact(const Track& t) { return timoshenko(t.section, t.material, t.bay_length, 1); }

/// All frequencies, lowest first. @param struck  the end heights are removed instead of sprung
Eigen::VectorXd frequencies(const Track& track, bool struck = false) {
  Line line = assemble(track)[0];
  std::vector<int> kept;
  for (int i = 0; i < line.unknowns(); ++i)
    if (!struck || (i != line.unknown_of[0].front()[2] && i != line.unknown_of[0].back()[2]))
      kept.push_back(i);
  const Eigen::MatrixXd K(line.stiffness), M(line.mass);
  line.stiffness = Eigen::MatrixXd(K(kept, kept)).sparseView();
  line.mass = Eigen::MatrixXd(M(kept, kept)).sparseView();
  return modes(line).frequency;
}

double nearest(const Eigen::VectorXd& all, double wanted) {
  double best = all[0];
  for (const double f : all)
    if (std::abs(f - wanted) < std::abs(best - wanted)) best = f;
  return best;
}

}  // namespace

TEST_CASE("the closed form is the printed pinned-pinned frequency", "[modes]") {
  // reference.md has 1141.44 Hz for k_z = .472: five units of k_z's fourth digit are open.
  Track f = pinned(1, 1);
  const double found = exact(f);
  f.section.shear_factor_z += 5e-4;
  CHECK_THAT(found, WithinAbs(1141.44, exact(f) - found));
  // rail-data.md has 1067.27 Hz for R60 with a shear factor of .4: half of the last digit.
  Track r60 = pinned(1, 1);
  r60.section = {.area = 7670e-6,
                 .inertia_y = 3038.3e-8,
                 .inertia_z = 512e-8,
                 .torsion = 221e-8,
                 .shear_factor_z = .4};
  CHECK_THAT(exact(r60), WithinAbs(1067.27, 5e-3));
}

TEST_CASE("1, 2 and 4 elements per bay have the printed errors of the pinned-pinned frequency",
          "[modes]") {
  // reference.md: +6.8 %, +0.82 %, +0.056 %, half of the last digit. The seats yield by the bay's
  // pi^4 EI/(2 l^3) = 1.8e9 N/m over 1e15, both: 1e-6 of the frequency.
  const double printed[3] = {6.8, .82, .056}, half[3] = {.05, .005, .0005};
  const int elements[3] = {1, 2, 4};
  for (int i = 0; i < 3; ++i) {
    const Track t = pinned(1, elements[i]);
    const double error = 100. * (frequencies(t)[0] / exact(t) - 1.);
    CAPTURE(elements[i], error);
    CHECK_THAT(error, WithinAbs(printed[i], half[i]));
  }
}

TEST_CASE("the mesh's pinned-pinned frequency converges with fourth order to the closed form",
          "[modes]") {
  // Quadratic shapes with two axial points have 2 p = 4. The next term is of order 6: with 4
  // elements it is (pi/8)^2 = .15 of the first or less, which changes the order by .2 at most.
  const auto error = [](int elements) {
    const Track t = pinned(1, elements);
    return frequencies(t, true)[0] / exact(t) - 1.;
  };
  for (const int n : {4, 8}) {
    CAPTURE(n, error(n), error(2 * n));
    CHECK_THAT(std::log2(error(n) / error(2 * n)), WithinAbs(4., .2));
  }
}

TEST_CASE("a rail of many bays has the pinned-pinned frequency of one bay", "[modes]") {
  // Alternating half waves need no moment over the seats. A seat between two bays carries twice the
  // force of one at an end; 2e-6 is for the seats' springs, as above.
  for (const int elements : {1, 2, 4}) {
    const double one = frequencies(pinned(1, elements))[0];
    CHECK_THAT(nearest(frequencies(pinned(5, elements)), one), WithinRel(one, 2e-6));
  }
}

TEST_CASE("all nine unknowns have the pinned-pinned frequency of the vertical ones alone",
          "[modes]") {
  // With the shear centre at the centroid, only height and vertical slope are coupled.
  Track t = pinned(1, 4);
  const double vertical = frequencies(t)[0];
  t.unknowns = Unknowns::full;
  t.section.shear_centre_z = 0.;
  int found = 0;
  for (const Line& line : assemble(t)) {
    if (line.unknown(0, 0, 2) < 0) continue;
    ++found;
    // The matrices are the same, perhaps in another order: rounding over the seats' 1e15 N/m, eps
    // 1e15/(5 kg)/(2 pi 1141/s)^2 = 1e-9.
    CHECK_THAT(nearest(modes(line).frequency, vertical), WithinRel(vertical, 1e-8));
  }
  CHECK(found == 1);
}
