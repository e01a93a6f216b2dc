// Steps of a track with one-sided supports: against statics, springs and other solutions.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "offline/analysis/modes.h"
#include "offline/analysis/statics.h"
#include "offline/energy/energy_account.h"
#include "online/contact/ports.h"
#include "support/block_fields.h"
#include "support/one_sided_tracks.h"
#include "support/rail_at.h"
#include "support/scene_run.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

/// Deflection under the first load, frame by frame.
std::vector<double> deflections(ModelRun& run, double end) {
  std::vector<double> z;
  while (run.time() < end - 1e-9) {
    run.step();
    z.push_back(run.outputs.load_deflection[0]);
  }
  return z;
}

double peak(const std::vector<double>& z) {
  double most = 0.;
  for (const double v : z) most = std::max(most, std::abs(v));
  return most;
}

/// Largest difference over the peak of b; b has `times` values for each of a.
double difference(const std::vector<double>& a, const std::vector<double>& b, std::size_t times) {
  double most = 0.;
  for (std::size_t i = 0; i < a.size(); ++i)
    most = std::max(most, std::abs(a[i] - b[times * (i + 1) - 1]));
  return most / peak(b);
}

}  // namespace

TEST_CASE("a gap that never closes acts as a missing support under a running load", "[ports]") {
  // R6: 50 kN at 30 m/s with dampers of 3e4 N s/m reach 8.824e-4 m (2e-4, and (0.2/20)^2 for the
  // step, as for the seat without a spring in tests/offline/track/test_seats).
  ModelRun run = in_equilibrium(with_gap(r6_track(3e4), 20, 2e-3), passing(6., 30., -50e3, 20.),
                                full_order(2e-4));
  double most = 0.;
  while (run.time() < .4) {
    run.step();
    if (run.time() > .1) most = std::max(most, -run.outputs.load_deflection[0]);
    CHECK(run.state.port_force[0] == 0.);
  }
  CHECK(run.seen == Status::ok);
  CHECK_THAT(most, WithinRel(8.824e-4, 1e-3));
}

TEST_CASE("a load that runs over a gap closes it and opens it again", "[ports]") {
  // The reference has a mesh four times and a step eight times finer. By the step it errs by a
  // sixteenth of the difference; H7's bound is 1e-3.
  const auto run_over = [](int elements, double dt, std::vector<double>& forces) {
    Track t = with_gap(r6_track(3e4), 20, .5e-3);
    t.elements_per_bay = elements;
    ModelRun run = in_equilibrium(t, passing(9., 30., -50e3, 16.), full_order(dt));
    std::vector<double> z;
    while (run.time() < .2 - 1e-9) {
      run.step();
      z.push_back(run.outputs.load_deflection[0]);
      forces.push_back(run.state.port_force[0]);
    }
    CHECK(run.seen == Status::ok);
    return z;
  };
  std::vector<double> forces, fine_forces;
  const std::vector<double> z = run_over(2, 2e-4, forces), fine = run_over(8, 2.5e-5, fine_forces);
  CHECK(difference(z, fine, 8) < 1e-3);
  // The load is over the seat at .1 s; 30 m/s is a twenty-fifth of the critical speed (R9).
  CHECK(peak(forces) > 7e3);
  CHECK(forces.front() == 0.);
  CHECK(forces.back() == 0.);
  CHECK(difference(forces, fine_forces, 8) < 2e-2);
}

TEST_CASE("a support that presses all the time acts as a spring", "[ports]") {
  // Weight closes all ballast by more than the first micrometre, over which a port's damper starts
  // to act. Then ports are exact but for the ports' residual of 1e-12 per step and rounding of K
  // (condition 1e8).
  Track springs = s1_rail(16), ports = springs;
  ports.sleeper->ballast_unilateral = true;
  PackOptions options = full_order(2e-4);
  options.gravity = 9.81;
  const Traffic traffic = passing(3., 30., -30e3, 7.);
  ModelRun a = in_equilibrium(springs, traffic, options),
           b = in_equilibrium(ports, traffic, options);
  REQUIRE(b.model().fixed.count == 17);
  const std::vector<double> u = deflections(a, .1);
  std::vector<double> v;
  double least = 1e9;
  while (b.time() < .1 - 1e-9) {
    b.step();
    v.push_back(b.outputs.load_deflection[0]);
    for (int j = 0; j < 17; ++j) least = std::min(least, b.state.port_force[j]);
  }
  REQUIRE(least > 1e-6 * 50e6);
  CHECK(b.seen == Status::ok);
  CHECK(difference(v, u, 1) < 1e-8);
  CHECK(b.outputs.iterations <= 1);  // the last step's active set is right again
}

TEST_CASE("mirror coordinates and one line step over a hanging sleeper alike", "[ports]") {
  for (const bool condensed_too : {false, true}) {
    Track mirrored = with_gap(s1_track(8, 2), 4, .3e-3);
    Track general = mirrored;
    general.mirror_coordinates = false;
    Traffic traffic = passing(1.5, 30., -80e3, 4.);
    traffic.loads.push_back({.rail = 1, .start = 1.6, .speed = 30., .stop = 4., .force = -60e3});
    const auto run = [&](const Track& track) {
      PackOptions options = condensed_too ? condensed(track, 0., 2e-4) : full_order(2e-4);
      ModelRun made = in_equilibrium(track, traffic, options);
      std::vector<double> z;
      while (made.time() < .06) {
        made.step();
        z.push_back(made.state.port_force[0]);
        z.push_back(made.state.port_force[1]);
      }
      CHECK(made.seen == Status::ok);
      return z;
    };
    const std::vector<double> a = run(mirrored), b = run(general);
    CHECK(peak(b) > 5e3);
    CHECK(difference(a, b, 1) < (condensed_too ? 1e-6 : 1e-8));  // docs/supports.md
  }
}

TEST_CASE("a condensed track with gaps converges to full order", "[ports]") {
  const Track track = with_gap(with_gap(s1_rail(24), 12, .4e-3), 13, .2e-3);
  const Traffic traffic = passing(5., 30., -80e3, 12.);
  const auto run = [&](const PackOptions& options, std::vector<double>& forces) {
    ModelRun made = in_equilibrium(track, traffic, options);
    std::vector<double> z;
    while (made.time() < .14 - 1e-9) {
      made.step();
      z.push_back(made.outputs.load_deflection[0]);
      forces.push_back(made.state.port_force[0]);
    }
    return z;
  };
  std::vector<double> want_force, force, coarse_force;
  const std::vector<double> want = run(full_order(5e-5), want_force);
  const std::vector<double> coarse = run(condensed(track, 2., 4e-4), coarse_force);
  const std::vector<double> z = run(condensed(track, 2., 1e-4), force);
  const double error = difference(z, want, 2), coarse_error = difference(coarse, want, 8);
  CAPTURE(error, coarse_error, difference(force, want_force, 2), peak(want_force));
  // 2 modes per bay with residual flexibility reach 3.6e-4 (design). Forces held over the step make
  // it of first order for theta above 1/2.
  CHECK(peak(want_force) > 5e3);
  CHECK(error < 1e-3);
  CHECK(error < .5 * coarse_error);
}

TEST_CASE("a condensed start has the statics of the ports", "[ports]") {
  const Track track = with_gap(s1_rail(24), 12, .4e-3);
  const Traffic traffic = passing(7.2, 0., -100e3, 20.);
  const Statics statics(track);
  const auto u = statics.solve({{at(7.2), -100e3}});
  ModelRun run = in_equilibrium(track, traffic, condensed(track, .5, 1e-3));
  // The basis has the port's static shape, so row u is the track's even without other shapes.
  const double want = statics.port_forces(u).at(0);
  REQUIRE(want > 10e3);
  CHECK_THAT(run.state.port_force[0], WithinRel(want, 1e-7));
  run.until(.05);
  CHECK_THAT(run.state.port_force[0], WithinRel(want, 1e-7));  // it stays
  CHECK_THAT(run.outputs.load_deflection[0], WithinRel(statics.at(u, at(7.2)), 1e-3));
}

TEST_CASE("a wheelset over a hanging sleeper stands in equilibrium and rolls slowly", "[ports]") {
  Wheelset w;
  w.mass = 1200.;
  w.inertia_roll = w.inertia_yaw = 700.;
  w.inertia_spin = 100.;
  w.weight = 160e3;
  w.start = 2.4;
  const Track track = with_gap(s1_track(8, 2), 4, .4e-3);
  const Traffic standing{.wheelsets = {w}, .head = {.091, .3, .036}};
  for (const bool condensed_too : {false, true}) {
    const PackOptions options = condensed_too ? condensed(track, 2., 1e-4) : full_order(1e-4);
    ModelRun run = in_equilibrium(track, standing, options);
    REQUIRE(run.model().fixed.count == 2);
    // A condensed force acts on the axis (the residual holds its squeeze of the section).
    const double z = condensed_too ? 0. : .091;
    const Statics statics(track);
    const auto u = statics.solve({{{0, 2.4, 0., z, 2}, -80e3}, {{1, 2.4, 0., z, 2}, -80e3}});
    CAPTURE(condensed_too);
    const double want = statics.port_forces(u).at(0), start = run.state.port_force[0];
    REQUIRE(want > 1e4);
    CHECK_THAT(start, WithinRel(want, 1e-4));  // a condensed force acts on the axis
    run.until(.02);
    // It stands. On condensed lines the wheel locates its contact beside the node, where the slopes
    // of the elements make a V. A load that moves by s shifts s/bay of it from seat to seat.
    const double shift = std::abs(run.outputs.contact_x[0] - 2.4);
    CHECK(shift < 1e-4);  // the V has slopes of 1e-4, half a metre below the axle
    const double moved = 80e3 * (shift / track.bay_length + 1e-10);
    CHECK_THAT(run.outputs.contact_force[0], WithinAbs(80e3, moved));
    CHECK_THAT(run.state.port_force[0], WithinAbs(start, moved));
    CHECK(run.seen == Status::ok);
  }
  // Slow rolling is a row of equilibria: at 0.5 m/s it moves by 25 um in a period of the 400 Hz at
  // which wheel, rail and sleepers oscillate.
  w.start = 2.35;
  w.speed = .5;
  ModelRun run =
      in_equilibrium(track, {.wheelsets = {w}, .head = {.091, .3, .036}}, full_order(1e-4));
  run.until(.1);
  const Statics statics(track);
  const auto u = statics.solve({{{0, 2.4, 0., .091, 2}, -80e3}, {{1, 2.4, 0., .091, 2}, -80e3}});
  CHECK_THAT(run.state.port_force[1], WithinRel(statics.port_forces(u).at(1), 1e-2));
}

TEST_CASE("32 ports of a track need no more iterations than the cap", "[ports]") {
  Track t = s1_rail(31);
  t.sleeper->ballast_unilateral = true;
  t.sleeper->ballast_gap = 0.;
  PackOptions options = full_order(2e-4);
  options.gravity = 9.81;
  ModelRun run = in_equilibrium(t, passing(6., 60., -300e3, 15.), options);
  REQUIRE(run.model().fixed.count == kMaxFixedPorts);
  int most = 0, open = 0;
  while (run.time() < .2) {
    run.step();
    most = std::max(most, run.outputs.iterations);
    for (int j = 0; j < kMaxFixedPorts; ++j) open += run.state.port_force[j] == 0. ? 1 : 0;
  }
  CHECK(run.seen == Status::ok);
  CHECK(most >= 2);
  CHECK(most <= kPortSweeps);
  CHECK(open > 100);
  t.bays = 32;
  CHECK_THROWS_WITH(PackedModel(t, passing(6., 60., -300e3, 15.), options),
                    Catch::Contains("33") && Catch::Contains("32"));
}

TEST_CASE("ports with bad numbers leave a status and a finite state", "[ports]") {
  ModelRun run =
      in_equilibrium(with_gap(s1_rail(8), 4, .1e-3), passing(2.4, 0., -80e3, 4.), full_order(2e-4));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Model broken = run.model();
  broken.fixed.compliance = &nan;
  Outputs outputs{};
  CHECK(has(advance_frame(broken, run.state, run.workspace, outputs), Status::contact_ill_posed));
  CHECK(outputs.first_bad_unknown == -1);
  // The next whole step recovers.
  run.seen = Status::ok;
  run.until(.02);
  CHECK(run.seen == Status::ok);
  CHECK(run.state.port_force[0] > 0.);
}

TEST_CASE("a snapshot of open and closed ports continues with the same bits", "[ports]") {
  const Track track = with_gap(s1_rail(16), 8, .4e-3);
  const Traffic traffic = passing(2.4, 30., -80e3, 8.);
  for (const bool condensed_too : {false, true}) {
    const PackOptions options = condensed_too ? condensed(track, 1., 2e-4) : full_order(2e-4);
    ModelRun run = in_equilibrium(track, traffic, options);
    const auto continued = [&](ModelRun& from) {
      ModelRun other = in_equilibrium(track, traffic, options);
      other.memory = from.memory;
      other.state = state_on(other.model(), other.memory.data());
      other.state.steps = from.state.steps;
      for (int i = 0; i < 50; ++i) other.step();
      for (int i = 0; i < 50; ++i) from.step();
      return state_hash(other.model(), other.state) == state_hash(from.model(), from.state);
    };
    REQUIRE(run.state.port_force[0] == 0.);
    CHECK(continued(run));
    while (run.state.port_force[0] == 0. && run.time() < .15) run.step();
    REQUIRE(run.state.port_force[0] > 0.);
    CHECK(continued(run));
  }
}

TEST_CASE("a model with fixed ports is written and read to the same bits", "[ports]") {
  const Track track = with_gap(s1_track(8, 1), 4, .3e-3);
  for (const bool condensed_too : {false, true}) {
    ModelRun run = in_equilibrium(track, passing(2., 20., -90e3, 4.),
                                  condensed_too ? condensed(track, 1., 2e-4) : full_order(2e-4));
    const Block block = to_block(run.model(), "");
    Model model;
    REQUIRE(read(block, model).status == LoadStatus::ok);
    REQUIRE(model.fixed.count == 2);
    LoadedRun read_back(model);
    for (int i = 0; i < 150; ++i) run.step();
    static_cast<void>(read_back.frames(150));
    CHECK(state_hash(model, read_back.state) == state_hash(run.model(), run.state));
    CHECK(run.state.port_force[0] > 0.);
    const bool same = to_block(model, "") == block;
    CHECK(same);
  }
}

TEST_CASE("a one-sided pad under a held end bears nothing", "[ports]") {
  // On an end that is held the port has zero compliance, which a block must carry. The other pads
  // see the same track either way: the sums differ only by zeros.
  for (const std::string kind : {"full", "modal"}) {
    const auto deflection = [&](const std::vector<std::string>& more) {
      std::vector<std::string> changes = {"track.bays=4",
                                          "track.ends=[\"clamped\", \"pinned\"]",
                                          "support.unilateral=true",
                                          "load[1].start_m=0.5",
                                          "step.duration_s=0.05",
                                          "condense.kind=\"" + kind + "\""};
      changes.insert(changes.end(), more.begin(), more.end());
      const Traced run("moving_load", changes);
      CHECK(run.status == Status::ok);
      return run["load_left.deflection_z_m"];
    };
    const auto held = deflection({});
    const auto without = deflection({"support_change=[{seats=[0, 4], missing=\"pad\"}]"});
    REQUIRE(held.size() == without.size());
    for (std::size_t i = 0; i < held.size(); ++i)
      CHECK_THAT(held[i], WithinAbs(without[i], 1e-12 * 1e-3));  // deflection: 1 mm
  }
}
