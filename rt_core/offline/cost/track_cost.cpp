#include "offline/cost/line_cost.h"
#include "online/model/contact_id.h"

namespace railstep {

namespace {

/// Cost of one external wheel in a step: its place, its force along three directions, its reading.
Cost external_cost(const Model& model) {
  Cost sum = work(300, 150) + kPDeltaSeats * (kLookUp + work(8, 4));
  for (std::int32_t l = 0; l < model.lines; ++l) {
    const LineCost line = line_cost(model, model.line[l]);
    const std::int64_t n = model.line[l].size;
    const Cost apply =
        model.form == Form::condensed ? line.shape + work(8 * n, 8 * n) : line.wheel_row;
    sum = sum + line.row + kPDeltaSeats * line.node_roll + 3 * apply + 6 * line.wheel_row;
  }
  return sum;
}

/// Cost of a frame's end: places, deflections, the residual flexibility between all forces.
Cost publish_cost(const Model& model) {
  const std::int64_t wheels = wheel_count(model);
  const std::int64_t forces = model.loads + wheels + model.external_wheels;
  Cost sum = work(5 * model.unknowns, 2 * model.unknowns) + forces * work(10, 8) +
             forces * forces * kPairLookUp + loads_cost(model) +
             wheels * (2 * kLookUp + work(20, 10));
  for (std::int32_t l = 0; l < model.lines; ++l) {
    const LineCost line = line_cost(model, model.line[l]);
    sum = sum + model.loads * line.row + wheels * 6 * (work(3, 2) + line.value);
    if (model.external_wheels > 0 && model.form == Form::condensed)
      sum = sum + work(6 * model.line[l].size, 6 * model.line[l].size);
  }
  return sum + publish_runners_cost(model);
}

/// Cost of a step, or of each of its stages.
Cost stage_cost(const Model& model) {
  Cost sum = work(20, 0) + loads_cost(model) + model.external_wheels * external_cost(model);
  for (std::int32_t l = 0; l < model.lines; ++l) {
    const LineModel& line = model.line[l];
    sum = sum + advance_cost(model, line) + work(2 * line.size, 2 * line.size);
    sum = sum + model.loads * line_cost(model, line).row;
  }
  // Bodies are predicted and corrected as the lines are.
  const std::int64_t bodies = model.unknowns - model.line_unknowns;
  sum = sum + work(21 * bodies, 18 * bodies);
  return sum + contact_cost(model) + runners_cost(model) + system_cost(model);
}

Cost step_cost(const Model& model) {
  if (model.scheme.stage_fraction == 0.) return stage_cost(model);
  // Where a step starts is kept for its second stage.
  return 2 * stage_cost(model) + work(2, 4 * std::int64_t{model.unknowns});
}

}  // namespace

Cost cost_of(const Model& model) {
  constexpr Cost step{0, 0, 2000}, frame{0, 0, 4000};  // calls, and what is published
  return model.steps_per_frame * (step + step_cost(model)) + frame + publish_cost(model);
}

}  // namespace railstep
