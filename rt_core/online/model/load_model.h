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
  other_byte_order,  // written on a machine with the other byte order
  wrong_size,        // too short or too long
  wrong_header,      // the header's bytes are not the ones that were written
  wrong_sum,         // the payload's bytes are not the ones that were written
  bad_content,       // a number in it is out of its range
};

struct LoadResult {
  LoadStatus status;
  const char* text;        // in the block: the columns of a trace, one a line
  std::size_t text_bytes;  // of it
};

/// Makes a model of views over a block (block.h), which must outlive the model. Sizes are checked
/// before they are used. Numbers must be finite where infinity has no meaning. Sizes, indices and
/// numbers of a step's solves must be in their range. So a wrong block gives a status and does no
/// harm, even with right sums. No heap.
[[nodiscard]] LoadResult load_model(const void* block, std::size_t bytes, Model& model) noexcept;

/// The caps of its loops that a block of the model states.
BlockCaps caps_of(const Model& model) noexcept;

/// The header of a block that load_model() accepted.
BlockHeader header_of(const void* block) noexcept;

}  // namespace railstep
