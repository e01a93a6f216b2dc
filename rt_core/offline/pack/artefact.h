#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "online/model/model.h"

namespace railstep {

/// A model and a text in one block, as online/model/load.h describes and load_model() reads it.
/// The same model gives the same bytes. @param text  columns of a trace, one a line
std::vector<std::byte> to_block(const Model& model, const std::string& text);

/// SHA-256 of a block's content, as it stands in the block, in hexadecimal.
std::string sum_of(const std::vector<std::byte>& block);

}  // namespace railstep
