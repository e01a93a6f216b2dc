#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "online/step/self_check.h"
#include "online/step/trace_row.h"
#include "support/small_model.h"

using namespace railstep;

TEST_CASE("every flipped bit of a block is refused, and in the header the error names the field",
          "[block]") {
  const Block good = smallest_block();
  const std::size_t payload = payload_of(good);
  const auto expected = [payload](std::size_t byte) {
    if (byte < 8) return LoadStatus::not_a_model;
    if (byte < offsetof(BlockHeader, minor)) return LoadStatus::other_version;
    const bool size = byte >= offsetof(BlockHeader, bytes) && byte < offsetof(BlockHeader, about);
    if (size) return LoadStatus::wrong_size;
    return byte < payload ? LoadStatus::wrong_header : LoadStatus::wrong_sum;
  };
  Block bad = good;
  std::size_t refused = 0;
  for (std::size_t byte = 0; byte < good.size(); ++byte)
    for (int bit = 0; bit < 8; ++bit) {
      bad[byte] ^= std::byte{1} << bit;
      const LoadStatus status = status_of(bad);
      bad[byte] = good[byte];
      refused += status == expected(byte) ? 1 : 0;
      if (status == expected(byte)) continue;
      CAPTURE(byte, bit);
      CHECK(status == expected(byte));
    }
  CHECK(refused == 8 * good.size());
  CHECK(status_of(bad) == LoadStatus::ok);
}

TEST_CASE("a block of the other byte order is refused as such", "[block]") {
  Block other = smallest_block();
  std::reverse(other.begin() + offsetof(BlockHeader, byte_order),
               other.begin() + offsetof(BlockHeader, major));
  CHECK(status_of(other) == LoadStatus::other_byte_order);
}

TEST_CASE(
    "a block that is too short or too long is refused, with its old checksums and with new ones",
    "[block]") {
  const Block good = smallest_block();
  for (std::size_t size = 0; size < good.size(); ++size) {
    Block cut(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size));
    const bool header = size >= sizeof(BlockHeader);
    CAPTURE(size);
    CHECK(status_of(cut) == (size < 8 ? LoadStatus::not_a_model : LoadStatus::wrong_size));
    if (!header) continue;
    sign(cut);
    CHECK(status_of(cut) != LoadStatus::ok);
  }
  for (const std::size_t more : {1u, 8u, 4096u}) {
    Block longer = good;
    longer.resize(good.size() + more);
    CHECK(status_of(longer) == LoadStatus::wrong_size);
    sign(longer);
    CHECK(status_of(longer) == (more % 8 == 0 ? LoadStatus::bad_content : LoadStatus::wrong_size));
  }
}

TEST_CASE("a header that contradicts its payload is refused although its checksums are right",
          "[block]") {
  const Block good = small_block(true, true);
  const BlockHeader stated = header_of(good.data());
  CHECK(stated.step_s == 1e-4);
  CHECK(stated.steps_per_frame == 2);
  CHECK(stated.caps.guides == 20);
  CHECK(stated.check_frames == kCheckFrames);
  CHECK(std::isnan(stated.static_error));
  const auto status = [&](const auto& change) {
    Block bad = good;
    BlockHeader header = stated;
    change(header);
    std::memcpy(bad.data(), &header, sizeof header);
    sign(bad);
    return status_of(bad);
  };
  using Header = BlockHeader;
  CHECK(status([](Header&) {}) == LoadStatus::ok);
  CHECK(status([](Header& h) { h.minor = 1; }) == LoadStatus::ok);
  CHECK(status([](Header& h) { h.static_error = .5; }) == LoadStatus::ok);
  const LoadStatus bad = LoadStatus::bad_content;
  CHECK(status([](Header& h) { h.real_bytes = 4; }) == bad);
  CHECK(status([](Header& h) { h.step_s = 2e-4; }) == bad);
  CHECK(status([](Header& h) { h.steps_per_frame = 3; }) == bad);
  CHECK(status([](Header& h) { --h.caps.locate; }) == bad);
  CHECK(status([](Header& h) { ++h.caps.ports; }) == bad);
  CHECK(status([](Header& h) { ++h.caps.guides; }) == bad);
  CHECK(status([](Header& h) { ++h.caps.system; }) == bad);
  CHECK(status([](Header& h) { ++h.flops_per_frame; }) == bad);
  CHECK(status([](Header& h) { h.state_bytes += 8; }) == bad);
  CHECK(status([](Header& h) { h.workspace_bytes -= 8; }) == bad);
  CHECK(status([](Header& h) { h.check_frames = 0; }) == bad);
  CHECK(status([](Header& h) { h.check_frames = kMostCheckFrames + 1; }) == bad);
  for (std::size_t s = 0; s < kSections; ++s)
    for (const std::uint64_t value : {std::uint64_t{0}, std::uint64_t{4}, ~std::uint64_t{0},
                                      ~std::uint64_t{7}, std::uint64_t{1} << 40}) {
      CAPTURE(s, value);
      if (s != kCheck && value != 0)
        CHECK(status([&](Header& h) { h.section[s].bytes = value; }) == bad);
      CHECK(status([&](Header& h) { h.section[s].at = value; }) == bad);
    }
  CHECK(status([](Header& h) { h.about.bytes = ~std::uint64_t{0}; }) == bad);
  CHECK(status([](Header& h) { h.about.at = 8; }) == bad);
}

namespace {

bool same_bits(const Model& model) {
  LoadedRun run(model);
  std::vector<double> row(static_cast<std::size_t>(trace_columns(model)));
  const std::uint64_t start = state_hash(model, run.state);
  const bool same = self_check(model, run.state, run.workspace, run.outputs, row.data());
  CHECK(state_hash(model, run.state) == start);
  return same;
}

}  // namespace

TEST_CASE("a reader checks that its steps have the bits of the steps where the block was written",
          "[block]") {
  for (const bool modal : {false, true}) {
    const Block good = small_block(modal, true);
    const auto same = [](const Block& block) {
      Model model;
      REQUIRE(read(block, model).status == LoadStatus::ok);
      return same_bits(model);
    };
    CHECK(same(good));
    Block other = good;  // the last bit of a number of the check
    other[section_at(other, kCheck) + 8] ^= std::byte{1};
    sign(other);
    CHECK_FALSE(same(other));
    other = good;
    BlockHeader header = header_of(other.data());
    header.check_hash ^= 1;
    std::memcpy(other.data(), &header, sizeof header);
    sign(other);
    CHECK_FALSE(same(other));
    Model model;  // stands for arithmetic that rounds differently
    REQUIRE(read(good, model).status == LoadStatus::ok);
    model.scheme.dt = std::nextafter(model.scheme.dt, 1.);
    CHECK_FALSE(same_bits(model));
  }
}
