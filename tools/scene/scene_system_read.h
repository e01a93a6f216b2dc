#pragma once
// The parts of a system's scene, one kind of table each. Only scene*.cpp include this.
#include <map>
#include <string>
#include <string_view>

#include "scene/scene_system.h"
#include "text/read.h"

namespace railstep {

/// The track of a scene that has a system too, with all that runs on it and its step. Throws
/// InputError for what is not stepped beside bodies.
/// @param intact  out: the parts that were read without a refusal
Scene read_track_beside(const Table& root, const SystemScene& scene, NameBook& names,
                        Intact& intact);

/// @returns whether none was refused
bool read_bodies(const Table& root, SystemScene& scene, NameBook& names);
bool read_beams(const Table& root, SystemScene& scene, NameBook& names);

/// The use of a name, which says what it may name.
enum class Naming {
  held,    // of joints and springs: the ground, bodies, beams and rails
  driven,  // of forces: bodies and beams
  sensed   // of sensors: bodies and beams; sensors on a track have other keys
};
/// The part of that name. Throws InputError with the names of all parts.
Part read_part(const Table& t, std::string_view key, const std::string& name,
               const SystemScene& scene, Naming naming);
/// A point of a part at rest, m. On a beam or a rail it lies within the length, and not farther
/// from the line than the size of the section.
Eigen::Vector3d read_point(const Table& t, std::string_view key, const Part& part,
                           const SystemScene& scene);

void read_joints(const Table& root, SystemScene& scene, NameBook& names);
void read_springs(const Table& root, SystemScene& scene, NameBook& names);
void read_forces(const Table& root, SystemScene& scene);
void read_system_sensors(const Table& root, SystemScene& scene, NameBook& names);

}  // namespace railstep
