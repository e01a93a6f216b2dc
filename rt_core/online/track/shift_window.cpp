#include "online/track/shift_window.h"

#include "online/model/progress.h"

namespace railstep {

namespace {

/// @param scratch  [line.size]
/// @param fill     null: 0
void shift(const LineModel& line, const double* fill, double* x, double* scratch) noexcept {
  const BayShift& to = line.shift;
  for (std::int32_t i = 0; i < line.size; ++i) scratch[i] = x[i];
  for (std::int32_t i = 0; i < line.size; ++i)
    x[i] = (to.own[i] * scratch[i] + to.other[i] * scratch[to.from[i]]) +
           (fill == nullptr ? 0. : fill[i]);
}

}  // namespace

void shift_window(const Model& model, std::int64_t step, State& s, Workspace& w) noexcept {
  const Endless& e = model.endless;
  // Traffic moves by less than a bay in a step, so that it passes at most one border.
  if (e.bays == 0 || bays_passed(e.progress, step).bays == bays_passed(e.progress, step - 1).bays)
    return;
  for (std::int32_t l = 0; l < model.lines; ++l) {
    const LineModel& line = model.line[l];
    shift(line, line.shift.fill, s.u + line.first, w.scaled);
    for (double* x : {s.v, s.a, s.g}) shift(line, nullptr, x + line.first, w.scaled);
  }
  for (std::int32_t b = 0; b < model.wheelsets; ++b) s.u[model.wheelset[b].first] -= e.bay_length;
}

}  // namespace railstep
