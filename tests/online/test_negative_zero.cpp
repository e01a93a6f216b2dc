// -0.0 is read as 0.0: a script that mirrors a scene by -x writes such zeros.
#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "run/simulation.h"
#include "scene/scene_system.h"
#include "support/program.h"
#include "support/scene_run.h"
#include "support/small_model.h"
#include "text/csv.h"
#include "text/read.h"

using namespace railstep;

namespace {

/// Calls `found` with every number under a node and its place, as --set names it.
void numbers_under(const toml::node& node, const std::string& path,
                   const std::function<void(const std::string&, double)>& found) {
  if (const toml::table* table = node.as_table())
    for (const auto& [key, value] : *table)
      numbers_under(value, path + (path.empty() ? "" : ".") + std::string(key.str()), found);
  if (const toml::array* array = node.as_array())
    for (std::size_t i = 0; i < array->size(); ++i)
      numbers_under(*array->get(i), fmt::format("{}[{}]", path, i), found);
  if (node.is_number()) found(path, *node.value<double>());
}

std::vector<std::string> places(const std::filesystem::path& scene, bool zeros_alone) {
  std::vector<std::string> all;
  numbers_under(toml::parse_file(scene.string()), "", [&](const std::string& path, double value) {
    if (value == 0. || !zeros_alone) all.push_back(path);
  });
  return all;
}

/// Checksum of all that a step of the scene reads, and of its start.
std::array<std::uint8_t, 32> model_sum(const std::filesystem::path& scene,
                                       const std::vector<std::string>& overrides) {
  std::array<std::uint8_t, 32> sum;
  const std::unique_ptr<Simulation> run = simulation_of(read_any_scene(scene, overrides));
  std::copy_n(run->model().sum, sum.size(), sum.begin());
  return sum;
}

bool has_run(const std::filesystem::path& scene) {
  return text_of(scene).find("\n[step]") != std::string::npos;
}

}  // namespace

TEST_CASE("numbers of scenes, tables and CSV files are read without the sign of a zero",
          "[negative_zero]") {
  const Table table = read_toml_text("a = -0.0\nb = [-0.0, 1]\nc = [[-0.0, -0e3]]\n", "t.toml");
  std::vector<double> all = {table.number("a", any_number()), table.slope("a", any_number(), 1.),
                             table.number("a", any_number(), 1.), csv_number("-0", "t.csv:1"),
                             csv_number("-0.0", "t.csv:1")};
  for (const double x : table.numbers("b", any_number())) all.push_back(x);
  for (const double x : table.rows("c", 2)) all.push_back(x);
  for (const double x : all) CHECK_FALSE(std::signbit(x));
}

TEST_CASE("a shipped scene whose zeros are -0.0 makes the same model", "[negative_zero]") {
  std::size_t zeros = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kScenes)) {
    if (!has_run(entry.path())) continue;
    std::vector<std::string> negative;
    for (const std::string& place : places(entry.path(), true)) negative.push_back(place + "=-0.0");
    if (negative.empty()) continue;
    zeros += negative.size();
    CAPTURE(entry.path().filename());
    CHECK(model_sum(entry.path(), negative) == model_sum(entry.path(), {}));
  }
  CHECK(zeros > 50);
}

TEST_CASE("any number of a small scene that may be 0 may be -0.0", "[negative_zero]") {
  std::size_t tried = 0;
  for (const char* name : {"moving_load", "spring_pendulum", "slider_crank"}) {
    const std::filesystem::path scene = kScenes + name + ".toml";
    for (const std::string& place : places(scene, false)) {
      std::array<std::uint8_t, 32> zero;
      try {
        zero = model_sum(scene, {place + "=0.0"});
      } catch (const InputError&) {
        continue;  // a mass, a length: it may not be 0
      }
      CAPTURE(name, place);
      CHECK(model_sum(scene, {place + "=-0.0"}) == zero);
      ++tried;
    }
  }
  CHECK(tried > 30);
}

TEST_CASE("a standing load that is mirrored by -x gives the same deflection", "[negative_zero]") {
  const auto deflection = [](const char* start, const char* speed) {
    const Traced run("moving_load", {fmt::format("load[0].start_m={}", start),
                                     fmt::format("load[0].speed_m_per_s={}", speed),
                                     "step.duration_s=0.02", "load[1].force_z_n=0"});
    return run["load_left.deflection_z_m"];
  };
  const std::vector<double> here = deflection("2.5", "0.0"), there = deflection("7.1", "-0.0");
  REQUIRE(here.size() == there.size());
  CHECK(here.back() < -1e-4);
  for (std::size_t i = 0; i < here.size(); ++i) CHECK(std::abs(here[i] - there[i]) < 1e-12);
}

TEST_CASE("a model whose load is taken off before it begins is refused", "[negative_zero]") {
  const std::unique_ptr<PackedModel> packed = small_model(false, true);
  const auto status = [&](double speed, double stop) {
    Model model = packed->model();
    model.load[0].travel.speed = speed;
    model.load[0].stop = stop;
    return status_of(to_block(model, kText));
  };
  constexpr double kFar = std::numeric_limits<double>::infinity();
  for (const double speed : {0., -0., 10.}) {
    CHECK(status(speed, kFar) == LoadStatus::ok);
    CHECK(status(speed, -kFar) == LoadStatus::bad_content);
  }
  CHECK(status(-10., -kFar) == LoadStatus::ok);
  CHECK(status(-10., kFar) == LoadStatus::bad_content);
}
