#pragma once
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "online/model/model.h"

namespace railstep {

/// The part of a block's header that says how the model was made; no step needs it.
struct BlockNotes {
  static constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();
  std::string about = {};  // lines of text: units, scheme, origin
  double static_error = kNotKnown, receptance_error = kNotKnown, transient_error = kNotKnown;
};

/// A model and a text in one block, as online/model/block.h describes and load_model() reads it,
/// with a check by its own first frames. The same model gives the same bytes.
/// @param columns  of a trace, one a line, and the inputs behind an empty line
std::vector<std::byte> to_block(const Model& model, const std::string& columns,
                                const BlockNotes& notes = {});

/// SHA-256 of a block's payload, as it stands in the block, in hexadecimal.
std::string sum_of(const std::vector<std::byte>& block);

}  // namespace railstep
