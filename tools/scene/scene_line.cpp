#include <fmt/format.h>

#include <cmath>

#include "scene/scene_read.h"

namespace railstep {
namespace {

constexpr double kCantDistance = 1.5;         // m, over which a cant is measured
constexpr double kMostCantHeight = .3;        // m
const Range kLinePlace = between(-1e7, 1e7);  // m

/// [[place (m), value], ...] with rising places. @param steepest  most change by length
std::vector<double> read_line_table(const Table& t, const char* key, double most, double steepest) {
  if (!t.has(key)) return {};
  std::vector<double> rows = t.rows(key, 2);
  if (rows.size() > 2 * std::size_t{kMostLineRows})
    t.refuse(
        key, "E-LINE-01",
        fmt::format("{} has {} rows; expected at most {}", key, rows.size() / 2, kMostLineRows));
  for (std::size_t i = 0; i < rows.size(); i += 2) {
    if (!kLinePlace.holds(rows[i]))
      t.refuse(key, "E-LINE-07",
               fmt::format("{}: a row at {:.15g} m; expected {}", key, rows[i], kLinePlace.text()));
    if (i > 0 && !(rows[i] > rows[i - 2]))
      t.refuse(key, "E-LINE-02",
               fmt::format("{}: the place {:.15g} m follows {:.15g} m; expected places that rise",
                           key, rows[i], rows[i - 2]));
    if (!between(-most, most).holds(rows[i + 1]))
      t.refuse(key, "E-LINE-03",
               fmt::format("{}: {:.15g} at {:.15g} m; expected {}", key, rows[i + 1], rows[i],
                           between(-most, most).text()));
    if (i > 0 && std::fabs(rows[i + 1] - rows[i - 1]) > steepest * (rows[i] - rows[i - 2]))
      t.refuse(
          key, "E-LINE-06",
          fmt::format("{}: from {:.15g} to {:.15g} m it changes by {:.15g} a metre; expected "
                      "at most {:.15g}",
                      key, rows[i - 2], rows[i],
                      std::fabs(rows[i + 1] - rows[i - 1]) / (rows[i] - rows[i - 2]), steepest));
  }
  return rows;
}

}  // namespace

LineShape read_design_line(const Table& root, const Scene& scene) {
  LineShape line;
  const std::optional<Table> t = root.table_if("line");
  if (!t) return line;
  if (scene.rail_vehicles.empty())
    t->refuse("", "E-LINE-04",
              "nothing in the scene follows a design line; expected a [[vehicle]] whose type is "
              "\"rail_vehicle\", or no [line]");
  if (!scene.vehicles.empty() || !scene.wheelsets.empty())
    t->refuse("", "E-LINE-05",
              "wheelsets and upright vehicles do not follow a design line; expected vehicles whose "
              "type is \"rail_vehicle\" alone beside [line]");
  line.transition = static_cast<Transition>(
      t->has("transition") ? t->choice("transition", {"linear", "bloss", "cosine"}) : 0);
  line.curvature = read_line_table(*t, "curvature_table", kMostCurvature, 1e300);
  line.cant = read_line_table(*t, "cant_table", kMostCantHeight, kMostTwist * kCantDistance);
  for (std::size_t i = 1; i < line.cant.size(); i += 2) line.cant[i] /= -kCantDistance;
  line.gradient = read_line_table(*t, "gradient_table", kMostGradient, kMostVerticalCurvature);
  return line;
}

}  // namespace railstep
