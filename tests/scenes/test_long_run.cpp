// Effects that only long runs show: memory, and difficult steps once in a minute.
// tests/checks/run-long has the runs of 1e6 and 1e7 steps.
#include <catch2/catch.hpp>
#include <string>

#include "run/simulate.h"

using namespace railstep;

namespace {

const std::string kConfig = std::string(RAILSTEP_SOURCE) + "/config/";

}  // namespace

TEST_CASE("the times that are kept are spread over the whole run", "[run]") {
  Simulation simulation(read_scene(kConfig + "hard/h34_ten_million_steps.toml",
                                   {"step.frame_s=1e-3", "step.duration_s=3000.0"}));
  const auto frames = static_cast<std::int64_t>(2 * kMostTimes + 10);
  const RunRecord record = simulate(simulation, frames, {}, false);
  CHECK(record.frame_stride == 4);
  CHECK(record.frame_us.size() == static_cast<std::size_t>((frames + 3) / 4));
  CHECK(record.slowest_us >= quantile(record.frame_us, 1.));
}

TEST_CASE("the double pendulum runs for a minute", "[run]") {
  // After 50 s the lower beam is bent so hard that a step needs more than one matrix.
  const auto run = simulation_of(
      read_any_scene(kConfig + "scenes/double_pendulum.toml", {"step.duration_s=60.0"}));
  const RunRecord record = simulate(*run, 60000, {}, false);
  CHECK(record.status == Status::ok);
  CHECK(run->state.steps == 60000);
  CHECK(record.constraint_violation < 1e-10);
  CHECK(record.iterations > 10);  // otherwise this tests nothing
}
