#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "online/contact/wheel.h"
#include "support/condensed_tracks.h"

using namespace railstep;
using Catch::Matchers::WithinRel;

namespace {

/// Energy of lines and wheelset with contact and weight, J, without residual flexibility.
double energy(const ModelRun& run) {
  const Model& model = run.model();
  double sum = 0.;
  for (std::int32_t l = 0; l < model.lines; ++l) {
    const PackedLine& own = run.packed->lines()[static_cast<std::size_t>(l)];
    const auto n = own.modes.rate().size();
    Eigen::VectorXcd z(n);
    for (Eigen::Index k = 0; k < n; ++k)
      z[k] = {run.state.u[model.line[l].first + k], run.state.v[model.line[l].first + k]};
    const Eigen::VectorXd y = own.modes.displacement(z),
                          velocity = own.modes.displacement(own.modes.rate().cwiseProduct(z));
    sum += .5 * (velocity.squaredNorm() + own.basis.omega.cwiseProduct(y).squaredNorm());
  }
  const WheelsetModel& w = model.wheelset[0];
  for (int k = 0; k < 6; ++k) {
    const double v = run.state.v[w.first + k];
    sum += .5 * w.mass[k] * v * v;
  }
  sum -= w.rest[2] * run.state.u[w.first + 2];
  WheelContact sides[2];
  find_contacts(model, 0, {run.state.u, {run.state.u, run.state.v}}, sides);
  for (const WheelContact& side : sides) {
    const double d = std::max(0., side.penetration);
    sum += .4 * model.contact[0].law.hertz * d * d * std::sqrt(d);
  }
  return sum;
}

struct Kicked {
  double start, most, last, gain;  // J over the energy at rest; gain: largest in one step
  bool lost;
};

/// Run of a wheelset on a track without dampers, kicked downwards out of its equilibrium.
Kicked kicked(double theta, int steps) {
  Track track = paper_track();
  track.support.damping = {};
  track.support.roll_damping = 0.;
  PackOptions options = condensed(track, 2., 5e-5, 1. / theta - 1.);
  options.residual_flexibility = false;
  ModelRun run =
      in_equilibrium(track, {.wheelsets = {paper_wheelset(3.2)}, .head = kHead}, options);
  const double rest = energy(run);
  run.state.v[run.model().wheelset[0].first + 2] -= .5;
  double before = energy(run) - rest;
  Kicked found{before, before, 0., 0., false};
  for (int i = 0; i < steps; ++i) {
    run.step();
    const double now = energy(run) - rest;
    found.gain = std::max(found.gain, now - before);
    found.most = std::max(found.most, now);
    before = found.last = now;
  }
  found.lost = has(run.seen, Status::contact_lost);
  CHECK_FALSE(has(run.seen, Status::cap_reached));
  CHECK_FALSE(has(run.seen, Status::nonfinite_state));
  return found;
}

}  // namespace

TEST_CASE("under a constant standing load the condensed track does not depend on the step",
          "[condensed]") {
  const Track track = peers_pair(1);
  const auto at = [&](double dt) {
    ModelRun run(track, {.loads = {{.start = 4.5, .stop = 9.3, .force = -50e3}}},
                 condensed(track, 1., dt));
    run.until(8e-3);
    return run.outputs.load_deflection[0];
  };
  const double coarse = at(4e-3), fine = at(1e-4);
  CHECK(std::abs(coarse) > 1e-4);
  CHECK_THAT(coarse, WithinRel(fine, 1e-11));  // 80 steps of rounding against 2
}

TEST_CASE("contact on a condensed track adds no energy", "[condensed]") {
  for (const double theta : {.625, 1.}) {
    const Kicked found = kicked(theta, 100'000);
    CAPTURE(theta, found.start, found.most / found.start, found.gain / found.start,
            found.last / found.start);
    CHECK(found.start > 10.);  // J; m v^2 / 2 = 12.5
    CHECK(found.lost);         // it bounces
    CHECK(found.last > 0.);
    // With theta 1, the penetration at the step's end, no step gains: V is convex. With a smaller
    // theta a step can gain (1 - theta) of V where contact closes, 1e-3 of a bounce at 50 us; it
    // loses as much where contact opens.
    CHECK(found.most < found.start * (theta == 1. ? 1. + 1.4e-5 : 1. + 1e-3));
    // The frozen contact gains a step's motion squared over the crown's radius, 25 um^2 / .3 m,
    // times some 80 kN: 1.7e-4 J of 12.5.
    if (theta == 1.) CHECK(found.gain < 1.4e-5 * found.start);
  }
}

TEST_CASE("two uncoupled rails share the arrays of their modes", "[condensed]") {
  const Track track = peers_pair(1);
  ModelRun run(track,
               {.loads = {{.rail = 0, .start = 3., .stop = 9., .force = -1e3},
                          {.rail = 1, .start = 3., .stop = 9., .force = -1e3}}},
               condensed(track, 1., 1e-3));
  const Model& model = run.model();
  REQUIRE(model.lines == 2);
  CHECK(model.line[1].twin == 0);
  CHECK(model.line[1].first == model.line[0].size);
  CHECK(model.line[1].modal.shape == model.line[0].modal.shape);
  CHECK(model.line[1].modal.keep.re == model.line[0].modal.keep.re);
  CHECK(model.line[1].unknown_of[1] == model.line[0].unknown_of[0]);
  run.until(.02);
  CHECK(run.outputs.load_deflection[1] == run.outputs.load_deflection[0]);
}

TEST_CASE("a condensed run has the same bits twice, and in frames of ten steps", "[condensed]") {
  const auto hash_of = [](int steps_per_frame) {
    Wheelset w = paper_wheelset(2.);
    w.speed = 10.;
    PackOptions options = condensed(paper_track(), 2., 1e-4);
    options.steps_per_frame = steps_per_frame;
    ModelRun run = in_equilibrium(paper_track(),
                                  {.loads = {{.start = 1., .speed = 5., .stop = 6., .force = -1e3}},
                                   .wheelsets = {w},
                                   .head = kHead},
                                  options);
    run.until(.05);
    REQUIRE(run.state.steps == 500);
    return state_hash(run.model(), run.state);
  };
  CHECK(hash_of(1) == hash_of(1));
  CHECK(hash_of(1) == hash_of(10));
}

TEST_CASE("long after the load has gone the state holds no subnormal number", "[condensed]") {
  PackOptions options = condensed(peers_pair(1), 1., 1e-3);
  options.steps_per_frame = 1000;
  ModelRun run(peers_pair(1), {.loads = {{.start = 9., .speed = 30., .stop = 9.3, .force = -50e3}}},
               options);
  run.step();
  double largest = 0.;
  for (const double value : run.memory) largest = std::max(largest, std::abs(value));
  CHECK(largest > 0.);
  for (int frame = 0; frame < 20; ++frame) run.step();
  for (const double value : run.memory)
    CHECK((value == 0. || std::abs(value) >= std::numeric_limits<double>::min()));
}
