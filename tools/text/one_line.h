#pragma once
#include <string>

namespace railstep {

/// `text` with control characters as '?', so that a quoted value cannot break the sentence.
std::string one_line(std::string text);

}  // namespace railstep
