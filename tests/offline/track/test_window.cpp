// A window of a track without end: shifting and stepping it adds no energy (docs/endless.md).
#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "offline/analysis/decay_length.h"
#include "online/track/shift_window.h"
#include "support/endless_tracks.h"

using namespace railstep;

namespace {

/// One rail on springs, as long as its traffic needs with a decay length on either side.
Track bare_window(double bay, int elements_per_bay, double stiffness, double damping) {
  Track t = endless_track(2, elements_per_bay);
  t.bay_length = bay;
  t.sleeper.reset();
  t.support.stiffness[2] = stiffness;
  t.support.damping[2] = damping;
  t.bays = 2 * (static_cast<int>(decay_length(t) / bay) + 2);
  return window_of(t);
}

ModelRun window_run(const Track& track, double speed, double force, const Scheme& scheme) {
  Traffic traffic{.loads = {moving_load(0.)}};
  traffic.loads[0].speed = speed;
  traffic.loads[0].force = force;
  PackOptions options = window_options(track);
  options.scheme = scheme;
  return ModelRun(track, traffic, options);
}

/// Sets numbers between -1 and 1 where lines have unknowns, but not in their padding.
void disturb(const ModelRun& run, double* x, std::mt19937& random) {
  std::uniform_real_distribution<double> any(-1., 1.);
  for (std::size_t l = 0; l < run.packed->lines().size(); ++l)
    for (int i = 0; i < run.packed->lines()[l].line.unknowns(); ++i)
      x[run.model().line[l].first + i] = any(random);
}

double energy(const ModelRun& run) {
  double sum = 0.;
  for (std::size_t l = 0; l < run.packed->lines().size(); ++l) {
    const Line& line = run.packed->lines()[l].line;
    const Eigen::Map<const Eigen::VectorXd> u(run.state.u + run.model().line[l].first,
                                              line.unknowns()),
        v(run.state.v + run.model().line[l].first, line.unknowns());
    sum += .5 * (v.dot(line.mass * v) + u.dot(line.stiffness * u));
  }
  return sum;
}

/// The steps from one shift of the window to the next are linear: this is their matrix, with a
/// column for every number of the state. Numbers have one unit: v times dt, a and g times dt^2.
Eigen::MatrixXd bay_map(ModelRun& run) {
  const Model& model = run.model();
  const double dt = model.scheme.dt;
  const auto n = static_cast<Eigen::Index>(model.unknowns);
  Eigen::VectorXd unit = Eigen::VectorXd::Ones(4 * n);
  unit.segment(n, n).setConstant(1. / dt);
  unit.tail(2 * n).setConstant(1. / (dt * dt));
  Eigen::MatrixXd map(4 * n, 4 * n);
  for (Eigen::Index i = 0; i < 4 * n; ++i) {
    std::fill(run.memory.begin(), run.memory.end(), 0.);
    run.state.steps = 0;
    run.state.u[i] = unit[i];
    for (std::int64_t step = 0; step < model.endless.progress.period; ++step) run.step();
    map.col(i) = Eigen::Map<const Eigen::VectorXd>(run.state.u, 4 * n).cwiseQuotient(unit);
  }
  return map;
}

}  // namespace

TEST_CASE("shifting a window takes the energy of its rear bay and adds none", "[window]") {
  std::mt19937 random(1);
  Track full = endless_track(30, 2, 2);
  full.unknowns = Unknowns::full;
  full.support.stiffness = {1e7, 2e7, 120e6};
  full.support.roll_stiffness = 1e6;
  for (const Track& track : {window_of(endless_track(30, 2)), window_of(full)}) {
    ModelRun run = window_run(track, kSpeed, kForce, generalised_alpha(.012, .6));
    for (int n = 0; n < 20; ++n) {
      disturb(run, run.state.u, random);
      disturb(run, run.state.v, random);
      const double before = energy(run);
      shift_window(run.model(), 2, run.state, run.workspace);
      CHECK(energy(run) < before);
    }
  }
}

TEST_CASE("the map from bay to bay has no eigenvalue beyond 1", "[window]") {
  // With a free front the largest is 1.018 at rho_inf = 1.
  for (const double rho_inf : {.6, 1.}) {
    ModelRun run =
        window_run(bare_window(.1, 1, 1e10, 0.), 400., 0., generalised_alpha(62.5e-6, rho_inf));
    REQUIRE(run.model().endless.progress.period == 4);
    const double radius = bay_map(run).eigenvalues().cwiseAbs().maxCoeff();
    CAPTURE(rho_inf, radius, run.model().unknowns);
    CHECK(radius < 1. + 1e-9);
  }
}

TEST_CASE("any motion in a window decays at 1 to 500 m/s", "[window]") {
  std::mt19937 random(1);
  for (const double speed : {1., 30., 150., 400., 500.})
    for (const double part : {.0714, .25, .9})
      for (const double rho_inf : {0., .6, .9})
        for (const int elements : {1, 2}) {
          const double bay = .1;
          ModelRun run = window_run(bare_window(bay, elements, 1e9, 1e3), speed, 0.,
                                    generalised_alpha(part * bay / speed, rho_inf));
          disturb(run, run.state.u, random);
          const double before = energy(run);
          for (int n = 0; n < 400; ++n) run.step();
          CAPTURE(speed, part, rho_inf, elements);
          CHECK(energy(run) < before);
        }
}

TEST_CASE("a window at 400 m/s moves as a long track does", "[window]") {
  constexpr double dt = 62.5e-6, speed = 400.;
  constexpr int kSteps = 2400;
  Track track = endless_track(400, 1);
  track.bay_length = .1;
  track.sleeper.reset();
  track.support.stiffness[2] = 5e6;
  track.support.damping[2] = 5e3;
  Track far = track;
  far.bays = 1300;
  track = window_of(track);
  ModelRun near = window_run(track, speed, -100e3, generalised_alpha(dt, .8));
  MovingLoad load = moving_load(40.);
  load.speed = speed;
  load.force = -100e3;
  ModelRun wanted(far, {.loads = {load}}, {.scheme = generalised_alpha(dt, .8)});
  near.packed->set_start(start_in_equilibrium(track, *near.packed, 0.));
  wanted.packed->set_start(start_in_equilibrium(far, *wanted.packed, 0.));
  double worst = 0., peak = 0.;
  for (ModelRun* run : {&near, &wanted}) reset(run->model(), run->state);
  for (int n = 0; n < kSteps; ++n) {
    near.step();
    wanted.step();
    peak = std::max(peak, std::abs(wanted.outputs.load_deflection[0]));
    worst = std::max(worst,
                     std::abs(near.outputs.load_deflection[0] - wanted.outputs.load_deflection[0]));
  }
  CAPTURE(worst, peak);
  CHECK(near.seen == Status::ok);
  CHECK(worst < 1e-2 * peak);
}

namespace {

/// Seats 0.1 m apart with free ends, for 100 kN at 400 m/s: a step is a quarter of a bay.
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
  MovingLoad load = moving_load(start);
  load.speed = 400.;
  load.force = -100e3;
  return load;
}

}  // namespace

TEST_CASE("a run with a growing motion does not settle into a steady state", "[window]") {
  const Track grows = fine_seats(400);
  const PackedModel packed(grows, {.loads = {fast_load(.05)}}, window_options(grows, kFast));
  CHECK_THROWS_WITH(start_moving(grows, packed, 0.), Catch::Contains("E-START-04"));
}

TEST_CASE("a deflection of a kilometre ends a run as lost", "[window]") {
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
