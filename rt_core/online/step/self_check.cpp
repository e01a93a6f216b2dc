#include "online/step/self_check.h"

#include "online/math/bytes.h"
#include "online/model/external_input.h"
#include "online/step/step.h"
#include "online/step/trace_row.h"

namespace railstep {

void check_inputs(const Model& model, double* input) noexcept {
  for (std::int32_t i = 0; i < model.inputs; ++i) input[i] = .25 * model.input_limit[i];
  for (std::int32_t i = 0; i < model.external_wheels; ++i) {
    double* const place = input + model.external_wheel[i].input;
    place[kExternalX] = .5 * model.elements * model.element_length;
    place[kExternalY] = 0.;
  }
}

void run_check(const Model& model, std::int32_t frames, State& state, Workspace& workspace,
               Outputs& outputs, double* row) noexcept {
  double input[kMaxInputs];
  check_inputs(model, input);
  reset(model, state);
  publish_start(model, state, outputs);
  for (std::int32_t i = 0; i < frames; ++i)
    static_cast<void>(advance_frame(model, input, state, workspace, outputs));
  trace_row(model, state, outputs, row);
}

bool self_check(const Model& model, State& state, Workspace& workspace, Outputs& outputs,
                double* row) noexcept {
  bool same = true;
  if (model.check.frames > 0) {
    run_check(model, model.check.frames, state, workspace, outputs, row);
    same = model.check.columns == trace_columns(model) &&
           state_hash(model, state) == model.check.hash &&
           same_bytes(reinterpret_cast<const unsigned char*>(row), model.check.row,
                      static_cast<int>(sizeof(double)) * model.check.columns);
  }
  reset(model, state);
  publish_start(model, state, outputs);
  return same;
}

}  // namespace railstep
