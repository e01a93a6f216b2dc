#pragma once
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "support/program.h"
#include "support/shipped.h"

namespace railstep {

/// A shipped scene with manchester_1 and more elements in its file.
/// @param elements  whole [[element]] tables
inline Scene scene_with_elements(const std::string& elements, const std::string& scene,
                                 std::vector<std::string> words) {
  const std::filesystem::path folder = fresh_folder("own_element");
  std::filesystem::create_directories(folder);
  const auto file = folder / "vehicle.toml";
  std::ofstream(file) << text_of(std::filesystem::path(RAILSTEP_SOURCE) / "config" / "vehicles" /
                                 "manchester_1.toml")
                      << "\n"
                      << elements;
  words.push_back("vehicle[0].file=\"" + file.string() + "\"");
  return read_scene(shipped(scene), words);
}

/// An element between the car and the first bogie.
inline std::string element_on_bogie(const std::string& name, const std::string& keys) {
  return "[[element]]\nname = \"" + name + "\"\nbetween = [\"car\", \"bogie_1\"]\n" + keys;
}

}  // namespace railstep
