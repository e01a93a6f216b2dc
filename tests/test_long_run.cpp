// What only long runs show: memory, and steps that are hard once in a minute. tests/run-long has
// the runs of 1e6 and 1e7 steps.
#include <sys/resource.h>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "program.h"
#include "simulate.h"

using namespace railstep;

namespace {

const std::string kScenes = std::string(RAILSTEP_SOURCE) + "/config/";

/// Memory of the largest child so far, KiB.
long memory_of_children() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  return usage.ru_maxrss;
}

}  // namespace

TEST_CASE("a run's memory does not grow with its frames", "[run][cli]") {
  const std::filesystem::path folder = fresh_folder("long");
  const std::string model = (folder / "ring.model").string();
  // of a model file no energies are told, so that frames are all there is
  REQUIRE(railstep_program("condense " + kScenes +
                           "hard/h34_ten_million_steps.toml --set step.frame_s=1e-3 "
                           "--skip-errors --out " +
                           model)
              .code == 0);
  const auto run = [&](int seconds) {
    const Ran ran = railstep_program("run " + model + " --duration " + std::to_string(seconds));
    REQUIRE(ran.code == 0);
    return memory_of_children();
  };
  const long once = run(1500), twice = run(3000);  // 1.5 and 3 million frames, 12 MB of times more
  CHECK(twice <= once + 512);
}

TEST_CASE("times that are kept are spread over the whole run", "[run]") {
  Simulation simulation(read_scene(kScenes + "hard/h34_ten_million_steps.toml",
                                   {"step.frame_s=1e-3", "step.duration_s=3000.0"}));
  const auto frames = static_cast<std::int64_t>(2 * kMostTimes + 10);
  const RunRecord record = simulate(simulation, frames, {}, false);
  CHECK(record.frame_stride == 4);
  CHECK(record.frame_us.size() == static_cast<std::size_t>((frames + 3) / 4));
  CHECK(record.slowest_us >= quantile(record.frame_us, 1.));
}

TEST_CASE("the double pendulum gets through a minute", "[run][cli]") {
  // After 50 s the lower beam is bent so hard that a step takes more matrices than one.
  const Ran ran =
      railstep_program("run " + kScenes + "scenes/double_pendulum.toml --duration 60 --json");
  CAPTURE(ran.err);
  REQUIRE(ran.code == 0);
  const auto told = nlohmann::json::parse(ran.out);
  CHECK(told["status"].empty());
  CHECK(told["final_time_s"] == 60.);
  CHECK(told["max_constraint_violation"].get<double>() < 1e-10);
}
