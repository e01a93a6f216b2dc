#pragma once
#include <string>

#include "offline/pack/time_schemes.h"
#include "scene/scene.h"

namespace railstep {

/// The coefficients of a scene's scheme, in full order.
Scheme scheme_of(const StepScene& step);

/// The coefficients for a condensed track.
Scheme held_scheme_of(const StepScene& step);

/// The scheme in words.
std::string scheme_text(const StepScene& step);
std::string held_scheme_text(const StepScene& step);

}  // namespace railstep
