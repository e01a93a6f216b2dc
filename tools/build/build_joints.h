#pragma once
#include <array>
#include <vector>

#include "offline/track/joint.h"
#include "scene/scene.h"

namespace railstep {

/// A scene's joints at its temperature: with the gaps that heat leaves of each, or pressed where it
/// closes them; and the compression of each rail by that, N.
struct HeatedJoints {
  std::vector<RailJoint> joints;
  std::array<double, 2> compression;
};

/// @param areas, heights  of left and right rail's section, m2, m. Ends that press give way by E
/// A/h
///                        where the scene says nothing else.
HeatedJoints heated_joints(const Scene& scene, const std::array<double, 2>& areas,
                           const std::array<double, 2>& heights);

}  // namespace railstep
