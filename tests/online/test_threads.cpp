#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstdint>
#include <string>
#include <thread>
#include <vector>

#include "online/step/step.h"
#include "run/simulation.h"

using namespace railstep;

namespace {

constexpr int kFrames = 50;

/// Steps a copy of `start` in memory of its own.
std::uint64_t hash_after(const Model& model, const State& start) {
  std::vector<double> memory(static_cast<std::size_t>(state_doubles(model)));
  std::vector<double> scratch(static_cast<std::size_t>(workspace_doubles(model)));
  State state = copied_state(model, start, memory.data());
  Workspace workspace = workspace_on(model, scratch.data());
  Outputs outputs{};
  for (int frame = 0; frame < kFrames; ++frame)
    (void)advance_frame(model, state, workspace, outputs);
  return state_hash(model, state);
}

}  // namespace

// The preset tsan fails this test too when a step writes to what it shares.
TEST_CASE("threads that share one model step to the bits of one alone", "[threads]") {
  for (const char* name : {"moving_load", "wheelset_on_track", "ballasted_track"}) {
    const Simulation run(
        read_scene(std::string(RAILSTEP_SOURCE) + "/config/scenes/" + name + ".toml"));
    const std::uint64_t start = state_hash(run.model(), run.state);
    const std::uint64_t alone = hash_after(run.model(), run.state);
    std::array<std::uint64_t, 3> hashes{};
    std::vector<std::thread> threads;
    threads.reserve(hashes.size());
    for (std::uint64_t& hash : hashes)
      threads.emplace_back([&run, &hash] { hash = hash_after(run.model(), run.state); });
    for (std::thread& thread : threads) thread.join();
    CAPTURE(name);
    CHECK(alone != start);  // it did move
    for (const std::uint64_t hash : hashes) CHECK(hash == alone);
  }
}
