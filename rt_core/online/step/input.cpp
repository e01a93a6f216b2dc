#include "online/step/input.h"

#include "online/math/tiny.h"

namespace railstep {

Status take_inputs(const Model& model, const double* value, State& state) noexcept {
  Status met = Status::ok;
  for (std::int32_t i = 0; i < model.inputs; ++i) {
    const double limit = model.input_limit[i];
    double given = value[i];
    if (!(given - given == 0.)) {  // 0 only for finite numbers
      met = met | Status::nonfinite_input;
      continue;
    }
    if (given > limit || given < -limit) {
      met = met | Status::force_saturated;
      given = given > 0. ? limit : -limit;
    }
    state.input[i] = without_tiny(given);
  }
  return met;
}

}  // namespace railstep
