#include "offline/cost/line_cost.h"
#include "online/contact/locate.h"
#include "online/contact/system_coupling.h"
#include "online/model/contact_id.h"

namespace railstep {

namespace {

constexpr std::int64_t kSearchNodes = 6;  // of the two elements that a wheel looks at, at a joint

/// Irregularities of the rails and of the tread.
Cost irregularity_cost(const Model& model) {
  return (1 + std::int64_t{model.signals}) * (kSignal + work(4, 2));
}

/// Both contacts of a wheelset, or both of its flanges, looked for on the rails as they lie.
Cost located_pair(const Model& model) {
  constexpr Cost rest = branching(240, 120);  // the nodes' places in the track's axes
  constexpr Cost contact =
      branching(700, 300);  // poses, the point on the crown, rows, the roll's part
  constexpr Cost search = kLocateSteps * branching(205, 60) + branching(200, 60);
  Cost sum = 2 * (rest + contact + search + irregularity_cost(model) + kPDeltaSeats * kLookUp);
  for (std::int32_t l = 0; l < model.lines; ++l) {
    const LineModel& line = model.line[l];
    const LineCost cost = line_cost(model, line);
    // Each unknown of a table for both rails is read once.
    const std::int64_t tables = line.unknown_of[0] == line.unknown_of[1] ? 1 : 2;
    sum = sum + kSearchNodes * 9 * (work(4, 6) + tables * cost.value) +
          2 * kPDeltaSeats * cost.node_roll;
  }
  return sum;
}

/// Wheels of vehicles: their laws, rows and offsets, and the vehicles' dense products.
Cost vehicles_cost(const Model& model, std::int64_t contacts) {
  Cost sum{};
  for (std::int32_t v = 0; v < model.vehicles; ++v) {
    const std::int64_t n = model.vehicle[v].size;
    sum = sum + work(6 * n * n + 20 * n, 3 * n * n + 14 * n);
  }
  for (const ContactId i : upright_wheels(model)) {
    const std::int64_t n = bodies_of(model, i).size;
    const Cost law = work(150 + 6 * n, 100 + 4 * n) + contacts * kPairLookUp;
    const Cost own = work(200 + 8 * n, 80 + 6 * n) + 2 * irregularity_cost(model);
    sum = sum + law + own;
    for (std::int32_t l = 0; l < model.lines; ++l)
      sum = sum + 3 * line_cost(model, model.line[l]).wheel_row;
  }
  return sum;
}

/// Positions of wheelsets and vehicles, looked up a few times a step, and forces on their bodies.
Cost tables_cost(const Model& model) {
  Cost sum{};
  for (std::int32_t w = 0; w < model.wheelsets; ++w) {
    sum = sum + 10 * table_cost(model.wheelset[w].travel.rows) +
          forces_cost(model.wheelset[w].force, model.wheelset[w].forces);
  }
  for (std::int32_t v = 0; v < model.vehicles; ++v) {
    const SuspendedModel& own = model.vehicle[v];
    sum = sum + 6 * table_cost(own.travel.rows) + forces_cost(own.force, own.forces);
  }
  for (const ContactId i : upright_wheels(model))
    sum = sum + 8 * table_cost(bodies_of(model, i).travel.rows);
  return sum;
}

/// The track under all contacts: responses, W, penetrations, and the forces' way back.
Cost responses_cost(const Model& model, const LineModel& line) {
  const std::int64_t bases = bases_on(model, line), n = line.size;
  const LineCost cost = line_cost(model, line);
  Cost sum = bases * (cost.unit + cost.add) + bases * (bases + 1) / 2 * (cost.pair + work(8, 8)) +
             bases * (cost.located + cost.read);
  if (line.modal.between != nullptr) sum = sum + work(8 * n, 6 * n);
  sum = sum + bases * std::int64_t{model.fixed.count} * cost.read;
  // Dampers of flanges: the rail's motion at three instants.
  return sum + 6 * std::int64_t{model.flanges} * cost.wheel_row;
}

Cost fixed_cost(const Model& model) {
  const std::int64_t count = model.fixed.count, n = model.line_unknowns;
  if (model.form == Form::condensed)
    return count * (2 * work(4 * n + 8, 4 * n) + work(4 * n, 6 * n) + work(20, 10));
  std::int64_t filled = 0;
  for (std::int64_t i = 0; i < count * model.lines; ++i)
    filled += kLanes * (model.fixed.panels[2 * i + 1] - model.fixed.panels[2 * i]);
  return work(2 * filled, 2 * filled) + work(2 * filled, 3 * filled) +
         count * (model.lines * work(9, 0) + work(20, 10)) +
         2 * work(2 * model.fixed.entries, 3 * model.fixed.entries);
}

/// The guides' iterations, each with a solve of all ports.
Cost coupled_cost(const Model& model, std::int64_t contacts) {
  std::int64_t iterations = 1, lift = 20 * std::int64_t{model.wheelsets} * 4;
  for (std::int32_t i = 0; i < model.wheelsets; ++i)
    if (model.wheelset[i].guide == Guide::augmented_lagrangian &&
        model.wheelset[i].cap > iterations)
      iterations = model.wheelset[i].cap;
  for (const ContactId i : upright_wheels(model))
    lift += 2 * std::int64_t{bodies_of(model, i).size};
  const std::int64_t ports = contacts + model.fixed.count;
  const Cost solve = wheel_seat_row_count(model) > 0 ? coupled_runners_cost(model)
                                                     : ports_cost(ports, model.scheme.mean != 0);
  const std::int64_t passes = couples_system(model) ? kSystemPasses : 1;
  return passes * iterations *
         (solve + work(lift + 3 * ports, lift) + model.wheelsets * work(150, 100));
}

}  // namespace

Cost contact_cost(const Model& model) {
  const std::int64_t contacts = contact_count(model), sets = model.wheelsets;
  if (track_row_count(model) + model.fixed.count == 0) return {};
  const std::int64_t moving = model.unknowns - modal_unknowns(model);
  Cost sum = work(2 * moving, 3 * moving) + (sets + model.flanges) * located_pair(model) +
             sets * work(400, 200);
  for (std::int32_t l = 0; l < model.lines; ++l) sum = sum + responses_cost(model, model.line[l]);
  const std::int64_t rows = track_row_count(model), pairs = rows * (rows + 1) / 2;
  sum = sum + pairs * (work(40, 20) + kPairLookUp);
  sum = sum + loads_cost(model) + model.loads * rows * kPairLookUp + rows * work(200, 100);
  if (model.scheme.mean != 0)  // where each contact was, and the residual displacement there
    sum = sum + contacts * (work(50, 30) + contacts * kPairLookUp);
  for (std::int32_t l = 0; l < model.lines && model.scheme.mean != 0; ++l)
    sum = sum + contacts * line_cost(model, model.line[l]).read;
  return sum + tables_cost(model) + vehicles_cost(model, contacts) + fixed_cost(model) +
         coupled_cost(model, contacts);
}

}  // namespace railstep
