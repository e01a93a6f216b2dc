#include "hil/hil_packet.h"

#include <bit>
#include <cstring>

#include "online/math/crc32.h"

namespace railstep {
namespace {

constexpr unsigned char kMagic[4] = {'R', 'S', 'H', 'L'};

void put(std::uint64_t value, std::size_t size, unsigned char* at) noexcept {
  for (std::size_t i = 0; i < size; ++i) at[i] = static_cast<unsigned char>(value >> (8 * i));
}

std::uint64_t get(const unsigned char* at, std::size_t size) noexcept {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < size; ++i) value |= static_cast<std::uint64_t>(at[i]) << (8 * i);
  return value;
}

}  // namespace

std::uint32_t names_sum(const std::vector<std::string>& names) noexcept {
  constexpr unsigned char kFeed[1] = {'\n'};
  std::uint32_t sum = 0;
  for (const std::string& name : names) {
    sum = crc32(name.data(), name.size(), sum);
    sum = crc32(kFeed, sizeof kFeed, sum);
  }
  return sum;
}

void encode(const PacketHead& head, const double* values, unsigned char* bytes) noexcept {
  std::memcpy(bytes, kMagic, sizeof kMagic);
  put(kPacketVersion, 2, bytes + 4);
  put(static_cast<std::uint64_t>(head.kind), 2, bytes + 6);
  put(head.names, 4, bytes + 8);
  put(head.count, 4, bytes + 12);
  put(head.sequence, 8, bytes + 16);
  put(static_cast<std::uint64_t>(head.frame), 8, bytes + 24);
  put(head.status, 4, bytes + 32);
  put(head.flags, 4, bytes + 36);
  for (std::size_t i = 0; i < head.count; ++i)
    put(std::bit_cast<std::uint64_t>(values[i]), 8, bytes + kPacketHead + 8 * i);
  const std::size_t body = packet_bytes(head.count) - kPacketSum;
  put(crc32(bytes, body), 4, bytes + body);
}

std::optional<PacketHead> decode(std::span<const unsigned char> bytes, PacketKind kind,
                                 std::uint32_t names, std::uint32_t count,
                                 double* values) noexcept {
  const unsigned char* const at = bytes.data();
  if (bytes.size() != packet_bytes(count)) return std::nullopt;
  if (std::memcmp(at, kMagic, sizeof kMagic) != 0 || get(at + 4, 2) != kPacketVersion ||
      get(at + 6, 2) != static_cast<std::uint64_t>(kind) || get(at + 8, 4) != names ||
      get(at + 12, 4) != count)
    return std::nullopt;
  const std::size_t body = bytes.size() - kPacketSum;
  if (get(at + body, 4) != crc32(at, body)) return std::nullopt;
  for (std::size_t i = 0; i < count; ++i)
    values[i] = std::bit_cast<double>(get(at + kPacketHead + 8 * i, 8));
  return PacketHead{kind,
                    names,
                    count,
                    get(at + 16, 8),
                    static_cast<std::int64_t>(get(at + 24, 8)),
                    static_cast<std::uint32_t>(get(at + 32, 4)),
                    static_cast<std::uint32_t>(get(at + 36, 4))};
}

}  // namespace railstep
