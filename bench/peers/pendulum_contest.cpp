// railstep's rows of the double pendulum, in the columns of Chrono's and Exudyn's programs.
#include <cmath>
#include <memory>
#include <string>

#include "../pendulum_run.h"
#include "contest.h"

namespace railstep {

namespace {

Contestant contestant(bool planar, bool energy_momentum_scheme, int elements) {
  const auto run = std::make_shared<Pendulum>(pendulum_system({}, elements, planar),
                                              pendulum_options(energy_momentum_scheme));
  const double error = error_of_c(*run);
  run->start();
  return {.peer = std::string("railstep ") + (planar ? "planar" : "in space") +
                  (energy_momentum_scheme ? " energy-momentum" : " generalised-alpha 0.9"),
          .scene = "double_pendulum",
          .elements = elements,
          .step = kPendulumStep,
          .error = error,
          .error_from_start = std::nan(""),
          .reference_error = kPendulumKnown,
          .unknowns = run->packed.model().system.unknowns,
          .flops = std::nan(""),  // the model states only those of the most iterations
          .frame =
              [run] {
                if (run->state.steps == kPendulumSteps) run->start();
                run->step();
                return run->iterations;
              },
          .passage = kPendulumSteps};
}

}  // namespace

std::vector<Contestant> double_pendulum_contest() {
  std::vector<Contestant> all;
  for (const bool planar : {false, true})
    for (const bool energy_momentum_scheme : {false, true})
      all.push_back(contestant(planar, energy_momentum_scheme, 4));
  return all;
}

}  // namespace railstep
