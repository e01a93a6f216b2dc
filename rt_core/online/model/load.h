#pragma once
#include <cstddef>

#include "online/model/model.h"

namespace railstep {

enum class LoadStatus : std::uint8_t {
  ok,
  misaligned,     // the block does not start at a multiple of 8 bytes
  not_a_model,    // it does not begin as a block does
  other_version,  // of the format, or another byte order
  wrong_size,     // cut short or run on
  wrong_sum,      // its bytes are not those that were written
  bad_content,    // a number in it is out of its range
};

struct LoadResult {
  LoadStatus status;
  const char* text;        // in the block: the columns of a trace, one a line
  std::size_t text_bytes;  // of it
};

/// A block, from its first byte:
///   8 bytes "railstep", int64 format, int64 bytes of the whole block, 32 bytes SHA-256 of all that
///   follows, int64 bytes of the text, the text padded to 8 bytes with zeros, then the model's
///   numbers as describe.h orders them: each count, integer and real in 8 bytes, each array as
///   an int64 of its length and its values, padded to 8 bytes. Values are reals of 8 bytes,
///   integers of 4, or structures as they stand in memory, which have no gaps.
inline constexpr std::int64_t kBlockFormat = 9;
inline constexpr std::size_t kBlockHeader = 8 + 8 + 8 + 32 + 8;

/// Views over a block, which must outlive the model. Every number that a step uses as a size or an
/// index is checked, so that a wrong block gives a status and no harm. No heap.
[[nodiscard]] LoadResult load_model(const void* block, std::size_t bytes, Model& model) noexcept;

}  // namespace railstep
