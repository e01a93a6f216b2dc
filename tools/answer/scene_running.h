#pragma once
#include <optional>
#include <string>
#include <vector>

#include "offline/runner/stability.h"
#include "scene/scene.h"

namespace railstep {

/// Modes of the rail vehicles of a scene that run at a speed on even rails, straight or in the
/// curve in which they start, the lowest first. Rails that give way are there as they stand under
/// the vehicle (standing_track.h). Throws InputError where the scene has no rail vehicle.
std::vector<RunningMode> modes_at_speed(const Scene& scene, double speed);

/// The same at several speeds; one at which the vehicles find no steady motion has no modes.
struct ModesAtSpeed {
  double speed;  // m/s
  std::vector<RunningMode> modes;
};
std::vector<ModesAtSpeed> modes_at_speeds(const Scene& scene, const std::vector<double>& speeds);

/// The lowest critical speed of the scene's rail vehicles between two speeds, m/s.
/// @param searched  out: as critical_running_speed() has it, of the vehicle with the smallest one
std::optional<CriticalRunning> critical_speed_between(const Scene& scene, double from, double to,
                                                      SpeedRange* searched = nullptr);

/// Forces of a wheel on its rail in the track's axes, down and outwards, and of the rail on the
/// wheel ahead, N.
struct WheelLoad {
  std::string name;
  double q, y, t_x;
};
/// Steady place of a wheelset, and its force on the track along y.
struct WheelsetLoad {
  std::string name;
  double y, yaw, sum_y;  // m, rad, N
  double resistance;     // to the vehicle's motion: what its creep dissipates by a metre of way, N
};
struct RunningLoads {
  std::vector<WheelLoad> wheels;
  std::vector<WheelsetLoad> wheelsets;
};
/// The loads of all rail vehicles at their speeds at t = 0; on rails that give way those at which
/// a run starts.
RunningLoads running_loads(const Scene& scene);

}  // namespace railstep
