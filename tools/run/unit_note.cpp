#include "run/unit_note.h"

#include <fmt/core.h>

#include <variant>

#include "section/lopsided.h"
#include "section/section_file.h"

namespace railstep {

std::optional<Message> depth_note(const RunRecord& record) {
  constexpr double kDeep = -.02;  // m
  if (!(record.deepest < kDeep)) return {};
  return Message(
      "W-RUN-01",
      fmt::format(
          "a rail sank by {:.3g} mm under its traffic, and tracks sink by a few millimetres: are "
          "stiffnesses given in N/m, young_pa in Pa, second moments in m4?",
          -1e3 * record.deepest));
}

std::optional<Message> constants_note(const Scene& scene) {
  for (const RailScene* rail : {&scene.rail, scene.right_rail ? &*scene.right_rail : nullptr}) {
    const auto* const section = rail != nullptr ? std::get_if<Section>(&rail->shape) : nullptr;
    if (section == nullptr || section->area.inertia_y <= most_inertia(*section)) continue;
    return Message(
        "W-RUN-02",
        fmt::format("inertia_y_m4 = {:g} of [rail.constants] is too large for this area, height "
                    "and centroid, which allow at most A c (h - c) = {:.4g}: is it given in m4?",
                    section->area.inertia_y, most_inertia(*section)));
  }
  return std::nullopt;
}

std::optional<Message> lopsided_note(const Scene& scene) {
  for (const RailScene* rail : {&scene.rail, scene.right_rail ? &*scene.right_rail : nullptr}) {
    const auto* const section = rail != nullptr ? std::get_if<SectionFile>(&rail->shape) : nullptr;
    const auto lopsided = section != nullptr ? read_lopsided(section->path) : std::nullopt;
    if (!lopsided) continue;
    if (auto warning = lopsided_warning(*lopsided, read_section(section->path))) {
      warning->text = fmt::format("{}: {}", section->path.string(), warning->text);
      return warning;
    }
  }
  return std::nullopt;
}

}  // namespace railstep
