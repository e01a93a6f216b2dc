#pragma once
#include <cstddef>
#include <cstdint>

namespace railstep {

// A model in one block of bytes, the model file of `railstep condense`: a header, then the payload.
// docs/model-file.md has it as a table.

/// A section of a block, bytes from its start. The rest of its last word is 0.
struct BlockSection {
  std::uint64_t at, bytes;
};

/// The sections of the payload, in this order and without a gap.
enum SectionName : std::size_t {
  kColumns,     // names of a trace's columns, one a line; after an empty line those of the inputs
  kWords,       // int64: every count, integer and length of an array
  kReals,       // doubles, of scalars and arrays
  kStructures,  // of a system, as in memory, without gaps or pointers
  kIntegers,    // int32, of arrays
  kCheck,       // doubles: what a step must publish, see self_check.h
  kSections
};

/// Caps of the loops in a step.
struct BlockCaps {
  std::int32_t locate, ports;   // of this library: caps.h
  std::int32_t guides, system;  // iterations of a wheelset's guide; Newton's of a system
};

/// The first bytes of a block, as in memory: fields without gaps, little-endian. The text `about`
/// follows, which a reader may show and never needs; the CRC covers it.
struct BlockHeader {
  char magic[8];               // "railstep"
  std::uint32_t byte_order;    // kByteOrder in the writer's order
  std::uint16_t major, minor;  // of the format
  std::uint32_t real_bytes;    // 8
  std::uint32_t header_bytes;  // up to the payload
  std::uint64_t bytes;         // of the whole block
  BlockSection about;
  BlockSection section[kSections];
  unsigned char sum[32];  // SHA-256 of the payload
  double step_s;
  std::int64_t steps_per_frame;
  BlockCaps caps;
  std::int64_t flops_per_frame, bytes_per_frame, instructions_per_frame;  // bounds: Cost
  std::int64_t state_bytes, workspace_bytes;
  double static_error, receptance_error, transient_error;  // of condensation; NaN: not known
  std::uint64_t check_hash;                                // of the state after check_frames
  std::int64_t check_frames;                               // 0: no check
  std::uint64_t crc;  // CRC-32 of the bytes up to the payload, these 8 being 0
};
static_assert(sizeof(BlockHeader) == 8 + 4 + 2 + 2 + 4 + 4 + 8 + 16 * (1 + kSections) + 32 + 8 + 8 +
                                         16 + 3 * 8 + 2 * 8 + 3 * 8 + 3 * 8);

inline constexpr std::uint32_t kByteOrder = 0x01020304;
/// Another major version is refused. A larger minor version only appends fields, and is read.
inline constexpr std::uint16_t kBlockMajor = 27, kBlockMinor = 0;
inline constexpr std::int64_t kMostCheckFrames = 1000;
inline constexpr std::size_t kSumAt = offsetof(BlockHeader, sum);
inline constexpr std::size_t kCrcAt = offsetof(BlockHeader, crc);

/// CRC of a block's first `header_bytes`, which hold a header.
std::uint32_t header_crc(const unsigned char* block, std::size_t header_bytes) noexcept;

}  // namespace railstep
