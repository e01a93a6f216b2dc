#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "offline/analysis/statics.h"
#include "online/track/track_sensor.h"
#include "support/condensed_tracks.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

using Rows = std::vector<std::vector<double>>;  // [frame][quantity]

Traffic peers_traffic() {
  Traffic traffic;
  for (const int rail : {0, 1})
    traffic.loads.push_back({.rail = rail, .start = .3, .speed = 30., .stop = 9.3, .force = -50e3});
  return traffic;
}

/// Largest difference in a column, over the reference's peak.
double error_of(const Rows& got, const Rows& want, std::size_t column) {
  REQUIRE(got.size() == want.size());
  double peak = 0., error = 0.;
  for (std::size_t i = 0; i < got.size(); ++i) {
    peak = std::max(peak, std::abs(want[i][column]));
    error = std::max(error, std::abs(got[i][column] - want[i][column]));
  }
  return error / peak;
}

constexpr double kFoot = -.081;  // m, of 60E1

/// S1 with 16 bays under a wheelset of 10 t at 30 m/s that starts in equilibrium. Sleeper and pad
/// are those of seat 8 at 4.8 m, which the wheelset passes after 50 ms.
ModelRun s1_run(int elements_per_bay, PackOptions options) {
  const Track track = s1_track(16, elements_per_bay);
  Wheelset w;
  w.mass = 1200.;
  w.inertia_roll = w.inertia_yaw = 700.;
  w.inertia_spin = 100.;
  w.weight = 10000. * 9.81;
  w.start = 3.3;
  w.speed = 30.;
  Traffic traffic{.wheelsets = {w}, .head = {.091, .3, .036}};
  const Functional sleeper{.sleeper = {{0, 8, 2, 1.}}};
  const Functional pad{.rail = {{{0, 4.8, 0., kFoot, 2}, 1.}}, .sleeper = {{0, 8, 2, -1.}}};
  traffic.track_sensors = {{.displacement = 1., .track = sleeper},
                           {.displacement = -200e6, .velocity = -20e3, .track = pad}};
  options.steps_per_frame = static_cast<int>(std::lround(1e-3 / options.scheme.dt));
  return in_equilibrium(track, traffic, options);
}

/// rail_z and mean force of the left wheel, sleeper displacement and pad force, in frames of 1 ms.
Rows s1_rows(ModelRun run, int frames) {
  Rows rows;
  double track_sensors[2];
  for (int i = 0; i < frames; ++i) {
    run.step();
    read_track_sensors(run.model(), run.state, run.outputs, track_sensors);
    rows.push_back({run.outputs.contact_rail_z[0], run.outputs.contact_force_mean[0],
                    track_sensors[0], track_sensors[1]});
  }
  CHECK(run.seen == Status::ok);
  return rows;
}

}  // namespace

TEST_CASE("a moving load on a condensed track has the deflections of the converged row",
          "[condensed]") {
  // The row is reference.md, "Moving load", good to 2e-8 m; the project's bound is 1e-3.
  const double converged[5] = {-5.83728e-4, -5.74847e-4, -5.67153e-4, -5.74738e-4, -5.83492e-4};
  for (const double modes_per_bay : {.5, 1.}) {
    const Track track = peers_pair(1);
    ModelRun run(track, peers_traffic(), condensed(track, modes_per_bay, 1e-3));
    for (int i = 0; i < 5; ++i) {
      run.until(.05 * (i + 1));
      CAPTURE(modes_per_bay, i, run.outputs.load_deflection[0] / converged[i] - 1.);
      CHECK_THAT(run.outputs.load_deflection[0], WithinRel(converged[i], 1e-3));
      CHECK(run.outputs.load_deflection[1] == run.outputs.load_deflection[0]);
    }
    CHECK(run.seen == Status::ok);
  }
}

TEST_CASE("a wheelset on condensed ballasted track moves as on one refined in mesh and step",
          "[condensed]") {
  const int frames = 80;
  const Track track = s1_track(16, 2);
  const Rows want = s1_rows(s1_run(4, full_order(2.5e-5)), frames);
  const Rows got = s1_rows(s1_run(2, condensed(track, 1., 5e-5)), frames);
  PackOptions bare_options = condensed(track, 1., 5e-5);
  bare_options.residual_flexibility = false;
  const Rows bare = s1_rows(s1_run(2, bare_options), frames);
  const Rows mesh = s1_rows(s1_run(2, full_order(5e-5)), frames);
  // Condensation may add this to the error of its own mesh, which full order has too.
  // Displacements: 1e-3, the project's bound; an independent model of this track had 3e-4 with one
  // mode per bay. The force follows the rail's acceleration: 1e-2 of the static force. The pad
  // force is a difference of displacements ten times as large: 1e-2 is 1e-3 of those.
  const double added[4] = {1e-3, 1e-2, 1e-3, 1e-2};
  for (std::size_t c = 0; c < 4; ++c) {
    const double error = error_of(got, want, c), of_mesh = error_of(mesh, want, c);
    CAPTURE(c, error, of_mesh);
    CHECK(of_mesh < added[c] * 2.);
    CHECK(error < added[c] + of_mesh);
    CHECK(error_of(bare, want, c) >
          added[c] + of_mesh);  // the residual flexibility reduces it to that
  }
}

TEST_CASE("on condensed track the paper's wheelset settles to the reactions of full order",
          "[condensed]") {
  const auto settled = [](const PackOptions& options) {
    Traffic traffic{.wheelsets = {paper_wheelset(3.2)}, .head = kHead};
    for (int seat = 0; seat < 5; ++seat)
      traffic.track_sensors.push_back({.displacement = -3e6,
                                       .velocity = -3e4,
                                       .track = {.rail = {{{0, 1.6 * seat, 0., 0., 2}, 1.}}}});
    ModelRun run(paper_track(), traffic, options);
    run.until(1.);
    CHECK(run.seen == Status::ok);
    std::vector<double> found(5);
    read_track_sensors(run.model(), run.state, run.outputs, found.data());
    found.push_back(run.outputs.contact_rail_z[0]);
    found.push_back(run.outputs.contact_force[0]);
    found.push_back(run.body()[2]);
    found.push_back(-run.outputs.contact_gap[0]);
    return found;
  };
  const auto full = settled(full_order(1e-4)), modal = settled(condensed(paper_track(), 2., 1e-4));
  for (std::size_t i = 0; i < 5; ++i)  // relative to the largest, the fall leaves this after 1 s
    CHECK_THAT(modal[i], WithinAbs(full[i], 1e-6 * full[2]));
  CHECK_THAT(modal[5], WithinRel(full[5], 1e-6));
  CHECK_THAT(modal[6], WithinRel(490.5, 1e-6));
  // The railhead on a mesh of 16 elements per bay, as in the tables, and Hertz's approach.
  Track fine = paper_track();
  fine.elements_per_bay = 16;
  const RailPoint head{0, 3.2, 0., .1007375, 2};
  const double sunk = -490.5 * Statics(fine).flexibility(head, head) - modal[8];
  CHECK_THAT(modal[7], WithinRel(sunk, 1e-6));
  // One element per bay is softer in the head by 2e-11 m/N, which nothing takes back.
  CHECK_THAT(full[7], WithinRel(sunk, 2e-4));
  // reference.md prints 2 digits after the point.
  const double printed[5] = {8.72, 131.46, 210.14, 131.46, 8.72};
  for (std::size_t i = 0; i < 5; ++i) CHECK_THAT(modal[i], WithinAbs(printed[i], .03));
}

TEST_CASE("a moving load on condensed track converges with the second order of the step",
          "[condensed]") {
  const Track track = peers_pair(1);
  const auto history = [&](double dt) {
    ModelRun run(track, peers_traffic(), condensed(track, 1., dt));
    Rows rows;
    for (int i = 0; i < 20; ++i) {
      run.until(.05 + 2e-3 * i);
      rows.push_back({run.outputs.load_deflection[0]});
    }
    return rows;
  };
  const Rows reference = history(1e-3 / 64.);
  const double coarse = error_of(history(1e-3), reference, 0),
               fine = error_of(history(.5e-3), reference, 0);
  CAPTURE(coarse, fine);
  // The chord of a shape is over 30 mm. Kinks of the mesh lie elsewhere in a shorter step: .3.
  CHECK_THAT(std::log2(coarse / fine), WithinAbs(2., .3));
  CHECK(coarse < 1e-3);
}

TEST_CASE("all modes without residual flexibility agree with full order that is refined in time",
          "[condensed]") {
  Track track = peers_pair(1);
  track.bays = 4;
  const auto history = [&](PackOptions options) {
    options.residual_flexibility = false;
    const MovingLoad load{.start = 1.1, .stop = 2.4, .force = -50e3, .table = {0., 0., .016, 1.}};
    ModelRun run(track, {.loads = {load}}, options);
    Rows rows;
    for (int i = 1; i <= 20; ++i) {
      run.until(1.6e-3 * i);
      rows.push_back({run.outputs.load_deflection[0]});
    }
    return rows;
  };
  const Rows modal =
      history(condensed(track, 1000., 1.6e-3));  // exact where the table bends at a step's end
  const double coarse = error_of(history(full_order(2e-5)), modal, 0),
               fine = error_of(history(full_order(1e-5)), modal, 0);
  CAPTURE(coarse, fine);
  // The slowest modes oscillate at 1e3 rad/s: (omega dt)^2 / 12 = 1e-5 of an amplitude of 1e-2.
  CHECK(fine < 1e-6);
  CHECK_THAT(std::log2(coarse / fine), WithinAbs(2., .2));
}
