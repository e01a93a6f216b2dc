#pragma once
#include <vector>

#include "offline/energy/frame_inputs.h"

namespace railstep {

/// A run that is stepped again from its model's start, one step a frame.
class SingleSteps {
 public:
  explicit SingleSteps(const Model& model)
      : steps_per_frame_(model.steps_per_frame), model_(model) {
    model_.steps_per_frame = 1;
    memory_.resize(static_cast<std::size_t>(state_doubles(model_)));
    scratch_.resize(static_cast<std::size_t>(workspace_doubles(model_)));
    state_ = state_on(model_, memory_.data());
    workspace_ = workspace_on(model_, scratch_.data());
    reset(model_, state_);
  }
  SingleSteps(const SingleSteps&) = delete;
  SingleSteps& operator=(const SingleSteps&) = delete;

  const Model& model() const { return model_; }
  const State& state() const { return state_; }

  /// @param account  follows the state after each step
  /// @param after    called after every frame of the model with the number of frames done; may be
  ///                 empty
  /// @param inputs   the inputs of the run
  template <typename Account>
  void make(std::int64_t frames, Account& account, const std::function<void(std::int64_t)>& after,
            const FrameInputs& inputs) {
    for (std::int64_t frame = 0; frame < frames; ++frame) {
      for (std::int32_t n = 0; n < steps_per_frame_; ++n) {  // the run reported the status
        static_cast<void>(make_frame(model_, n == 0 ? inputs : FrameInputs{}, frame, state_,
                                     workspace_, outputs_));
        account.follow(state_);
      }
      if (after) after(frame + 1);
    }
  }

 private:
  std::int32_t steps_per_frame_;
  Model model_;
  std::vector<double> memory_, scratch_;
  State state_{};
  Workspace workspace_{};
  Outputs outputs_{};
};

}  // namespace railstep
