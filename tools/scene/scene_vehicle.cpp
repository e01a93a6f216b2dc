#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "offline/math/constants.h"
#include "offline/pack/travel_rows.h"
#include "scene/scene_read.h"

namespace railstep {
namespace {

const Range kMass = above_upto(0.0, 1e7);              // kg
const Range kInertia = above_upto(0.0, 1e9);           // kg m2
const Range kSpringStiffness = above_upto(0.0, 1e13);  // N/m
const Range kSpringDamping = between(0.0, 1e11);       // N s/m
const Range kRadius = between(0.02, 3.0);              // m

BogieData read_bogie(const Table& t) {
  BogieData b{};
  b.frame_mass = t.number("frame_mass_kg", kMass);
  b.frame_inertia = t.number("frame_inertia_kg_m2", kInertia);
  b.wheel_mass = t.number("wheel_mass_kg", kMass);
  b.wheelbase = t.number("wheelbase_m", above_upto(0.0, 100.0));
  b.axles = static_cast<int>(t.integer("axles", 2, 3, 2));
  b.primary_stiffness = t.number("primary_stiffness_n_per_m", kSpringStiffness);
  b.primary_damping = t.number("primary_damping_n_s_per_m", kSpringDamping, 0.0);
  b.radius = t.number("radius_m", kRadius, kWheelRadius);
  return b;
}

NamedVehicle read_sprung(const Table& t) {
  const double mass = t.number("mass_kg", kMass);
  const double unsprung = t.number("unsprung_mass_kg", kMass);
  const double stiffness = t.number("stiffness_n_per_m", kSpringStiffness);
  const double damping = t.number("damping_n_s_per_m", kSpringDamping, 0.0);
  return sprung_mass(mass, unsprung, stiffness, damping,
                     t.number("radius_m", kRadius, kWheelRadius));
}

NamedVehicle read_car(const Table& t) {
  CarData c{};
  c.bogie = read_bogie(t);
  c.body_mass = t.number("body_mass_kg", kMass);
  c.body_inertia = t.number("body_inertia_kg_m2", kInertia);
  c.bogie_distance = t.number("bogie_distance_m", above_upto(c.bogie.wheelbase, 1000.0));
  c.secondary_stiffness = t.number("secondary_stiffness_n_per_m", kSpringStiffness);
  c.secondary_damping = t.number("secondary_damping_n_s_per_m", kSpringDamping, 0.0);
  return car(c);
}

/// Bodies and springs of a vehicle by its type. The spring of a sprung mass without an unsprung
/// mass is its contact.
NamedVehicle read_bodies(const Table& t, VehicleScene& v) {
  switch (t.choice("type", {"mass", "sprung_mass", "bogie", "vehicle"})) {
    case 0:
      v.contact = WheelContactKind::bonded;
      return point_mass(t.number("mass_kg", kMass), t.number("radius_m", kRadius, kWheelRadius));
    case 1:
      if (t.has("unsprung_mass_kg")) return read_sprung(t);
      {
        const double mass = t.number("mass_kg", kMass);
        v.contact = WheelContactKind::linear;
        v.stiffness = t.number("stiffness_n_per_m", kSpringStiffness);
        v.damping = t.number("damping_n_s_per_m", kSpringDamping, 0.0);
        return point_mass(mass);
      }
    case 2: {
      BogieData b = read_bogie(t);
      b.carried = t.number("carried_mass_kg", between(0.0, 1e7), 0.0);
      return bogie(b);
    }
    default:
      return read_car(t);
  }
}

void read_kind(const Table& t, VehicleScene& v) {
  NamedVehicle kind = read_bodies(t, v);
  v.vehicle = std::move(kind.vehicle);
  v.bodies = std::move(kind.bodies);
}

/// Reads an upright vehicle itself, here or from a file of its own.
void read_what(const Table& t, VehicleScene& v) {
  if (!t.has("file")) return read_kind(t, v);
  if (t.has("type"))
    t.refuse("type", "E-VEHICLE-03",
             "type is given beside file, which has its own type; expected one of them");
  read_toml(t.path("file")).whole([&](const Table& root) {
    static_cast<void>(root.integer("schema", 1, 1));  // a newer one is refused
    read_kind(root.table("vehicle"), v);
    for (const char* text : {"name", "source"})
      if (root.has(text)) static_cast<void>(root.string(text));
    return 0;
  });
}

/// Reads the contact of its wheels, unless its type says it.
void read_contact(const Table& t, VehicleScene& v) {
  if (v.contact == WheelContactKind::linear) {
    if (t.has("contact"))
      t.refuse("contact", "E-VEHICLE-04",
               "a sprung mass without unsprung_mass_kg stands on its spring, which is "
               "its contact; expected no key contact, or unsprung_mass_kg");
    return;
  }
  const std::size_t otherwise = v.contact == WheelContactKind::bonded ? 2 : 0;
  constexpr WheelContactKind kContacts[] = {WheelContactKind::hertz, WheelContactKind::linear,
                                            WheelContactKind::bonded};
  v.contact = kContacts[t.choice("contact", {"hertz", "linear", "bonded"}, otherwise)];
  const char* const keys[] = {"contact_stiffness_n_per_m", "contact_damping_n_s_per_m"};
  if (v.contact == WheelContactKind::linear) {
    v.stiffness = t.number(keys[0], kSpringStiffness);
    v.damping = t.number(keys[1], kSpringDamping, 0.0);
    return;
  }
  for (const char* key : keys)
    if (t.has(key))
      t.refuse(key, "E-VEHICLE-05",
               fmt::format(
                   "{} belongs to a linear contact; expected contact = \"linear\" beside it", key));
}

/// Refuses a vehicle with a wheel that leaves the rail before the end of the run.
void check_wheels(const Table& t, const Scene& scene, const VehicleScene& v,
                  const SpeedScene& speed) {
  for (const Vehicle::Wheel& wheel : v.vehicle.wheels) {
    const double start = v.start + wheel.place;
    if (start < 0.0 || start > scene.track.length())
      t.refuse("start_m", "E-VEHICLE-11",
               fmt::format("start_m = {:.15g} puts a wheel at x = {:.6g} m, off the rail; expected "
                           "0 to {:.6g} m, or may_leave_rail = true",
                           v.start, start, scene.track.length()));
    check_path(t, scene, start, speed);
  }
}

/// [[vehicle.force]] along the height or the pitch of a body.
OuterForce read_force(const Table& t, const VehicleScene& v, std::vector<InputScene>& inputs) {
  const std::size_t body = read_forced_body(t, v.bodies);
  const int pitch = static_cast<int>(t.choice("direction", {"z", "pitch"}));
  if (pitch == 1 && v.vehicle.bodies[body].pitch_inertia == 0.)
    t.refuse("direction", "E-VEHICLE-13",
             fmt::format("direction = \"pitch\", but {} does not pitch; expected \"z\"",
                         v.bodies[body]));
  return read_body_force(t, first_coordinates(v.vehicle)[body] + pitch, pitch == 1, inputs);
}

/// Reads how a vehicle falls onto the track, if it does.
std::optional<Falling> read_falling(const Table& t, const Scene& scene, const VehicleScene& v) {
  const char* const keys[] = {"drop_height_m", "drop_speed_m_per_s"};
  for (const char* key : keys) {
    if (t.has(key) && v.contact != WheelContactKind::hertz)
      t.refuse(key, "E-VEHICLE-09",
               fmt::format("{} belongs to a wheel that can leave the rail; expected contact = "
                           "\"hertz\" beside it",
                           key));
    if (t.has(key) && scene.step && scene.step->start != Start::released)
      t.refuse(key, "E-VEHICLE-10",
               fmt::format("{} belongs to a vehicle that does not stand on the track at the start; "
                           "expected step.start = \"released\"",
                           key));
  }
  if (!t.has(keys[0]) && !t.has(keys[1])) return std::nullopt;
  return Falling{t.number(keys[0], between(0.0, 10.0), 0.0),
                 t.number(keys[1], between(0.0, 100.0), 0.0)};
}

/// One vehicle for each rail that the table names.
void read_vehicle(const Table& t, const Scene& scene, std::vector<VehicleScene>& vehicles,
                  std::vector<InputScene>& inputs) {
  VehicleScene v{};
  v.table = v.name = checked_name(t, "name", t.string("name"));
  const bool both = t.has("rail") && t.string("rail") == "both";
  if (both && scene.track.rails == 1)
    t.refuse("rail", "E-VEHICLE-14",
             "rail = \"both\", but the track has one rail; expected \"left\"");
  v.rail = both ? kLeftRail : read_side(t, scene);
  read_what(t, v);
  read_contact(t, v);
  v.may_leave_rail = t.boolean("may_leave_rail", false);
  v.start = t.number("start_m", between(-1e6, 1e6));
  const SpeedScene speed = read_speed(t, std::nullopt);
  v.speed = speed.speed;
  v.speeds = speed.speeds;
  v.gravity = t.boolean("gravity", true) ? kGravity : 0.;
  v.falling = read_falling(t, scene, v);
  v.treads = read_wheel_treads(t, scene, v);
  for (const Table& force : t.tables("force")) v.forces.push_back(read_force(force, v, inputs));
  if (!v.may_leave_rail) check_wheels(t, scene, v, speed);
  if (!both) return vehicles.push_back(std::move(v));
  for (const int rail : {kLeftRail, kRightRail}) {
    vehicles.push_back(v);
    vehicles.back().rail = rail;
    vehicles.back().name += rail == kLeftRail ? "_left" : "_right";
  }
}

}  // namespace

std::size_t read_forced_body(const Table& t, const std::vector<std::string>& bodies) {
  const std::string name = t.string("body");
  const auto found = std::find(bodies.begin(), bodies.end(), name);
  if (found == bodies.end())
    t.refuse("body", "E-VEHICLE-12",
             fmt::format("body = \"{}\" is not a body of this vehicle; expected one of {}", name,
                         fmt::join(bodies, ", ")));
  return static_cast<std::size_t>(found - bodies.begin());
}

std::vector<VehicleScene> read_vehicles(const Table& root, const Scene& scene,
                                        std::vector<InputScene>& inputs,
                                        std::vector<RailVehicleScene>& rail_vehicles) {
  std::vector<VehicleScene> vehicles;
  const bool known = root.each("vehicle", [&](const Table& t) {
    if (is_rail_vehicle(t))
      rail_vehicles.push_back(read_rail_vehicle(root, t, scene, inputs));
    else
      read_vehicle(t, scene, vehicles, inputs);
  });
  if (!known) root.leave_open("contact");  // a rail vehicle reads it
  root.attempt(
      {"coupler"}, [&] { read_couplers(root, rail_vehicles); }, known || root.is_tainted());
  return vehicles;
}

bool has_wheels(const Scene& scene) {
  return !scene.wheelsets.empty() || !scene.vehicles.empty() || !scene.rail_vehicles.empty();
}

double fastest_wheel(const Scene& scene) {
  double speed = 0.;
  for (const WheelsetScene& w : scene.wheelsets) speed = std::max(speed, std::fabs(fastest(w)));
  for (const VehicleScene& v : scene.vehicles) speed = std::max(speed, std::fabs(fastest(v)));
  for (const RailVehicleScene& v : scene.rail_vehicles)
    speed = std::max(speed, std::fabs(fastest(v)));
  return speed;
}

}  // namespace railstep
