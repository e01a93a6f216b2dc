#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "offline/math/constants.h"
#include "online/track/travel.h"
#include "scene/scene_read.h"

namespace railstep {
namespace {

const Range kSpeed = between(-2000.0, 2000.0);
const Range kForce = between(-1e8, 1e8);

}  // namespace

int read_side(const Table& t, const Scene& scene) {
  // One rail is the left one, so that a scene can leave the key out.
  const bool left = scene.track.rails == 1 ? t.choice("rail", {"left", "right"}, 0) == 0
                                           : t.choice("rail", {"left", "right"}) == 0;
  if (!left && scene.track.rails == 1)
    t.refuse("rail", "E-SCENE-01",
             "rail = \"right\", but the track has one rail; expected \"left\"");
  return left ? kLeftRail : kRightRail;
}

std::vector<double> read_time_table(const Table& t, std::string_view key, const Range& accepted) {
  std::vector<double> rows = t.rows(key, 2);
  for (std::size_t i = 0; i < rows.size(); i += 2) {
    if (rows[i] < 0.0 || (i > 0 && rows[i] <= rows[i - 2]))
      t.refuse(key, "E-RUNNER-02",
               fmt::format("{}: the time {:.15g} s of row {} does not rise; expected times from 0 "
                           "on, each above the one before",
                           key, rows[i], i / 2));
    if (!accepted.holds(rows[i + 1]))
      t.refuse(key, "E-RUNNER-21",
               fmt::format("{}: {:.15g} in row {} is out of range; expected {}", key, rows[i + 1],
                           i / 2, accepted.text()));
  }
  return rows;
}

namespace {

/// A force is 0 before its first row, where table_value() keeps the first value. A row one bit
/// earlier makes them the same function.
std::vector<double> read_force_table(const Table& t, std::string_view key, const Range& accepted) {
  std::vector<double> rows = read_time_table(t, key, accepted);
  rows.insert(rows.begin(),
              {std::nextafter(rows.front(), -std::numeric_limits<double>::infinity()), 0.});
  return rows;
}

}  // namespace

SpeedScene read_speed(const Table& t, std::optional<double> otherwise) {
  if (!t.has("speed_table"))
    return {otherwise ? t.number("speed_m_per_s", kSpeed, *otherwise)
                      : t.number("speed_m_per_s", kSpeed),
            {}};
  if (t.has("speed_m_per_s"))
    t.refuse("speed_table", "E-RUNNER-22",
             "speed_table is given beside speed_m_per_s; expected one of them");
  std::vector<double> rows = read_time_table(t, "speed_table", kSpeed);
  double least = rows[1], most = rows[1];
  for (std::size_t i = 3; i < rows.size(); i += 2) {
    least = std::min(least, rows[i]);
    most = std::max(most, rows[i]);
  }
  if (least < 0.0 && most > 0.0)
    t.refuse("speed_table", "E-RUNNER-23",
             fmt::format("speed_table goes from {:.15g} to {:.15g} m/s and so turns around; "
                         "expected speeds of one sign",
                         least, most));
  const double first = rows[1];
  return {first, std::move(rows)};
}

void check_path(const Table& t, const Scene& scene, double start, const SpeedScene& speed,
                const std::optional<double>& stop) {
  if (scene.track.endless) return;
  const double length = scene.track.length();
  const double way =
      travelled(travel_table(speed.speed, speed.speeds).model(), scene.duration()).distance;
  double end = start + way;
  if (stop) end = way >= 0.0 ? std::min(end, *stop) : std::max(end, *stop);
  // A path may end exactly on the border; 1e-9 of the length forgives its rounding.
  if (end >= -1e-9 * length && end <= length * (1.0 + 1e-9)) return;
  if (!speed.speeds.empty())
    t.refuse("speed_table", "E-RUNNER-06",
             fmt::format("speed_table leads from x = {:.15g} to {:.6g} m, off the rail; expected "
                         "0 to {:.6g} m, or may_leave_rail = true",
                         start, end, length));
  t.refuse("speed_m_per_s", "E-RUNNER-07",
           fmt::format("speed_m_per_s = {:.15g} from start_m = {:.15g} leads to x = {:.6g} m, "
                       "off the rail; expected 0 to {:.6g} m, or may_leave_rail = true",
                       speed.speed, start, end, length));
}

namespace {

/// Reads amplitude_n, frequency_hz and phase_deg of a force that swings.
void read_swing(const Table& t, const Scene& scene, LoadScene& load) {
  if (!t.has("amplitude_n")) {
    for (const char* key : {"frequency_hz", "phase_deg"})
      if (t.has(key))
        t.refuse(
            key, "E-RUNNER-08",
            fmt::format("{} belongs to a force that swings; expected amplitude_n beside it", key));
    return;
  }
  load.amplitude = t.number("amplitude_n", kForce);
  load.frequency = t.number("frequency_hz", between(0.0, 1e6));
  load.phase = t.number("phase_deg", between(-360.0, 360.0), 0.0) / 360.0;
  if (scene.step && load.frequency * scene.step->dt > .125 * (1.0 + 1e-12))
    t.refuse("frequency_hz", "E-RUNNER-09",
             fmt::format("frequency_hz = {:.15g} has {:.3g} steps of dt_s = {:.6g} a period; "
                         "expected 8 or more, by a shorter step.dt_s",
                         load.frequency, 1.0 / (load.frequency * scene.step->dt), scene.step->dt));
}

LoadScene read_load(const Table& t, const Scene& scene) {
  const double length = scene.track.length();
  LoadScene load{};
  load.name = checked_name(t, "name", t.string("name"));
  load.rail = read_side(t, scene);
  load.may_leave_rail = t.boolean("may_leave_rail", false);
  load.start = t.number("start_m", load.may_leave_rail ? between(-1e6, 1e6) : between(0.0, length));
  const SpeedScene speed = read_speed(t, 0.0);
  load.speed = speed.speed;
  load.speeds = speed.speeds;
  load.force = t.number("force_z_n", kForce);
  load.at = t.choice("at", {"axis", "head"}, 0) == 0 ? Height::axis : Height::head;
  if (t.has("table")) load.table = read_force_table(t, "table", between(-1e6, 1e6));
  read_swing(t, scene, load);
  constexpr double kFar = std::numeric_limits<double>::infinity();
  load.stop = fastest(load) < 0. ? -kFar : kFar;
  if (t.has("stop_m")) {
    load.stop = t.number("stop_m", between(0.0, scene.track.endless ? 1e12 : length));
    if ((load.stop - load.start) * fastest(load) <= 0.0)
      t.refuse("stop_m", "E-RUNNER-24",
               fmt::format("stop_m = {:.15g} is not ahead of start_m = {:.15g}; expected a place "
                           "that the load moves to",
                           load.stop, load.start));
  }
  if (!load.may_leave_rail)
    check_path(t, scene, load.start, speed,
               t.has("stop_m") ? std::optional(load.stop) : std::nullopt);
  return load;
}

void read_guide(const Table& wheelset, WheelsetScene& w) {
  const std::optional<Table> t = wheelset.table_if("guide");
  if (!t) return;
  w.guide = Guide{static_cast<std::int32_t>(
      t->choice("method", {"augmented_lagrangian", "baumgarte", "elimination"}, 0))};
  const bool baumgarte = w.guide == Guide::baumgarte;
  w.cap = static_cast<int>(t->integer("cap", 1, 1000, w.cap));
  w.tolerance = t->number("tolerance", between(1e-15, 1e-2), w.tolerance);
  if (!baumgarte && (t->has("alpha_per_s") || t->has("beta_per_s")))
    t->refuse(t->has("alpha_per_s") ? "alpha_per_s" : "beta_per_s", "E-RUNNER-11",
              "alpha_per_s and beta_per_s belong to Baumgarte's method; expected "
              "method = \"baumgarte\" beside them");
  if (baumgarte) {
    w.alpha = t->number("alpha_per_s", above_upto(0.0, 1e6));
    w.beta = t->number("beta_per_s", above_upto(0.0, 1e6));
  }
}

/// A wheelset that stands on no rail has no equilibrium.
void check_start(const Table& t, const Scene& scene, const WheelsetScene& w) {
  const double length = scene.track.length();
  const bool on_rail = w.start >= 0.0 && w.start <= length;
  if (on_rail || scene.track.endless || !scene.step || scene.step->start == Start::released) return;
  t.refuse("start_m", "E-RUNNER-12",
           fmt::format("start_m = {:.15g} is off the rail, where the wheelset has no "
                       "equilibrium; expected 0 to {:.6g} m, or step.start = \"released\"",
                       w.start, length));
}

WheelsetScene read_wheelset(const Table& t, const Scene& scene, std::vector<InputScene>& inputs) {
  if (scene.track.rails != 2)
    t.refuse("", "E-RUNNER-13", "a wheelset needs two rails; expected track.rails = 2");
  const Range inertia = above_upto(0.0, 1e6);
  WheelsetScene w{};
  w.name = checked_name(t, "name", t.string("name"));
  w.wheels = {w.name + "_left", w.name + "_right"};
  if (t.has("wheels")) {
    const std::vector<std::string> names = t.strings("wheels", 2, 2);
    w.wheels = {checked_name(t, "wheels", names[0]), checked_name(t, "wheels", names[1])};
  }
  w.mass = t.number("mass_kg", above_upto(0.0, 1e6));
  w.inertia_roll = t.number("inertia_roll_kg_m2", inertia);
  w.inertia_spin = t.number("inertia_spin_kg_m2", inertia);
  w.inertia_yaw = t.number("inertia_yaw_kg_m2", inertia);
  w.radius = t.number("radius_m", between(0.02, 3.0));
  w.tread_half_width = t.number("tread_half_width_m", between(0.005, 0.3), kTreadHalfWidth);
  w.may_leave_rail = t.boolean("may_leave_rail", false);
  w.start = t.number("start_m",
                     w.may_leave_rail ? between(-1e6, 1e6) : between(0.0, scene.track.length()));
  const SpeedScene speed = read_speed(t, std::nullopt);
  w.speed = speed.speed;
  w.speeds = speed.speeds;
  w.carried_mass = t.number("carried_mass_kg", between(0.0, 1e6), 0.0);
  w.weight = t.boolean("gravity", true) ? (w.mass + w.carried_mass) * kGravity : 0.;
  read_guide(t, w);
  for (const Table& force : t.tables("force"))
    w.forces.push_back(read_body_force(
        force, static_cast<int>(force.choice("direction", {"x", "y", "z"})), false, inputs));
  w.treads = read_treads(t, scene, w);
  if (const std::optional<Table> flange = t.table_if("flange"))
    w.flange = read_flange(*flange, scene);
  if (!w.may_leave_rail) check_path(t, scene, w.start, speed);
  check_start(t, scene, w);
  return w;
}

}  // namespace

std::string checked_name(const Table& t, std::string_view key, const std::string& name) {
  const auto is_letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-';
  };
  if (!std::all_of(name.begin(), name.end(), is_letter) || name.size() > 64)
    t.refuse(key, "E-RUNNER-14",
             fmt::format("{} = \"{}\" is not a valid name; expected up to 64 of a-z, A-Z, 0-9, _ "
                         "and -",
                         key, name.substr(0, 64)));
  if (name.starts_with("support_"))
    t.refuse(key, "E-RUNNER-15",
             fmt::format("{} = \"{}\" is kept for the supports in the trace; expected a name that "
                         "does not start with support_",
                         key, name));
  return name;
}

std::vector<LoadScene> read_loads(const Table& root, const Scene& scene) {
  std::vector<LoadScene> loads;
  root.each("load", [&](const Table& t) { loads.push_back(read_load(t, scene)); });
  return loads;
}

std::vector<WheelsetScene> read_wheelsets(const Table& root, const Scene& scene,
                                          std::vector<InputScene>& inputs) {
  std::vector<WheelsetScene> wheelsets;
  root.each("wheelset",
            [&](const Table& t) { wheelsets.push_back(read_wheelset(t, scene, inputs)); });
  return wheelsets;
}

std::vector<ExternalWheelScene> read_external_wheels(const Table& root, const Scene& scene) {
  std::vector<ExternalWheelScene> wheels;
  root.each("external_wheel", [&](const Table& t) {
    const std::string name = checked_name(t, "name", t.string("name"));
    const int rail = read_side(t, scene);
    wheels.push_back({{rail, t.number("limit_n", above_upto(0.0, 1e12))}, name});
  });
  return wheels;
}

OuterForce read_body_force(const Table& t, int direction, bool moment,
                           std::vector<InputScene>& inputs) {
  if (!t.has("input")) return {direction, read_force_table(t, "table", kForce)};
  if (t.has("table"))
    t.refuse("table", "E-RUNNER-25", "table is given beside input; expected one of them");
  return {direction, {}, read_input(t, moment ? "moment_n_m" : "force_n", inputs)};
}

int read_input(const Table& t, std::string_view quantity, std::vector<InputScene>& inputs) {
  const std::string name =
      fmt::format("{}.{}", checked_name(t, "input", t.string("input")), quantity);
  for (const InputScene& other : inputs)
    if (other.name == name)
      t.refuse(
          "input", "E-RUNNER-17",
          fmt::format("{} is taken by another force; expected a name that is used once", name));
  if (inputs.size() == static_cast<std::size_t>(kMaxInputs))
    t.refuse("input", "E-RUNNER-18",
             fmt::format("there are more than {0} inputs; expected at most {0}", kMaxInputs));
  // limit_n of force_n, limit_n_s_per_m of damping_n_s_per_m, and so on.
  const std::string limit = "limit" + std::string(quantity.substr(quantity.find('_')));
  inputs.push_back({name, t.number(limit, above_upto(0.0, 1e12))});
  return static_cast<int>(inputs.size()) - 1;
}

namespace {

/// The names of a vehicle in space, its wheelsets and its rigid rods.
void claim_in_space(const Table& t, const std::string& name, const Scene& scene, NameBook& names) {
  for (const RailVehicleScene& own : scene.rail_vehicles)
    for (const RailVehicleScene::Part& part : own.parts) {
      if (part.name != name) continue;
      names.claim(t, "name", name);
      for (const auto* all : {&own.wheelsets, &own.rods, &own.force_elements})
        for (const std::string& of_part : *all)
          if (of_part.starts_with(name + ".")) names.claim(t, "name", of_part);
    }
}

/// The tables of a list, one for each entry; none where an entry was refused.
template <typename Entry>
std::vector<Table> tables_of(const Table& root, const char* key, const std::vector<Entry>& read) {
  std::vector<Table> all = root.tables(key);
  if (all.size() != read.size()) all.clear();
  return all;
}

}  // namespace

void claim_names(const Table& root, const Scene& scene, NameBook& names) {
  NameBook wheelsets;  // a sensor may have the name of a wheelset, which has no columns of its own
  const auto claim = [&root](const Table& t, std::string_view key, const std::string& name,
                             NameBook& book) {
    if (!name.empty()) root.attempt({}, [&] { book.claim(t, key, name); });  // empty: a bad value
  };
  const auto claim_all = [&](const char* key, const auto& read) {
    const std::vector<Table> all = tables_of(root, key, read);
    for (std::size_t i = 0; i < all.size(); ++i) claim(all[i], "name", read[i].name, names);
  };
  claim_all("load", scene.loads);
  const std::vector<Table> bodies = tables_of(root, "wheelset", scene.wheelsets);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    claim(bodies[i], "name", scene.wheelsets[i].name, wheelsets);
    for (const std::string& wheel : scene.wheelsets[i].wheels)
      claim(bodies[i], "wheels", wheel, names);
  }
  claim_all("external_wheel", scene.external_wheels);
  claim_all("stop", scene.stops);
  // One table that stands on both rails makes two vehicles, whose names begin with its own.
  std::size_t vehicle = 0;
  for (const Table& t : root.tables("vehicle")) {
    const std::string name = t.string("name");
    while (vehicle < scene.vehicles.size() && scene.vehicles[vehicle].table == name)
      claim(t, "name", scene.vehicles[vehicle++].name, names);
    root.attempt({}, [&] { claim_in_space(t, name, scene, names); });
  }
  for (const Table& t : root.tables("coupler")) claim(t, "name", t.string("name"), names);
  claim_all("sensor", scene.sensors);
}

}  // namespace railstep
