#include <catch2/catch.hpp>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "run/recording.h"
#include "run/simulate.h"
#include "support/program.h"
#include "support/shipped.h"

using namespace railstep;
using Catch::Contains;

namespace {

Recording recorded(const Scene& scene, std::int64_t frames, std::int64_t every,
                   const FrameInputs& inputs) {
  Simulation run(scene);
  Recording made = Recording::begin(run, every);
  simulate(
      run, frames, nullptr, false,
      [&](std::int64_t done) { made.frame(run, inputs ? inputs(done - 1) : run.state.input); },
      inputs);
  made.finish(run);
  return made;
}

void write_bytes(const std::filesystem::path& file, const std::vector<std::byte>& bytes) {
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

Recording pushed() {
  const Scene scene =
      read_scene(kScenes + "wheelset_on_track.toml",
                 {"wheelset[0].force=[{direction=\"y\", input=\"push\", limit_n=1e3}]"});
  static double value = 0.;
  return recorded(scene, 23, 5, [](std::int64_t frame) {
    value = 3. * static_cast<double>(frame);
    return &value;
  });
}

}  // namespace

TEST_CASE("a replay of a recorded run gives the same hashes", "[recording]") {
  const Recording made = pushed();
  CHECK(made.hashes.size() == 5);  // after frames 5, 10, 15, 20 and 23
  CHECK(replay(made, "it").identical);
}

TEST_CASE("replay finds the frames in which another input was given", "[recording]") {
  Recording made = pushed();
  made.inputs[11] += 1e-9;  // input of frame 12
  const Replay again = replay(made, "it");
  CHECK_FALSE(again.identical);
  CHECK(again.first.frame == 15);
  made = pushed();
  made.snapshot[90] ^= std::byte{1};
  CHECK_THROWS_WITH(replay(made, "it"), Contains("E-RECORDING-06"));
}

TEST_CASE("a flipped bit or a missing end of a recording is refused", "[recording]") {
  const auto folder = fresh_folder("recording");
  const std::vector<std::byte> bytes = pushed().bytes();
  write_bytes(folder / "whole", bytes);
  CHECK(Recording::read(folder / "whole").bytes() == bytes);
  // test_artefact checks the bits of a block. Here: the whole header and one bit in 997.
  for (std::size_t bit = 0; bit < 8 * bytes.size(); bit += bit < 8 * 64 ? 1 : 997) {
    std::vector<std::byte> flipped = bytes;
    flipped[bit / 8] ^= static_cast<std::byte>(1u << (bit % 8));
    write_bytes(folder / "flipped", flipped);
    CHECK_THROWS_AS(Recording::read(folder / "flipped"), InputError);
  }
  for (const std::size_t size : {std::size_t{0}, std::size_t{7}, std::size_t{63}, std::size_t{64},
                                 std::size_t{95}, bytes.size() / 2, bytes.size() - 1}) {
    write_bytes(folder / "cut", {bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)});
    CHECK_THROWS_AS(Recording::read(folder / "cut"), InputError);
  }
}

TEST_CASE("a recording with hashes farther apart than frames can be counted is refused",
          "[recording]") {
  const auto folder = fresh_folder("recording_every");
  Recording made = pushed();
  made.every = std::numeric_limits<std::int64_t>::max();
  made.hashes.resize(1);
  write_bytes(folder / "far", made.bytes());
  CHECK_THROWS_WITH(Recording::read(folder / "far"), Contains("E-RECORDING-05"));
}

TEST_CASE("the program records a run and replays it", "[recording][cli]") {
  const auto folder = fresh_folder("replay");
  const std::string file = (folder / "run.recording").string();
  const Ran ran = railstep_program("run " + kScenes +
                                   "hanging_sleeper.toml --duration 0.05 --hash-every 7 --json "
                                   "--record " +
                                   file);
  CAPTURE(ran.err);
  REQUIRE(ran.code == 0);
  const Ran again = railstep_program("replay " + file + " --json");
  CHECK(again.code == 0);
  const auto told = nlohmann::json::parse(again.out);
  CHECK(told["identical"] == true);
  CHECK(told["first_difference"].is_null());
  CHECK(told["frames"] == 50);
  CHECK(told["hashes"] == 8);

  Recording other = Recording::read(file);
  other.hashes[3] ^= 1;
  write_bytes(file, other.bytes());
  const Ran differing = railstep_program("replay " + file + " --json");
  CHECK(differing.code == 1);
  CHECK(nlohmann::json::parse(differing.out)["first_difference"]["frame"] == 28);

  const Ran none = railstep_program("replay " + kScenes + "moving_load.toml");
  CHECK(none.code == 2);
  CHECK_THAT(none.err, Contains("E-RECORDING-01"));
  CHECK(railstep_program("replay " + (folder / "nothing").string()).code == 2);
}
