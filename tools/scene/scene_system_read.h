#pragma once
// The parts of a system's scene, one kind of table each. Only scene*.cpp include this.
#include <map>
#include <string>
#include <string_view>

#include "scene/scene_system.h"
#include "text/read.h"

namespace railstep {

/// Names of a scene, each given once.
class NameBook {
 public:
  /// The key `name` of a table; throws InputError where it is no name, or taken.
  std::string claim(const Table& t);

 private:
  std::map<std::string, std::string> owner_;  // name -> the table that gave it first
};

/// The track of a scene that has a system too, its loads and its step. Throws InputError at what is
/// not stepped beside bodies.
Scene read_track_beside(const Table& root, const SystemScene& scene, NameBook& names);

void read_bodies(const Table& root, SystemScene& scene, NameBook& names);
void read_beams(const Table& root, SystemScene& scene, NameBook& names);

/// What a key names.
enum class Naming {
  held,    // of joints and springs: the ground, bodies, beams and rails
  driven,  // of forces: bodies and beams
  sensed   // of sensors: the same; what is on a track has other keys
};
/// The part of that name. Throws InputError, naming all there are.
Part read_part(const Table& t, std::string_view key, const std::string& name,
               const SystemScene& scene, Naming naming);
/// A point of a part, at rest; on a beam or a rail within its length and not farther from its line
/// than the section is large.
Eigen::Vector3d read_point(const Table& t, std::string_view key, const Part& part,
                           const SystemScene& scene);

void read_joints(const Table& root, SystemScene& scene, NameBook& names);
void read_springs(const Table& root, SystemScene& scene, NameBook& names);
void read_forces(const Table& root, SystemScene& scene);
void read_system_sensors(const Table& root, SystemScene& scene, NameBook& names);

}  // namespace railstep
