#pragma once
#include <optional>
#include <string>
#include <vector>

#include "answer/scene_running.h"

namespace railstep {

/// A page with the root locus of the rail vehicles of a scene over speed, and the least damping
/// over it. Throws Failed where gnuplot fails.
std::string critical_page(const std::string& title, const std::vector<ModesAtSpeed>& modes,
                          const std::optional<CriticalRunning>& critical);

}  // namespace railstep
