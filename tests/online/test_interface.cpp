#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "online/interface/railstep.h"
#include "run/simulate.h"
#include "support/shipped.h"

using namespace railstep;

namespace {

const char* const kPushed = "wheelset[0].force=[{direction=\"y\", input=\"push\", limit_n=1e3}]";

/// A model and a run of it through the C interface, in memory of their own.
struct Held {
  std::vector<double> model_memory, run_memory;
  const railstep_model* model = nullptr;
  railstep_run* run = nullptr;
  explicit Held(const std::vector<std::byte>& block)
      : model_memory(railstep_model_bytes() / 8 + 1) {
    REQUIRE(railstep_load(block.data(), block.size(), model_memory.data(), railstep_model_bytes(),
                          &model) == RAILSTEP_OK);
    run_memory.assign(railstep_run_bytes(model) / 8 + 1, std::nan(""));
    REQUIRE(railstep_start(model, run_memory.data(), railstep_run_bytes(model), &run) ==
            RAILSTEP_OK);
  }
  std::vector<double> outputs() const {
    std::vector<double> row(static_cast<std::size_t>(railstep_outputs(model)));
    railstep_read(run, row.data());
    return row;
  }
};

}  // namespace

TEST_CASE("a run through the C interface has the bits of a run of the program", "[interface]") {
  for (const char* name : {"wheelset_on_track", "wheelset_flange", "hanging_sleeper",
                           "bogie_at_speed", "double_pendulum", "spring_pendulum"}) {
    const auto run = simulation_of(read_any_scene(kScenes + name + ".toml"));
    const Held held(run->block());
    CAPTURE(name);
    REQUIRE(static_cast<std::size_t>(railstep_outputs(held.model)) == run->columns().size());
    const RunRecord record = simulate(*run, 30, nullptr, true);
    const std::size_t width = run->columns().size();
    for (std::size_t frame = 0; frame <= 30; ++frame) {
      if (frame > 0) static_cast<void>(railstep_step(held.run, nullptr));
      const std::vector<double> row = held.outputs();
      CHECK(std::memcmp(row.data(), record.rows.data() + frame * width, 8 * width) == 0);
    }
    CHECK(railstep_hash(held.run) == state_hash(run->model(), run->state));
    CHECK(railstep_steps(held.run) == run->state.steps);
    CHECK(railstep_time_s(held.run) == Approx(30. * railstep_frame_s(held.model)));
  }
}

TEST_CASE("inputs and outputs have names", "[interface]") {
  const Simulation run(read_scene(kScenes + "wheelset_on_track.toml", {kPushed}));
  const Held held(run.block());
  REQUIRE(railstep_inputs(held.model) == 1);
  CHECK(railstep_find_input(held.model, "push.force_n") == 0);
  CHECK(railstep_find_input(held.model, "push.force") == -1);
  CHECK(railstep_find_input(held.model, "push.force_n2") == -1);
  for (std::int32_t i = 0; i < railstep_outputs(held.model); ++i) {
    char name[80];
    const std::size_t length = railstep_output_name(held.model, i, name, sizeof name);
    CHECK(name == run.columns()[static_cast<std::size_t>(i)]);
    CHECK(length == std::strlen(name));
    CHECK(railstep_find_output(held.model, name) == i);
  }
  char cut[5];
  CHECK(railstep_input_name(held.model, 0, cut, sizeof cut) == std::strlen("push.force_n"));
  CHECK(std::string(cut) == "push");
  CHECK(railstep_input_name(held.model, 1, cut, sizeof cut) == 0);
  CHECK(railstep_input_name(held.model, -1, nullptr, 0) == 0);
}

TEST_CASE("inputs act, a bad one is reported, and a reset goes back to the start", "[interface]") {
  const Simulation run(read_scene(kScenes + "wheelset_on_track.toml", {kPushed}));
  const Held held(run.block()), other(run.block());
  const auto y = static_cast<std::size_t>(railstep_find_output(held.model, "wheelset.y_m"));
  double force = 500.;
  for (int n = 0; n < 50; ++n) {
    CHECK(railstep_step(held.run, &force) == 0);
    CHECK(railstep_step(other.run, nullptr) == 0);
  }
  CHECK(held.outputs()[y] > 1e-4);
  CHECK(other.outputs()[y] < 1e-6);
  force = std::nan("");
  CHECK((railstep_step(held.run, &force) & RAILSTEP_NONFINITE_INPUT) != 0);
  CHECK(std::string(railstep_status_name(RAILSTEP_NONFINITE_INPUT)) == "nonfinite_input");
  CHECK(std::string(railstep_status_text(RAILSTEP_FORCE_SATURATED)).find("limit") !=
        std::string::npos);
  CHECK(std::string(railstep_status_name(0)).empty());
  railstep_reset(held.run);
  CHECK(railstep_steps(held.run) == 0);
  CHECK(railstep_step(held.run, nullptr) == 0);
}

TEST_CASE("a response without inputs is that to the held inputs", "[interface]") {
  const Simulation run(
      read_scene(kScenes + "open_track.toml", {"step.dt_s=1e-3", "step.frame_s=1e-3"}));
  const Held held(run.block());
  REQUIRE(railstep_external_wheels(held.model) == 1);
  const std::vector<double> inputs = {3.1, .001, 10., 200., -5e4};  // place and forces
  REQUIRE(railstep_inputs(held.model) == 5);
  CHECK(railstep_step(held.run, inputs.data()) == 0);
  double given[12] = {}, as_held[12] = {};
  CHECK(railstep_response(held.run, inputs.data(), given, given + 3) == 0);
  CHECK(railstep_response(held.run, nullptr, as_held, as_held + 3) == 0);
  CHECK(given[11] > 0.);
  for (int i = 0; i < 12; ++i) CHECK(as_held[i] == given[i]);
}

TEST_CASE("a snapshot of one run is restored into another", "[interface]") {
  const Simulation run(read_scene(kScenes + "wheelset_flange.toml", {}));
  const Held held(run.block()), other(run.block());
  for (int n = 0; n < 20; ++n) static_cast<void>(railstep_step(held.run, nullptr));
  std::vector<unsigned char> bytes(railstep_snapshot_bytes(held.model));
  railstep_save(held.run, bytes.data());
  CHECK(railstep_restore(other.run, bytes.data(), bytes.size() - 1) == RAILSTEP_WRONG_SIZE);
  bytes[100] ^= 1;
  CHECK(railstep_restore(other.run, bytes.data(), bytes.size()) == RAILSTEP_WRONG_SUM);
  CHECK(railstep_steps(other.run) == 0);
  bytes[100] ^= 1;
  REQUIRE(railstep_restore(other.run, bytes.data(), bytes.size()) == RAILSTEP_OK);
  CHECK(railstep_hash(other.run) == railstep_hash(held.run));
  static_cast<void>(railstep_step(held.run, nullptr));
  static_cast<void>(railstep_step(other.run, nullptr));
  CHECK(other.outputs() == held.outputs());
}

TEST_CASE("unfit blocks and unfit memory are refused, and every result has a sentence",
          "[interface]") {
  const Simulation run(read_scene(kScenes + "moving_load.toml", {}));
  std::vector<std::byte> block = run.block();
  std::vector<double> memory(railstep_model_bytes() / 8 + 2);
  const railstep_model* model = nullptr;
  const auto load = [&](std::size_t bytes, void* at, std::size_t room) {
    return railstep_load(block.data(), bytes, at, room, &model);
  };
  const std::size_t room = railstep_model_bytes();
  CHECK(load(block.size(), memory.data(), room - 1) == RAILSTEP_TOO_LITTLE_MEMORY);
  CHECK(load(block.size(), reinterpret_cast<char*>(memory.data()) + 4, room) ==
        RAILSTEP_MISALIGNED);
  CHECK(load(block.size() - 8, memory.data(), room) == RAILSTEP_WRONG_SIZE);
  CHECK(load(3, memory.data(), room) == RAILSTEP_NOT_A_MODEL);
  CHECK(model == nullptr);
  block[block.size() / 2] ^= std::byte{4};
  CHECK(load(block.size(), memory.data(), room) == RAILSTEP_WRONG_SUM);
  block[block.size() / 2] ^= std::byte{4};
  REQUIRE(load(block.size(), memory.data(), room) == RAILSTEP_OK);
  std::vector<double> place(railstep_run_bytes(model) / 8 + 2);
  railstep_run* made = nullptr;
  CHECK(railstep_start(model, place.data(), railstep_run_bytes(model) - 1, &made) ==
        RAILSTEP_TOO_LITTLE_MEMORY);
  CHECK(railstep_start(model, reinterpret_cast<char*>(place.data()) + 1, railstep_run_bytes(model),
                       &made) == RAILSTEP_MISALIGNED);
  CHECK(made == nullptr);
  for (std::int32_t result = RAILSTEP_OK; result <= RAILSTEP_OTHER_MODEL; ++result)
    CHECK(std::strlen(railstep_result_text(result)) > 5);
  CHECK(std::string(railstep_result_text(99)).find("not a result") == 0);
  CHECK(railstep_load(nullptr, 64, memory.data(), room, &model) == RAILSTEP_NOT_A_MODEL);
  CHECK(load(block.size(), nullptr, room) == RAILSTEP_TOO_LITTLE_MEMORY);
  CHECK(model == nullptr);
  CHECK(railstep_load(block.data(), block.size(), memory.data(), room, nullptr) ==
        RAILSTEP_TOO_LITTLE_MEMORY);
  REQUIRE(load(block.size(), memory.data(), room) == RAILSTEP_OK);
  CHECK(railstep_start(model, nullptr, railstep_run_bytes(model), &made) ==
        RAILSTEP_TOO_LITTLE_MEMORY);
  CHECK(railstep_start(model, place.data(), railstep_run_bytes(model), nullptr) ==
        RAILSTEP_TOO_LITTLE_MEMORY);
  REQUIRE(railstep_start(model, place.data(), railstep_run_bytes(model), &made) == RAILSTEP_OK);
  CHECK(railstep_restore(made, nullptr, 64) == RAILSTEP_NOT_A_SNAPSHOT);
  CHECK(railstep_version() == RAILSTEP_VERSION);
}

TEST_CASE("status bits of the C interface are those of the core", "[interface]") {
  CHECK(RAILSTEP_OFF_RAIL == static_cast<int>(Status::off_rail));
  CHECK(RAILSTEP_CONTACT_LOST == static_cast<int>(Status::contact_lost));
  CHECK(RAILSTEP_CAP_REACHED == static_cast<int>(Status::cap_reached));
  CHECK(RAILSTEP_NONFINITE_STATE == static_cast<int>(Status::nonfinite_state));
  CHECK(RAILSTEP_CONTACT_UNRESOLVED == static_cast<int>(Status::contact_unresolved));
  CHECK(RAILSTEP_REDUNDANT_JOINT == static_cast<int>(Status::redundant_joint));
  CHECK(RAILSTEP_LARGE_TURN == static_cast<int>(Status::large_turn));
  CHECK(RAILSTEP_CONTACT_ILL_POSED == static_cast<int>(Status::contact_ill_posed));
  CHECK(RAILSTEP_FULL_SLIP == static_cast<int>(Status::full_slip));
  CHECK(RAILSTEP_BEYOND_PROFILE == static_cast<int>(Status::beyond_profile));
  CHECK(RAILSTEP_NONFINITE_INPUT == static_cast<int>(Status::nonfinite_input));
  CHECK(RAILSTEP_FORCE_SATURATED == static_cast<int>(Status::force_saturated));
}
