// A window of a track without end: what passing its bays on makes of it.
#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "endless.h"

using namespace railstep;

namespace {

/// A rail on springs that are stiff and damped a little; its decay length is some 3 m.
Track stiff_track(int bays, double bay, int elements_per_bay) {
  Track t;
  t.section = section_f();
  t.unknowns = Unknowns::vertical;
  t.rails = 1;
  t.bays = bays;
  t.bay_length = bay;
  t.elements_per_bay = elements_per_bay;
  t.support.stiffness = {0., 0., 8e8 * bay};
  t.support.damping = {0., 0., 2e4 * bay};
  return t;
}

struct Passing {
  double bay;  // m
  int elements_per_bay;
  int steps;     // of a bay
  double speed;  // m/s
  double rho_inf;
};

MovingLoad nothing_at(double speed) {
  return {.speed = speed, .stop = std::numeric_limits<double>::infinity()};
}

/// The map of all numbers of the state over one bay, its passing on included: a column for each,
/// from the program's own steps. In units that make a state's size its energy's, or nearly.
Eigen::MatrixXd map_of_a_bay(Track track, const Passing& p) {
  PackOptions options;
  options.scheme = generalised_alpha(p.bay / (p.steps * p.speed), p.rho_inf);
  options.residual_flexibility = false;
  options.endless = EndlessTrack{track.bays / 2};
  ModelRun run(track, {.loads = {nothing_at(p.speed)}}, options);
  const auto n = static_cast<Eigen::Index>(run.model().unknowns);
  const double dt = run.model().scheme.dt;
  Eigen::VectorXd unit = Eigen::VectorXd::Ones(4 * n);
  unit.segment(n, n).setConstant(1. / dt);
  unit.tail(2 * n).setConstant(1. / (dt * dt));
  Eigen::MatrixXd map(4 * n, 4 * n);
  for (Eigen::Index i = 0; i < 4 * n; ++i) {
    std::fill(run.memory.begin(), run.memory.end(), 0.);
    run.state.steps = 0;
    run.state.u[i] = unit[i];  // the fields stand in one row from u on
    for (int step = 0; step < p.steps; ++step) run.step();
    map.col(i) = Eigen::Map<const Eigen::VectorXd>(run.state.u, 4 * n).cwiseQuotient(unit);
  }
  return map;
}

double growth_of_a_bay(const Track& track, const Passing& p) {
  return map_of_a_bay(track, p).eigenvalues().cwiseAbs().maxCoeff();
}

}  // namespace

TEST_CASE("no motion of a window grows from bay to bay, whatever its speed", "[endless]") {
  // 16 bays of 0.5 m; a front that is free grows where it is passed fast, a bay in many steps, by a
  // scheme that damps little.
  for (const int steps : {2, 4, 7})
    for (const double rho_inf : {0., .6, .9, 1.})
      for (const double speed : {30., 250., 800.}) {
        const Passing p{.5, 1, steps, speed, rho_inf};
        CAPTURE(steps, rho_inf, speed);
        CHECK(growth_of_a_bay(window_of(stiff_track(16, p.bay, 1)), p) < 1.);
      }
  const Passing p{.5, 1, 7, 800., 1.};
  CHECK(growth_of_a_bay(stiff_track(16, p.bay, 1), p) > 1.005);
}

namespace {

/// Seats 0.1 m apart, under 100 kN at 400 m/s, a quarter of a bay in a step.
constexpr double kFast = 62.5e-6;  // s
Track fine_seats(int bays) {
  Track track;
  track.section = section_f();
  track.unknowns = Unknowns::vertical;
  track.rails = 1;
  track.bays = bays;
  track.bay_length = .1;
  track.elements_per_bay = 1;
  track.support.stiffness = {0., 0., 5e6};
  track.support.damping = {0., 0., 5e3};
  return track;
}
MovingLoad fast_load(double start) {
  MovingLoad load = nothing_at(400.);
  load.start = start;
  load.force = -100e3;
  return load;
}

}  // namespace

TEST_CASE("at 400 m/s a window moves as a long track", "[endless]") {
  const Track near_track = window_of(fine_seats(400)), far_track = fine_seats(1300);
  ModelRun near(near_track, {.loads = {fast_load(.05)}}, window_options(near_track, kFast));
  ModelRun far(far_track, {.loads = {fast_load(20.05)}}, {.scheme = generalised_alpha(kFast, .6)});
  near.packed->set_start(start_in_equilibrium(near_track, *near.packed, 0.));
  far.packed->set_start(start_in_equilibrium(far_track, *far.packed, 0.));
  reset(near.model(), near.state);
  reset(far.model(), far.state);
  double most = 0., apart = 0.;
  while (near.time() < .15) {
    near.step();
    far.step();
    const double z = far.outputs.load_deflection[0];
    most = std::max(most, std::abs(z));
    apart = std::max(apart, std::abs(near.outputs.load_deflection[0] - z));
  }
  CAPTURE(most, apart);
  CHECK(most < 1.3e-3);
  CHECK(apart < 1e-5 * most);  // 1.3e-6: what ends 20 m away feel at this speed
}

TEST_CASE("a run that is lost has not settled into a steady state", "[endless]") {
  const Track grows = fine_seats(400);  // its front is free
  const PackedModel packed(grows, {.loads = {fast_load(.05)}}, window_options(grows, kFast));
  CHECK_THROWS_WITH(start_moving(grows, packed, 0.), Catch::Contains("does not settle"));
}

TEST_CASE("a track that a run leaves behind by a kilometre is lost", "[endless]") {
  const Track grows = fine_seats(400);
  ModelRun run(grows, {.loads = {fast_load(.05)}}, window_options(grows, kFast));
  double most = 0.;
  while (run.time() < .15 && !has(run.seen, Status::nonfinite_state)) {
    run.step();
    most = std::max(most, std::abs(run.outputs.load_deflection[0]));
  }
  CHECK(has(run.seen, Status::nonfinite_state));
  CHECK(most < 1024.);
}
