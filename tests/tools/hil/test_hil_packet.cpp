#include <bit>
#include <catch2/catch.hpp>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "hil/hil_packet.h"
#include "hil/hil_receiver.h"
#include "online/math/crc32.h"

using namespace railstep;

namespace {

using Bytes = std::vector<unsigned char>;

const std::vector<std::string> kNames = {"push.force_n", "brake.moment_n_m"};
constexpr std::int64_t kMs = 1'000'000;  // ns

Bytes packet(std::uint64_t sequence, std::int64_t frame = -1, double first = 1.5) {
  const double values[2] = {first, -2e-3};
  Bytes bytes(packet_bytes(2));
  encode({.kind = PacketKind::inputs,
          .names = names_sum(kNames),
          .count = 2,
          .sequence = sequence,
          .frame = frame},
         values, bytes.data());
  return bytes;
}

/// A receiver with the values that it took last.
struct Ear {
  Receiver receiver{names_sum(kNames), 2};
  double value[2] = {0., 0.};
  std::int64_t now = 0;

  bool take(const Bytes& bytes, std::uint64_t sender = 7, std::int64_t begun = -1) {
    now += kMs;
    return receiver.take(bytes, sender, now, begun, value);
  }
  const PacketCounts& counts() const { return receiver.counts(); }
};

}  // namespace

TEST_CASE("the sum is the CRC-32 of zlib", "[hil]") {
  const std::string digits = "123456789";
  CHECK(crc32(digits.data(), 9) == 0xCBF43926u);
  CHECK(crc32(nullptr, 0) == 0u);
  // Python: zlib.crc32(b"push.force_n\nbrake.moment_n_m\n")
  CHECK(names_sum(kNames) == 0x575e95fau);
}

TEST_CASE("a packet has the documented bytes", "[hil]") {
  // Written with Python's struct and zlib from the table of docs/hil.md.
  const Bytes want = {0x52, 0x53, 0x48, 0x4c, 0x01, 0x00, 0x01, 0x00, 0xfa, 0x95, 0x5e, 0x57,
                      0x02, 0x00, 0x00, 0x00, 0x08, 0x07, 0x06, 0x05, 0x04, 0x03, 0x02, 0x01,
                      0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x00, 0x00, 0x00, 0x00,
                      0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xf8, 0x3f,
                      0xfc, 0xa9, 0xf1, 0xd2, 0x4d, 0x62, 0x60, 0xbf, 0x2b, 0xdc, 0x39, 0xa6};
  CHECK(packet(0x0102030405060708) == want);
}

TEST_CASE("decoding returns the values that were encoded", "[hil]") {
  const double values[3] = {std::numeric_limits<double>::quiet_NaN(), -0.,
                            std::numeric_limits<double>::denorm_min()};
  const PacketHead head{PacketKind::outputs, 5, 3, 1ULL << 40, 1LL << 50, 0x1234, kSafeStop};
  Bytes bytes(packet_bytes(3));
  encode(head, values, bytes.data());
  double back[3] = {};
  const auto found = decode(bytes, PacketKind::outputs, 5, 3, back);
  REQUIRE(found);
  for (int i = 0; i < 3; ++i)
    CHECK(std::bit_cast<std::uint64_t>(values[i]) == std::bit_cast<std::uint64_t>(back[i]));
  CHECK(found->sequence == head.sequence);
  CHECK(found->frame == head.frame);
  CHECK(found->status == head.status);
  CHECK(found->flags == head.flags);
}

TEST_CASE("every flipped bit, every other length and other names are refused", "[hil]") {
  const Bytes whole = packet(3);
  const std::uint32_t names = names_sum(kNames);
  double values[3] = {4., 5., 6.};
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    Bytes flipped = whole;
    flipped[bit / 8] = static_cast<unsigned char>(flipped[bit / 8] ^ (1u << (bit % 8)));
    CHECK_FALSE(decode(flipped, PacketKind::inputs, names, 2, values));
  }
  for (std::size_t size = 0; size < whole.size(); ++size)
    CHECK_FALSE(decode({whole.data(), size}, PacketKind::inputs, names, 2, values));
  Bytes longer = whole;
  longer.push_back(0);
  CHECK_FALSE(decode(longer, PacketKind::inputs, names, 2, values));
  CHECK_FALSE(decode(whole, PacketKind::outputs, names, 2, values));
  CHECK_FALSE(decode(whole, PacketKind::inputs, names + 1, 2, values));
  CHECK_FALSE(decode(whole, PacketKind::inputs, names, 3, values));
  CHECK(values[0] == 4.);  // no value was written
  CHECK(decode(whole, PacketKind::inputs, names, 2, values));
}

TEST_CASE("lost, repeated and reordered packets are counted separately and the newest wins",
          "[hil]") {
  Ear ear;
  CHECK(ear.take(packet(10, -1, 10.)));
  CHECK(ear.take(packet(11, -1, 11.)));
  CHECK(ear.counts().lost == 0);
  CHECK(ear.take(packet(15, -1, 15.)));
  CHECK(ear.counts().lost == 3);
  CHECK_FALSE(ear.take(packet(13, -1, 13.)));
  CHECK(ear.counts().reordered == 1);
  CHECK(ear.counts().lost == 2);
  CHECK_FALSE(ear.take(packet(13, -1, 13.)));
  CHECK_FALSE(ear.take(packet(15, -1, 15.)));
  CHECK(ear.counts().repeated == 2);
  CHECK_FALSE(ear.take(packet(9)));  // it came before the first one, so it was not missing
  CHECK(ear.counts().reordered == 2);
  CHECK(ear.counts().lost == 2);
  CHECK(ear.value[0] == 15.);
  CHECK(ear.take(packet(15 + Receiver::kMemory)));
  CHECK_FALSE(ear.take(packet(14)));  // too old to be remembered
  CHECK(ear.counts().repeated == 3);
  CHECK_FALSE(ear.take(packet(16)));  // this one is remembered
  CHECK(ear.counts().reordered == 3);
  CHECK(ear.counts().good == 4);
  CHECK(ear.counts().foreign == 0);
}

TEST_CASE("every packet of a shuffled, thinned and doubled stream is counted once", "[hil]") {
  Ear ear;
  std::int64_t came = 0, first_time = 0;
  std::vector<bool> seen(2000, false);
  std::uint64_t random = 88172645463325252ULL, highest = 1;
  CHECK(ear.take(packet(1)));
  seen[1] = true;
  for (std::uint64_t n = 2; n < 1900; ++n) {
    random ^= random << 13, random ^= random >> 7, random ^= random << 17;
    const std::uint64_t sequence = n + random % 40;
    ++came;
    first_time += seen[sequence] ? 0 : 1;
    seen[sequence] = true;
    highest = std::max(highest, sequence);
    ear.take(packet(sequence));
  }
  const PacketCounts& c = ear.counts();
  CHECK(c.good + c.reordered + c.repeated == 1 + came);
  CHECK(c.good + c.reordered == 1 + first_time);
  CHECK(c.lost == static_cast<std::int64_t>(highest) - 1 - first_time);
}

TEST_CASE("foreign packets and other senders change nothing", "[hil]") {
  Ear ear;
  CHECK(ear.take(packet(1, -1, 1.)));
  Bytes damaged = packet(2, -1, 2.);
  damaged[44] ^= 1;
  CHECK_FALSE(ear.take(damaged));
  CHECK_FALSE(ear.take({}));
  CHECK_FALSE(ear.take(packet(2, -1, 2.), 8));
  CHECK_FALSE(ear.take(packet(1ULL << 60)));
  CHECK(ear.counts().foreign == 4);
  CHECK(ear.value[0] == 1.);
  CHECK(ear.take(packet(2, -1, 2.)));
  CHECK(ear.counts().good == 2);
  CHECK(ear.counts().lost == 0);
}

TEST_CASE("one number far ahead does not shut out those that follow it", "[hil]") {
  Ear ear;
  CHECK(ear.take(packet(1)));
  CHECK_FALSE(ear.take(packet(Receiver::kMostSequence)));
  CHECK(ear.counts().foreign == 1);
  CHECK(ear.take(packet(2)));
  CHECK(ear.take(packet(2 + Receiver::kMostAhead)));
  CHECK(ear.counts().lost == static_cast<std::int64_t>(Receiver::kMostAhead - 1));
  ear.now += Receiver::kPeerSilence;
  CHECK(ear.take(packet(Receiver::kMostSequence)));  // the sender starts again there
  CHECK(ear.counts().lost == static_cast<std::int64_t>(Receiver::kMostAhead - 1));
}

TEST_CASE("after a silence another sender or one that starts again is accepted", "[hil]") {
  Ear ear;
  CHECK(ear.take(packet(100)));
  CHECK_FALSE(ear.take(packet(1)));
  ear.now += Receiver::kPeerSilence;
  CHECK(ear.take(packet(1)));
  CHECK(ear.counts().lost == 0);
  ear.now += Receiver::kPeerSilence;
  CHECK(ear.take(packet(1), 9));
  CHECK_FALSE(ear.take(packet(2), 7));
  ear.now += Receiver::kPeerSilence;
  CHECK(ear.take(packet(5), 9));  // the same sender goes on: missing packets were lost
  CHECK(ear.counts().lost == 3);
}

TEST_CASE("inputs for a frame that has begun are accepted and counted as late", "[hil]") {
  Ear ear;
  CHECK(ear.take(packet(1, 6), 7, 5));
  CHECK(ear.counts().late == 0);
  CHECK(ear.take(packet(2, 6), 7, 6));
  CHECK(ear.take(packet(3, -1), 7, 6));
  CHECK(ear.counts().late == 1);
  CHECK(ear.counts().good == 3);
}
