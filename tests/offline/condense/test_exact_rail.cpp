// Exact beams between seats, with named resonances and decay rates, against closed forms.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <vector>

#include "offline/receptance/decay_rate.h"
#include "offline/receptance/exact_rail.h"
#include "offline/receptance/full_order.h"
#include "offline/receptance/resonances.h"
#include "support/foundation.h"
#include "support/reference_tracks.h"
#include "support/sections.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

using Value = std::complex<double>;

Transfer driving(double x) {
  const Functional point = rail_point({0, x, 0., 0., 2});
  return {point, {point}};
}

Track s1(int bays) {
  Track t = s1_rail(bays);
  t.elements_per_bay = 4;
  return t;
}

std::vector<double> steps(double from, double to, double ratio) {
  std::vector<double> hz;
  for (double f = from; f <= to; f *= ratio) hz.push_back(f);
  return hz;
}

std::vector<Resonance> resonances(const Track& track, double x) {
  FullOrderReceptance receptance(track, driving(x));
  const std::vector<double> hz = steps(30., 2000., 1.02);
  std::vector<double> magnitude;
  magnitude.reserve(hz.size());
  for (const double f : hz) magnitude.push_back(std::abs(receptance.at(f)[0]));
  return name_resonances(expected_resonances(track, x), extrema(receptance, hz, magnitude));
}

}  // namespace

TEST_CASE("one bay between pins has the resonances of the closed forms", "[exact-rail]") {
  // rail-data.md, section 3: Timoshenko has 1067.27 Hz and Euler-Bernoulli 1420.4, to half a unit
  // of the last digit. Without damping the receptance changes its sign there.
  Track track = s1(1);
  track.support = {};
  track.sleeper.reset();
  track.ends = {RailEnd::pinned, RailEnd::pinned};
  CHECK_THAT(half_wave_hz(track, .6), WithinAbs(1067.27, .005));
  const auto changes = [&](BeamTheory theory, double low, double high) {
    ExactRailReceptance rail(track, driving(.3), theory);
    return rail.at(low)[0].real() > 0. && rail.at(high)[0].real() < 0.;
  };
  CHECK(changes(BeamTheory::timoshenko, 1067.265, 1067.275));
  CHECK(changes(BeamTheory::euler_bernoulli, 1420.35, 1420.45));
  // Between pins H(mid) of Euler's beam is (tan b - tanh b)/(4 EI k^3), b = k L/2, the textbook
  // form of L/(4 EI (kL/2)^3) (tan - tanh)(kL/2) L^2/8.
  const double EI = 210e9 * 3038.3e-8, m = 7850. * 7670e-6;
  for (const double hz : {100., 900., 1700.}) {
    const double k = std::pow(m * std::pow(2. * M_PI * hz, 2) / EI, .25), b = .3 * k;
    const Value got =
        ExactRailReceptance(track, driving(.3), BeamTheory::euler_bernoulli).at(hz)[0];
    // 1e-8 is the rounding of four waves whose amplitudes are 1e4 times their sum.
    CHECK_THAT(got.real(), WithinRel((std::tan(b) - std::tanh(b)) / (4. * EI * k * k * k), 1e-8));
  }
}

TEST_CASE("an endless track has S1's receptance to the digits printed", "[exact-rail]") {
  // rail-data.md, section 3, "exact (Timoshenko transfer matrices + Floquet)", in nm/N to half a
  // unit of the last digit.
  struct Row {
    double hz, mid, mid_half, over, over_half;
  };
  constexpr Row kRows[] = {{50., 11.695, 5e-4, 11.389, 5e-4}, {100., 8.238, 5e-4, 8.230, 5e-4},
                           {200., 2.405, 5e-4, 2.165, 5e-4},  {300., 3.867, 5e-4, 3.064, 5e-4},
                           {400., 6.436, 5e-4, 5.264, 5e-4},  {500., 3.711, 5e-4, 3.061, 5e-4},
                           {800., 1.316, 5e-4, .9867, 5e-5},  {1000., 1.209, 5e-4, .5591, 5e-5},
                           {1100., 1.442, 5e-4, .1132, 5e-5}, {2000., .2934, 5e-5, .3043, 5e-5}};
  const Track track = s1(2);  // its length does not matter
  ExactRailReceptance mid(track, driving(.9), BeamTheory::timoshenko, true),
      over(track, driving(.6), BeamTheory::timoshenko, true),
      longer(s1(9), driving(2.7), BeamTheory::timoshenko, true);
  for (const Row& row : kRows) {
    CAPTURE(row.hz);
    // A tenth more covers the digits of the constants (k G A is known to 1e-4).
    CHECK_THAT(1e9 * std::abs(mid.at(row.hz)[0]), WithinAbs(row.mid, 1.1 * row.mid_half));
    CHECK_THAT(1e9 * std::abs(over.at(row.hz)[0]), WithinAbs(row.over, 1.1 * row.over_half));
    CHECK(std::abs(longer.at(row.hz)[0] / mid.at(row.hz)[0] - 1.) < 1e-9);
  }
}

TEST_CASE("Euler-Bernoulli is 17 % stiffer on S1 at 200 to 400 Hz", "[exact-rail]") {
  // Users of Euler codes read this figure; over the band it is 15 to 24 % at mid-bay.
  const Track track = s1(40);
  ExactRailReceptance timoshenko(track, driving(12.3), BeamTheory::timoshenko),
      euler(track, driving(12.3), BeamTheory::euler_bernoulli);
  double sum = 0.;
  int count = 0;
  for (double hz = 200.; hz <= 400.; hz += 20.) {
    const double less = 1. - std::abs(euler.at(hz)[0]) / std::abs(timoshenko.at(hz)[0]);
    CAPTURE(hz, less);
    CHECK(less > .15);
    CHECK(less < .24);
    sum += less;
    ++count;
  }
  CHECK_THAT(sum / count, WithinAbs(.2, .03));
}

TEST_CASE("the program finds and names the resonances of S1", "[resonances]") {
  // rail-data.md, extrema of the infinite track: frequencies hold within 1 %, heights within 2 %
  // except that of the pinned-pinned peak.
  const Track track = s1(120);
  const std::vector<Resonance> mid = resonances(track, 36.3), over = resonances(track, 36.);
  const double mid_hz[4] = {63., 199.25, 401., 1067.25}, mid_nm[3] = {12.016, 2.405, 6.437};
  const double over_hz[4] = {63.75, 217., 402., 1091.}, over_nm[3] = {11.757, 2.074, 5.267};
  const char* const names[4] = {"track on ballast", "sleeper anti-resonance", "rail on pads",
                                "pinned-pinned"};
  REQUIRE(mid.size() == 4);
  REQUIRE(over.size() == 4);
  for (std::size_t i = 0; i < 4; ++i) {
    CAPTURE(names[i]);
    CHECK(std::string(mid[i].name) == names[i]);
    REQUIRE(mid[i].found);
    REQUIRE(over[i].found);
    CHECK_THAT(mid[i].found->hz, WithinRel(mid_hz[i], .01));
    CHECK_THAT(over[i].found->hz, WithinRel(over_hz[i], .01));
    if (i == 3) continue;
    CHECK_THAT(1e9 * mid[i].found->magnitude, WithinRel(mid_nm[i], .02));
    CHECK_THAT(1e9 * over[i].found->magnitude, WithinRel(over_nm[i], .02));
  }
  CHECK(mid[3].found->peak);
  CHECK_FALSE(over[3].found->peak);  // under a seat the same wave has a node
}

TEST_CASE("a decay rate is the sum of the standard over its 29 positions", "[decay-rate]") {
  // EN 15461, A.1 and A.2: e^(-beta x) has 8.686 beta dB/m. The positions 0, 0.5 and 1.4 m stand
  // for 0.25, 0.7 and 0.9 m.
  CHECK_THAT(decay_rate({0., .5, 1.4}, {4., 1., .5}),
             WithinRel(4.343 / (.25 + .7 / 4. + .9 / 8.), 1e-14));
  std::vector<double> distance, energy;
  for (int i = 0; i < 4000; ++i) {
    distance.push_back(.01 * i);
    energy.push_back(std::exp(-2. * .3 * distance.back()));
  }
  // The trapezoidal rule errs by (beta dx)^2/3 = 3e-6, 4.343 for 10 lg e by 2e-5.
  CHECK_THAT(decay_rate(distance, energy), WithinRel(20. * std::log10(std::exp(.3)), 1e-4));
  const Track track = s1(200);
  const std::vector<double> grid = decay_distances(track, 60.3);
  CHECK(grid.size() == 29);
  CHECK_THAT(grid.back(), WithinRel(39.6, 1e-14));
  CHECK(decay_distances(track, 100.).size() == 29);  // towards the far end
  CHECK(decay_distances(s1(10), 3.3).size() == 15);  // 5 of the 5.5 bays that remain
  const std::vector<ThirdOctave> bands = third_octaves(89., 1200.);
  REQUIRE(bands.size() == 11);
  CHECK(bands.front().nominal_hz == 100);
  CHECK(bands.back().nominal_hz == 1000);
  CHECK(third_octaves(90., 1200.).front().nominal_hz == 125);  // 100 begins at 89.1 Hz
  CHECK(third_octaves(1., 1e5).size() == 18);
}

TEST_CASE("the vibration of a rail on a foundation decays along it as in the closed form",
          "[decay-rate]") {
  // Springs each 50 mm stand for a foundation; the positions of EN 15461 are 12.5 mm to 3.3 m from
  // the force.
  Track track;
  track.section = peers_rectangle();
  track.unknowns = Unknowns::vertical;
  track.rails = 1;
  track.bays = 400;
  track.bay_length = .05;
  track.elements_per_bay = 2;
  track.support.stiffness[2] = 2.5e6;
  track.support.damping[2] = 2e4;
  const double x = 10.025;
  const std::vector<double> distance = decay_distances(track, x);
  Transfer along{rail_point({0, x, 0., 0., 2}), {}};
  for (const double d : distance) along.reads.push_back(rail_point({0, x - d, 0., 0., 2}));
  FullOrderReceptance rail(track, along);
  const BendingBeam beam = bending_beam(track, BeamTheory::timoshenko);
  const std::vector<ThirdOctave> bands = third_octaves(80., 1300.);
  const std::vector<DecayRate> rates = decay_rates(rail, distance, bands);
  REQUIRE(rates.size() == 11);
  for (const DecayRate& got : rates) {
    std::vector<double> energy(distance.size(), 0.);
    double slowest = 0.;
    for (int line = 0; line < kLinesPerBand; ++line) {
      const double hz = got.band.from + (got.band.to - got.band.from) * (line + .5) / kLinesPerBand;
      const Foundation wave(beam, Value(2.5e6, 2. * M_PI * hz * 2e4) / .05, hz);
      for (std::size_t i = 0; i < distance.size(); ++i)
        energy[i] += std::pow(hz, 4) * std::norm(wave.receptance(distance[i]));
      slowest += std::max(wave.kappa[0].real(), wave.kappa[1].real()) / kLinesPerBand;
    }
    const double want = decay_rate(distance, energy), of_wave = -20. * std::log10(M_E) * slowest;
    CAPTURE(got.band.nominal_hz, got.rate, want, of_wave);
    // The closed form gives the same sum to 2e-3, as its receptances do (springs for a foundation).
    CHECK_THAT(got.rate, WithinRel(want, 2e-3));
    // At the force, near field and travelling wave have twice the energy of the wave alone. So the
    // sum is down to half of the wave's and the rate up to twice the wave's. Below the cut-on there
    // is no travelling wave and the rate is near that of the near field.
    CHECK(got.rate / of_wave > .8);
    CHECK(got.rate / of_wave < 2.1);
  }
}

TEST_CASE("exact rails refuse tracks and points that they cannot solve", "[exact-rail]") {
  Track track = s1(4);
  const Functional sideways = rail_point({0, .3, 0., 0., 1});
  CHECK_THROWS_WITH(ExactRailReceptance(track, {sideways, {sideways}}, BeamTheory::timoshenko),
                    Catch::Contains("E-RECEPTANCE-11"));
  CHECK_THROWS_WITH(ExactRailReceptance(track, driving(2.5), BeamTheory::timoshenko),
                    Catch::Contains("E-TRACK-05"));
  Track pressed = track;
  pressed.axial_force = -1e5;
  CHECK_THROWS_WITH(ExactRailReceptance(pressed, driving(.3), BeamTheory::timoshenko),
                    Catch::Contains("E-RECEPTANCE-09"));
  // Without damping, waves above the cut-on travel without end.
  track.sleeper.reset();
  track.support.damping[2] = 0.;
  ExactRailReceptance endless(track, driving(.3), BeamTheory::timoshenko, true);
  CHECK_THROWS_AS(endless.at(600.), std::runtime_error);
  CHECK(std::abs(endless.at(50.)[0]) > 0.);
}
