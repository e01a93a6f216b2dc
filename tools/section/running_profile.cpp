#include "section/running_profile.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "offline/profile/smoothing.h"
#include "section/profile.h"
#include "text/read.h"

namespace railstep {
namespace {

const Range kPlaceMm = between(-200.0, 200.0);

std::vector<Point> points_of(const Table& t, const char* key) {
  const std::vector<double> values = t.rows(key, 2);
  std::vector<Point> points;
  for (std::size_t i = 0; i < values.size(); i += 2)
    points.push_back({kMillimetre * values[i], kMillimetre * values[i + 1]});
  return points;
}

double tolerance_of(const Table& t) {
  return kMillimetre * t.number("tolerance_mm", between(0.0, 1.0), 0.0);
}

/// One [[section]] of a wheel, from the end of the one before it.
SurfacePiece read_section(const Table& t, double from) {
  SurfacePiece piece{from, kMillimetre * t.number("to_mm", kPlaceMm), 0., 0., 0., {}};
  if (t.has("arc_mm") == t.has("polynomial_mm"))
    t.refuse("arc_mm", "E-WHEEL-01",
             "the section has both or none of arc_mm and polynomial_mm; expected one of them");
  if (t.has("arc_mm")) {
    const std::vector<double> arc = t.numbers("arc_mm", any_number(), 3, 3);
    piece.middle = kMillimetre * arc[0];
    piece.height = kMillimetre * arc[1];
    piece.radius = kMillimetre * arc[2];
    if (piece.radius == 0.)
      t.refuse("arc_mm", "E-WHEEL-02", "the arc has a radius of 0; expected another one");
    return piece;
  }
  piece.middle = kMillimetre * t.number("about_mm", kPlaceMm, 0.0);
  piece.coefficients = t.numbers("polynomial_mm", any_number(), 1, 16);
  double unit = kMillimetre;  // m^(1-k) of coefficient k
  for (double& c : piece.coefficients) {
    c *= unit;
    unit /= kMillimetre;
  }
  return piece;
}

RunningSurface read_sections(const Table& root) {
  double from = kMillimetre * root.number("start_mm", kPlaceMm);
  std::vector<SurfacePiece> pieces;
  for (const Table& t : root.tables("section")) {
    pieces.push_back(read_section(t, from));
    from = pieces.back().to;
  }
  return RunningSurface(std::move(pieces));
}

WheelProfile read_growth(const Table& root, std::string name, std::string source, double back) {
  if (root.has("points_mm") == root.has("section"))
    root.refuse("section", "E-WHEEL-03",
                "the wheel has both or none of [[section]] and points_mm; expected one of them");
  if (root.has("section"))
    return {std::move(name), std::move(source), read_sections(root), back, std::nullopt};
  const double tolerance = tolerance_of(root);
  const SmoothedPoints made = smoothed(points_of(root, "points_mm"), tolerance);
  return {std::move(name), std::move(source), through(made.points), back,
          Smoothing{tolerance, made.rms, made.largest}};
}

void check_width(const Table& root, const RunningSurface& growth) {
  const double width = growth.last() - growth.first();
  if (!(width > .05 && width < .2))
    root.refuse("flange_back_mm", "E-WHEEL-04",
                "the wheel is " + std::to_string(1e3 * width) +
                    " mm wide; expected 50 to 200 mm. Are its values in millimetres?");
}

}  // namespace

WheelProfile read_wheel_profile(const std::filesystem::path& file) {
  const Table root = read_shape_file(file);
  static_cast<void>(root.integer("schema", 1, 1));
  static_cast<void>(root.choice("kind", {"wheel"}));
  std::string name = root.string("name"), source = root.string("source");
  const double back = kMillimetre * root.number("flange_back_mm", between(-100.0, -40.0));
  try {
    WheelProfile wheel = read_growth(root, std::move(name), std::move(source), back);
    check_width(root, wheel.growth);
    root.finish();
    return wheel;
  } catch (const Refused& error) {
    root.refuse(root.has("section") ? "section" : "points_mm", error.id(), error.sentence());
  }
}

PlacedRail read_placed_rail(const std::filesystem::path& file, const RailPlace& place) {
  const Table root = read_shape_file(file);
  try {
    if (!root.has("head_points_mm")) {
      const Profile profile = read_profile(file);
      return {profile.name, profile.source, placed(tangent_head(profile.outline), place),
              std::nullopt};
    }
    static_cast<void>(root.integer("schema", 1, 1));
    static_cast<void>(root.choice("kind", {"rail"}));
    std::string name = root.string("name"), source = root.string("source");
    const double tolerance = tolerance_of(root);
    const SmoothedPoints made = smoothed(points_of(root, "head_points_mm"), tolerance);
    root.finish();
    return {std::move(name), std::move(source), placed(made.points, place),
            Smoothing{tolerance, made.rms, made.largest}};
  } catch (const Refused& error) {
    root.refuse(root.has("head_points_mm") ? "head_points_mm" : "half_outline_mm", error.id(),
                error.sentence());
  }
}

}  // namespace railstep
