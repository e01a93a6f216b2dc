#pragma once
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "online/model/model.h"

namespace railstep {

/// What stands in a block's header of how the model was made; no step needs it.
struct BlockNotes {
  static constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();
  std::string about = {};  // lines of text: units, scheme, where it comes from
  double static_error = kNotKnown, receptance_error = kNotKnown, transient_error = kNotKnown;
};

/// A model and a text in one block, as online/model/block.h describes and load_model() reads it,
/// with what its own first frames come to as a check. The same model gives the same bytes.
/// @param columns  of a trace, one a line, and the inputs behind an empty line
std::vector<std::byte> to_block(const Model& model, const std::string& columns,
                                const BlockNotes& notes = {});

/// SHA-256 of a block's payload, as it stands in the block, in hexadecimal.
std::string sum_of(const std::vector<std::byte>& block);

}  // namespace railstep
