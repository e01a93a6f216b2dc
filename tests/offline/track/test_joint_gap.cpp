// Rail ends that press on each other: bars on springs, heat, an impact, a passing load.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "offline/analysis/buckling.h"
#include "offline/analysis/statics.h"
#include "support/condensed_tracks.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

constexpr double kRigidJoint = std::numeric_limits<double>::infinity();
constexpr double kAlong = 2e8, kEnds = 5e9;  // N/m, of a seat and of pressed ends

/// A rail of 21 bays, cut in the middle of the eleventh, on seats at its axis.
Track cut_rail(double gap, double along) {
  Track t;
  t.section = section_f();
  t.unknowns = Unknowns::rigid_section;
  t.rails = 1;
  t.bays = 21;
  t.support = {.stiffness = {along, 1e8, 1e8}, .roll_stiffness = 1e6};
  RailJoint joint;
  joint.x = .5 * t.length();
  joint.stiffness = {0., kRigidJoint, kRigidJoint};
  joint.rotation_stiffness = {1e6, 1e6, 1e6};
  joint.end_stiffness = kEnds;
  joint.gap = {gap, gap};
  t.joints = {joint};
  return t;
}

/// Force per strain, N; the axial force of a rail stiffens it along x too.
double stretch(const Track& t) { return t.material.young * t.section.area + t.axial_force; }

/// Stiffness of half the rail along x, at its first seat with all beyond, and at its cut end: bars
/// of EA/h and seats alternate, Z = k + s Z/(s + Z), from the free end on.
struct Half {
  double seat, end;
};
Half half(const Track& t) {
  const double s = stretch(t) / t.bay_length, k = t.support.stiffness[0];
  double Z = k;
  for (int bay = 0; bay < t.bays / 2; ++bay) Z = k + s * Z / (s + Z);
  return {Z, 2. * s * Z / (2. * s + Z)};
}

/// Force between the ends under forces along x, N.
double pressing(const Statics& statics, const std::vector<PointForce>& forces) {
  return statics.port_forces(statics.solve(forces)).at(0);
}

PointForce along(double x, double force) { return {{0, x, 0., 0., 0}, force}; }

}  // namespace

TEST_CASE("a rail that braking moves towards a gap closes it and presses", "[joint]") {
  const Track t = cut_rail(1e-4, kAlong);
  const Half each = half(t);
  const double seat = .5 * (t.length() - t.bay_length);
  const Statics statics(t);
  // At the seat behind the gap F moves the end by F/Z; then k (F/Z - 2 N/D - gap) = N.
  const double closing = 1e-4 * each.seat;
  CHECK(pressing(statics, {along(seat, .99 * closing)}) == 0.);
  for (const double force : {1.5 * closing, 10. * closing}) {
    const double pressed = kEnds * (force / each.seat - 1e-4) / (1. + 2. * kEnds / each.end);
    // Newton's method in the statics stops at 1e-9.
    CHECK_THAT(pressing(statics, {along(seat, force)}), WithinRel(pressed, 1e-8));
  }
  CHECK(pressing(statics, {along(seat, -10. * closing)}) == 0.);
}

TEST_CASE("heat closes a gap between held ends and presses the rails", "[joint]") {
  // Heat acts as forces that stretch free bars by their growth, on ports with the cold gap.
  Track t = cut_rail(1e-3, 0.);
  t.ends = {RailEnd::clamped, RailEnd::clamped};
  const double EA = stretch(t), strain = 3e-4, x = t.joints[0].x, h = t.element_length();
  const double pressed =
      pressing(Statics(t), {along(x - 1e-9 * h, EA * strain), along(x, -EA * strain)});
  const double found = compression_by_heat(strain * t.length(), t.length() / EA, {{1e-3, kEnds}});
  CHECK(found > 1e5);
  CHECK_THAT(pressed, WithinRel(found, 1e-7));  // the force is 1e-9 of an element from the end
  CHECK(compression_by_heat(strain * t.length(), 1., {{.002, kEnds}, {.002, kEnds}}) == 0.);
  CHECK(compression_by_heat(strain * t.length(), 1., {{1e-3, kEnds}, {1e-3, 0.}}) == 0.);
}

TEST_CASE("ends pressed by heat stay at rest and open under a pull", "[joint]") {
  const double P = 1e5;
  Track t = cut_rail(-P / kEnds, kAlong);
  t.axial_force = -P;
  t.joints[0].end_force = {P, P};
  const Half each = half(t);
  const Statics statics(t);
  const double x = t.joints[0].x, h = t.element_length();
  const auto pulled = [&](double force) {
    return std::vector<PointForce>{along(x - 1e-9 * h, -force), along(x, force)};
  };
  const auto rest = statics.solve({});
  CHECK_THAT(statics.at(rest, {0, 3., 0., 0., 0}), WithinAbs(0., 1e-15));  // rounding of 2e-5 m
  CHECK_THAT(statics.port_forces(rest).at(0), WithinRel(P, 1e-9));
  // Each end moves by (F - P + N)/D; N = P - 2 k u until it is 0.
  const double opens = P * (1. + each.end / (2. * kEnds));
  CHECK_THAT(pressing(statics, pulled(.5 * opens)), WithinRel(.5 * P, 1e-7));
  CHECK(pressing(statics, pulled(1.01 * opens)) == 0.);
  const auto open = statics.solve(pulled(2. * P));
  CHECK_THAT(statics.at(open, {0, x, 0., 0., 0}), WithinRel(P / each.end, 1e-6));
  // Where everything is linear, the ends stay connected.
  CHECK_NOTHROW(refuse_buckled(t));
}

TEST_CASE("a rail that runs into another hands its momentum over", "[joint]") {
  // Two equal bars press by rho A c v/2 while a wave runs to their far ends and back. Then one
  // rests and the other has the speed (Saint-Venant).
  Track t = cut_rail(1e-5, 1.);  // 1 N/m per seat along x: nearly free for the 4 ms
  t.joints[0].end_stiffness = 2e10;
  const double v = .1, c = std::sqrt(t.material.young / t.material.density);
  const double plateau = .5 * t.material.density * t.section.area * c * v;
  const double passage = t.length() / c;  // there and back over half of it
  const double dt = 5e-6;
  ModelRun run(t, {}, full_order(dt));
  const Model& model = run.model();
  const std::int32_t cut = model.elements / 2;
  for (std::int32_t l = 0; l < model.lines; ++l)
    for (std::int32_t e = 0; e < cut; ++e)
      for (int i = 0; i < 3; ++i)
        if (const int own = model.line[l].unknown_of[0][27 * e + 9 * i]; own >= 0)
          run.state.v[model.line[l].first + own] = v;
  double impulse = 0., between = 0.;
  int counted = 0;
  const double meets = 1e-5 / v;
  while (run.time() < meets + 1.5 * passage) {
    run.step();
    const double force = run.state.port_force[0], since = run.time() - meets;
    impulse += force * dt;
    if (since < .25 * passage || since > .75 * passage) continue;
    between += force;
    ++counted;
  }
  // A front is spread over a node on either side, .15 m of 12.6 m.
  const double smeared = 2. * .15 / 12.6;
  CHECK_THAT(between / counted, WithinRel(plateau, smeared));
  const double mass = .5 * t.length() * t.material.density * t.section.area;
  CHECK_THAT(impulse, WithinRel(mass * v, smeared));
  CHECK(run.state.port_force[0] == 0.);
}

TEST_CASE("a load passes a joint pressed by heat on condensed track as in full order", "[joint]") {
  const double P = 2e5;
  Track t = cut_rail(-P / kEnds, 5e7);
  t.support.damping = {2e4, 2e4, 2e4};
  t.support.height_z = -.08;
  t.axial_force = -P;
  t.joints[0].end_force = {P, P};
  const Traffic traffic{.loads = {{.start = 4., .speed = 40., .stop = 12., .force = -8e4}}};
  ModelRun full = in_equilibrium(t, traffic, full_order(1e-4));
  ModelRun modal = in_equilibrium(t, traffic, condensed(t, 6., 1e-4));
  double largest = 0., change = 0.;
  for (int n = 0; n < 1000; ++n) {
    full.step();
    modal.step();
    largest = std::max(largest, std::abs(full.state.port_force[0] - modal.state.port_force[0]));
    change = std::max(change, std::abs(full.state.port_force[0] - P));
  }
  CAPTURE(largest, change);
  CHECK(change > 1e3);  // bending over the foot opens the ends
  // Forces held over steps of 0.1 ms, at 40 m/s over a kink, are of first order: 1 % of the change.
  CHECK(largest < .02 * change);
}
