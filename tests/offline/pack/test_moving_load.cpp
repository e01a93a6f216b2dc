#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "offline/analysis/statics.h"
#include "offline/condense/flexibility.h"
#include "offline/pack/time_schemes.h"
#include "online/math/finite.h"
#include "support/condensed_tracks.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

double deflection_at(ModelRun& run, double time) {
  run.until(time);
  CHECK(run.seen == Status::ok);
  return run.outputs.load_deflection[0];
}

ModelRun peers_run(const Track& track, double dt, bool residual) {
  Traffic traffic;
  for (const int rail : {0, 1})
    traffic.loads.push_back({.rail = rail, .start = .3, .speed = 30., .stop = 9.3, .force = -50e3});
  return {track, traffic, {generalised_alpha(dt, .6), 1, residual, 16}};
}

const double kTimes[5] = {.05, .10, .15, .20, .25};

}  // namespace

TEST_CASE("a moving load on one element per bay with residual flexibility is as converged") {
  // The row of reference.md, "Moving load", is good to 2e-8 m; the demand is 1e-3.
  const double converged[5] = {-5.83728e-4, -5.74847e-4, -5.67153e-4, -5.74738e-4, -5.83492e-4};
  ModelRun run = peers_run(peers_pair(1), 1e-3, true);
  for (int i = 0; i < 5; ++i) {
    const double z = deflection_at(run, kTimes[i]);
    CAPTURE(kTimes[i], z, z / converged[i] - 1.);
    CHECK_THAT(z, WithinRel(converged[i], 1e-3));
  }
}

TEST_CASE("a moving load on eight elements per bay with a fine step has the converged row") {
  const double converged[5] = {-5.83728e-4, -5.74847e-4, -5.67153e-4, -5.74738e-4, -5.83492e-4};
  ModelRun run = peers_run(peers_pair(8), 1e-4, false);
  for (int i = 0; i < 5; ++i)  // +-2e-8 m for the row and as much for this step
    CHECK_THAT(deflection_at(run, kTimes[i]), WithinAbs(converged[i], 4e-8));
}

TEST_CASE("a moving load without residual flexibility has the element's own rows") {
  // reference.md has 1 element per bay with 2 and 3 axial points; the demand on the second is 3e-4.
  const double two[5] = {-5.83608e-4, -5.64767e-4, -5.66946e-4, -5.64658e-4, -5.83236e-4};
  const double three[5] = {-5.76017e-4, -5.62059e-4, -5.58991e-4, -5.61946e-4, -5.75650e-4};
  Track locking = peers_pair(1);
  locking.rule.axial_points = 3;
  ModelRun run_two = peers_run(peers_pair(1), 1e-4, false),
           run_three = peers_run(locking, 1e-4, false);
  for (int i = 0; i < 5; ++i) {
    CHECK_THAT(deflection_at(run_two, kTimes[i]), WithinRel(two[i], 3e-4));
    CHECK_THAT(deflection_at(run_three, kTimes[i]), WithinRel(three[i], 3e-4));
  }
}

TEST_CASE("with residual flexibility the static deflection is that of a refined mesh everywhere") {
  for (const bool full : {false, true}) {
    Track coarse = peers_pair(1), fine = peers_pair(16);
    if (full) {
      for (Track* t : {&coarse, &fine}) {
        t->unknowns = Unknowns::full;
        t->section = section_f();
        t->support.roll_stiffness = 1e6;
        t->support.height_z = -.085;
      }
    }
    const double z = full ? .1 : 0.;
    const auto table = ResidualFlexibility(coarse, assemble(coarse), {}, 16).under({0, z});
    const Statics model(coarse), exact(fine);
    double largest = 0.;
    for (const std::size_t e : {0u, 5u, 8u, 15u})
      for (std::size_t p = 0; p <= 16; ++p) {
        const double x = .6 * (static_cast<double>(e) + static_cast<double>(p) / 16.);
        const RailPoint at{0, x, 0., z, 2};
        const double sum = model.flexibility(at, at) + table[17 * e + p];
        const double want = exact.flexibility(at, at);
        largest = std::max(largest, std::abs(sum / want - 1.));
      }
    // Both sides solve one discrete problem in two ways; the condition of K is about 1e8.
    CHECK(largest < 1e-7);
  }
}

TEST_CASE("the schemes converge with their order") {
  // A load stands still and grows from zero: the response oscillates at the track's frequencies.
  const auto history = [](const Scheme& scheme) {
    Track t = peers_pair(1);
    t.rails = 1;
    const MovingLoad load{.start = 4.5, .stop = 9.3, .force = -50e3, .table = {0., 0., .02, 1.}};
    ModelRun run(t, {.loads = {load}}, {scheme, 1, false, 16});
    std::vector<double> z;
    for (int i = 1; i <= 10; ++i) z.push_back(deflection_at(run, 1.6e-3 * i));
    return z;
  };
  const auto reference = history(generalised_alpha(6.25e-6, .6));
  const auto error = [&](const Scheme& s) {
    const auto z = history(s);
    double largest = 0.;
    for (std::size_t i = 0; i < z.size(); ++i)
      largest = std::max(largest, std::abs(z[i] - reference[i]));
    return largest;
  };
  // The orders are 2 and 1. The next term of the series is as large as the step over the period of
  // the oscillation: 0.2.
  const auto order = [&](const Scheme& coarse, const Scheme& fine) {
    return std::log2(error(coarse) / error(fine));
  };
  CHECK_THAT(order(generalised_alpha(2e-4, .6), generalised_alpha(1e-4, .6)), WithinAbs(2., .2));
  CHECK_THAT(order(generalised_alpha(2e-4, 1.), generalised_alpha(1e-4, 1.)), WithinAbs(2., .2));
  CHECK_THAT(order(backward_euler(1e-4), backward_euler(5e-5)), WithinAbs(1., .2));
}

TEST_CASE("a run gives the same bits again, and a frame of ten steps those of ten frames") {
  const auto hash_of = [](int steps_per_frame) {
    MovingLoad load{.rail = 1, .start = .3, .speed = 30., .stop = 9.3, .force = -50e3};
    ModelRun run(peers_pair(1), {.loads = {load}},
                 {generalised_alpha(1e-3, .6), steps_per_frame, true, 16});
    deflection_at(run, .1);
    return state_hash(run.packed->model(), run.state);
  };
  CHECK(hash_of(1) == hash_of(1));
  CHECK(hash_of(1) == hash_of(10));
}

TEST_CASE("a load that runs off the rail is reported and the track comes to rest") {
  MovingLoad load{.rail = 0, .start = 9., .speed = 30., .stop = 100., .force = -50e3};
  ModelRun run(peers_pair(1), {.loads = {load}}, {generalised_alpha(1e-3, .6), 100, true, 16});
  CHECK(has(advance_frame(run.packed->model(), run.state, run.workspace, run.outputs),
            Status::off_rail));
  for (int frame = 0; frame < 20; ++frame)
    (void)advance_frame(run.packed->model(), run.state, run.workspace, run.outputs);
  double largest = 0.;
  for (std::int32_t i = 0; i < run.packed->model().unknowns; ++i)
    largest = std::max(largest, std::abs(run.state.u[i]));
  CHECK(largest < 1e-9);  // m; 2 s after 574 um; the slowest decay is 500 1/s
}

TEST_CASE("a state that is not finite is reported with its unknown") {
  MovingLoad load{.rail = 0, .start = .3, .speed = 30., .stop = 9.3, .force = -50e3};
  ModelRun run(peers_pair(1), {.loads = {load}}, {generalised_alpha(1e-3, .6), 1, true, 16});
  run.state.v[5] = std::numeric_limits<double>::infinity();
  CHECK(has(advance_frame(run.packed->model(), run.state, run.workspace, run.outputs),
            Status::nonfinite_state));
  CHECK(run.outputs.first_bad_unknown >= 0);
}

TEST_CASE("a rail that is more than a kilometre away counts as not finite") {
  const MovingLoad load{.rail = 0, .start = .3, .speed = 30., .stop = 9.3, .force = -50e3};
  for (const double size : {-1e3, 1e3, -1.1e3, 1.1e3, 1e70}) {
    ModelRun run(peers_pair(1), {.loads = {load}}, {generalised_alpha(1e-3, .6), 1, true, 16});
    run.state.u[5] = size;
    publish_start(run.model(), run.state, run.outputs);
    CHECK(has(run.outputs.status, Status::nonfinite_state) == (std::abs(size) > 1024.));
    CHECK(run.outputs.first_bad_unknown == (std::abs(size) > 1024. ? 5 : -1));
  }
}

TEST_CASE("long after the load has gone the state has no subnormal numbers") {
  MovingLoad load{.rail = 0, .start = 9., .speed = 30., .stop = 100., .force = -50e3};
  ModelRun run(peers_pair(1), {.loads = {load}}, {generalised_alpha(1e-3, .6), 1000, true, 16});
  for (int frame = 0; frame < 20; ++frame)
    (void)advance_frame(run.packed->model(), run.state, run.workspace, run.outputs);
  for (const double value : run.memory)
    CHECK((value == 0. || std::abs(value) >= std::numeric_limits<double>::min()));
}
