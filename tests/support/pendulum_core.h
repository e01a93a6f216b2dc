#pragma once
#include "offline/system/pack_system.h"
#include "support/double_pendulum.h"

namespace railstep {

/// The paper's double pendulum as a system: sensors A, B, C.
inline System pendulum_system(const DoublePendulum& scene, int elements, bool planar) {
  FlexibleBeam link{.section = scene.section(),
                    .material = scene.material,
                    .elements = elements,
                    .length = scene.link,
                    .half_height = scene.height / 2.,
                    .ends = {BeamEnd::pinned, BeamEnd::free}};
  const Eigen::Vector3d hinge = scene.link * Eigen::Vector3d::UnitX();
  System system{.planar = planar,
                .gravity = Eigen::Vector3d(scene.gravity[0], 0., scene.gravity[1]),
                .beams = {link, link}};
  system.beams[1].start = hinge;
  system.beams[1].ends[0] = BeamEnd::free;
  system.joints = {{.a = beam(0), .b = beam(1), .point = hinge}};
  system.sensors = {{beam(0), Eigen::Vector3d::Zero()}, {beam(0), hinge}, {beam(1), 2. * hinge}};
  return system;
}

}  // namespace railstep
