#include "build/build_sensors.h"

#include <fmt/core.h>

#include <Eigen/Core>
#include <array>
#include <initializer_list>
#include <optional>
#include <utility>

#include "build/build.h"
#include "build/build_endless.h"
#include "offline/math/refuse.h"
#include "online/step/trace_columns.h"

namespace railstep {
namespace {

/// One direction of a sensor: its place at rest and the functional that moves it.
struct Direction {
  double rest = 0.;   // m; x along the track's elements
  double moved = 0.;  // at the start, of a sensor that moves with the traffic
  Functional track;
  std::optional<RunnerSum> runner;  // in place of `track`
};
using Point = std::array<Direction, 3>;

/// @param axis_z  height of the sensor's rail over the left rail's axis, m
Point point_of(const RailSensor& sensor, const Track& track, double z, double axis_z) {
  const int rail = sensor.rail;
  const double y = track.rails == 1 ? 0. : (rail == 0 ? .5 : -.5) * track.rail_spacing;
  const double in_section[3] = {sensor.position, 0., z};
  std::array<double, 3> rest;
  to_track(track.lean(rail), in_section, rest.data());
  rest[1] += y;
  rest[2] += axis_z;
  Point point;
  for (int d = 0; d < 3; ++d)
    point[static_cast<std::size_t>(d)] = {rest[static_cast<std::size_t>(d)],
                                          0.,
                                          {.rail = {{{rail, sensor.position, 0., z, d}, 1.}}},
                                          {}};
  return point;
}

/// An end of a sleeper, or its centre: the mean of its ends.
Point point_of(const SleeperSensor& sensor, const Track& track, double z) {
  const int seat = static_cast<int>(sensor.sleeper);
  std::array<double, 3> rest = {seat * track.bay_length, 0., z};
  if (sensor.rail) rest[1] = (*sensor.rail == kRightRail ? -.5 : .5) * track.rail_spacing;
  Point point;
  for (int d = 0; d < 3; ++d) {
    Direction& direction = point[static_cast<std::size_t>(d)];
    direction.rest = rest[static_cast<std::size_t>(d)];
    for (int rail = 0; rail < track.rails; ++rail) {
      if (sensor.rail && rail != *sensor.rail) continue;
      direction.track.sleeper.push_back({rail, seat, d, sensor.rail ? 1. : 1. / track.rails});
    }
  }
  return point;
}

Point point_of(const WheelsetSensor& sensor, const Scene& scene, const Track& track,
               const Railhead& head, double origin) {
  const WheelsetScene& w = scene.wheelsets[sensor.wheelset];
  Point point;
  point[0].rest = origin + w.start;
  point[0].moved = origin;
  point[2].rest = crown_top(track.lean(0), head.top_z, head.crown_radius).height + w.radius;
  for (int d = 0; d < 3; ++d)
    point[static_cast<std::size_t>(d)].runner = {
        RunnerSum::Of::wheelset, sensor.wheelset, {{d, 1.}}};
  return point;
}

/// Displacement, velocity and acceleration along an axis.
void add_motion(const std::string& name, const char* axis, const RunnerSum& sum, Sensors& sensors) {
  const auto add = [&](const char* quantity, const char* unit, TrackSensor track_sensor) {
    track_sensor.runner = sum;
    sensors.columns.push_back(fmt::format("{}.{}{}_{}", name, quantity, axis, unit));
    sensors.track_sensors.push_back(std::move(track_sensor));
  };
  add("", "m", {.displacement = 1.});
  add("v", "m_per_s", {.velocity = 1.});
  add("a", "m_per_s2", {.acceleration = 1.});
}

/// Motion of a point of a vehicle's body: z as in its body's columns.
void add_vehicle_point(const std::string& name, const VehicleSensor& sensor, const Scene& scene,
                       Sensors& sensors) {
  const int z = first_coordinates(scene.vehicles[sensor.vehicle].vehicle)[sensor.body];
  RunnerSum sum{RunnerSum::Of::vehicle, sensor.vehicle, {{z, 1.}}};
  if (sensor.ahead != 0.) sum.parts.push_back({z + 1, -sensor.ahead});  // pitch turns it down
  add_motion(name, "z", sum, sensors);
}

/// The same in space, along y and z. Axle boxes do not spin with their wheelset.
void add_point_in_space(const std::string& name, const RailVehicleSensor& sensor,
                        const Scene& scene, Sensors& sensors) {
  const RunnerBody& body = scene.rail_vehicles[sensor.vehicle].runner.bodies[sensor.body];
  const auto sum = [&](std::initializer_list<std::pair<BodyMotion, double>> parts) {
    RunnerSum made{RunnerSum::Of::rail_vehicle, sensor.vehicle, {}};
    for (const auto& [motion, factor] : parts)
      if (motion != BodyMotion::pitch || !body.is_wheelset())
        made.parts.push_back({kMotions * static_cast<int>(sensor.body) + index_of(motion), factor});
    return made;
  };
  const auto& [x, y, z] = sensor.point;
  add_motion(name, "y", sum({{BodyMotion::y, 1.}, {BodyMotion::roll, -z}, {BodyMotion::yaw, x}}),
             sensors);
  add_motion(name, "z", sum({{BodyMotion::z, 1.}, {BodyMotion::roll, y}, {BodyMotion::pitch, -x}}),
             sensors);
}

/// The motions of a rail vehicle's bodies other than wheelsets, which have columns of their own.
void add_bodies(const RailVehicleScene& vehicle, const RailVehicleScene::Part& part,
                std::size_t index, Sensors& sensors) {
  constexpr const char* kNames[kMotions] = {"x_m",      "y_m",       "z_m",
                                            "roll_rad", "pitch_rad", "yaw_rad"};
  for (std::size_t b = part.first; b < part.first + part.bodies; ++b) {
    const RunnerBody& body = vehicle.runner.bodies[b];
    if (body.is_wheelset()) continue;
    for (int k = 1; k < kMotions; ++k) {  // x is prescribed
      TrackSensor sensor{.displacement = 1.};
      sensor.runner = {
          RunnerSum::Of::rail_vehicle, index, {{kMotions * static_cast<int>(b) + k, 1.}}};
      sensors.columns.push_back(fmt::format("{}.{}.{}", part.name, body.name, kNames[k]));
      sensors.track_sensors.push_back(std::move(sensor));
    }
  }
}

void add_in_space(const RailVehicleScene& vehicle, std::size_t index, Sensors& sensors) {
  for (const RailVehicleScene::Part& part : vehicle.parts)
    add_bodies(vehicle, part, index, sensors);
}

void add_point(const std::string& name, const Point& point, Sensors& sensors) {
  for (const SensorColumn& column : kSensorColumns) {
    const int d = column.direction;
    const Direction& own = point[static_cast<std::size_t>(d)];
    TrackSensor track_sensor;
    switch (column.quantity) {
      case SensorQuantity::position:
        track_sensor = {.rest = own.rest, .displacement = 1., .along = d == 0};
        break;
      case SensorQuantity::displacement:
        track_sensor = {
            .rest = own.moved, .displacement = 1., .along = d == 0 && own.runner.has_value()};
        break;
      case SensorQuantity::velocity:
        track_sensor = {.velocity = 1.};
        break;
    }
    track_sensor.track = own.track;
    track_sensor.runner = own.runner;
    sensors.columns.push_back(fmt::format("{}.{}", name, column.name));
    sensors.track_sensors.push_back(std::move(track_sensor));
  }
}

/// Reading of a strain gauge on a rail times Young's modulus: the mean strain along x over its
/// length, by the motion of the rail from rest.
void add_gauge(const std::string& name, const RailSensor& sensor, double z, double young,
               Sensors& sensors) {
  const int rail = sensor.rail;
  const double length = *sensor.gauge_length;
  TrackSensor track_sensor{.displacement = young};
  for (const double side : {-1., 1.})
    track_sensor.track.rail.push_back(
        {{rail, sensor.position + .5 * side * length, 0., z, 0}, side / length});
  sensors.columns.push_back(name + ".stress_x_pa");
  sensors.track_sensors.push_back(std::move(track_sensor));
}

/// Forces of those one-sided springs of a track that `chosen` picks.
template <typename Chosen>
TrackSensor press_of(const Track& track, const Chosen& chosen) {
  const std::vector<FixedPort> ports = fixed_ports(track);
  TrackSensor track_sensor;
  for (std::size_t j = 0; j < ports.size(); ++j)
    if (chosen(ports[j])) track_sensor.ports.push_back({static_cast<int>(j), 1.});
  return track_sensor;
}

/// Force of a seat on its rail along the pad's normal, up positive: its spring and damper on the
/// gap between foot and sleeper.
void add_support(int rail, int seat, const Track& track, Sensors& sensors) {
  const Support pad = track.seat(seat).pad[static_cast<std::size_t>(rail)];
  TrackSensor track_sensor;
  if (pad.one_sided()) {
    track_sensor = press_of(track, [&](const FixedPort& port) {
      return port.of == FixedPort::Of::pad && port.rail == rail && port.seat == seat;
    });
  } else {
    const Functional gap = pad_gap(track, rail, seat);
    track_sensor = {.displacement = -pad.stiffness[2], .velocity = -gap.part * pad.damping[2]};
    track_sensor.track = gap;
  }
  sensors.columns.push_back(fmt::format("support_{}{}.force_z_n", rail == 0 ? "" : "right_", seat));
  sensors.track_sensors.push_back(std::move(track_sensor));
}

/// Moves a sensor from the scene's places to those of a ring or window, where x = 0 of the scene
/// lies some bays ahead.
void move_on(SensorScene& sensor, int behind, const Track& track) {
  const auto refuse = [&](const std::string& place) {
    railstep::refuse(
        "E-SENSOR-07",
        fmt::format("sensor \"{}\" is at {}, beyond the {} bays of the ring or window that "
                    "lie ahead of x = 0; expected a place within them, or more track.bays",
                    sensor.name, place, track.bays - behind));
  };
  if (auto* rail = std::get_if<RailSensor>(&sensor.on)) {
    rail->position += behind * track.bay_length;
    if (rail->position > (1. + 1e-12) * track.length())
      refuse(fmt::format("{:.6g} m", rail->position - behind * track.bay_length));
  } else if (auto* sleeper = std::get_if<SleeperSensor>(&sensor.on)) {
    sleeper->sleeper += behind;
    if (sleeper->sleeper > track.bays) refuse(fmt::format("sleeper {}", sleeper->sleeper - behind));
  }
}

/// Heights of a vehicle's bodies over their places on a level rail without weight, and pitches.
void add_bodies(const VehicleScene& scene, std::size_t vehicle, Sensors& sensors) {
  const std::vector<int> first = first_coordinates(scene.vehicle);
  for (std::size_t b = 0; b + 1 < first.size(); ++b)
    for (int c = first[b]; c < first[b + 1]; ++c) {
      sensors.columns.push_back(fmt::format("{}.{}.{}", scene.name, scene.bodies[b],
                                            c == first[b] ? "z_m" : "pitch_rad"));
      TrackSensor sensor{.displacement = 1.};
      sensor.runner = {RunnerSum::Of::vehicle, vehicle, {{c, 1.}}};
      sensors.track_sensors.push_back(std::move(sensor));
    }
}

void add_rail_sensor(const std::string& name, const RailSensor& sensor, const Scene& scene,
                     const Track& track, const RailSections& sections, Sensors& sensors) {
  const double z = height_z(sensor.at, section_of(sections, sensor.rail));
  add_point(name, point_of(sensor, track, z, rail_z(scene, sections, track, sensor.rail)), sensors);
  if (!sensor.gauge_length) return;
  const bool right = sensor.rail == kRightRail && scene.right_rail;
  add_gauge(name, sensor, z, (right ? *scene.right_rail : scene.rail).young, sensors);
}

}  // namespace

Sensors sensors_of(const Scene& scene, const Track& track, const RailSections& sections,
                   const Railhead& head) {
  Sensors sensors;
  for (std::size_t i = 0; i < scene.vehicles.size(); ++i) add_bodies(scene.vehicles[i], i, sensors);
  for (std::size_t i = 0; i < scene.rail_vehicles.size(); ++i)
    add_in_space(scene.rail_vehicles[i], i, sensors);
  const int behind = scene.track.endless ? bays_behind(scene) : 0;
  for (SensorScene sensor : scene.sensors) {
    move_on(sensor, behind, track);
    if (const auto* rail = std::get_if<RailSensor>(&sensor.on))
      add_rail_sensor(sensor.name, *rail, scene, track, sections, sensors);
    else if (const auto* sleeper = std::get_if<SleeperSensor>(&sensor.on))
      add_point(sensor.name, point_of(*sleeper, track, height_z(Height::foot, sections[0])),
                sensors);
    else if (const auto* vehicle = std::get_if<VehicleSensor>(&sensor.on))
      add_vehicle_point(sensor.name, *vehicle, scene, sensors);
    else if (const auto* in_space = std::get_if<RailVehicleSensor>(&sensor.on))
      add_point_in_space(sensor.name, *in_space, scene, sensors);
    else
      add_point(sensor.name,
                point_of(std::get<WheelsetSensor>(sensor.on), scene, track, head,
                         behind * track.bay_length),
                sensors);
  }
  for (int rail = 0; rail < track.rails && scene.trace_supports; ++rail)
    for (int seat = 0; seat <= track.bays; ++seat) add_support(rail, seat, track, sensors);
  for (std::size_t i = 0; i < scene.stops.size(); ++i) {
    sensors.columns.push_back(scene.stops[i].name + ".force_n");
    sensors.track_sensors.push_back(press_of(track, [&](const FixedPort& port) {
      return port.of == FixedPort::Of::stop && port.stop == static_cast<int>(i);
    }));
  }
  return sensors;
}

std::optional<Functional> functional_of(const SensorScene& sensor, const Scene& scene,
                                        const Track& track, int direction) {
  const auto d = static_cast<std::size_t>(direction);
  if (const auto* rail = std::get_if<RailSensor>(&sensor.on)) {
    const RailSections sections = sections_of(scene);
    return point_of(*rail, track, height_z(rail->at, section_of(sections, rail->rail)),
                    rail_z(scene, sections, track, rail->rail))[d]
        .track;
  }
  if (const auto* sleeper = std::get_if<SleeperSensor>(&sensor.on))
    return point_of(*sleeper, track, 0.)[d].track;
  return std::nullopt;
}

}  // namespace railstep
