#pragma once
#include <optional>
#include <string>
#include <vector>

#include "section/lopsided.h"
#include "section/profile.h"
#include "section/section_fit.h"
#include "text/message.h"

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
  std::optional<Message> refusal = {};
  std::vector<Message> warnings = {};
};

/// Finds the properties of a profile's outline, and fits rectangles to it. Where no rectangles fit,
/// the result has the outline and a refusal. Throws InputError, naming the file, where the outline
/// is too thin or ragged.
FitResult fit_profile(Profile profile, const std::string& file);

}  // namespace railstep
