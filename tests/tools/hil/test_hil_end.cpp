#include <fmt/format.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "support/shipped.h"
#include "support/started.h"

using namespace railstep;
using Catch::Contains;

namespace {

const std::string kPushedWords =
    kWheelset +
    " --set 'wheelset[0].force=[{direction=\"y\", input=\"push\", limit_n=1e3}]' --json";

std::string shared_name(const std::string& of) {
  return "railstep_" + of + "_" + std::to_string(getpid());
}

std::filesystem::path shared_file(const std::string& name) { return "/dev/shm/" + name; }

std::uint64_t word_of(const std::string& bytes, std::size_t word) {
  std::uint64_t value = 0;
  if (bytes.size() >= 8 * (word + 1)) std::memcpy(&value, bytes.data() + 8 * word, sizeof value);
  return value;
}

/// Number of times that outputs were written into shared memory.
std::uint64_t outputs_of(const std::string& name) {
  const std::string bytes = text_of(shared_file(name));
  if (word_of(bytes, 1) != 1) return 0;
  return word_of(bytes, word_of(bytes, 5) / 8 + 1);
}

}  // namespace

TEST_CASE("a signal ends a run between two frames and the program says so", "[hil][cli]") {
  const auto folder = fresh_folder("hil_signal");
  Started hil("hil " + kWheelset + " --rate 100 --duration 6000 --json --names " +
              (folder / "names").string());
  hil.await(folder / "names");
  hil.signal(SIGINT);
  const Ran ran = hil.end();
  CAPTURE(ran.out, ran.err);
  CHECK(ran.code == 1);
  CHECK_THAT(ran.err, Contains("E-HIL-16"));
  const auto told = nlohmann::json::parse(ran.out);
  CHECK(told["interrupted"] == true);
  CHECK(told["errors"].at(0)["id"] == "E-HIL-16");
}

TEST_CASE("a signal ends a run within a period of any length", "[hil][cli]") {
  // The period is 1000 s: the test would not wait for its end.
  const std::string name = shared_name("slow");
  Started hil("hil " + kPushedWords + " --rate 0.001 --duration 1e5 --shm " + name);
  hil.await(shared_file(name));
  hil.signal(SIGTERM);
  const Ran ran = hil.end();
  CHECK(ran.code == 1);
  CHECK_THAT(ran.err, Contains("E-HIL-16"));
  CHECK_FALSE(std::filesystem::exists(shared_file(name)));
}

TEST_CASE("a signal ends the wait for the first inputs and the program says so", "[hil][cli]") {
  const std::string name = shared_name("waits");
  Started hil("hil " + kPushedWords + " --rate 100 --duration 1 --wait 1e4 --shm " + name);
  hil.await(shared_file(name));
  hil.signal(SIGINT);
  const Ran ran = hil.end();
  CHECK(ran.code == 1);
  CHECK_THAT(ran.err, Contains("E-HIL-16"));
}

TEST_CASE("a second signal during a frame without end leaves no shared memory", "[hil][cli]") {
  const std::string name = shared_name("stalls");
  Started hil(
      "hil " + kPushedWords +
      " --rate 1000 --duration 1e5 --policy free-run --stall-frame 1 --stall-us 1e8 --shm " + name);
  hil.await([&] { return outputs_of(name) > 0; });  // frame 0 is over, and 1 takes 100 s
  hil.signal(SIGINT);
  usleep(100'000);  // two signals at once may count as one
  hil.signal(SIGINT);
  const Ran ran = hil.end();
  CHECK((ran.code == -SIGINT || ran.code == 1));
  CHECK_FALSE(std::filesystem::exists(shared_file(name)));
}

TEST_CASE("shared memory that another process cuts short ends the run with one sentence",
          "[hil][cli]") {
  for (const std::uintmax_t left : {0u, 16u}) {
    const std::string name = shared_name("cut");
    const auto folder = fresh_folder("hil_cut");
    Started hil(fmt::format("hil {} --rate 100 --duration 6000 --record {} --shm {}", kPushedWords,
                            (folder / "recording").string(), name));
    hil.await([&] { return outputs_of(name) > 3; });
    std::filesystem::resize_file(shared_file(name), left);
    if (left > 0) {  // a cut within a page raises no signal, so the rest is overwritten
      const std::string none(left, '\0');
      std::ofstream(shared_file(name), std::ios::binary) << none;
    }
    const Ran ran = hil.end();
    CAPTURE(ran.out, ran.err, left);
    CHECK(ran.code == 1);
    CHECK_THAT(ran.err, Contains("E-HIL-09"));
    CHECK(nlohmann::json::parse(ran.out)["frames"].get<int>() >= 3);
    CHECK_FALSE(std::filesystem::exists(shared_file(name)));
    CHECK(railstep_program("replay " + (folder / "recording").string()).code == 0);
  }
}

TEST_CASE("shared memory that is cut short before the first inputs ends the wait", "[hil][cli]") {
  const std::string name = shared_name("cut_wait");
  Started hil("hil " + kPushedWords + " --rate 100 --duration 1 --wait 1e4 --shm " + name);
  hil.await([&] { return word_of(text_of(shared_file(name)), 1) == 1; });
  std::filesystem::resize_file(shared_file(name), 0);
  const Ran ran = hil.end();
  CHECK(ran.code == 1);
  CHECK_THAT(ran.err, Contains("E-HIL-09"));
  CHECK_FALSE(std::filesystem::exists(shared_file(name)));
}
