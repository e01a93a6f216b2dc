#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "offline/contact/hertz.h"
#include "offline/math/hertz_depth.h"
#include "offline/runner/suspension.h"
#include "scene/scene_read.h"
#include "section/running_profile.h"

namespace railstep {
namespace {

/// Hertz's ellipse under a cone.
RollingPatch hertz_patch(const RollingContact& c, double radius, const BarScene& steel) {
  constexpr double kLoad = 1e5;  // N: the ellipse has the same shape under every load
  const HertzContact patch =
      hertz_contact(radius, c.crown_radius, steel.young, steel.poisson, kLoad);
  const double root = std::sqrt(hertz_depth(kLoad, c.hertz));
  return {patch.half_along / root, patch.half_across / root,
          steel.young / (2. * (1. + steel.poisson)), 1. / 3.,
          kalker(patch.half_along / patch.half_across, steel.poisson)};
}

/// Profiles have patches of their own, which grow.
RollingPatch patch_of_profiles(const BarScene& steel) {
  return {1., 1., steel.young / (2. * (1. + steel.poisson)), 1., {}};
}

const Range kFriction = between(1e-3, 2.0);

/// [x, left, right] along the track as parts of the most that each rail has. @param most  out
std::vector<double> read_friction_table(const Table& t, double* most) {
  const char* const key = "friction_table";
  std::vector<double> rows = t.rows(key, 3);
  if (rows.size() > 3 * std::size_t{kMostFrictionPlaces})
    t.refuse(key, "E-CONTACT-08",
             fmt::format("{} has {} rows; expected at most {}", key, rows.size() / 3,
                         kMostFrictionPlaces));
  most[0] = most[1] = 0.;
  for (std::size_t i = 0; i < rows.size(); i += 3) {
    if (i > 0 && !(rows[i] > rows[i - 3]))
      t.refuse(key, "E-CONTACT-09",
               fmt::format("{}: x = {:.15g} follows x = {:.15g}; expected places that rise", key,
                           rows[i], rows[i - 3]));
    for (std::size_t side = 0; side < 2; ++side) {
      const double own = rows[i + 1 + side];
      if (!kFriction.holds(own))
        t.refuse(
            key, "E-CONTACT-10",
            fmt::format("{}: a coefficient of {:.15g}; expected {}", key, own, kFriction.text()));
      most[side] = std::max(most[side], own);
    }
  }
  for (std::size_t i = 0; i < rows.size(); i += 3)
    for (std::size_t side = 0; side < 2; ++side) rows[i + 1 + side] /= most[side];
  return rows;
}

/// @param parts  RailVehicle::friction, out
RollingFriction read_friction(const Table& t, std::vector<double>& parts) {
  RollingFriction f{{1., 1.}};
  if (t.has("friction_table")) {
    if (t.has("friction"))
      t.refuse("friction_table", "E-CONTACT-11",
               "friction_table is given beside friction; expected one of them");
    parts = read_friction_table(t, f.rail);
  } else {
    const std::array<double, 2> friction = t.number_or_pair("friction", kFriction);
    std::copy(friction.begin(), friction.end(), f.rail);
  }
  if (!t.has("kinetic_part")) {
    if (t.has("half_slip_m_per_s"))
      t.refuse("half_slip_m_per_s", "E-CONTACT-12",
               "half_slip_m_per_s is given without kinetic_part; expected both, or none");
    return f;
  }
  f.kinetic = t.number("kinetic_part", between(0.01, 1.0));
  f.half = t.number("half_slip_m_per_s", between(1e-3, 1e3));
  return f;
}

/// The law of creep. Without coefficients the patch follows from the contact.
RollingCreep read_creep(const Table& t, const RollingContact& c, double radius,
                        const BarScene& steel, std::vector<double>& parts) {
  RollingCreep creep{CreepLaw::linear, 0, {{1., 1.}}, {1., 1., 1., 0., {}}};
  const std::size_t law = t.choice("creep", {"none", "linear", "she", "fastsim", "polach"});
  if (law == 0) return creep;
  creep.law = CreepLaw{static_cast<std::int32_t>(law - 1)};
  if (creep.law != CreepLaw::linear) creep.friction = read_friction(t, parts);
  if (creep.law == CreepLaw::fastsim)
    creep.strips = static_cast<std::int32_t>(t.integer("strips", 1, kMostStrips, 10));
  if (t.has("kalker")) {
    if (creep.law == CreepLaw::fastsim || creep.law == CreepLaw::polach)
      t.refuse("kalker", "E-CONTACT-07",
               "this law of creep needs the patch, not its coefficients; expected no kalker, or "
               "creep = \"linear\" or \"she\"");
    const std::vector<double> f = t.numbers("kalker", between(0.0, 1e12), 4, 4);
    creep.patch.kalker = {f[0], f[1], f[2], f[3]};
    return creep;
  }
  creep.patch = has_profiles(c) ? patch_of_profiles(steel) : hertz_patch(c, radius, steel);
  return creep;
}

/// Wheels that are cones on crowns that are circles.
RollingContact read_cones(const Table& t, const Scene& scene, double radius) {
  static_cast<void>(t.choice("rail", {"crown"}));
  static_cast<void>(t.choice("normal", {"hertz"}));
  RollingContact c{};
  c.slope = t.slope("slope", between(0.0, 0.5), 0.05);
  c.crown_radius = scene.rail.crown_radius;
  c.half_distance = .5 * t.number("distance_m", between(0.3, 3.0), scene.track.rail_spacing);
  c.hertz = t.has("hertz_n_per_m15")
                ? t.number("hertz_n_per_m15", between(1e6, 1e14))
                : hertz_constant(radius, c.crown_radius, scene.rail.young, scene.rail.poisson);
  return c;
}

/// Length in which creep follows slip at a standstill: there a contact is Mindlin's spring, of
/// 4 G a / (2 - nu), and its coefficient along the rail over the length is that stiffness.
double relaxation_length(const RollingContact& c, double radius, double load,
                         const RailScene& steel) {
  const HertzContact patch =
      hertz_contact(radius, steel.crown_radius, steel.young, steel.poisson, load);
  const double shear = steel.young / (2. * (1. + steel.poisson));
  const RollingPatch& given = c.creep.patch;
  const double along = given.exponent == 0.
                           ? given.shear * given.half_length * given.half_width * given.kalker.c11
                           : shear * patch.half_along * patch.half_across *
                                 kalker(patch.half_along / patch.half_across, steel.poisson).c11;
  return along * (2. - steel.poisson) / (4. * shear * patch.half_along);
}

double first_radius(const Runner& runner) {
  for (const RunnerBody& body : runner.bodies)
    if (body.is_wheelset()) return body.radius;
  return kWheelRadius;
}

/// Weight on a wheel of a vehicle at rest, its mean over all, N.
double mean_load(const Runner& runner) {
  double mass = 0.;
  int wheelsets = 0;
  for (const RunnerBody& body : runner.bodies) {
    mass += body.mass;
    wheelsets += body.is_wheelset() ? 1 : 0;
  }
  return mass * kGravity / (2. * wheelsets);
}

/// Wheels and rails by their profiles.
RollingProfiles read_profiles(const Table& t, const Scene& scene, const Runner& runner) {
  static_cast<void>(t.choice("rail", {"profile"}));
  static_cast<void>(t.choice("normal", {"strips"}));
  const RailPlace place{t.slope("inclination", between(0.0, 0.2), scene.rail.cant),
                        t.number("gauge_m", between(0.5, 2.0), 1.435)};
  const double back_to_back = t.number("back_to_back_m", between(0.4, 1.9), 1.36);
  const WheelProfile wheel = read_wheel_profile(t.path("wheel_profile"));
  const PlacedRail rail = read_placed_rail(t.path("rail_profile"), place);
  const WheelRail pair{wheel.growth, rail.surface, .5 * back_to_back - wheel.flange_back,
                       first_radius(runner)};
  try {
    return rolling_profiles(pair, {scene.rail.young, scene.rail.poisson}, scene.rail.crown_radius,
                            mean_load(runner));
  } catch (const Refused& error) {
    t.refuse("wheel_profile", error.id(), error.sentence());
  }
}

/// [contact]
void read_rolling(const Table& root, const Scene& scene, RailVehicle& vehicle) {
  const Table t = root.table("contact");
  const double radius = first_radius(vehicle.runner);
  if (t.choice("wheel", {"cone", "profile"}) == 0) {
    vehicle.contact = read_cones(t, scene, radius);
  } else {
    RollingProfiles profiles = read_profiles(t, scene, vehicle.runner);
    vehicle.contact = profiles.contact;
    vehicle.contact.profiles.pair.patches = static_cast<std::int32_t>(
        t.integer("patches", 1, kMostLeast, vehicle.contact.profiles.pair.patches));
    vehicle.tables = std::move(profiles.tables);
  }
  vehicle.contact.creep = read_creep(t, vehicle.contact, radius, scene.rail, vehicle.friction);
  vehicle.contact.relaxation =
      t.number("relaxation_m", between(0.0, 1.0),
               relaxation_length(vehicle.contact, radius, mean_load(vehicle.runner), scene.rail));
}

Runner read_runner_of(const Table& t) {
  Runner runner =
      !t.has("file") ? read_runner(t) : read_toml(t.path("file")).whole([](const Table& root) {
        static_cast<void>(root.integer("schema", 1, 1));
        static_cast<void>(root.table("vehicle").string("type"));
        for (const char* text : {"name", "source"})
          if (root.has(text)) static_cast<void>(root.string(text));
        return read_runner(root);
      });
  try {
    balance_preloads(runner, kGravity);
  } catch (const Refused& error) {
    t.refuse(t.has("file") ? "file" : "element", error.id(), error.sentence());
  }
  return runner;
}

/// [[vehicle.force]] along a motion of a body.
OuterForce read_force_in_space(const Table& t, const Runner& runner,
                               std::vector<InputScene>& inputs) {
  const auto body = static_cast<int>(read_forced_body(t, body_names(runner)));
  const auto motion =
      static_cast<int>(t.choice("direction", {"x", "y", "z", "roll", "pitch", "yaw"}));
  return read_body_force(t, kMotions * body + motion, motion >= index_of(BodyMotion::roll), inputs);
}

/// [[vehicle.brake]] on a wheelset.
RunnerForceElement read_brake(const Table& t, const Runner& runner,
                              std::vector<InputScene>& inputs) {
  RunnerForceElement brake{};
  brake.name = checked_name(t, "name", t.string("name"));
  const std::vector<std::string> names = body_names(runner);
  const auto body_of = [&](const char* key, const std::string& name) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end())
      t.refuse(key, "E-VEHICLE-30",
               fmt::format("{} = \"{}\" is not a body of the vehicle; expected one of {}", key,
                           name, fmt::join(names, ", ")));
    return static_cast<int>(found - names.begin());
  };
  brake.a = body_of("wheelset", t.string("wheelset"));
  const RunnerBody& wheelset = runner.bodies[static_cast<std::size_t>(brake.a)];
  if (!wheelset.is_wheelset())
    t.refuse("wheelset", "E-VEHICLE-32",
             fmt::format("wheelset = \"{}\" has no wheels; expected a wheelset", wheelset.name));
  const std::string on = t.string("on");
  brake.b = on == "ground" ? kGround : body_of("on", on);
  if (brake.b == brake.a)
    t.refuse("on", "E-VEHICLE-33",
             "a brake acts between a wheelset and itself; expected another body, or \"ground\"");
  brake.axis = index_of(BodyMotion::pitch);
  brake.law = ElementLaw::slider;
  brake.stiffness = t.number("stiffness_n_m_per_rad", above_upto(0.0, 1e12), 1e7);
  brake.damping = t.number("damping_n_m_s_per_rad", between(0.0, 1e12), 5e4);
  brake.per_way = 1. / wheelset.radius;
  const OuterForce limit = read_body_force(t, 0, true, inputs);
  brake.value = limit.table;
  brake.input = limit.input;
  for (std::size_t i = 1; i < brake.value.size(); i += 2)
    if (!(brake.value[i] >= 0.))
      t.refuse(
          "table", "E-VEHICLE-31",
          fmt::format("a brake has the moment {:.15g} N m; expected 0 or more: it acts against "
                      "the wheelset's turn",
                      brake.value[i]));
  return brake;
}

}  // namespace

std::vector<std::string> body_names(const Runner& runner) {
  std::vector<std::string> names;
  for (const RunnerBody& body : runner.bodies) names.push_back(body.name);
  return names;
}

bool is_rail_vehicle(const Table& t) {
  constexpr const char* kType = "rail_vehicle";
  if (!t.has("file")) return t.has("type") && t.string("type") == kType;
  const Table root = read_toml(t.path("file"));
  const std::optional<Table> vehicle = root.table_if("vehicle");
  return vehicle && vehicle->has("type") && vehicle->string("type") == kType;
}

RailVehicleScene read_rail_vehicle(const Table& root, const Table& t, const Scene& scene,
                                   std::vector<InputScene>& inputs) {
  if (scene.track.rails == 1)
    t.refuse("", "E-VEHICLE-26",
             "a rail vehicle runs on two rails, but the track has one; expected track.rails = 2");
  RailVehicleScene v{};
  v.name = checked_name(t, "name", t.string("name"));
  if (!t.has("file")) static_cast<void>(t.string("type"));
  v.runner = read_runner_of(t);
  v.parts = {{v.name, 0, v.runner.bodies.size()}};
  for (const RunnerBody& body : v.runner.bodies)
    if (body.is_wheelset()) v.wheelsets.push_back(v.name + "." + body.name);
  for (const RunnerElement& element : v.runner.elements)
    if (element.kind == RunnerElement::Kind::rod) v.rods.push_back(v.name + "." + element.name);
  for (const RunnerElement& element : v.runner.elements)
    v.traced.insert(v.traced.end(), traced_entries(element).size(), v.name + "." + element.name);
  for (const RunnerForceElement& element : v.runner.force_elements)
    v.force_elements.push_back(v.name + "." + element.name);
  read_rolling(root, scene, v);
  v.start = t.number("start_m", between(-1e6, 1e6), 0.0);
  v.rolls_freely = t.has("drive") && t.choice("drive", {"speed", "force"}) == 1;
  if (v.rolls_freely && t.has("speed_table"))
    t.refuse("speed_table", "E-VEHICLE-28",
             "the speed of a vehicle with drive = \"force\" follows from its forces; expected "
             "speed_m_per_s, from which on it rolls");
  if (v.rolls_freely && scene.track.endless && !scene.track.rigid)
    t.refuse("drive", "E-VEHICLE-29",
             "a track without end goes along with vehicles of one given speed; expected drive = "
             "\"speed\", or a track with ends or of form \"rigid\"");
  const SpeedScene speed = read_speed(t, std::nullopt);
  v.speed = speed.speed;
  v.speeds = speed.speeds;
  for (const Table& force : t.tables("force"))
    v.forces.push_back(read_force_in_space(force, v.runner, inputs));
  const auto add = [&](RunnerForceElement element) {
    v.force_elements.push_back(v.name + "." + element.name);
    v.runner.force_elements.push_back(std::move(element));
  };
  for (const Table& brake : t.tables("brake")) add(read_brake(brake, v.runner, inputs));
  for (const Table& actuator : t.tables("actuator")) add(read_actuator(actuator, v.runner, inputs));
  return v;
}

}  // namespace railstep
