#pragma once
#include "hard/hard_case.h"

namespace railstep {

/// H46: stretch, rate and energy of a bar that spins.
HardResult spinning(const std::filesystem::path& scene);

}  // namespace railstep
