#pragma once
#include <string>

#include "scene.h"
#include "simulate.h"

namespace railstep {

/// Asks about units where a rail sank farther than tracks do; else empty.
std::string depth_note(const RunRecord& record);

/// Asks about units where [rail.constants] are those of no shape; else empty.
std::string constants_note(const Scene& scene);

}  // namespace railstep
