#pragma once
#include <cstdint>
#include <functional>

#include "online/step/step.h"

namespace railstep {

/// The inputs of a frame by its index from 0, [model.inputs]. With an empty function the inputs
/// keep their values: 0 from the start on.
using FrameInputs = std::function<const double*(std::int64_t frame)>;

/// Makes a frame with its inputs.
inline Status make_frame(const Model& model, const FrameInputs& inputs, std::int64_t frame,
                         State& state, Workspace& workspace, Outputs& outputs) {
  return inputs ? advance_frame(model, inputs(frame), state, workspace, outputs)
                : advance_frame(model, state, workspace, outputs);
}

}  // namespace railstep
