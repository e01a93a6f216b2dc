#pragma once
#include <optional>

#include "run/simulate.h"
#include "scene/scene.h"
#include "text/message.h"

namespace railstep {

/// Asks about units where a rail sank farther than tracks do; else nothing.
std::optional<Message> depth_note(const RunRecord& record);

/// Asks about units where [rail.constants] are those of no shape; else nothing.
std::optional<Message> constants_note(const Scene& scene);

/// Names a rail's section file whose outline is too lopsided for a symmetric section; else nothing.
std::optional<Message> lopsided_note(const Scene& scene);

/// On stderr, where there is one.
void print_note(const std::optional<Message>& note);

}  // namespace railstep
