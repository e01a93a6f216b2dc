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
  /// V.<body>.z_m of each vehicle's bodies, and .pitch_rad of those that pitch. Then kSensorColumns
  /// of each sensor; a sensor on a vehicle has S.z_m, S.vz_m_per_s, S.az_m_per_s2. Then, where the
  /// scene asks for them, support_<i>.force_z_n of the left rail's supports and
  /// support_right_<i>.force_z_n of the right rail's. Then <stop>.force_n of every stop.
  std::vector<std::string> columns;
  std::vector<TrackSensor> track_sensors;  // one per column
};

/// @param head  the railhead of the same track
Sensors sensors_of(const Scene& scene, const Track& track, const RailSections& sections,
                   const Railhead& head);

/// Displacement of a sensor on a rail or a sleeper as a functional of the track's displacements.
/// nullopt for a sensor on a wheelset or a vehicle.
/// @param direction  0 x, 1 y, 2 z
std::optional<Functional> functional_of(const SensorScene& sensor, const Scene& scene,
                                        const Track& track, int direction);

}  // namespace railstep
