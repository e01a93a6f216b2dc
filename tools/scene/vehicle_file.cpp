#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "scene/vehicle_read.h"

namespace railstep {
namespace {

const Range kMassRange = above_upto(0.0, 1e7);     // kg
const Range kInertiaRange = above_upto(0.0, 1e9);  // kg m2

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

void read_runner_element(const Table& t, const BogiePlace& place, const Runner& runner,
                         RunnerParts& parts_of) {
  const std::vector<RunnerPart> parts = read_runner_parts(t);
  const std::string name = checked_name(t, "name", t.string("name")) + place.suffix;
  const std::vector<std::string> between = t.strings("between", 2, 2);
  if (between.size() != 2) return;  // its error is kept
  const int a = runner_body(t, runner, place, between[0]),
            b = runner_body(t, runner, place, between[1]);
  const auto add = [&](const RunnerPart& part, const std::string& side) {
    const std::string& by = part.pressed_by;
    parts_of.add_part(part, {name + side, a, b},
                      {by + place.suffix + side + part.of_presser,
                       by + place.suffix + part.of_presser, by + part.of_presser});
  };
  const bool mirror = t.boolean("mirror", false);
  for (const RunnerPart& part : parts) {
    const RunnerPart own = placed(part, place);
    if (!mirror)
      add(own, "");
    else
      add_mirrored(t, own, add);
  }
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
bool read_runner_elements(const Table& t, const BogiePlace& place, const Runner& runner,
                          RunnerParts& parts) {
  return t.each("element", [&](const Table& e) { read_runner_element(e, place, runner, parts); });
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

Runner read_runner(const Table& t) {
  Runner runner;
  read_runner_bodies(t, {}, runner);
  const std::optional<Table> bogie = t.table_if("bogie");
  const std::vector<BogiePlace> places =
      bogie ? read_bogie_places(*bogie) : std::vector<BogiePlace>{};
  for (const BogiePlace& place : places) read_runner_bodies(*bogie, place, runner);
  RunnerParts parts(runner);
  bool known = read_runner_elements(t, {}, runner, parts);
  for (const BogiePlace& place : places)
    known = read_runner_elements(*bogie, place, runner, parts) && known;
  if (known) parts.find_pressers(t, "element");
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
