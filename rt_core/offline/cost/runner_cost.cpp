#include "offline/cost/line_cost.h"
#include "online/math/newton.h"
#include "online/model/state.h"
#include "online/runner/runner_step.h"

namespace railstep {

namespace {

// One wheel on its rail: forces alone, and with their slopes.
constexpr Cost kWheel = branching(600, 250), kWheelSlopes = branching(2600, 2600);

/// One evaluation of a law of creep with its slopes, beyond linear creep.
Cost creep_cost(const RollingCreep& creep) {
  const std::int64_t strips = creep.strips;
  if (creep.law == CreepLaw::linear) return {};
  return creep.law == CreepLaw::fastsim
             ? branching(150 * strips * strips + 60 * strips + 700, 40 * strips * strips + 400)
             : branching(800, 400);
}

/// All wheels and scalar laws at the caps of Newton's iterations, and the matrices of these.
/// @param creep  of all wheels, evaluated once
Cost newton_cost(std::int64_t wheels, const Cost& creep, std::int64_t scalars, std::int64_t n) {
  constexpr std::int64_t trials = 3;  // of a step's parts
  const std::int64_t ranks = scalars + kWheelsetRank * wheels / 2;
  const Cost missed = work(2 * n * n + 8 * n, n * n + 6 * n);
  // Y B, then S Y B, then its elimination.
  const Cost factor =
      work(2 * kWheelsetRank * n * n + 2 * n * ranks + 2 * kMostLaw * ranks * ranks +
               ranks * ranks * (2 * ranks / 3 + 4),
           2 * kWheelsetRank * n * n + 2 * kMostLaw * ranks * ranks + ranks * ranks * ranks);
  // One elimination's substitution, and one for each pass over the changes of slopes.
  constexpr std::int64_t solves = 1 + kChangePasses;
  const Cost step =
      work(2 * kMostLaw * ranks + solves * (2 * ranks * ranks + 6 * ranks) + 2 * n * ranks + 8 * n,
           2 * kMostLaw * ranks + solves * (2 * ranks * ranks + 6 * ranks) + 2 * n * ranks);
  const Cost scalar = branching(40, 20);
  return (trials + 1) * kNewtonSweeps * (scalars * scalar + creep) + creep +
         kNewtonSweeps * (trials * (wheels * kWheel + missed) + wheels * kWheelSlopes + missed +
                          factor + step) +
         wheels * kWheel + work(6 * n, 3 * n * n);
}

}  // namespace

Cost runners_cost(const Model& model) {
  Cost sum{};
  for (std::int32_t i = 0; i < model.runners; ++i) {
    const RunnerModel& own = model.runner[i];
    const std::int64_t n = own.size, meets = interface_size(own);
    const Cost solved =
        model.lines > 0
            ? Cost{}
            : newton_cost(2LL * own.wheelsets, 2LL * own.wheelsets * creep_cost(own.contact.creep),
                          own.stops, meets);
    const std::int64_t products = model.form == Form::condensed ? 3 : 2;
    const std::int64_t motions = kMotions * std::int64_t{own.wheelsets},
                       held = constraint_count(own);
    sum = sum + work(2 * products * n * n + 20 * n, products * n * n + 12 * n) +
          work(2 * n * meets + 8 * n * own.stops, n * meets + n + 8 * n * own.stops) +
          work(held * (2 * n + 2 * motions + (2 * n + 2) * own.stops),
               held * (2 * n + motions + 2 * n * own.stops)) +
          solved + 3 * table_cost(own.travel.rows) + forces_cost(own.force, own.forces) +
          own.wheelsets * (branching(40, 40) + model.signals * kSignal);
  }
  return sum;
}

Cost coupled_runners_cost(const Model& model) {
  const std::int64_t n = newton_size(model),
                     scalars = contact_count(model) + model.fixed.count + model.runner_stops;
  if (model.lines == 0 || n == 0) return {};
  Cost seats{}, creep{};
  for (std::int32_t i = 0; i < model.runners; ++i)
    creep = creep + 2LL * model.runner[i].wheelsets * creep_cost(model.runner[i].contact.creep);
  for (std::int32_t l = 0; l < model.lines; ++l) {
    const LineCost cost = line_cost(model, model.line[l]);
    seats = seats + 3 * cost.wheel_row + kPDeltaSeats * cost.node_roll;
  }
  return newton_cost(2LL * model.runner_wheelsets, creep, scalars, n) + work(0, 4 * n * n) +
         wheel_seat_row_count(model) * (work(300, 150) + seats + port_count(model) * kPairLookUp) +
         wheel_seat_row_count(model) / kWheelSeatRows * 2 * (2 * kLookUp + work(60, 80));
}

Cost publish_runners_cost(const Model& model) {
  Cost sum{};
  for (std::int32_t i = 0; i < model.runners; ++i) {
    const RunnerModel& own = model.runner[i];
    const std::int64_t n = own.size;
    const std::int64_t rows = own.rods + own.stops;
    sum = sum + rows * (work(2 * n, 2 * n) + branching(10, 5)) +
          own.wheelsets * table_cost(own.travel.rows) + own.wheelsets * branching(40, 40);
  }
  return sum;
}

}  // namespace railstep
