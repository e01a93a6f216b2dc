#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "scene/scene_read.h"

namespace railstep {
namespace {

using Triple = std::array<double, 3>;

const Range kMassRange = above_upto(0.0, 1e7);     // kg
const Range kInertiaRange = above_upto(0.0, 1e9);  // kg m2
const Range kPlaceRange = between(-1e3, 1e3);      // m
const Range kStiffnessRange = between(0.0, 1e13);  // N/m, N m/rad
const Range kDampingRange = between(0.0, 1e11);    // N s/m, N m s/rad
const Range kPreloadRange = between(-1e8, 1e8);    // N

Triple three_numbers(const Table& t, std::string_view key, const Range& accepted) {
  const std::vector<double> read = t.numbers(key, accepted, 3, 3);
  return read.size() == 3 ? Triple{read[0], read[1], read[2]} : Triple{};
}
Triple three_numbers(const Table& t, std::string_view key, const Range& accepted,
                     const Triple& otherwise) {
  return t.has(key) ? three_numbers(t, key, accepted) : otherwise;
}

/// Where the points of a part of the vehicle lie: of a bogie about its pivot, perhaps turned by
/// half a revolution about z.
struct BogiePlace {
  double x = 0.;  // m
  bool turned = false;
  std::string suffix;  // of the names
  [[nodiscard]] Triple at(const Triple& p) const {
    const double sign = turned ? -1. : 1.;
    return {x + sign * p[0], sign * p[1], p[2]};
  }
};

RunnerBody read_runner_body(const Table& t, const BogiePlace& place) {
  return {checked_name(t, "name", t.string("name")) + place.suffix, t.number("mass_kg", kMassRange),
          three_numbers(t, "inertia_kg_m2", kInertiaRange),
          place.at(three_numbers(t, "centre_m", kPlaceRange))};
}

RunnerBody read_runner_wheelset(const Table& t, const BogiePlace& place) {
  const double radius = t.number("radius_m", between(0.02, 3.0), kWheelRadius);
  return {checked_name(t, "name", t.string("name")) + place.suffix, t.number("mass_kg", kMassRange),
          three_numbers(t, "inertia_kg_m2", kInertiaRange),
          place.at({t.number("place_m", kPlaceRange), 0., radius}), radius};
}

/// Index of a body by its name, of those of the element's own bogie first.
int runner_body(const Table& t, const Runner& runner, const BogiePlace& place,
                const std::string& name) {
  const std::string own[] = {name + place.suffix, name};
  for (const std::string& wanted : own)
    for (std::size_t b = 0; b < runner.bodies.size(); ++b)
      if (runner.bodies[b].name == wanted) return static_cast<int>(b);
  if (name == kGroundName) return kGround;
  std::vector<std::string> names = body_names(runner);
  names.emplace_back(kGroundName);
  t.refuse("between", "E-VEHICLE-20",
           fmt::format("\"{}\" is not a body or wheelset of this vehicle; expected one of {}", name,
                       fmt::join(names, ", ")));
}

/// The two points of an element that has ends.
std::array<Triple, 2> read_points(const Table& t) {
  const std::vector<double> p = t.rows("points_m", 3);
  if (p.size() != 6)
    t.refuse("points_m", "E-VEHICLE-21",
             fmt::format("points_m has {} points; expected two: one on each body", p.size() / 3));
  return {Triple{p[0], p[1], p[2]}, Triple{p[3], p[4], p[5]}};
}

/// A spring, a damper, both, or a damper in series with a spring, along a line.
RunnerElement read_line(const Table& t, bool stiff, bool damped, bool series) {
  RunnerElement e{};
  e.kind = RunnerElement::Kind::line;
  const auto [a, b] = read_points(t);
  e.point_a = a;
  e.point_b = b;
  if (stiff) e.stiffness[0] = t.number("stiffness_n_per_m", kStiffnessRange);
  if (damped) e.damping[0] = t.number("damping_n_s_per_m", kDampingRange);
  if (series) e.series[0] = t.number("series_stiffness_n_per_m", above_upto(0.0, 1e13));
  if (stiff) e.preload[0] = t.number("preload_n", kPreloadRange, 0.0);
  return e;
}

RunnerElement read_traction_rod(const Table& t) {
  RunnerElement e = read_line(t, true, false, false);
  e.damping[0] = t.number("damping_n_s_per_m", kDampingRange, 0.0);
  return e;
}

RunnerElement read_rigid_rod(const Table& t) {
  RunnerElement e = read_line(t, false, false, false);
  e.kind = RunnerElement::Kind::rod;
  e.preload[0] = t.number("preload_n", kPreloadRange, 0.0);
  return e;
}

RunnerElement read_bushing(const Table& t) {
  RunnerElement e{};
  e.kind = RunnerElement::Kind::mid_frame;
  e.point_a = e.point_b = three_numbers(t, "point_m", kPlaceRange);
  const Triple k = three_numbers(t, "stiffness_n_per_m", kStiffnessRange),
               c = three_numbers(t, "damping_n_s_per_m", kDampingRange, {}),
               turned = three_numbers(t, "stiffness_n_m_per_rad", kStiffnessRange, {}),
               rolled = three_numbers(t, "damping_n_m_s_per_rad", kDampingRange, {}),
               series = three_numbers(t, "series_stiffness_n_per_m", kStiffnessRange, {}),
               preload = three_numbers(t, "preload_n", kPreloadRange, {});
  e.stiffness = {k[0], k[1], k[2], turned[0], turned[1], turned[2]};
  e.damping = {c[0], c[1], c[2], rolled[0], rolled[1], rolled[2]};
  e.series = {series[0], series[1], series[2]};
  e.preload = {preload[0], preload[1], preload[2]};
  return e;
}

/// A coil, whose shear acts at its middle.
RunnerElement read_shear_spring(const Table& t) {
  RunnerElement e{};
  e.kind = RunnerElement::Kind::mid_frame;
  const auto [a, b] = read_points(t);
  for (std::size_t d = 0; d < 3; ++d) e.point_a[d] = e.point_b[d] = .5 * (a[d] + b[d]);
  const Triple k = three_numbers(t, "stiffness_n_per_m", kStiffnessRange),
               c = three_numbers(t, "damping_n_s_per_m", kDampingRange, {}),
               series = three_numbers(t, "series_stiffness_n_per_m", kStiffnessRange, {}),
               preload = three_numbers(t, "preload_n", kPreloadRange, {});
  const auto bending = t.has("bending_n_m_per_rad")
                           ? t.number_or_pair("bending_n_m_per_rad", kStiffnessRange)
                           : std::array<double, 2>{};
  e.stiffness = {k[0], k[1], k[2], bending[0], bending[1], 0.};
  e.damping = {c[0], c[1], c[2]};
  e.series = {series[0], series[1], series[2]};
  e.preload = {preload[0], preload[1], preload[2]};
  return e;
}

RunnerElement read_anti_roll_bar(const Table& t) {
  RunnerElement e{};
  e.kind = RunnerElement::Kind::mid_frame;  // where it acts does not matter
  e.stiffness[index_of(BodyMotion::roll)] = t.number("stiffness_n_m_per_rad", kStiffnessRange);
  return e;
}

/// An element's type, in the order of the switch below.
enum { kBumpStop = 8 };
std::size_t element_type(const Table& t) {
  return t.choice("type", {"spring", "damper", "spring_damper", "maxwell", "traction_rod",
                           "bushing", "shear_spring", "anti_roll_bar", "bump_stop", "rigid_rod"});
}

RunnerElement read_typed_element(const Table& t, std::size_t type) {
  switch (type) {
    case 0:
      return read_line(t, true, false, false);
    case 1:
      return read_line(t, false, true, false);
    case 2:
      return read_line(t, true, true, false);
    case 3:
      return read_line(t, false, true, true);
    case 4:
      return read_traction_rod(t);
    case 5:
      return read_bushing(t);
    case 6:
      return read_shear_spring(t);
    case 7:
      return read_anti_roll_bar(t);
    default:
      return read_rigid_rod(t);
  }
}

/// The same element on the vehicle's other side.
RunnerElement mirrored(RunnerElement e) {
  e.point_a[1] = -e.point_a[1];
  e.point_b[1] = -e.point_b[1];
  if (e.kind == RunnerElement::Kind::mid_frame) e.preload[1] = -e.preload[1];
  return e;
}

RunnerElement placed(RunnerElement e, const BogiePlace& place) {
  e.point_a = place.at(e.point_a);
  e.point_b = place.at(e.point_b);
  if (place.turned && e.kind == RunnerElement::Kind::mid_frame)
    for (const std::size_t d : {0u, 1u}) e.preload[d] = -e.preload[d];
  return e;
}

RunnerStop read_stop(const Table& t) {
  RunnerStop s{};
  s.point = three_numbers(t, "point_m", kPlaceRange);
  s.axis = static_cast<int>(t.choice("axis", {"x", "y", "z"}));
  const auto [below, above] = t.number_or_pair("clearance_m", between(0.0, 10.0));
  s.law = {below, above, t.number("stiffness_n_per_m", above_upto(0.0, 1e13))};
  return s;
}

RunnerStop placed(RunnerStop s, const BogiePlace& place) {
  s.point = place.at(s.point);
  if (place.turned && s.axis != 2) std::swap(s.law.below, s.law.above);
  return s;
}

/// The same stop on the vehicle's other side.
RunnerStop mirrored(RunnerStop s) {
  s.point[1] = -s.point[1];
  if (s.axis == 1) std::swap(s.law.below, s.law.above);
  return s;
}

/// Place across the vehicle at which an element acts, m.
double side_of(const RunnerElement& e) { return e.point_a[1] != 0. ? e.point_a[1] : e.point_b[1]; }
double side_of(const RunnerStop& s) { return s.point[1]; }

/// Adds an element or a stop, and on request the same on the other side.
/// @param add  adds one of a name
template <typename Part, typename Add>
void add_mirrored(const Table& t, const Part& part, const Add& add) {
  if (!t.boolean("mirror", false)) return add(part, "");
  const double y = side_of(part);
  if (y == 0.)
    t.refuse("mirror", "E-VEHICLE-22",
             "mirror = true, but the element lies in the middle of the vehicle; expected a point "
             "with y other than 0, or no mirror");
  add(part, y > 0. ? "_left" : "_right");
  add(mirrored(part), y > 0. ? "_right" : "_left");
}

void read_runner_element(const Table& t, const BogiePlace& place, Runner& runner) {
  const RunnerPart part = read_runner_part(t);
  const std::string name = checked_name(t, "name", t.string("name")) + place.suffix;
  const std::vector<std::string> between = t.strings("between", 2, 2);
  if (between.size() != 2) return;  // its error is kept
  const auto add = [&](auto one, const char* side) {
    one.a = runner_body(t, runner, place, between[0]);
    one.b = runner_body(t, runner, place, between[1]);
    one.name = name + side;
    add_part(runner, one);
  };
  std::visit([&](const auto& own) { add_mirrored(t, placed(own, place), add); }, part);
}

void read_runner_bodies(const Table& t, const BogiePlace& place, Runner& runner) {
  const bool bodies = t.each(
      "body", [&](const Table& body) { runner.bodies.push_back(read_runner_body(body, place)); });
  const bool wheelsets = t.each("wheelset", [&](const Table& set) {
    runner.bodies.push_back(read_runner_wheelset(set, place));
  });
  if (!bodies || !wheelsets) t.end_part();  // elements name them
}

/// @returns whether none was refused
bool read_runner_elements(const Table& t, const BogiePlace& place, Runner& runner) {
  return t.each("element", [&](const Table& e) { read_runner_element(e, place, runner); });
}

/// Places of a bogie that is written once: NAME_1 at the first, and so on.
std::vector<BogiePlace> read_bogie_places(const Table& bogie) {
  const std::vector<double> places = bogie.numbers("places_m", kPlaceRange, 1, 4);
  const bool turned = bogie.boolean("turned", false);
  std::vector<BogiePlace> all;
  for (std::size_t i = 0; i < places.size(); ++i)
    all.push_back({places[i], turned && i % 2 == 1, fmt::format("_{}", i + 1)});
  return all;
}

}  // namespace

RunnerPart read_runner_part(const Table& t) {
  const std::size_t type = element_type(t);
  if (type == kBumpStop) return read_stop(t);
  return read_typed_element(t, type);
}

void add_part(Runner& runner, const RunnerElement& element) { runner.elements.push_back(element); }
void add_part(Runner& runner, const RunnerStop& stop) { runner.stops.push_back(stop); }

Runner read_runner(const Table& t) {
  Runner runner;
  read_runner_bodies(t, {}, runner);
  const std::optional<Table> bogie = t.table_if("bogie");
  const std::vector<BogiePlace> places =
      bogie ? read_bogie_places(*bogie) : std::vector<BogiePlace>{};
  for (const BogiePlace& place : places) read_runner_bodies(*bogie, place, runner);
  bool known = read_runner_elements(t, {}, runner);
  for (const BogiePlace& place : places)
    known = read_runner_elements(*bogie, place, runner) && known;
  for (const RunnerBody& body : runner.bodies)
    if (std::count_if(runner.bodies.begin(), runner.bodies.end(),
                      [&](const RunnerBody& other) { return other.name == body.name; }) > 1)
      t.refuse(
          "body", "E-VEHICLE-24",
          fmt::format("the name {} stands at two bodies or wheelsets of this vehicle; expected "
                      "names that are used once",
                      body.name));
  if (std::none_of(runner.bodies.begin(), runner.bodies.end(),
                   [](const RunnerBody& b) { return b.is_wheelset(); }))
    t.refuse("wheelset", "E-VEHICLE-25",
             "this vehicle has no wheelset; expected one or more [[wheelset]]");
  if (!known) t.end_part();  // the vehicle cannot be balanced without its elements
  return runner;
}

}  // namespace railstep
