#pragma once
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "offline/pack/pack.h"
#include "online/step/step.h"

namespace railstep {

/// A model with its state, stepped frame by frame. The workspace holds NaN before every frame, so
/// no frame can depend on its old content.
struct ModelRun {
  std::unique_ptr<PackedModel> packed;
  std::vector<double> memory, scratch;
  State state;
  Workspace workspace;
  Outputs outputs{};
  Status seen = Status::ok;

  explicit ModelRun(std::unique_ptr<PackedModel> made)
      : packed(std::move(made)),
        memory(static_cast<std::size_t>(state_doubles(model()))),
        scratch(static_cast<std::size_t>(workspace_doubles(model()))),
        state(state_on(model(), memory.data())),
        workspace(workspace_on(model(), scratch.data())) {
    reset(model(), state);
  }
  ModelRun(const Track& track, const Traffic& traffic, const PackOptions& options)
      : ModelRun(std::make_unique<PackedModel>(track, traffic, options)) {}

  const Model& model() const { return packed->model(); }
  const double* body(int wheelset = 0) const { return state.u + model().wheelset[wheelset].first; }
  double time() const { return static_cast<double>(state.steps) * model().scheme.dt; }
  void step() {
    scratch.assign(scratch.size(), std::numeric_limits<double>::quiet_NaN());
    seen = seen | advance_frame(model(), state, workspace, outputs);
  }
  void until(double t) {
    const auto steps = static_cast<std::int64_t>(std::llround(t / model().scheme.dt));
    while (state.steps < steps) step();
  }
};

}  // namespace railstep
