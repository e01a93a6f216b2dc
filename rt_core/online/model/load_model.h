#pragma once
#include <cstddef>

#include "online/model/block.h"
#include "online/model/model.h"

namespace railstep {

enum class LoadStatus : std::uint8_t {
  ok,
  misaligned,        // the block does not start at a multiple of 8 bytes
  not_a_model,       // it does not begin as a block does
  other_version,     // of the format
  other_byte_order,  // written where the bytes of a number stand the other way round
  wrong_size,        // cut short or run on
  wrong_header,      // the header's bytes are not those that were written
  wrong_sum,         // the payload's are not
  bad_content,       // a number in it is out of its range
};

struct LoadResult {
  LoadStatus status;
  const char* text;        // in the block: the columns of a trace, one a line
  std::size_t text_bytes;  // of it
};

/// Views over a block (block.h), which must outlive the model. Sizes are checked before they are
/// used, every number must be finite where it may not be infinite, and every number that a step
/// uses as a size, an index or for its solve be in its range, so that a wrong block gives a status
/// and no harm whatever its sums are. No heap.
[[nodiscard]] LoadResult load_model(const void* block, std::size_t bytes, Model& model) noexcept;

/// What a block of the model states of its loops.
BlockCaps caps_of(const Model& model) noexcept;

/// The header of a block that load_model() took.
BlockHeader header_of(const void* block) noexcept;

}  // namespace railstep
