#pragma once
#include <optional>
#include <string>
#include <vector>

#include "build/build.h"
#include "offline/pack/pack.h"
#include "scene/scene.h"

namespace railstep {

/// A scene's sensors and support forces as track sensors of a model.
struct Sensors {
  /// V.<body>.z_m of each vehicle's bodies, and .pitch_rad of those that pitch; then kSensorColumns
  /// of each sensor, of one on a vehicle S.z_m, S.vz_m_per_s, S.az_m_per_s2; then
  /// support_<i>.force_z_n of the left rail's supports and support_right_<i>.force_z_n of the right
  /// rail's where the scene asks for them, then <stop>.force_n of every stop.
  std::vector<std::string> columns;
  std::vector<TrackSensor> track_sensors;  // one per column
};

/// @param head  the railhead of the same track
Sensors sensors_of(const Scene& scene, const Track& track, const RailSections& sections,
                   const Railhead& head);

/// Displacement of a sensor on a rail or a sleeper over the track; 0 x, 1 y, 2 z. None on a
/// wheelset or a vehicle.
std::optional<Functional> functional_of(const SensorScene& sensor, const Scene& scene,
                                        const Track& track, int direction);

}  // namespace railstep
