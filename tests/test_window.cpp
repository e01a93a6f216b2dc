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
  double clamped = 0., free = 0.;
  int grows = 0;
  for (const int elements : {1, 2})
    for (const int steps : {1, 2, 4, 7})
      for (const double rho_inf : {0., .6, .9, 1.})
        for (const double speed : {30., 100., 250., 400., 800.}) {
          const Passing p{.2, elements, steps, speed, rho_inf};
          const Track track = stiff_track(36, p.bay, elements);
          const double with_clamp = growth_of_a_bay(window_of(track), p);
          const double without = growth_of_a_bay(track, p);
          clamped = std::max(clamped, with_clamp);
          free = std::max(free, without);
          if (without > 1.001) ++grows;
          CAPTURE(elements, steps, rho_inf, speed, without);
          CHECK(with_clamp <= 1. + 1e-9);
        }
  WARN("clamped " << clamped << " free " << free << " grows " << grows);
}
