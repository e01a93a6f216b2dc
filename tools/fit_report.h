#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "lopsided.h"
#include "profile.h"
#include "section_fit.h"

namespace railstep {

/// All that `fit` found. Without an outline the outline's area properties are the targets, and what
/// only an outline has is NaN (null in JSON). Where `refusal` says that no rectangles fit, only the
/// outline is described.
struct FitResult {
  std::string name, source;
  std::optional<Profile> profile = {};
  Section outline = {}, section = {};
  SectionFit fit = {};
  Lopsided lopsided = {};  // of the outline
  std::string refusal = {};
  std::vector<std::string> warnings = {};  // sentences
};

/// The keys of the command line's contract.
nlohmann::ordered_json to_json(const FitResult& result);

/// Outline against section, and the dimensions, for a terminal.
std::string to_table(const FitResult& result);

/// A section file: what a scene names; numbers with 17 digits.
std::string to_toml(const FitResult& result);

/// A page on its own: the outline and the rectangles drawn together, and the table.
std::string to_html(const FitResult& result);

}  // namespace railstep
