#pragma once
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "support/program.h"
#include "support/shipped.h"

namespace railstep {

/// A file of manchester_1 with more elements. @param elements  whole [[element]] tables
inline std::string vehicle_with_elements(const std::string& elements) {
  const auto file = fresh_folder("own_element") / "vehicle.toml";
  std::ofstream(file) << text_of(std::filesystem::path(RAILSTEP_SOURCE) / "config" / "vehicles" /
                                 "manchester_1.toml")
                      << "\n"
                      << elements;
  return file.string();
}

/// A shipped scene with such a vehicle.
inline Scene scene_with_elements(const std::string& elements, const std::string& scene,
                                 std::vector<std::string> words) {
  words.push_back("vehicle[0].file=\"" + vehicle_with_elements(elements) + "\"");
  return read_scene(shipped(scene), words);
}

/// An element between the car and the first bogie.
inline std::string element_on_bogie(const std::string& name, const std::string& keys) {
  return "[[element]]\nname = \"" + name + "\"\nbetween = [\"car\", \"bogie_1\"]\n" + keys;
}

}  // namespace railstep
