#pragma once
#include <string>

#include "fit_report.h"

namespace railstep {

/// Fits a profile, and finds what there is to compare of its outline. Throws InputError, naming the
/// file, where the outline is too thin or ragged, std::runtime_error where no rectangles fit.
FitResult fit_profile(Profile profile, const std::string& file);

}  // namespace railstep
