#pragma once
#include <string>

#include "run/simulate.h"
#include "scene/scene.h"

namespace railstep {

/// Asks about units where a rail sank farther than tracks do; else empty.
std::string depth_note(const RunRecord& record);

/// Asks about units where [rail.constants] are those of no shape; else empty.
std::string constants_note(const Scene& scene);

/// Names a rail's section file whose outline is too lopsided for a symmetric section; else empty.
std::string lopsided_note(const Scene& scene);

/// On stderr, where there is one.
void print_note(const std::string& note);

}  // namespace railstep
