#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "scene/scene_read.h"

namespace railstep {
namespace {

using Of = double& (*)(Seat&, std::size_t);

enum class Kind { stiffness, damping, other };

/// A key of a seat's table: the place of its number and its range.
struct Property {
  const char* table;
  const char* key;
  Kind kind;
  Range accepted;
  Of of;
};

const Range kStiffness = between(0.0, 1e13), kDamping = between(0.0, 1e11);

const Property kProperties[] = {
    {"support", "stiffness_x_n_per_m", Kind::stiffness, kStiffness,
     [](Seat& s, std::size_t i) -> double& { return s.pad[i].stiffness[0]; }},
    {"support", "stiffness_y_n_per_m", Kind::stiffness, kStiffness,
     [](Seat& s, std::size_t i) -> double& { return s.pad[i].stiffness[1]; }},
    {"support", "stiffness_z_n_per_m", Kind::stiffness, kStiffness,
     [](Seat& s, std::size_t i) -> double& { return s.pad[i].stiffness[2]; }},
    {"support", "stiffness_roll_n_m_per_rad", Kind::stiffness, kStiffness,
     [](Seat& s, std::size_t i) -> double& { return s.pad[i].roll_stiffness; }},
    {"support", "damping_x_n_s_per_m", Kind::damping, kDamping,
     [](Seat& s, std::size_t i) -> double& { return s.pad[i].damping[0]; }},
    {"support", "damping_y_n_s_per_m", Kind::damping, kDamping,
     [](Seat& s, std::size_t i) -> double& { return s.pad[i].damping[1]; }},
    {"support", "damping_z_n_s_per_m", Kind::damping, kDamping,
     [](Seat& s, std::size_t i) -> double& { return s.pad[i].damping[2]; }},
    {"support", "damping_roll_n_m_s_per_rad", Kind::damping, kDamping,
     [](Seat& s, std::size_t i) -> double& { return s.pad[i].roll_damping; }},
    {"support", "half_spread_m", Kind::other, between(0.0, 0.5),
     [](Seat& s, std::size_t i) -> double& { return s.pad[i].half_spread; }},
    {"support", "length_m", Kind::other, between(0.0, 5.0),
     [](Seat& s, std::size_t i) -> double& { return s.pad[i].length; }},
    {"support", "gap_m", Kind::other, between(0.0, 0.1),
     [](Seat& s, std::size_t i) -> double& { return s.pad[i].gap; }},
    {"sleeper", "mass_kg", Kind::other, between(0.0, 1e5),
     [](Seat& s, std::size_t) -> double& { return s.sleeper->mass; }},
    {"sleeper", "roll_inertia_kg_m2", Kind::other, between(0.0, 1e6),
     [](Seat& s, std::size_t) -> double& { return s.sleeper->roll_inertia; }},
    {"sleeper", "pitch_inertia_kg_m2", Kind::other, between(0.0, 1e6),
     [](Seat& s, std::size_t) -> double& { return s.sleeper->pitch_inertia; }},
    {"ballast", "stiffness_x_n_per_m", Kind::stiffness, kStiffness,
     [](Seat& s, std::size_t i) -> double& { return s.ballast[i].stiffness[0]; }},
    {"ballast", "stiffness_y_n_per_m", Kind::stiffness, kStiffness,
     [](Seat& s, std::size_t i) -> double& { return s.ballast[i].stiffness[1]; }},
    {"ballast", "stiffness_z_n_per_m", Kind::stiffness, kStiffness,
     [](Seat& s, std::size_t i) -> double& { return s.ballast[i].stiffness[2]; }},
    {"ballast", "damping_x_n_s_per_m", Kind::damping, kDamping,
     [](Seat& s, std::size_t i) -> double& { return s.ballast[i].damping[0]; }},
    {"ballast", "damping_y_n_s_per_m", Kind::damping, kDamping,
     [](Seat& s, std::size_t i) -> double& { return s.ballast[i].damping[1]; }},
    {"ballast", "damping_z_n_s_per_m", Kind::damping, kDamping,
     [](Seat& s, std::size_t i) -> double& { return s.ballast[i].damping[2]; }},
    {"ballast", "length_m", Kind::other, between(0.0, 5.0),
     [](Seat& s, std::size_t i) -> double& { return s.ballast[i].length; }},
    {"ballast", "gap_m", Kind::other, between(0.0, 0.1),
     [](Seat& s, std::size_t i) -> double& { return s.ballast[i].gap; }},
    {"under_sleeper_pad", "stiffness_z_n_per_m", Kind::stiffness, above_upto(0.0, 1e13),
     [](Seat& s, std::size_t i) -> double& { return s.under_pad[i].stiffness; }},
    {"under_sleeper_pad", "damping_z_n_s_per_m", Kind::damping, kDamping,
     [](Seat& s, std::size_t i) -> double& { return s.under_pad[i].damping; }},
};

/// Seats `from` to `to`, or a list; all seats without these keys.
std::vector<int> read_seats(const Table& t, const Scene& scene) {
  const std::int64_t last = scene.track.bays;
  std::vector<int> seats;
  if (t.has("seats")) {
    for (const char* other : {"from", "to"})
      if (t.has(other))
        t.refuse(
            other, "E-SUPPORT-04",
            fmt::format("{} is given beside seats; expected seats alone, or from and to", other));
    for (const double seat : t.numbers("seats", between(0.0, static_cast<double>(last)))) {
      if (std::isnan(seat)) continue;  // it has been refused
      const int number = static_cast<int>(seat);
      if (number != seat)
        t.refuse(
            "seats", "E-SUPPORT-05",
            fmt::format("seats: {:.15g} is not the number of a seat; expected whole numbers from "
                        "0 to {}",
                        seat, last));
      if (!seats.empty() && number <= seats.back())
        t.refuse("seats", "E-SUPPORT-06",
                 fmt::format("seats: {} does not rise; expected numbers each above the one before",
                             number));
      seats.push_back(number);
    }
    return seats;
  }
  const std::int64_t from = t.integer("from", 0, last, 0), to = t.integer("to", from, last, last);
  for (std::int64_t seat = from; seat <= to; ++seat) seats.push_back(static_cast<int>(seat));
  return seats;
}

std::array<bool, 2> read_sides(const Table& t, const Scene& scene) {
  const std::size_t side = t.choice("rail", {"both", "left", "right"}, 0);
  if (scene.track.rails == 1 && side == 2)
    t.refuse("rail", "E-SCENE-01",
             "rail = \"right\", but the track has one rail; expected \"left\"");
  return {side != 2, side != 1};
}

/// Adds a value. For several seats [first, last] is a transition along them.
void add_value(const Table& t, const char* key, const Range& accepted, const std::vector<Of>& of,
               bool scales, SeatChange& change) {
  if (!t.has(key)) return;
  const std::array<double, 2> ends = t.number_or_pair(key, accepted);
  if (ends[0] != ends[1] && change.seats.size() < 2)
    t.refuse(key, "E-SUPPORT-08",
             fmt::format("{} has two values, but the change has one seat; expected one value, or "
                         "several seats",
                         key));
  for (const Of each : of) change.values.push_back({each, ends[0], ends[1], scales});
}

std::vector<Of> all_of(std::string_view table, Kind kind) {
  std::vector<Of> found;
  for (const Property& property : kProperties)
    if (property.table == table && property.kind == kind) found.push_back(property.of);
  return found;
}

void add_scatter(const Table& t, const char* key, const std::vector<Of>& of, std::uint64_t stream,
                 SeatChange& change) {
  const double width = t.number(key, {.least = 0.0, .most = 1.0, .most_itself = false}, 0.0);
  if (width > 0.0) change.scatter.push_back({of, width, stream});
}

/// Ballast along x or y can change only where the scene has it: without, the sleeper is held there.
void check_held(const Table& t, const Property& property, const Scene& scene) {
  if (std::string_view(property.table) != "ballast" || !t.has(property.key)) return;
  const std::string_view key = property.key;
  const bool x = key.find("_x_") != std::string_view::npos;
  const bool y = key.find("_y_") != std::string_view::npos;
  if ((x && scene.sleeper->ballast_stiffness[0] == 0.0) ||
      (y && scene.sleeper->ballast_stiffness[1] == 0.0))
    t.refuse(key, "E-SUPPORT-18",
             fmt::format("{} is given, but [ballast] holds the sleeper along {}; expected "
                         "ballast.stiffness_{}_n_per_m",
                         key, x ? "x" : "y", x ? "x" : "y"));
  if (key == "length_m" && scene.sleeper->ballast_length == 0.0)
    t.refuse(key, "E-SUPPORT-10",
             "length_m is given, but the sleeper does not pitch; expected "
             "ballast.length_m and support.length_m");
}

/// A change of something that the scene has; but a stiffness gives seats a pad under the sleeper.
void check_has_part(const Table& t, std::string_view name, const Scene& scene) {
  if (name == "support") return;
  if (!scene.sleeper)
    t.refuse(
        "", "E-SUPPORT-11",
        fmt::format("the scene has no [{}] to change; expected a change of support alone", name));
  if (name == "under_sleeper_pad" && scene.sleeper->under_pad.stiffness == 0.0 &&
      !t.has("stiffness_z_n_per_m"))
    t.refuse("", "E-SUPPORT-11",
             "the scene has no [under_sleeper_pad] to change; expected this table, or "
             "stiffness_z_n_per_m beside the other keys of the change");
}

void read_part(const Table& change_table, std::string_view name, const Scene& scene,
               std::uint64_t stream, SeatChange& change) {
  const std::optional<Table> given = change_table.table_if(name);
  if (!given) return;
  const Table& t = *given;
  check_has_part(t, name, scene);
  if (name == "sleeper" && change.sides[0] != change.sides[1])
    t.refuse("", "E-SUPPORT-12", "one sleeper lies under both rails; expected rail = \"both\"");
  for (const Property& property : kProperties) {
    if (property.table != name) continue;
    check_held(t, property, scene);
    add_value(t, property.key, property.accepted, {property.of}, false, change);
  }
  if (name == "sleeper") return;
  const bool under_sleeper = name == "under_sleeper_pad";
  if (!under_sleeper && t.has("unilateral"))
    (name == "ballast" ? change.ballast_unilateral : change.pad_unilateral) =
        t.boolean("unilateral");
  const Range factor = between(0.0, 1e6),
              of_springs = under_sleeper ? above_upto(0.0, 1e6) : factor;
  const std::vector<Of> stiffness = all_of(name, Kind::stiffness),
                        damping = all_of(name, Kind::damping);
  add_value(t, "stiffness_factor", of_springs, stiffness, true, change);
  add_value(t, "damping_factor", factor, damping, true, change);
  add_scatter(t, "stiffness_scatter", stiffness, stream, change);
  add_scatter(t, "damping_scatter", damping, stream + 1, change);
}

Missing read_missing(const Table& t, const Scene& scene, const SeatChange& change) {
  if (!t.has("missing")) return Missing::nothing;
  constexpr Missing kParts[] = {Missing::pad, Missing::ballast, Missing::sleeper};
  const Missing missing = kParts[t.choice("missing", {"pad", "ballast", "sleeper"})];
  if (missing != Missing::pad && !scene.sleeper)
    t.refuse("missing", "E-SUPPORT-13",
             "the scene has no [sleeper] that could be missing; expected \"pad\"");
  if (missing == Missing::sleeper && change.sides[0] != change.sides[1])
    t.refuse("missing", "E-SUPPORT-14",
             "missing = \"sleeper\" takes the sleeper from both rails; expected rail "
             "= \"both\"");
  return missing;
}

SeatChange read_change(const Table& t, const Scene& scene) {
  if (!scene.support)
    t.refuse("", "E-SUPPORT-15", "the scene has no [support] to change; expected one");
  SeatChange change;
  change.seats = read_seats(t, scene);
  change.sides = read_sides(t, scene);
  read_part(t, "support", scene, 0, change);
  read_part(t, "sleeper", scene, 0, change);
  read_part(t, "ballast", scene, 2, change);
  read_part(t, "under_sleeper_pad", scene, 4, change);
  change.missing = read_missing(t, scene, change);
  if (!change.scatter.empty())
    change.seed =
        static_cast<std::uint64_t>(t.integer("seed", 0, std::numeric_limits<std::int64_t>::max()));
  else if (t.has("seed"))
    t.refuse("seed", "E-SUPPORT-16",
             "seed is given without scatter; expected stiffness_scatter or "
             "damping_scatter beside it");
  if (!t.has("missing") && !t.has("support") && !t.has("sleeper") && !t.has("ballast") &&
      !t.has("under_sleeper_pad"))
    t.refuse("", "E-SUPPORT-17",
             "nothing is changed; expected missing, or numbers in support, sleeper, ballast or "
             "under_sleeper_pad");
  return change;
}

}  // namespace

std::vector<SeatChange> read_seat_changes(const Table& root, const Scene& scene) {
  std::vector<SeatChange> changes;
  root.each("support_change", [&](const Table& t) { changes.push_back(read_change(t, scene)); });
  return changes;
}

}  // namespace railstep
