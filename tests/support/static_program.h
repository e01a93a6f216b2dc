#pragma once
#include <array>
#include <catch2/catch.hpp>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "support/program.h"
#include "support/shipped.h"

namespace railstep {

/// The file of a shipped scene and a blank.
inline std::string shipped_word(const std::string& name) { return shipped(name) + " "; }

/// A scene of a test, in a folder of its own.
struct OwnScene {
  std::filesystem::path folder = fresh_folder("static");
  std::filesystem::path file = folder / "scene.toml";
  explicit OwnScene(const std::string& text) { std::ofstream(file) << text; }
  ~OwnScene() { std::filesystem::remove_all(folder); }
  OwnScene(const OwnScene&) = delete;
  OwnScene& operator=(const OwnScene&) = delete;
  std::string words() const { return file.string() + " "; }
};

/// Result of `railstep static`.
inline nlohmann::json solved(const std::string& words) {
  const Ran ran = railstep_program("static " + words + " --json");
  INFO(words << "\n" << ran.err);
  REQUIRE(ran.code == 0);
  return nlohmann::json::parse(ran.out);
}

/// Displacement of a named point of the result, m.
inline std::array<double, 3> point(const nlohmann::json& result, const std::string& name = "tip") {
  for (const auto& p : result["points"])
    if (p["name"] == name) return p["displacement_m"];
  FAIL("no point " << name);
  return {};
}

}  // namespace railstep
