#pragma once
// Only read*.cpp include this, as read_document.h.
#include <toml++/toml.h>

#include <string>

namespace railstep {

/// A value as the file writes it, short enough for a sentence.
std::string shown(const toml::node& node);
/// "a string", "an integer", ...
std::string type_of(const toml::node& node);

}  // namespace railstep
