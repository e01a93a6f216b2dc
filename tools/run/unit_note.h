#pragma once
#include <optional>

#include "run/simulate.h"
#include "scene/scene.h"
#include "text/message.h"

namespace railstep {

/// A question about units where a rail sank farther than tracks do; nothing where not.
std::optional<Message> depth_note(const RunRecord& record);

/// A question about units where no shape has the [rail.constants]; nothing where a shape does.
std::optional<Message> constants_note(const Scene& scene);

/// A note that names a rail's section file whose outline is too lopsided for a symmetric section;
/// nothing where it is not.
std::optional<Message> lopsided_note(const Scene& scene);

}  // namespace railstep
