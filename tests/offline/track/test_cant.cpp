// Rails that lean inwards: closed forms, frame indifference, and the mirror image of both sides.
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "offline/analysis/statics.h"
#include "offline/beam/equilibrium.h"
#include "offline/beam/track_structure.h"
#include "offline/pack/accuracy.h"
#include "support/condensed_tracks.h"
#include "support/mirror.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

constexpr double kInertiaY = 3038.3e-8, kInertiaZ = 512e-8, kRailArea = 7670e-6, kFactor = .4;
constexpr double kLean = 1. / 20.;

/// 16 m of R60 on a bed of `stiffness` per metre, equal along y and z. The bed is seats `spacing`
/// apart on the axis, where the shear centre is too.
Track on_bed(double stiffness, double spacing) {
  Track t;
  t.rails = 1;
  t.unknowns = Unknowns::rigid_section;
  t.cant = kLean;
  t.section = {.area = kRailArea,
               .inertia_y = kInertiaY,
               .inertia_z = kInertiaZ,
               .torsion = 221e-8,
               .shear_factor_y = kFactor,
               .shear_factor_z = kFactor};
  t.bay_length = spacing;
  t.bays = 2 * static_cast<int>(std::lround(8. / spacing));
  t.elements_per_bay = 1;
  t.support = {.stiffness = {1e6, stiffness * spacing, stiffness * spacing},
               .roll_stiffness = 1e6 * spacing};
  return t;
}

/// Deflection of an endless Timoshenko beam on a bed under a force of 1 N, m.
double winkler_depth(double k, double inertia) {
  const double EI = 210e9 * inertia, GA = 210e9 / 2.6 * kRailArea * kFactor;
  const double product = std::sqrt(k / (4. * EI)), half = k / (4. * GA);
  return (product / k + 1. / (2. * GA)) / (2. * std::sqrt(product + half));
}

/// Displacements of the axis along y and z under a downward force at mid-length, m.
std::array<double, 2> axis_under(const Track& t, double force) {
  const Statics statics(t);
  const double x = .5 * t.length();
  const auto u = statics.solve({{{0, x, 0., 0., 2}, -force}});
  return {statics.at(u, {0, x, 0., 0., 1}), statics.at(u, {0, x, 0., 0., 2})};
}

/// A rail on feet that hold it along its own axes, with a stiffness for each axis.
Track on_feet(double cant, int rails) {
  Track t;
  t.section = section_f();
  t.section.moments = moments(kSectionF);
  t.rails = rails;
  t.cant = cant;
  t.bays = 6;
  t.support = {
      .stiffness = {2e7, 3e7, 1e8}, .roll_stiffness = .3e6, .height_z = -.0837, .half_spread = .04};
  return t;
}

/// A force on a point of the section, given in the rail's axes, as forces in the track's axes.
std::vector<PointForce> own_force(const Track& t, int rail, double x, double y, double z,
                                  const std::array<double, 3>& own) {
  std::array<double, 3> along;
  to_track(t.lean(rail), own.data(), along.data());
  return {{{rail, x, y, z, 0}, along[0]},
          {{rail, x, y, z, 1}, along[1]},
          {{rail, x, y, z, 2}, along[2]}};
}

/// Displacement of a point along the rail's axes.
template <typename At>
std::array<double, 3> own_displacement(const Track& t, const RailPoint& point, const At& at) {
  std::array<double, 3> along, own;
  for (int d = 0; d < 3; ++d)
    along[static_cast<std::size_t>(d)] = at(RailPoint{point.rail, point.x, point.y, point.z, d});
  to_rail(t.lean(point.rail), along.data(), own.data());
  return own;
}

constexpr std::array<double, 3> kOblique = {3e3, -20e3, -80e3};

/// Two canted rails on sleepers; the ballast holds them along y too.
Track leaning_pair(Unknowns unknowns) {
  Track t = s1_track(12, 2);
  t.unknowns = unknowns;
  t.cant = kLean;
  t.sleeper->ballast_stiffness = {0., 30e6, 50e6};
  t.sleeper->ballast_damping = {0., 60e3, 80e3};
  return t;
}

}  // namespace

TEST_CASE("a canted rail on a bed bends about both of its axes", "[cant]") {
  const double k = 5e7, force = 100e3, GA = 210e9 / 2.6 * kRailArea * kFactor;
  const double cosine = 1. / std::sqrt(1. + kLean * kLean), sine = kLean * cosine;
  const double upright = winkler_depth(k, kInertiaY), aside = winkler_depth(k, kInertiaZ);
  for (const double spacing : {.1, .05}) {
    const std::array<double, 2> found = axis_under(on_bed(k, spacing), force);
    CAPTURE(spacing, found[0], found[1]);
    // The sum over seats replaces the bed. At the jump of the slope of w^2 under the force, 2 w0
    // P/GA, it errs by h^2/12 of the jump: k h^2/6GA of the deflection, which is 3.3e-4 and 8.3e-5
    // here. The next term in h is a tenth of it.
    const double mesh = k * spacing * spacing / (6. * GA);
    const double down = force * (cosine * cosine * upright + sine * sine * aside);
    CHECK_THAT(-found[1], WithinRel(down, 1.1 * mesh));
    // This is the difference of two deflections, each with its error.
    CHECK_THAT(-found[0], WithinAbs(force * sine * cosine * (aside - upright),
                                    1.1 * mesh * force * sine * (aside + upright)));
  }
}

TEST_CASE("a rail rotated with its seats and loads moves as it did upright", "[cant]") {
  const auto unknowns = GENERATE(Unknowns::full, Unknowns::rigid_section);
  Track upright = on_feet(0., 1), leaning = on_feet(kLean, 1);
  upright.unknowns = leaning.unknowns = unknowns;
  const Statics before(upright), after(leaning);
  const auto forces = [](const Track& t) { return own_force(t, 0, 1.7, .02, .1, kOblique); };
  const auto u = before.solve(forces(upright)), v = after.solve(forces(leaning));
  for (const RailPoint at : {RailPoint{0, 1.7, .02, .1, 0}, RailPoint{0, 2.4, 0., -.08, 0}}) {
    const auto own =
        own_displacement(upright, at, [&](const RailPoint& p) { return before.at(u, p); });
    const auto turned =
        own_displacement(leaning, at, [&](const RailPoint& p) { return after.at(v, p); });
    // Two factorisations of condition 1e6 round, relative to the largest component.
    for (std::size_t d = 0; d < 3; ++d)
      CHECK_THAT(turned[d], WithinAbs(own[d], 1e-10 * std::abs(own[2])));
  }
}

TEST_CASE("a nonlinear rail rotated with its seats and loads moves as it did upright", "[cant]") {
  std::vector<std::array<double, 3>> found;
  for (const double cant : {0., kLean}) {
    const Track t = on_feet(cant, 1);
    const TrackStructure rail(t);
    Eigen::VectorXd load = Eigen::VectorXd::Zero(rail.structure().unknowns());
    for (const PointForce& f : own_force(t, 0, 1.7, .02, .1, kOblique))
      load += f.force * rail.row(f.at);
    const Equilibrium at = equilibrium(rail.structure(), {load});
    REQUIRE(at.converged);
    const Eigen::VectorXd moved = at.q - rail.structure().rest;
    found.push_back(own_displacement(t, {0, 1.7, .02, .1, 0},
                                     [&](const RailPoint& p) { return rail.row(p).dot(moved); }));
  }
  // Newton's method stops at a residual of 1e-10 of the load.
  for (std::size_t d = 0; d < 3; ++d)
    CHECK_THAT(found[1][d], WithinAbs(found[0][d], 1e-8 * std::abs(found[0][2])));
}

TEST_CASE("at rest the nonlinear track of canted rails has the linear track's tangent", "[cant]") {
  Track t = on_feet(kLean, 2);
  t.sleeper = Sleeper{300., 169., {0., 30e6, 50e6}, {}};
  const Statics linear(t);
  const TrackStructure rails(t);
  // Displacements are 1e-8 m: rounding of positions of some metres leaves 4e-8 of them, the second
  // order leaves less.
  const std::vector<PointForce> forces = {{{0, 1.7, .015, .1, 2}, -1.}, {{1, 2.2, 0., .1, 1}, .2}};
  Eigen::VectorXd load = Eigen::VectorXd::Zero(rails.structure().unknowns());
  for (const PointForce& f : forces) load += f.force * rails.row(f.at);
  const Equilibrium at = equilibrium(rails.structure(), {load});
  REQUIRE(at.converged);
  const auto u = linear.solve(forces);
  const double size = std::abs(linear.at(u, forces[0].at));
  for (const RailPoint point : {forces[0].at, forces[1].at, RailPoint{1, 1.2, 0., -.08, 2}})
    CHECK_THAT(rails.row(point).dot(at.q - rails.structure().rest),
               WithinAbs(linear.at(u, point), 1e-6 * size));
}

TEST_CASE("canted rails have the same solution in mirror coordinates and in one line", "[cant]") {
  const auto unknowns = GENERATE(Unknowns::full, Unknowns::rigid_section);
  Track t = leaning_pair(unknowns);
  const RailPoint left{0, 3.05, .015, .09, 2}, right{1, 3.4, -.02, .09, 1};
  const Statics mirror(t);
  t.mirror_coordinates = false;
  const Statics general(t);
  check_alike(mirror, general, left, right);
  const auto u = mirror.solve({}, 9.81), v = general.solve({}, 9.81);
  for (int d = 0; d < 3; ++d) {
    const RailPoint at{1, 4.1, 0., .09, d};
    CHECK_THAT(general.at(v, at),
               WithinAbs(mirror.at(u, at), 1e-8 * std::abs(mirror.at(u, {1, 4.1, 0., .09, 2}))));
  }
}

TEST_CASE("the ballast carries the weight of canted rails", "[cant]") {
  Track t = leaning_pair(Unknowns::rigid_section);
  const double g = 9.81;
  const Statics statics(t);
  const auto u = statics.solve({}, g);
  double borne = 0.;
  for (int seat = 0; seat <= t.bays; ++seat)
    for (const int rail : {0, 1}) {
      const Functional end{.rail = {}, .sleeper = {{rail, seat, 2, 1.}}};
      for (std::size_t l = 0; l < u.size(); ++l)
        borne -= 50e6 * functional_row(t, statics.lines()[l], end).dot(u[l]);
    }
  const double weight =
      g * (2. * t.length() * t.material.density * t.section.area + 300. * (t.bays + 1));
  CHECK_THAT(borne, WithinRel(weight, 1e-9));  // rounding of the solution
  // Rails with cant move inwards as they sink.
  CHECK(statics.at(u, {0, 3.6, 0., 0., 1}) < 0.);
}

TEST_CASE("one-sided pads press along their normals as springs do", "[cant]") {
  Track spring = on_feet(kLean, 2);
  spring.sleeper = Sleeper{300., 169., {0., 30e6, 50e6}, {}};
  Track pressing = spring;
  Seat seat = pressing.seat(3);
  for (Support& pad : seat.pad) pad.unilateral = true;
  pressing.changed_seats[3] = seat;
  const std::vector<PointForce> load = {{{0, 1.8, 0., .1, 2}, -80e3}, {{1, 1.8, 0., .1, 2}, -60e3}};
  const Statics one(spring), other(pressing);
  const auto u = one.solve(load), v = other.solve(load);
  // All pads press: these are the same equations, solved by Newton's method to 1e-9.
  for (const RailPoint at : {RailPoint{0, 1.8, 0., .1, 1}, RailPoint{1, 1.9, 0., .1, 2}})
    CHECK_THAT(other.at(v, at), WithinRel(one.at(u, at), 1e-8));
  CHECK_THAT(other.support_force(v, 0, 3), WithinRel(one.support_force(u, 0, 3), 1e-7));
}

TEST_CASE("the residual flexibility under wheels is right on canted rails", "[cant]") {
  const Track t = leaning_pair(Unknowns::full);
  const Traffic traffic{.loads = {{.rail = 0, .start = 3., .force = -5e4, .z = .0907}},
                        .wheelsets = {paper_wheelset(2.9)},
                        .head = {.0907, .3, .035}};
  Track upright = t;
  upright.cant = 0.;
  // Cubics read tables at 16 points: the bound is their error on an upright rail.
  for (const PackOptions& options : {full_order(1e-4), condensed(t, 3., 1e-4)}) {
    const double before = static_error(upright, PackedModel(upright, traffic, options));
    const double after = static_error(t, PackedModel(t, traffic, options));
    CAPTURE(before, after);
    CHECK(before < 1e-4);
    CHECK(after < 1.1 * before);
  }
}

TEST_CASE("a wheelset at rest on canted rails stays in their middle", "[cant]") {
  const auto unknowns = GENERATE(Unknowns::full, Unknowns::rigid_section);
  const Track t = leaning_pair(unknowns);
  const Traffic traffic{.wheelsets = {paper_wheelset(3.3)}, .head = {.0907, .3, .035}};
  const bool modal = GENERATE(false, true);
  ModelRun run = in_equilibrium(t, traffic, modal ? condensed(t, 4., 1e-4) : full_order(1e-4));
  double largest = 0.;
  for (int n = 0; n < 3000; ++n) {
    run.step();
    for (const int wheel : {0, 1})
      largest = std::max(largest, std::abs(run.outputs.contact_force[wheel] - 981. / 2.));
  }
  CAPTURE(largest);
  CHECK(run.seen == Status::ok);
  CHECK(largest < 1e-9 * 981.);
  CHECK_THAT(run.outputs.contact_force[1], WithinRel(run.outputs.contact_force[0], 1e-9));
  CHECK_THAT(run.body()[1], WithinAbs(0., 1e-12));  // y, m: rounding of the sums over both sides
  CHECK_THAT(run.body()[3], WithinAbs(0., 1e-12));  // roll
}
