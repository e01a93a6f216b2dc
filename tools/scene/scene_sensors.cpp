#include <fmt/core.h>

#include <algorithm>

#include "scene/scene_read.h"

namespace railstep {
namespace {

/// Index of `name` in `names`. Refuses an unknown name.
std::size_t index_of(const Table& t, std::string_view key, const std::string& name,
                     const std::vector<std::string>& names) {
  std::string known;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == name) return i;
    known += fmt::format("{}\"{}\"", known.empty() ? "" : ", ", names[i]);
  }
  if (names.empty())
    t.refuse(key, "E-SENSOR-02",
             fmt::format("{0} = \"{1}\", but the scene has no {0}; expected a [[{0}]]", key, name));
  t.refuse(key, "E-SENSOR-01",
           fmt::format("{} = \"{}\" is unknown; expected {}", key, name, known));
}

WheelsetSensor read_wheelset_sensor(const Table& t, const Scene& scene) {
  std::vector<std::string> names;
  for (const WheelsetScene& w : scene.wheelsets) names.push_back(w.name);
  return {index_of(t, "wheelset", t.string("wheelset"), names)};
}

const Range kFromMiddle = between(-100.0, 100.0);  // m

/// A body of a vehicle: the first one unless the table names another.
std::size_t read_sensed_body(const Table& t, const std::vector<std::string>& bodies) {
  return t.has("body") ? index_of(t, "body", t.string("body"), bodies) : 0;
}

/// A point of a vehicle's body over one rail.
VehicleSensor read_upright_sensor(const Table& t, const Scene& scene, std::size_t vehicle) {
  const VehicleScene& own = scene.vehicles[vehicle];
  const std::size_t body = read_sensed_body(t, own.bodies);
  VehicleSensor sensor{vehicle, body, t.number("x_m", kFromMiddle, 0.0)};
  if (sensor.ahead != 0.0 && own.vehicle.bodies[body].pitch_inertia == 0.0)
    t.refuse("x_m", "E-SENSOR-06",
             fmt::format("x_m = {:.15g}, but {} does not pitch; expected x_m = 0", sensor.ahead,
                         own.bodies[body]));
  return sensor;
}

/// A vehicle of a train.
struct InSpace {
  std::size_t train;
  RailVehicleScene::Part part;
};

/// A point of a vehicle's body in space.
RailVehicleSensor read_sensor_in_space(const Table& t, const Scene& scene, const InSpace& of) {
  const std::vector<std::string> bodies = body_names(scene.rail_vehicles[of.train].runner);
  const auto first = bodies.begin() + static_cast<std::ptrdiff_t>(of.part.first);
  const std::size_t body =
      read_sensed_body(t, {first, first + static_cast<std::ptrdiff_t>(of.part.bodies)});
  return {of.train,
          of.part.first + body,
          {t.number("x_m", kFromMiddle, 0.0), t.number("y_m", kFromMiddle, 0.0),
           t.number("z_m", kFromMiddle, 0.0)}};
}

void read_vehicle_sensor(const Table& t, const Scene& scene, SensorScene& sensor) {
  std::vector<std::string> vehicles;
  for (const VehicleScene& v : scene.vehicles) vehicles.push_back(v.name);
  std::vector<InSpace> in_space;
  for (std::size_t i = 0; i < scene.rail_vehicles.size(); ++i)
    for (const RailVehicleScene::Part& part : scene.rail_vehicles[i].parts) {
      vehicles.push_back(part.name);
      in_space.push_back({i, part});
    }
  const std::size_t vehicle = index_of(t, "vehicle", t.string("vehicle"), vehicles),
                    upright = scene.vehicles.size();
  if (vehicle < upright)
    sensor.on = read_upright_sensor(t, scene, vehicle);
  else
    sensor.on = read_sensor_in_space(t, scene, in_space[vehicle - upright]);
}

RailSensor read_rail_sensor(const Table& t, const Scene& scene) {
  RailSensor rail{read_side(t, scene), 0.0, Height::axis};
  rail.position = t.number("position_m", between(0.0, (1.0 + 1e-12) * scene.track.length()));
  const Height heights[] = {Height::axis, Height::head, Height::foot};
  rail.at = heights[t.choice("at", {"axis", "head", "foot"}, 0)];
  if (!t.has("gauge_length_m")) return rail;
  rail.gauge_length = t.number("gauge_length_m", between(1e-3, 1.0));
  const double half = 0.5 * *rail.gauge_length;
  if (!scene.track.endless && (rail.position < half || rail.position > scene.track.length() - half))
    t.refuse("gauge_length_m", "E-SENSOR-03",
             fmt::format("gauge_length_m = {:.15g} at position_m = {:.15g} reaches beyond the "
                         "rail; expected at most twice the distance to the rail's end",
                         *rail.gauge_length, rail.position));
  return rail;
}

SleeperSensor read_sleeper_sensor(const Table& t, const Scene& scene) {
  if (!scene.sleeper)
    t.refuse("on", "E-SENSOR-04",
             "on = \"sleeper\", but the scene has no [sleeper]; expected \"rail\", "
             "\"wheelset\" or \"vehicle\"");
  SleeperSensor sleeper{t.integer("sleeper", 0, scene.track.bays), std::nullopt};
  for (const SeatChange& change : scene.seat_changes)
    if (change.missing == Missing::sleeper &&
        std::find(change.seats.begin(), change.seats.end(), sleeper.sleeper) != change.seats.end())
      t.refuse("sleeper", "E-SENSOR-05",
               fmt::format("sleeper = {} is missing by a [[support_change]]; expected a sleeper "
                           "that is there",
                           sleeper.sleeper));
  if (t.has("rail")) sleeper.rail = read_side(t, scene);
  return sleeper;
}

}  // namespace

SensorScene read_sensor(const Table& t, const Scene& scene) {
  SensorScene sensor;
  sensor.name = checked_name(t, "name", t.string("name"));
  switch (t.choice("on", {"rail", "sleeper", "wheelset", "vehicle"})) {
    case 0:
      sensor.on = read_rail_sensor(t, scene);
      break;
    case 1:
      sensor.on = read_sleeper_sensor(t, scene);
      break;
    case 2:
      sensor.on = read_wheelset_sensor(t, scene);
      break;
    default:
      read_vehicle_sensor(t, scene, sensor);
  }
  return sensor;
}

std::vector<SensorScene> read_sensors(const Table& root, const Scene& scene) {
  std::vector<SensorScene> sensors;
  root.each("sensor", [&](const Table& t) { sensors.push_back(read_sensor(t, scene)); });
  return sensors;
}

}  // namespace railstep
