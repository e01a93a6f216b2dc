#pragma once
#include <memory>
#include <string>
#include <vector>

#include "offline/pack/pack.h"
#include "read.h"
#include "scene.h"

namespace railstep {

/// The section that a scene names, whichever way it does; shear factors given in [rail] replace the
/// section's. Those of rectangles are at the scene's Poisson ratio, those of a profile or a section
/// file at kFitPoisson. Throws InputError, std::runtime_error where no rectangles fit the profile.
Section section_of(const Scene& scene);

/// The track of a scene, about the section's centroid. Throws InputError, for rails under so much
/// compression that they buckle too.
Track track_of(const Scene& scene);

/// A scene's model, and the columns of its trace: time_s, then those of every load, wheel, sensor
/// and support. Throws InputError, in one sentence, for what makes no model (a free rigid mode,
/// say) and for what `railstep run` does not step.
struct Built {
  explicit Built(const Scene& scene);
  Track track;
  std::vector<std::string> columns;
  std::unique_ptr<PackedModel> packed;
};

/// The model and its columns in one block.
std::vector<std::byte> block_of(const Built& built);

}  // namespace railstep
