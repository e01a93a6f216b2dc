#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace railstep {

/// One frame's inputs or outputs as bytes, little-endian:
///   0  4 bytes "RSHL"          16  uint64 sequence number    40  count doubles
///   4  uint16 version          24  int64 frame               ..  uint32 CRC-32 of all before
///   6  uint16 kind             32  uint32 status
///   8  uint32 CRC-32 of names  36  uint32 flags
///  12  uint32 count
inline constexpr std::uint16_t kPacketVersion = 1;
inline constexpr std::size_t kPacketHead = 40, kPacketSum = 4;
inline constexpr std::size_t kMostInPacket = (65507 - kPacketHead - kPacketSum) / 8;  // of UDP

enum class PacketKind : std::uint16_t { inputs = 1, outputs = 2 };

/// Flags of outputs.
inline constexpr std::uint32_t kLastFrame = 1;  // the run ends with it
inline constexpr std::uint32_t kSafeStop = 2;   // inputs go to 0, or are there

struct PacketHead {
  PacketKind kind = PacketKind::inputs;
  std::uint32_t names = 0;     // CRC-32 of what the values are called: see names_sum()
  std::uint32_t count = 0;     // of values
  std::uint64_t sequence = 0;  // of the sender, from 1, one more each packet
  std::int64_t frame = 0;      // outputs: of which frame; inputs: for which one, -1 for any
  std::uint32_t status = 0;    // of outputs: model/status.h
  std::uint32_t flags = 0;     // of outputs
};

/// CRC-32 of the names, a line feed behind each: both sides mean the same values.
std::uint32_t names_sum(const std::vector<std::string>& names) noexcept;

constexpr std::size_t packet_bytes(std::size_t count) noexcept {
  return kPacketHead + 8 * count + kPacketSum;
}

/// @param values  [head.count]
/// @param bytes   [packet_bytes(head.count)]
void encode(const PacketHead& head, const double* values, unsigned char* bytes) noexcept;

/// The head of a packet that is whole and has this kind and these names; nothing for any other.
/// @param values  [count] overwritten where it is
std::optional<PacketHead> decode(std::span<const unsigned char> bytes, PacketKind kind,
                                 std::uint32_t names, std::uint32_t count, double* values) noexcept;

}  // namespace railstep
