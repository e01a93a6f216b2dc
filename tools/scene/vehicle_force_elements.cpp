#include <fmt/core.h>

#include <cmath>

#include "scene/vehicle_read.h"

// Elements of a vehicle that are not linear.

namespace railstep {
namespace {

/// A table of places and forces. If it begins at 0 or above with no force, it holds for both
/// directions alike. Beyond its ends it goes on as in its last and first piece.
void read_curve(const Table& t, RunnerForceElement& e) {
  const std::vector<double> read = t.rows("table", 2);
  const auto wrong = [&](const std::string& found) {
    t.refuse(
        "table", "E-VEHICLE-35",
        "table has " + found +
            fmt::format("; expected 2 to {} rows whose places rise and whose forces do not fall",
                        kMostCurvePoints / 2));
  };
  if (read.size() < 4 || read.size() > std::size_t{kMostCurvePoints})
    wrong(fmt::format("{} rows", read.size() / 2));
  for (std::size_t i = 2; i < read.size(); i += 2)
    if (!(read[i] > read[i - 2]) || !(read[i + 1] >= read[i - 1]))
      wrong(fmt::format("the row [{:.15g}, {:.15g}] after [{:.15g}, {:.15g}]", read[i], read[i + 1],
                        read[i - 2], read[i - 1]));
  const auto slope = [&](std::size_t i) {
    return (read[i + 3] - read[i + 1]) / (read[i + 2] - read[i]);
  };
  for (std::size_t i = 0; i < read.size(); i += 2) {
    if (!(std::fabs(read[i]) <= 1e3) || !(std::fabs(read[i + 1]) <= 1e9))
      wrong(fmt::format("the row [{:.15g}, {:.15g}] beyond 1000 or 1e9 N", read[i], read[i + 1]));
    if (i + 2 < read.size() && !(slope(i) <= 1e13))
      wrong(fmt::format("a slope of {:.6g} from [{:.15g}, {:.15g}] on, above 1e13", slope(i),
                        read[i], read[i + 1]));
  }
  e.slope_behind = slope(read.size() - 4);
  e.slope_before = slope(0);
  if (read[0] >= 0. && read[1] == 0.) {  // the other direction
    e.slope_before = e.slope_behind;
    for (std::size_t i = read.size() - 2; i >= 2; i -= 2)
      e.curve.insert(e.curve.end(), {-read[i], -read[i + 1]});
    if (read[0] > 0.) e.curve.insert(e.curve.end(), {-read[0], 0.});
  }
  e.curve.insert(e.curve.end(), read.begin(), read.end());
}

RunnerForceElement slider(const Triple& point, int axis, double stiffness, double coefficient) {
  RunnerForceElement e{};
  e.point_a = e.point_b = point;
  e.axis = axis;
  e.law = ElementLaw::slider;
  e.stiffness = stiffness;
  e.value = {0., coefficient};
  return e;
}

const Range kFrictionRange = between(0.0, 10.0);
const Range kSpringRange = above_upto(0.0, 1e13);

/// A spring along z that cannot pull: its preload, and itself.
std::vector<RunnerPart> pressing(const Triple& point, double stiffness, double clearance,
                                 const std::string& name, const std::string& suffix) {
  RunnerElement spring{};
  spring.kind = RunnerElement::Kind::mid_frame;
  spring.point_a = spring.point_b = point;
  spring.stiffness[2] = stiffness;
  spring.presses_only = true;
  spring.clearance = clearance;
  RunnerForceElement force{};
  force.point_a = force.point_b = point;
  force.axis = 2;
  return {{spring, suffix}, {force, suffix, name, suffix}};
}

}  // namespace

void read_direction(const Table& t, RunnerForceElement& e) {
  if (t.has("points_m")) {
    const std::array<Triple, 2> points = read_points(t);
    e.point_a = points[0];
    e.point_b = points[1];
    e.along = RunnerForceElement::Along::line;
    return;
  }
  e.point_a = e.point_b = three_numbers(t, "point_m", kPlaceRange);
  const auto axis = static_cast<int>(t.choice("axis", {"x", "y", "z", "roll", "pitch", "yaw"}));
  e.axis = axis % 3;
  if (axis >= 3) e.along = RunnerForceElement::Along::about_axis;
}

std::array<Triple, 2> read_points(const Table& t) {
  const std::vector<double> p = t.rows("points_m", 3);
  if (p.size() != 6)
    t.refuse("points_m", "E-VEHICLE-21",
             fmt::format("points_m has {} points; expected two: one on each body", p.size() / 3));
  return {Triple{p[0], p[1], p[2]}, Triple{p[3], p[4], p[5]}};
}

RunnerForceElement read_bump_stop(const Table& t) {
  RunnerForceElement e{};
  e.point_a = e.point_b = three_numbers(t, "point_m", kPlaceRange);
  e.axis = static_cast<int>(t.choice("axis", {"x", "y", "z"}));
  if (t.has("table")) {
    read_curve(t, e);
    return e;
  }
  const auto [below, above] = t.number_or_pair("clearance_m", between(0.0, 10.0));
  e.curve = {below == 0. ? 0. : -below, 0., above, 0.};
  e.slope_before = e.slope_behind = t.number("stiffness_n_per_m", kSpringRange);
  return e;
}

RunnerForceElement read_nonlinear_damper(const Table& t) {
  RunnerForceElement e{};
  e.law = ElementLaw::damper;
  read_direction(t, e);
  read_curve(t, e);
  e.series = t.number("series_stiffness_n_per_m", kStiffnessRange, 0.0);
  for (std::size_t i = 0; i < e.curve.size(); i += 2) {
    const bool last = i + 2 == e.curve.size();
    if (e.curve[i] == 0. && e.curve[i + 1] == 0.) return e;
    if (e.curve[i] >= 0. || last || e.curve[i + 2] > 0.) break;
  }
  t.refuse("table", "E-VEHICLE-36",
           "a damper has no row [0, 0] in its table; expected one: it has no force at rest");
}

RunnerPart read_friction(const Table& t) {
  RunnerForceElement e{};
  read_direction(t, e);
  const bool about = e.along == RunnerForceElement::Along::about_axis;
  constexpr ElementLaw laws[] = {ElementLaw::slider, ElementLaw::exponential, ElementLaw::berg};
  e.law = t.has("shape") ? laws[t.choice("shape", {"slider", "exponential", "berg"})] : laws[0];
  e.stiffness = t.number(about ? "stiffness_n_m_per_rad" : "stiffness_n_per_m", kSpringRange);
  if (!t.has("normal")) {
    e.value = {0., t.number(about ? "limit_n_m" : "limit_n", between(0.0, 1e9))};
    return {e};
  }
  if (e.law == ElementLaw::berg)
    t.refuse("shape", "E-VEHICLE-37",
             "shape = \"berg\" with the key normal: under a limit that changes, friction by Berg's "
             "law can make energy; expected limit_n, or shape \"slider\" or \"exponential\"");
  const double radius = about ? t.number("radius_m", above_upto(0.0, 10.0)) : 1.;
  e.value = {0., t.number("friction", kFrictionRange) * radius};
  return {e, "", t.string("normal")};
}

std::vector<RunnerPart> read_support(const Table& t) {
  return pressing(three_numbers(t, "point_m", kPlaceRange),
                  t.number("stiffness_n_per_m", kSpringRange),
                  t.number("clearance_m", between(0.0, 10.0), 0.0), t.string("name"), "");
}

std::vector<RunnerPart> read_side_bearer(const Table& t) {
  const Triple point = three_numbers(t, "point_m", kPlaceRange);
  const std::string name = t.string("name");
  std::vector<RunnerPart> parts =
      pressing(point, t.number("stiffness_n_per_m", kSpringRange),
               t.number("clearance_m", between(0.0, 10.0), 0.0), name, "");
  parts.push_back({slider(point, 0, t.number("shear_n_per_m", kSpringRange),
                          t.number("friction", kFrictionRange)),
                   "_friction", name});
  return parts;
}

std::vector<RunnerPart> read_centre_plate(const Table& t) {
  struct Rim {
    const char* name;
    double x, y;
    int friction;
  };
  constexpr Rim rims[] = {
      {"_front", 1., 0., 1}, {"_back", -1., 0., 1}, {"_left", 0., 1., 0}, {"_right", 0., -1., 0}};
  const Triple point = three_numbers(t, "point_m", kPlaceRange),
               stiffness = three_numbers(t, "stiffness_n_per_m", kSpringRange);
  const double radius = t.number("radius_m", above_upto(0.0, 10.0)),
               shear = t.number("shear_n_per_m", kSpringRange),
               coefficient = t.number("friction", kFrictionRange);
  const std::string name = t.string("name");
  RunnerElement pivot{};
  pivot.kind = RunnerElement::Kind::mid_frame;
  pivot.point_a = pivot.point_b = point;
  pivot.stiffness = {stiffness[0], stiffness[1]};
  std::vector<RunnerPart> parts = {{pivot, "_pivot"}};
  for (const Rim& rim : rims) {
    const Triple at = {point[0] + radius * rim.x, point[1] + radius * rim.y, point[2]};
    for (RunnerPart& part : pressing(at, .25 * stiffness[2], 0., name, rim.name))
      parts.push_back(std::move(part));
    parts.push_back({slider(at, rim.friction, shear, coefficient),
                     rim.name + std::string("_friction"), name, rim.name});
  }
  return parts;
}

}  // namespace railstep
