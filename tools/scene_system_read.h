#pragma once
// The parts of a system's scene, one kind of table each. Only scene*.cpp include this.
#include <map>
#include <string>
#include <string_view>

#include "read.h"
#include "scene_system.h"

namespace railstep {

/// Names of a scene, each given once.
class NameBook {
 public:
  /// The key `name` of a table; throws InputError where it is no name, or taken.
  std::string claim(const Table& t);

 private:
  std::map<std::string, std::string> owner_;  // name -> the table that gave it first
};

void read_bodies(const Table& root, SystemScene& scene, NameBook& names);
void read_beams(const Table& root, SystemScene& scene, NameBook& names);

/// The part of that name; the ground where it is accepted. Throws InputError, naming all there are.
Part read_part(const Table& t, std::string_view key, const std::string& name,
               const SystemScene& scene, bool ground_too);
/// A point of a part, at rest; on a beam within its length and not farther from its line than the
/// section is large.
Eigen::Vector3d read_point(const Table& t, std::string_view key, const Part& part,
                           const SystemScene& scene);

void read_joints(const Table& root, SystemScene& scene, NameBook& names);
void read_springs(const Table& root, SystemScene& scene);
void read_forces(const Table& root, SystemScene& scene);
void read_system_sensors(const Table& root, SystemScene& scene, NameBook& names);

}  // namespace railstep
