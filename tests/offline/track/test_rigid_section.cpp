// Six unknowns per node: the section rotates but does not strain.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "offline/analysis/statics.h"
#include "offline/condense/flexibility.h"
#include "offline/track/functional.h"
#include "offline/track/squeeze.h"
#include "support/condensed_tracks.h"
#include "support/mirror.h"
#include "support/sections.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

Track with(Track track, Unknowns unknowns) {
  track.unknowns = unknowns;
  return track;
}

/// One rail of section F; springs hold it at its foot.
Track one_rail(Unknowns unknowns) {
  Track t;
  t.section = section_f();
  t.unknowns = unknowns;
  t.rails = 1;
  t.bays = 16;
  t.support = {.stiffness = {2e7, 3e7, 1e8}, .roll_stiffness = .3e6, .height_z = -.0837};
  return t;
}

/// Deflection of a point of the track under a force of 1 N there, m.
double own_flexibility(const Track& track, double y, double z, int direction) {
  const RailPoint at{0, 4.95, y, z, direction};
  return Statics(track).flexibility(at, at);
}

/// Unsupported elements of section F, 0.6 m each.
Track free_rail(Unknowns unknowns) {
  Track t;
  t.section = section_f();
  t.unknowns = unknowns;
  t.rails = 1;
  t.bays = 4;
  t.elements_per_bay = 1;
  return t;
}

/// All frequencies of the free rail, Hz, ascending.
std::vector<double> frequencies(Unknowns unknowns) {
  std::vector<double> found;
  for (const Line& line : assemble(free_rail(unknowns))) {
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> modes(
        Eigen::MatrixXd(line.stiffness), Eigen::MatrixXd(line.mass), Eigen::EigenvaluesOnly);
    for (const double square : modes.eigenvalues())
      found.push_back(std::sqrt(std::max(square, 0.)) / (2. * M_PI));
  }
  std::sort(found.begin(), found.end());
  return found;
}

/// Outputs of a wheelset that runs over a track from rest in equilibrium.
class Ride {
 public:
  explicit Ride(const Track& track)
      : run_(in_equilibrium(track, {.wheelsets = {paper_wheelset(2.9)}, .head = kHead},
                            full_order(1e-4))) {}
  Outputs advance(int steps) {
    for (int i = 0; i < steps; ++i) run_.step();
    return run_.outputs;
  }

 private:
  ModelRun run_;
};

}  // namespace

TEST_CASE("with six unknowns per node a free rail has six rigid modes and bends as with nine",
          "[unknowns]") {
  const std::vector<double> nine = frequencies(Unknowns::full),
                            six = frequencies(Unknowns::rigid_section);
  CHECK(nine.size() == 81);
  CHECK(six.size() == 54);
  // Rigid modes are zero to the square root of rounding of the highest.
  CHECK(six[5] < 1e-6 * six.back());
  CHECK(six[6] > 10.);
  // In bending and torsion the section's strain follows at once. So the constraint only stiffens:
  // never below, and by less than the required 0.3 %.
  for (std::size_t i = 6; i < 14; ++i) {
    CAPTURE(i, nine[i], six[i]);
    CHECK(six[i] > nine[i] * (1. - 1e-9));
    CHECK_THAT(six[i], WithinRel(nine[i], 3e-3));
  }
  // It leaves out the fast modes of the section: fewer steps are lost on them.
  CHECK(six.back() < .7 * nine.back());
}

TEST_CASE("with six unknowns per node statics differs only by the section's strain", "[unknowns]") {
  Track nine = one_rail(Unknowns::full), six = one_rail(Unknowns::rigid_section);
  const double head = .1007375;
  const auto differ = [&](double y, double z, int direction) {
    return own_flexibility(nine, y, z, direction) / own_flexibility(six, y, z, direction) - 1.;
  };
  // On the axis the foot's squeeze is in series with the pads; the residual flexibility holds that
  // of the head.
  CHECK_THAT(differ(0., 0., 1), WithinAbs(0., 3e-3));
  CHECK_THAT(differ(0., 0., 0), WithinAbs(0., 3e-3));
  CHECK_THAT(differ(0., head, 1), WithinAbs(0., 3e-3));
  CHECK_THAT(differ(0., 0., 2), WithinAbs(0., 5e-4));
  const double squeeze = differ(0., head, 2);
  CHECK(squeeze > 3e-3);
  CHECK(squeeze < 2e-2);
  // Nothing squeezes a section between its axis and a seat at the axis.
  nine.support.height_z = six.support.height_z = 0.;
  CHECK_THAT(differ(0., 0., 2), WithinAbs(0., 1e-9));
}

TEST_CASE("a rigid section has its squeeze in series with the pads", "[unknowns]") {
  // Against nine unknowns on eight elements per bay. The shear of the section that widens is left,
  // 4e-3 of the squeeze: 5e-5 of the deflection. Pads alone miss 4e-3 of it at 2e8 N/m.
  const Unknowns fewer = GENERATE(Unknowns::rigid_section, Unknowns::vertical);
  const double length = GENERATE(0., .16);
  Track nine = one_rail(Unknowns::full), few = one_rail(fewer);
  for (Track* t : {&nine, &few}) {
    t->elements_per_bay = 8;
    t->support.stiffness = {1e3, 50e6, 2e8};  // along x too soft to bend the rail from its foot
    t->support.length = length;
  }
  Track stiff = few;
  stiff.support.stiffness[2] /= part_of_pad(few, 8, 0);
  CHECK(part_of_pad(nine, 8, 0) == 1.);
  for (const double x : {4.8, 5.1}) {
    const RailPoint at{0, x, 0., 0., 2};
    const double want = Statics(nine).flexibility(at, at);
    CAPTURE(length, x, Statics(few).flexibility(at, at) / want - 1.);
    CHECK_THAT(Statics(few).flexibility(at, at), WithinRel(want, 1e-4));
    CHECK(Statics(stiff).flexibility(at, at) < want * (1. - (length > 0. ? 1.5e-3 : 4e-3)));
  }
}

TEST_CASE("adjoining pads press a section evenly", "[unknowns]") {
  Track t = one_rail(Unknowns::vertical);
  t.support.length = t.bay_length;
  const RailBar bar = t.bar(0);
  const double z = t.support.height_z,
               evenly = t.support.stiffness[2] * z * z /
                        (bar.material.young * bar.section.area * t.bay_length);
  CHECK_THAT(1. / part_of_pad(t, 8, 0) - 1., WithinRel(evenly, 1e-12));
  // Points that are close together do so too.
  t.support.length = 0.;
  t.bay_length = 1e-3;
  CHECK_THAT(1. / part_of_pad(t, 8, 0) - 1., WithinRel(evenly * .6 / t.bay_length, 1e-4));
}

TEST_CASE("the residual flexibility holds what few unknowns miss of a force on the head",
          "[unknowns]") {
  // Nine unknowns on a mesh of 16 parts of every element give deflections at head and foot under
  // the head's force, over a seat and beside it, and the force of a pad.
  const Unknowns fewer = GENERATE(Unknowns::rigid_section, Unknowns::vertical);
  const double along = GENERATE(0., 2e7);
  constexpr double kRailheadZ = .1007375;
  constexpr int kIntervals = 8;
  Track few = one_rail(fewer);
  few.support.stiffness[0] = along;
  Track nine = with(few, Unknowns::full);
  if (along == 0.) nine.ends = few.ends = {RailEnd::pinned, RailEnd::pinned};
  nine.elements_per_bay *= 2 * kIntervals;
  const Statics exact(nine), model(few);
  const ResidualFlexibility residual(few, assemble(few), {}, kIntervals);
  const std::vector<double> under = residual.under({0, kRailheadZ});
  const Functional pad = pad_gap(few, 0, 8);
  const std::vector<double> opens = residual.from({0, kRailheadZ}, pad);
  const double k = few.support.stiffness[2];
  double largest = 0.;
  for (int p = 0; p <= kIntervals; ++p) {  // over an element from seat 8
    const RailPoint at{0, 4.8 + few.element_length() * p / kIntervals, 0., kRailheadZ, 2};
    constexpr std::size_t kElement = 16, kPlaces = kIntervals + 1;
    const std::size_t place = kElement * kPlaces + static_cast<std::size_t>(p);
    const double want = exact.flexibility(at, at), got = model.flexibility(at, at) + under[place];
    const auto moved = exact.solve({{at, 1.}}), by_model = model.solve({{at, 1.}});
    const double pressed = exact.support_force(moved, 0, 8);
    const double found = model.support_force(by_model, 0, 8) - k * opens[place];
    CAPTURE(along, p, got / want - 1., found / pressed - 1.);
    CHECK_THAT(got, WithinRel(want, 1e-4));
    CHECK_THAT(found, WithinRel(pressed, 1e-4));
    largest = std::max(largest, std::abs(k * opens[place] / pressed));
  }
  CHECK(largest > 5e-3);
}

TEST_CASE("a vertical track is compared in its own plane, also under compression", "[unknowns]") {
  // At 400 kN rails that pads do not hold sideways would buckle. Two rails on sleepers that roll,
  // with a force on one rail, use both mirror coordinates. The pads hold the rails' rotation.
  Track t = s1_track(12, 2);
  t.unknowns = Unknowns::vertical;
  t.axial_force = -4e5;
  t.support.half_spread = .05;
  Track fine = with_strain(t);
  constexpr int kIntervals = 8;
  fine.elements_per_bay *= 2 * kIntervals;
  const Statics exact(fine), model(t);
  const ResidualFlexibility residual(t, assemble(t), {}, kIntervals);
  const RailPoint at{0, 3.6 + t.element_length() * 3. / kIntervals, 0., .09, 2};
  const std::vector<double> under = residual.under({0, .09});
  const double found = model.flexibility(at, at) + under[12 * (kIntervals + 1) + 3];
  CHECK_THAT(found, WithinRel(exact.flexibility(at, at), 1e-5));
  // Readings across the track or along its axis do not change.
  for (const int direction : {0, 1}) {
    const Functional read{.rail = {{{0, 4.8, 0., .0, direction}, 1.}}};
    for (const double value : residual.from({0, .09}, read)) CHECK(std::abs(value) < 1e-18);
  }
}

TEST_CASE("with six unknowns per node a vertical force moves two of them", "[unknowns]") {
  // On the axis both carry r_z and b_x, if the pads do not couple bending and stretching.
  Track six = one_rail(Unknowns::rigid_section);
  six.support.stiffness[0] = 0.;
  six.ends = {RailEnd::pinned, RailEnd::pinned};
  CHECK_THAT(own_flexibility(six, 0., 0., 2),
             WithinRel(own_flexibility(with(six, Unknowns::vertical), 0., 0., 2), 1e-9));
}

TEST_CASE("with six unknowns per node a twisted rail rotates by TL/GJ", "[unknowns]") {
  Track t = free_rail(Unknowns::rigid_section);
  t.ends = {RailEnd::clamped, RailEnd::free};
  const double lever = .05;
  const Statics statics(t);
  const RailPoint up{0, t.length(), lever, 0., 2}, down{0, t.length(), -lever, 0., 2};
  const auto u = statics.solve({{up, 1.}, {down, -1.}});
  const double turn = (statics.at(u, up) - statics.at(u, down)) / (2. * lever);
  // The linear element's twist is exact under an end moment (2 lever N m).
  CHECK_THAT(
      turn,
      WithinRel(2. * lever * t.length() / (t.material.shear_modulus() * t.section.torsion), 1e-9));
}

TEST_CASE("with six unknowns per node mirror coordinates and one line agree", "[unknowns]") {
  Track t = with(s1_track(12, 2), Unknowns::rigid_section);
  const RailPoint left{0, 3.05, .01, .09, 2}, right{1, 3.4, -.02, .09, 1};
  const Statics mirror(t);
  t.mirror_coordinates = false;
  check_alike(mirror, Statics(t), left, right);
}

TEST_CASE("with six unknowns per node a wheelset rides as with nine", "[unknowns]") {
  Ride nine(s1_track(12, 2)), six(with(s1_track(12, 2), Unknowns::rigid_section));
  const Outputs a = nine.advance(200), b = six.advance(200);
  REQUIRE(a.contact_on_rail[0]);
  REQUIRE(b.contact_on_rail[0]);
  // The wheel's static force is its weight; the track gives the rail's height under it: 0.3 %.
  CHECK_THAT(b.contact_force[0], WithinRel(a.contact_force[0], 3e-3));
  CHECK_THAT(b.contact_rail_z[0], WithinRel(a.contact_rail_z[0], 3e-3));
}
