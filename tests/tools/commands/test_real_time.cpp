// The table of docs/real-time.md: it must have every shipped scene that runs, as it is shipped.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <map>
#include <sstream>
#include <string>
#include <variant>
#include <vector>

#include "scene/scene_system.h"
#include "support/program.h"
#include "support/scene_run.h"

using namespace railstep;
using Catch::Matchers::WithinRel;

namespace {

const std::filesystem::path kTree = RAILSTEP_SOURCE;

using TableRow = std::map<std::string, std::string>;  // by name of column

std::vector<std::string> parts(const std::string& line, char between) {
  std::vector<std::string> found;
  std::istringstream in(line + between);
  for (std::string part; std::getline(in, part, between);) found.push_back(part);
  return found;
}

/// Rows of a file of docs/data by their scene; each scene has one row.
std::map<std::string, TableRow> stored(const char* name) {
  std::istringstream in(text_of(kTree / "docs/data" / name));
  std::string line;
  std::getline(in, line);
  const std::vector<std::string> columns = parts(line, ',');
  std::map<std::string, TableRow> rows;
  while (std::getline(in, line)) {
    const std::vector<std::string> fields = parts(line, ',');
    CAPTURE(line);
    REQUIRE(fields.size() == columns.size());
    TableRow row;
    for (std::size_t i = 0; i < fields.size(); ++i) row[columns[i]] = fields[i];
    CHECK(rows.emplace(fields[0], row).second);
  }
  return rows;
}

/// Scenes of config/scenes that have a [step], with that table.
std::map<std::string, StepScene> runnable() {
  std::map<std::string, StepScene> found;
  for (const auto& entry : std::filesystem::directory_iterator(kScenes)) {
    const AnyScene any = read_any_scene(entry.path());
    const std::string name = entry.path().stem().string();
    if (const auto* system = std::get_if<SystemScene>(&any))
      found.emplace(name, system->step);
    else if (const auto& step = std::get<Scene>(any).step)
      found.emplace(name, *step);
  }
  return found;
}

std::string first_line(const std::filesystem::path& file) {
  const std::string text = text_of(file);
  return text.substr(0, text.find('\n'));
}

/// Number of lines about a scene in the page's table.
int lines_about(const std::string& page, const std::string& scene) {
  const std::vector<std::string> lines = parts(page, '\n');
  return static_cast<int>(std::count_if(lines.begin(), lines.end(), [&](const std::string& line) {
    return line.starts_with("| `" + scene + "` |");
  }));
}

}  // namespace

TEST_CASE("every scene that runs has its row of times and of errors, and no other scene has",
          "[docs]") {
  const std::map<std::string, StepScene> scenes = runnable();
  CHECK(scenes.size() > 15);
  const std::string page = text_of(kTree / "docs/real-time.md");
  for (const char* const file : {"real_time.csv", "real_time_errors.csv"}) {
    const std::map<std::string, TableRow> rows = stored(file);
    for (const auto& [scene, row] : rows) {
      CAPTURE(file, scene);
      CHECK(scenes.count(scene) == 1);
    }
    CHECK(rows.size() == scenes.size());
  }
  for (const auto& [scene, step] : scenes) {
    CAPTURE(scene);
    CHECK(lines_about(page, scene) == 1);
  }
}

TEST_CASE("rows of times have the scenes' own steps, frames, meshes and models", "[docs]") {
  const std::map<std::string, StepScene> scenes = runnable();
  for (const auto& [name, row] : stored("real_time.csv")) {
    CAPTURE(name);
    REQUIRE(scenes.count(name) == 1);
    const StepScene& step = scenes.at(name);
    CHECK_THAT(std::stod(row.at("step_s")), WithinRel(step.dt, 1e-8));
    CHECK_THAT(std::stod(row.at("frame_s")),
               WithinRel(step.dt * static_cast<double>(step.steps_per_frame), 1e-8));
    const AnyScene any = read_any_scene(kScenes + name + ".toml");
    if (std::holds_alternative<SystemScene>(any)) continue;
    const Scene& scene = std::get<Scene>(any);
    if (!scene.track.rigid) CHECK(std::stoi(row.at("elements")) == scene.track.elements_per_bay);
    CHECK((row.at("kind") != "full") == scene.condense.kind.has_value());
    if (scene.condense.modes_per_bay)
      CHECK(std::stod(row.at("amount")) == *scene.condense.modes_per_bay);
  }
}

TEST_CASE("a scene that is not real time at its own frame says that it is a study", "[docs]") {
  for (const auto& [scene, row] : stored("real_time.csv")) {
    const double share = 1e-6 * std::stod(row.at("median_us")) / std::stod(row.at("frame_s"));
    CAPTURE(scene, share);
    CHECK(share > 0.);
    if (share > 1.) CHECK(first_line(kScenes + scene + ".toml").find("study") != std::string::npos);
  }
}
