#pragma once
#include <string>

#include "fit_report.h"

namespace railstep {

/// Finds what there is to say of a profile's outline, and fits it. Where no rectangles fit, the
/// result has the outline and a refusal. Throws InputError, naming the file, where the outline is
/// too thin or ragged.
FitResult fit_profile(Profile profile, const std::string& file);

}  // namespace railstep
