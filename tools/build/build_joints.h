#pragma once
#include <array>
#include <vector>

#include "offline/track/joint.h"
#include "scene/scene.h"

namespace railstep {

/// A scene's joints at its temperature. Heat leaves a part of each gap, or closes all gaps and
/// presses the ends. `compression` is the force in each rail by that, N.
struct HeatedJoints {
  std::vector<RailJoint> joints;
  std::array<double, 2> compression;
};

/// @param areas, heights  of the left and the right rail's section, m2, m. Rail ends in contact
/// have
///                        the stiffness E A / h unless the scene gives another.
HeatedJoints heated_joints(const Scene& scene, const std::array<double, 2>& areas,
                           const std::array<double, 2>& heights);

}  // namespace railstep
