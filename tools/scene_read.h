#pragma once
// The parts of read_scene, one table each. Only scene*.cpp include this.
#include "read.h"
#include "scene.h"

namespace railstep {

RailScene read_rail(const Table& rail);
std::vector<LoadScene> read_loads(const Table& root, const Scene& scene);
std::vector<WheelsetScene> read_wheelsets(const Table& root, const Scene& scene);
std::vector<SensorScene> read_sensors(const Table& root, const Scene& scene);
/// Every name of the trace is there once. Throws InputError at the second.
void check_names(const Table& root, const Scene& scene);

}  // namespace railstep
