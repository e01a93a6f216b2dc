#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "online/interface/railstep.h"
#include "online/math/sha256.h"
#include "online/model/block.h"
#include "support/bad_input.h"

using namespace railstep;

namespace {

/// The bytes of a model that the program wrote, once for all tests.
const std::string& good_model() {
  static const std::string bytes = [] {
    const BadInput folder("good_model");
    const Ran ran = railstep_program(
        "condense " + shipped("moving_load") +
        " --set 'condense={kind=\"modal\", modes_per_bay=1}' --skip-errors --out " +
        folder.path("x.model"));
    REQUIRE(ran.code == 0);
    return text_of(folder.path("x.model"));
  }();
  return bytes;
}

BlockHeader header_of(const std::string& model) {
  BlockHeader header{};
  std::memcpy(&header, model.data(), sizeof header);
  return header;
}

template <typename T>
std::string with(std::string model, std::size_t at, T value) {
  const auto* bytes = reinterpret_cast<const char*>(&value);
  for (std::size_t i = 0; i < sizeof value; ++i) model.at(at + i) = bytes[i];
  return model;
}

/// The model with checksums of its present content.
std::string with_its_sums(std::string model) {
  const std::size_t from = header_of(good_model()).header_bytes;
  sha256(model.data() + from, model.size() - from,
         reinterpret_cast<std::uint8_t*>(model.data() + kSumAt));
  const auto* const block = reinterpret_cast<const unsigned char*>(model.data());
  return with(std::move(model), kCrcAt, std::uint64_t{header_crc(block, from)});
}

/// Checks that `run` and `hil` refuse a model and leave existing output files alone.
void program_refuses(const std::string& model, const std::vector<std::string>& said) {
  const BadInput bad("model");
  const std::string file = bad.file("x.model", model);
  std::vector<std::string> all = said;
  all.push_back("x.model");
  bad.refused("run " + file + bad.old("--trace", "t.csv") + bad.old("--record", "r.bin"), all);
  bad.refused("hil " + file + " --rate 100 --duration 0.1" + bad.old("--report", "h.html"), all);
}

/// A model loaded by the C interface; checks that no model is handed out when it is refused.
struct Loaded {
  std::int32_t result = -1;
  const railstep_model* model = nullptr;
  std::vector<double> block, memory;
  explicit Loaded(const std::string& bytes)
      : block(bytes.size() / 8 + 1), memory(railstep_model_bytes() / 8 + 1) {
    std::memcpy(block.data(), bytes.data(), bytes.size());
    model = reinterpret_cast<const railstep_model*>(memory.data());  // a refusal clears this
    result =
        railstep_load(block.data(), bytes.size(), memory.data(), railstep_model_bytes(), &model);
    if ((result == RAILSTEP_OK) != (model != nullptr)) FAIL("a model is there where none is");
  }
};

std::int32_t result_of(const std::string& bytes) { return Loaded(bytes).result; }

}  // namespace

TEST_CASE("a model without its magic word is refused", "[bad_input][cli]") {
  std::string other = good_model();
  other[0] = 'R';
  program_refuses(other, {"railstep condense", "E-MODEL-07"});
  CHECK(result_of(other) == RAILSTEP_NOT_A_MODEL);
  const BadInput bad("no_model");
  bad.refused("run '" RAILSTEP_PROGRAM "'" + bad.old("--trace", "t.csv"), {"E-MODEL-07"});
  program_refuses("railstep is a word of a text that is long enough to be more than a header", {});
  program_refuses(std::string("\0\1\2\3", 4), {"E-MODEL-07"});
}

TEST_CASE("a model of another version is refused with both versions", "[bad_input][cli]") {
  for (const int major : {0, 1, kBlockMajor - 1, kBlockMajor + 1, 65535}) {
    const std::string other =
        with(good_model(), offsetof(BlockHeader, major), static_cast<std::uint16_t>(major));
    program_refuses(other, {"format " + std::to_string(major) + ";",
                            "expected format " + std::to_string(kBlockMajor), "E-MODEL-08"});
    CHECK(result_of(other) == RAILSTEP_OTHER_VERSION);
  }
}

TEST_CASE("a model cut at any byte is refused", "[bad_input][cli]") {
  const std::string& good = good_model();
  std::size_t refused = 0;
  for (std::size_t size = 0; size < good.size(); ++size) {
    const std::int32_t result = result_of(good.substr(0, size));
    refused += result == (size < 8 ? RAILSTEP_NOT_A_MODEL : RAILSTEP_WRONG_SIZE) ? 1u : 0u;
  }
  CHECK(refused == good.size());
  const std::size_t head = sizeof(BlockHeader), from = header_of(good).header_bytes;
  for (const std::size_t size : {std::size_t{8}, std::size_t{15}, std::size_t{16}, head - 1, head,
                                 from, good.size() / 2, good.size() - 8, good.size() - 1})
    program_refuses(good.substr(0, size), {"E-MODEL-10"});
  for (const std::size_t size : {0u, 1u, 7u}) program_refuses(good.substr(0, size), {});
}

TEST_CASE("a model with any flipped bit is refused", "[bad_input][cli]") {
  const std::string& good = good_model();
  const std::size_t from = header_of(good).header_bytes;
  std::size_t bits = 0, refused = 0;
  for (std::size_t byte = 0; byte < good.size(); byte += byte < from ? 1 : 101) {
    std::string bad = good;
    bad[byte] = static_cast<char>(bad[byte] ^ (1 << (byte % 8)));
    ++bits;
    refused += result_of(bad) != RAILSTEP_OK ? 1u : 0u;
  }
  CHECK(refused == bits);
  std::string bad = good;
  bad[good.size() / 2] ^= 1;
  program_refuses(bad, {"E-MODEL-12"});
  bad = good;
  bad[from - 8] ^= 1;
  program_refuses(bad, {"E-MODEL-11"});
}

TEST_CASE("counts whose product with a size overflows are refused even with right checksums",
          "[bad_input][cli]") {
  const std::string& good = good_model();
  const BlockHeader header = header_of(good);
  const std::int64_t wrapping[] = {std::numeric_limits<std::int64_t>::max(),
                                   std::numeric_limits<std::int64_t>::min(),
                                   -1,
                                   (std::int64_t{1} << 61) + 1,
                                   std::int64_t{1} << 60,
                                   std::int64_t{1} << 32};
  const Loaded whole(good);
  REQUIRE(whole.result == RAILSTEP_OK);
  std::size_t harmless = 0;
  const std::size_t words = header.section[kWords].bytes / 8;
  for (std::size_t i = 0; i < words; ++i)
    for (const std::int64_t value : wrapping) {
      const Loaded other(with_its_sums(with(good, header.section[kWords].at + 8 * i, value)));
      CAPTURE(i, value);
      if (other.result == RAILSTEP_OK) {  // not a count: the frames of a scene
        ++harmless;
        CHECK(railstep_run_bytes(other.model) == railstep_run_bytes(whole.model));
      } else {
        CHECK(other.result == RAILSTEP_BAD_CONTENT);
      }
    }
  CHECK(harmless < 10);
  for (std::size_t s = 0; s < kSections; ++s)
    for (const std::int64_t value : wrapping) {
      const std::size_t at = offsetof(BlockHeader, section) + s * sizeof(BlockSection);
      CHECK(result_of(with_its_sums(with(good, at, value))) == RAILSTEP_BAD_CONTENT);
      CHECK(result_of(with_its_sums(with(good, at + 8, value))) == RAILSTEP_BAD_CONTENT);
    }
  program_refuses(with_its_sums(with(good, header.section[kWords].at + 8, wrapping[3])),
                  {"not finite or out of its range"});
}

TEST_CASE("a model with bytes after its end is refused", "[bad_input][cli]") {
  for (const std::size_t more : {1u, 8u, 4096u}) {
    const std::string longer = good_model() + std::string(more, '\0');
    program_refuses(longer, {"E-MODEL-10"});
    CHECK(result_of(longer) == RAILSTEP_WRONG_SIZE);
    const std::uint64_t bytes = longer.size();
    CHECK(result_of(with_its_sums(with(longer, offsetof(BlockHeader, bytes), bytes))) !=
          RAILSTEP_OK);
  }
}

TEST_CASE("NaN in a matrix of a model is refused even with right checksums", "[bad_input][cli]") {
  const std::string& good = good_model();
  const BlockSection reals = header_of(good).section[kReals];
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::size_t tried = 0, refused = 0;
  for (std::size_t at = 0; at < reals.bytes; at += 8 * 13, ++tried)
    refused += result_of(with_its_sums(with(good, reals.at + at, nan))) == RAILSTEP_BAD_CONTENT;
  CHECK(tried > 100);
  CHECK(refused == tried);
  const double infinite = std::numeric_limits<double>::infinity();
  for (const double value : {nan, infinite, -infinite})
    program_refuses(with_its_sums(with(good, reals.at + reals.bytes / 2 / 8 * 8, value)),
                    {"not finite or out of its range"});
}

TEST_CASE("names, frames and costs of a model that no scene could have are refused",
          "[bad_input][cli]") {
  const std::string& good = good_model();
  const BlockHeader header = header_of(good);
  REQUIRE(header.steps_per_frame == 40);
  const std::size_t dot = good.find("load_left.") + 9;
  for (const char c : {',', '\r', '\x1b', '"'})
    program_refuses(with_its_sums(with(good, dot, c)), {"E-MODEL-06"});
  // Places of a number among the words.
  const auto places = [&](std::int64_t value) {
    std::vector<std::size_t> all;
    for (std::size_t at = header.section[kWords].at;
         at < header.section[kWords].at + header.section[kWords].bytes; at += 8)
      if (std::memcmp(good.data() + at, &value, sizeof value) == 0) all.push_back(at);
    return all;
  };
  REQUIRE(places(12'000).size() == 1);  // steps of the scene
  const std::size_t of_steps = places(12'000).front();
  for (const std::int64_t steps : {0, 39, 41})
    program_refuses(with_its_sums(with(good, of_steps, steps)), {"E-MODEL-06"});
  constexpr std::int64_t kMany = 1 << 22;
  std::string long_frames = with(good, of_steps, kMany);
  long_frames = with(long_frames, offsetof(BlockHeader, steps_per_frame), kMany);
  CHECK_FALSE(places(40).empty());
  for (const std::size_t at : places(40))  // one of them holds the steps per frame
    program_refuses(with_its_sums(with(long_frames, at, kMany)), {"E-MODEL-06"});
}

TEST_CASE("memory that is misaligned or too small gives no model and no run", "[bad_input]") {
  const std::string& bytes = good_model();
  std::vector<double> block(bytes.size() / 8 + 2), memory(railstep_model_bytes() / 8 + 2);
  std::memcpy(block.data(), bytes.data(), bytes.size());
  const std::size_t room = railstep_model_bytes();
  const railstep_model* model = nullptr;
  const auto load = [&](std::size_t block_off, std::size_t off, std::size_t given) {
    auto* const from = reinterpret_cast<char*>(block.data()) + block_off;
    std::copy(bytes.begin(), bytes.end(), from);
    model = reinterpret_cast<const railstep_model*>(memory.data());
    const std::int32_t result = railstep_load(
        from, bytes.size(), reinterpret_cast<char*>(memory.data()) + off, given, &model);
    CHECK((model == nullptr || result == RAILSTEP_OK));
    return result;
  };
  for (std::size_t off = 1; off < 8; ++off) {
    CHECK(load(0, off, room) == RAILSTEP_MISALIGNED);
    CHECK(load(off, 0, room) == RAILSTEP_MISALIGNED);
  }
  for (const std::size_t given : {std::size_t{0}, room / 2, room - 1})
    CHECK(load(0, 0, given) == RAILSTEP_TOO_LITTLE_MEMORY);
  REQUIRE(load(0, 0, room) == RAILSTEP_OK);
  const std::size_t wanted = railstep_run_bytes(model);
  std::vector<double> place(wanted / 8 + 2);
  const auto start = [&](std::size_t off, std::size_t given) {
    railstep_run* run = reinterpret_cast<railstep_run*>(place.data());
    const std::int32_t result =
        railstep_start(model, reinterpret_cast<char*>(place.data()) + off, given, &run);
    CHECK((run == nullptr || result == RAILSTEP_OK));
    return result;
  };
  for (std::size_t off = 1; off < 8; ++off) CHECK(start(off, wanted) == RAILSTEP_MISALIGNED);
  for (const std::size_t given : {std::size_t{0}, wanted / 2, wanted - 1})
    CHECK(start(0, given) == RAILSTEP_TOO_LITTLE_MEMORY);
  CHECK(start(0, wanted) == RAILSTEP_OK);
  for (const std::int32_t result : {RAILSTEP_MISALIGNED, RAILSTEP_TOO_LITTLE_MEMORY})
    CHECK(std::strlen(railstep_result_text(result)) > 5);
}

TEST_CASE("a recording that is cut or changed is refused, and so is a file that is not a recording",
          "[bad_input][cli]") {
  const BadInput bad("recording");
  const std::string file = bad.path("good.rec");
  REQUIRE(railstep_program("run " + shipped("moving_load") + " --duration 0.01 --record " + file)
              .code == 0);
  const std::string good = text_of(file);
  const auto refused = [&](const std::string& bytes, const std::string& said) {
    bad.refused("replay " + bad.file("bad.rec", bytes), {"bad.rec", said});
  };
  for (const std::size_t size : {0u, 5u, 8u, 30u}) refused(good.substr(0, size), "E-RECORDING-01");
  for (const std::size_t size : {std::size_t{100}, good.size() / 2, good.size() - 1})
    refused(good.substr(0, size), "and it has " + std::to_string(size));
  refused(good + "more", "E-RECORDING-03");
  refused(good_model(), "E-RECORDING-01");
  std::string other = good;
  other[good.size() / 2] ^= 1;
  refused(other, "E-RECORDING-04");
  bad.refused("replay /dev/zero", {"/dev/zero: ", "E-MODEL-01"});
  std::filesystem::create_directory(bad.path("folder"));
  bad.refused("replay " + bad.path("folder"), {"E-MODEL-01"});
  bad.refused("replay " + bad.path("none"), {"none: ", "E-FILE-04"});
}
