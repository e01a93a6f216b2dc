#include "offline/cost/line_cost.h"
#include "online/math/newton.h"
#include "online/model/state.h"
#include "online/runner/runner_step.h"

namespace railstep {

namespace {

// One wheel on its rail: forces alone, and with their slopes.
constexpr Cost kWheel = branching(600, 250), kWheelSlopes = branching(2600, 2600);
// By profiles: where it touches, then forces of its patches alone and with their slopes.
constexpr Cost kFind = branching(56000, 28000), kPatches = branching(17000, 9500),
               kPatchesSlopes = branching(24000, 23000);

/// One evaluation of a law of creep with its slopes, beyond linear creep.
Cost creep_cost(const RollingCreep& creep) {
  const std::int64_t strips = creep.strips;
  if (creep.law == CreepLaw::linear) return {};
  const Cost fall = falls(creep.friction) ? branching(120, 60) : Cost{};
  return fall +
         (creep.law == CreepLaw::fastsim
              ? branching(150 * strips * strips + 60 * strips + 700, 40 * strips * strips + 400)
              : branching(800, 400));
}

/// All wheels of some runners: where they touch, their forces alone and with their slopes; the
/// scalars of their laws, and the most of one.
struct WheelsCost {
  Cost find = {}, force = {}, slopes = {}, creep = {};
  std::int64_t wheels = 0, ranks = 0, most = kWheelsetRank;
  std::int64_t solves = 1;  // two where contacts are followed
};

/// @param size  coordinates of a wheelset's law
void add_wheels(const RunnerModel& runner, std::int64_t size, WheelsCost& sum) {
  const bool drawn = has_profiles(runner.contact);
  const std::int64_t wheels = 2LL * runner.wheelsets, ranks = wheelset_ranks(runner, size);
  sum.wheels += wheels;
  sum.ranks += ranks * runner.wheelsets;
  if (ranks > sum.most) sum.most = ranks;
  if (drawn) {
    sum.find = sum.find + wheels * kFind;
    sum.solves = 2;
  }
  sum.force = sum.force + wheels * (drawn ? kPatches : kWheel);
  sum.slopes = sum.slopes + wheels * (drawn ? kPatchesSlopes : kWheelSlopes);
  sum.creep = sum.creep + wheels * (drawn ? kMostZones : 1) * creep_cost(runner.contact.creep);
}

/// All wheels and scalar laws at the caps of Newton's iterations, and the matrices of these.
Cost newton_cost(const WheelsCost& of, std::int64_t scalars, std::int64_t n) {
  constexpr std::int64_t trials = 3;  // of a step's parts
  const Cost& creep = of.creep;
  const std::int64_t ranks = scalars + of.ranks, rank = of.most;
  const Cost missed = work(2 * n * n + 8 * n, n * n + 6 * n);
  // Y B, then S Y B, then its elimination.
  const Cost factor = work(2 * rank * n * n + 2 * n * ranks + 2 * kMostLaw * ranks * ranks +
                               ranks * ranks * (2 * ranks / 3 + 4),
                           2 * rank * n * n + 2 * kMostLaw * ranks * ranks + ranks * ranks * ranks);
  // One elimination's substitution, and one for each pass over the changes of slopes.
  constexpr std::int64_t solves = 1 + kChangePasses;
  const Cost step =
      work(2 * kMostLaw * ranks + solves * (2 * ranks * ranks + 6 * ranks) + 2 * n * ranks + 8 * n,
           2 * kMostLaw * ranks + solves * (2 * ranks * ranks + 6 * ranks) + 2 * n * ranks);
  const Cost scalar = branching(40, 20);
  const Cost solve =
      (trials + 1) * kNewtonSweeps * (scalars * scalar + creep) +
      kNewtonSweeps * (trials * (of.force + missed) + of.slopes + missed + factor + step) + of.find;
  return of.solves * solve + of.solves * of.force + creep + work(6 * n, 3 * n * n);
}

/// Cost of the laws of force elements, and of their limits, rates and memories.
/// @param solves  of Newton's method in a stage
Cost elements_cost(const RunnerModel& runner, std::int64_t solves) {
  Cost sum{};
  for (std::int32_t j = 0; j < runner.force_elements; ++j) {
    const ForceElement& e = runner.force_element[j];
    const std::int64_t evaluations = solves * 4 * kNewtonSweeps + 2;
    sum = sum + evaluations * table_cost(e.curve.points);
    if (e.law != ElementLaw::spring)
      sum = sum +
            evaluations *
                (e.law == ElementLaw::exponential ? branching(2500, 800) : branching(150, 50)) +
            table_cost(e.value.points) + table_cost(runner.travel.rows) +
            work(4 * std::int64_t{runner.size} + 80, 4 * std::int64_t{runner.size} + 40);
  }
  return sum;
}

// A design line: the rotation of a frame at a place, a pose, and one piece of a table beside it.
constexpr Cost kRotation = branching(350, 150), kPose = branching(900, 350),
               kLinePiece = branching(240, 80);

/// All tables of a design line at one place.
Cost line_tables_cost(const DesignLine& line) {
  return table_cost(line.curvature.rows) + table_cost(line.cant.rows) +
         table_cost(line.gradient.rows);
}
/// The poses of all pairs of a runner's frames, and of its force elements and rods.
Cost poses_cost(const Model& model, const RunnerModel& runner) {
  const DesignLine& line = model.design_line;
  const std::int64_t poses = kMotions * std::int64_t{runner.frames.pairs};
  return runner.frames.pairs *
             (kPose + 3 * line_tables_cost(line) + 2 * std::int64_t{line.pieces} * kLinePiece) +
         (runner.element_coordinates + runner.traced_elements + runner.rods) *
             work(2 * poses + 2, 2 * poses);
}
/// Forces of the design line on a runner in a stage.
Cost design_line_cost(const Model& model, const RunnerModel& runner) {
  if (!is_there(model.design_line)) return {};
  const std::int64_t poses = kMotions * std::int64_t{runner.frames.pairs}, n = runner.size,
                     rods = runner.rods > 0 ? n + constraint_count(runner) : 0;
  const Cost rotation = kRotation + line_tables_cost(model.design_line);
  const std::int64_t places = (runner.force_elements > 0 ? 2 : 0) + (runner.rods > 0 ? 1 : 0);
  return (4 * std::int64_t{runner.bodies} + 2 * std::int64_t{runner.wheelsets}) * rotation +
         runner.bodies * branching(250, 150) + (2 + places) * poses_cost(model, runner) +
         runner.frames.pairs * branching(2 * 144 + 700, 144 + 300) +
         runner.frames.elements * branching(450, 200) +
         work((2 * n + 2 * rods) * poses + 2 * poses, (n + rods) * poses) + work(8 * n, 6 * n);
}

}  // namespace

Cost runners_cost(const Model& model) {
  Cost sum{};
  std::int64_t together = 1;  // solves of all runners on a track
  for (std::int32_t i = 0; i < model.runners; ++i)
    if (has_profiles(model.runner[i].contact)) together = 2;
  for (std::int32_t i = 0; i < model.runners; ++i) {
    const RunnerModel& own = model.runner[i];
    const std::int64_t n = own.size, meets = interface_size(own),
                       places = own.contact.creep.friction.places;
    const Cost grip = places > 0 ? 2 * table_cost(places) : Cost{};
    WheelsCost wheels;
    add_wheels(own, kMotions, wheels);
    const Cost solved = model.lines > 0 ? Cost{} : newton_cost(wheels, own.force_elements, meets);
    const std::int64_t products = model.form == Form::condensed ? 3 : 2;
    const std::int64_t motions = kMotions * std::int64_t{own.wheelsets},
                       held = constraint_count(own);
    sum = sum + work(2 * products * n * n + 20 * n, products * n * n + 12 * n) +
          work(2 * n * meets + 8 * n * own.element_coordinates,
               n * meets + n + 8 * n * own.element_coordinates) +
          work(held * (2 * n + 2 * motions + (2 * n + 2) * own.element_coordinates),
               held * (2 * n + motions + 2 * n * own.element_coordinates)) +
          solved + 3 * table_cost(own.travel.rows) + forces_cost(own.force, own.forces) +
          own.wheelsets * (branching(40, 40) + model.signals * kSignal + grip) +
          elements_cost(own, model.lines > 0 ? together : wheels.solves) +
          design_line_cost(model, own);
  }
  return sum;
}

Cost coupled_runners_cost(const Model& model) {
  const std::int64_t n = newton_size(model), scalars = contact_count(model) + model.fixed.count +
                                                       model.runner_force_elements;
  if (model.lines == 0 || n == 0) return {};
  Cost seats{};
  WheelsCost wheels;
  for (std::int32_t i = 0; i < model.runners; ++i)
    add_wheels(model.runner[i], kMotions + 2 * kWheelSeatRows, wheels);
  for (std::int32_t l = 0; l < model.lines; ++l) {
    const LineCost cost = line_cost(model, model.line[l]);
    seats = seats + 3 * cost.wheel_row + kPDeltaSeats * cost.node_roll;
  }
  return newton_cost(wheels, scalars, n) + work(0, 4 * n * n) +
         wheel_seat_row_count(model) * (work(300, 150) + seats + port_count(model) * kPairLookUp) +
         wheel_seat_row_count(model) / kWheelSeatRows * 2 * (2 * kLookUp + work(60, 80));
}

Cost publish_runners_cost(const Model& model) {
  Cost sum{};
  for (std::int32_t i = 0; i < model.runners; ++i) {
    const RunnerModel& own = model.runner[i];
    const std::int64_t n = own.size;
    const std::int64_t traced = own.traced_elements,
                       rows = own.rods + own.element_coordinates + 2 * traced;
    sum = sum + rows * (work(2 * n, 2 * n) + branching(10, 5)) +
          own.wheelsets * table_cost(own.travel.rows) + own.wheelsets * branching(40, 40) +
          elements_cost(own, 1) +
          (rows > 0 && is_there(model.design_line) ? (traced > 0 ? 2 : 1) * poses_cost(model, own)
                                                   : Cost{});
  }
  return sum;
}

}  // namespace railstep
