#include "fit_profile.h"

#include <fmt/core.h>

#include <stdexcept>
#include <utility>

#include "read.h"
#include "section_file.h"

namespace railstep {

FitResult fit_profile(Profile profile, const std::string& file) try {
  FitResult r{.name = profile.name, .source = profile.source};
  r.profile = std::move(profile);
  const Outline& outline = r.profile->outline;
  r.fit = fit_section(outline);
  r.asymmetry = asymmetry(polygon(outline, kChordTolerance));
  r.outline = {properties(outline), outline_shear(outline, r.asymmetry), outline.height};
  r.section = fitted_section(r.fit, outline.height);
  return r;
} catch (const std::invalid_argument& error) {
  throw InputError(fmt::format("{}: {}", file, error.what()));
}

}  // namespace railstep
