#pragma once
#include <memory>
#include <vector>

#include "offline/pack/pack.h"
#include "read.h"
#include "scene.h"

namespace railstep {

/// The section that a scene names, whichever way it does; shear factors given in [rail] replace the
/// section's. Those of rectangles are at the scene's Poisson ratio, those of a profile or a section
/// file at kFitPoisson. Throws InputError, std::runtime_error where no rectangles fit the profile.
Section section_of(const Scene& scene);

/// The track of a scene, about the section's centroid. Throws InputError.
Track track_of(const Scene& scene);

/// A scene made ready to step: its model, the state at its start, and scratch.
class Simulation {
 public:
  /// Throws InputError, in one sentence, for what makes no model (a free rigid mode, say) and for
  /// what `railstep run` does not step.
  explicit Simulation(const Scene& scene);

  const Model& model() const { return packed_->model(); }
  const Track& track() const { return track_; }
  State state;
  Workspace workspace;

 private:
  Track track_;
  std::unique_ptr<PackedModel> packed_;
  std::vector<double> memory_, scratch_;
};

}  // namespace railstep
