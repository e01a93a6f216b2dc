#pragma once
#include <string>

namespace railstep {

/// The folder of the shipped scenes.
inline const std::string kScenes = std::string(RAILSTEP_SOURCE) + "/config/scenes/";

/// The file of a shipped scene.
inline std::string shipped(const std::string& name) { return kScenes + name + ".toml"; }

inline const std::string kMovingLoad = shipped("moving_load"),
                         kWheelset = shipped("wheelset_on_track");

}  // namespace railstep
