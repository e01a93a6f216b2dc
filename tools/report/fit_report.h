#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "section/fit_profile.h"

namespace railstep {

/// The keys of the command line's contract.
nlohmann::ordered_json to_json(const FitResult& result);

/// Outline against section, and the dimensions, for a terminal.
std::string to_table(const FitResult& result);

/// A section file: what a scene names; numbers with 17 digits.
std::string to_toml(const FitResult& result);

/// A page on its own: the outline and the rectangles drawn together, and the table.
std::string to_html(const FitResult& result);

}  // namespace railstep
