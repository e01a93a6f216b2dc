// Packets from the network, one after the other, for one receiver: raw ones, and ones with a
// corrected head and sum. Accepted packets go through the inputs that a run holds.
#include <algorithm>
#include <bit>
#include <cstring>
#include <vector>

#include "hil/hil_inputs.h"
#include "hil/hil_packet.h"
#include "hil/hil_receiver.h"
#include "online/math/crc32.h"
#include "oracle.h"
#include "patch.h"

using namespace railstep;
using namespace railstep::fuzz;

namespace {

constexpr std::uint32_t kNames = 0x575e95fa;
constexpr std::uint64_t kUntouched = 0x7ff8000000000123;

using Packet = std::vector<std::uint8_t>;

void put(Packet& packet, std::size_t at, std::uint64_t value, std::size_t bytes) {
  for (std::size_t i = 0; i < bytes && at + i < packet.size(); ++i)
    packet[at + i] = static_cast<std::uint8_t>(value >> (8 * i));
}

/// Corrects the parts of a packet for which `how` has a bit.
void mend(Packet& packet, std::uint8_t how, std::uint32_t count) {
  if ((how & 1) != 0) packet.resize(packet_bytes(count));
  if ((how & 2) != 0) put(packet, 0, 0x0001'0001'4c48'5352, 8);  // "RSHL", version 1, inputs
  if ((how & 4) != 0) put(packet, 8, kNames | std::uint64_t{count} << 32, 8);
  if ((how & 8) == 0 || packet.size() < 4) return;
  const std::size_t body = packet.size() - 4;
  put(packet, body, crc32(packet.data(), body), 4);
}

/// Checks that a packet that is accepted is written again with the same bytes.
void check_decoded(const Packet& packet, std::uint32_t count) {
  std::vector<double> values(count);
  const auto head = decode(packet, PacketKind::inputs, kNames, count, values.data());
  if (!head) return;
  Packet again(packet_bytes(count));
  encode(*head, values.data(), again.data());
  check(again == packet, "a packet is not written as it was read");
}

/// Checks that counts rise by one with every packet and that a refused one leaves the values alone.
void check_taken(Receiver& receiver, const Packet& packet, std::uint32_t count,
                 std::uint64_t sender, std::int64_t now, HeldInputs& held) {
  const PacketCounts before = receiver.counts();
  std::vector<double> values(count, std::bit_cast<double>(kUntouched)), good(count, 1.);
  const bool taken = receiver.take(packet, sender, now, now / 1'000'000, values.data());
  const PacketCounts after = receiver.counts();
  check(after.good - before.good == (taken ? 1 : 0), "a good packet is not counted");
  check(after.good + after.repeated + after.reordered + after.foreign ==
            before.good + before.repeated + before.reordered + before.foreign + 1,
        "a packet is counted twice or not at all");
  check(after.lost >= 0 && after.late <= after.good, "more packets are found than were lost");
  for (const double value : values)
    check(taken || std::bit_cast<std::uint64_t>(value) == kUntouched,
          "a packet that is not taken changed the values");
  const double* const next = held.next(taken ? values.data() : nullptr, good.data());
  for (std::uint32_t i = 0; i < count && held.stopping(); ++i)
    check(next[i] >= 0. && next[i] <= 1., "a safe stop leaves its ramp");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes input(data, size);
  const std::uint32_t count = input.byte() % 5;
  Receiver receiver(kNames, count);
  HeldInputs held(count, 1 + input.byte() % 8, 1 + input.byte() % 8);
  std::int64_t now = 0;
  for (int n = 0; n < 200 && !input.empty(); ++n) {
    const std::uint8_t how = input.byte(), length = input.byte();
    now += std::int64_t{1'000'000} << (how >> 5);
    Packet packet = input.take(length);
    mend(packet, how, count);
    check_decoded(packet, count);
    check_taken(receiver, packet, count, how >> 4 & 1, now, held);
  }
  return 0;
}
