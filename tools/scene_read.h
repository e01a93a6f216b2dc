#pragma once
// The parts of read_scene, one table each. Only scene*.cpp include this.
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "read.h"
#include "scene.h"

namespace railstep {

/// Parses, and checks the schema. Throws InputError.
Table open_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides);
Scene read_track_scene(const Table& root);
/// The first key of bodies, beams and joints in a scene without [track]; null in one with. Throws
/// InputError where both are there.
const char* key_of_system(const Table& root);

/// Section, material and rule of [rail] or of a beam.
BarScene read_bar(const Table& bar);
RailScene read_rail(const Table& rail);
/// dt, frame and duration of [step]; the scheme and the start are its reader's.
StepScene read_times(const Table& step);
/// How a track's nodes lie in its section: reference_line, the centroid by default.
ReferenceLine read_reference_line(const Table& t);
/// A name that can stand in the trace's header. Throws InputError where it cannot.
std::string checked_name(const Table& t, std::string_view key, const std::string& name);
std::vector<LoadScene> read_loads(const Table& root, const Scene& scene);
std::vector<WheelsetScene> read_wheelsets(const Table& root, const Scene& scene);
std::optional<IrregularityScene> read_irregularity(const Table& root, const Scene& scene);
std::vector<DefectScene> read_defects(const Table& root, const Scene& scene);
/// [[wheelset.tread]] of a wheelset whose radius and speed are read.
std::vector<TreadScene> read_treads(const Table& t, const Scene& scene, const WheelsetScene& own);
std::vector<SensorScene> read_sensors(const Table& root, const Scene& scene);
/// Every name of the trace is there once. Throws InputError at the second.
void check_names(const Table& root, const Scene& scene);

}  // namespace railstep
