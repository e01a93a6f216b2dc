#include "answer/assessed_signals.h"

#include <algorithm>
#include <cmath>

#include "online/track/along_line.h"
#include "online/track/travel.h"

namespace railstep {

TraceRows::TraceRows(const Simulation& run, const RunRecord& record)
    : columns_(run.columns()),
      values_(record.rows),
      rows_(record.rows.size() / run.columns().size()),
      interval_(run.model().scheme.dt * static_cast<double>(run.model().steps_per_frame)) {}

std::vector<double> TraceRows::column(const std::string& name) const {
  const auto found = std::find(columns_.begin(), columns_.end(), name);
  if (found == columns_.end()) return {};
  const auto at = static_cast<std::size_t>(found - columns_.begin());
  std::vector<double> values(rows_);
  for (std::size_t r = 0; r < rows_; ++r) values[r] = values_[r * columns_.size() + at];
  return values;
}

Way way_of(const Simulation& run, const TraceRows& rows, std::size_t vehicle,
           const RailVehicleScene& scene) {
  const RunnerModel& runner = run.model().runner[vehicle];
  const std::vector<double> ahead = rows.column(scene.name + ".x_m"),
                            faster = rows.column(scene.name + ".speed_m_per_s");
  const double first = scene.start + scene.runner.bodies.front().centre[0];
  Way way{{}, std::vector<double>(rows.rows(), 0.), 1.};
  for (std::size_t r = 0; r < rows.rows(); ++r) {
    const Travelled frame = travelled(runner.travel, rows.interval() * static_cast<double>(r));
    way.at.push_back({first + (frame.distance + (ahead.empty() ? 0. : ahead[r])),
                      frame.speed + (faster.empty() ? 0. : faster[r]), frame.acceleration});
  }
  // A vehicle that rolls freely is faster or slower by itself.
  for (std::size_t r = 1; r < faster.size(); ++r)
    way.at[r].faster += (faster[r] - faster[r - 1]) / rows.interval();
  const double start = way.at.front().place;
  if (way.at.back().place < start) way.direction = -1.;
  for (std::size_t r = 1; r < rows.rows(); ++r)
    way.distance[r] = std::max(way.distance[r - 1], way.direction * (way.at[r].place - start));
  return way;
}

OverWay over_way(const Way& way, const std::vector<double>& values) {
  OverWay over{{way.distance.front()}, {values.front()}};
  for (std::size_t r = 1; r < values.size(); ++r) {
    if (!(way.distance[r] > over.distance.back())) continue;
    over.distance.push_back(way.distance[r]);
    over.value.push_back(values[r]);
  }
  return over;
}

namespace {

struct Vector {
  double x, y, z;
};
Vector cross(const Vector& a, const Vector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Acceleration of a point that is at rest in a body's frame, without gravity's part on straight
/// track. @param arm  from the frame's origin
Vector carried(const FrameMotion& frame, const Vector& arm) {
  const Vector rate{frame.rate[0], frame.rate[1], frame.rate[2]},
      angular{frame.angular[0], frame.angular[1], frame.angular[2]};
  const Vector turned = cross(angular, arm), inwards = cross(rate, cross(rate, arm));
  return {frame.acceleration[0] + turned.x + inwards.x,
          frame.acceleration[1] + turned.y + inwards.y,
          frame.acceleration[2] + turned.z + inwards.z};
}

/// NAME.BODY of a vehicle's body; of trains the vehicle's own name.
std::string body_name(const RailVehicleScene& vehicle, std::size_t body) {
  for (const RailVehicleScene::Part& part : vehicle.parts)
    if (body >= part.first && body < part.first + part.bodies)
      return part.name + "." + vehicle.runner.bodies[body].name;
  return {};
}

}  // namespace

FeltAccelerations felt_at(const Simulation& run, const TraceRows& rows, const Way& way,
                          const RailVehicleScene& vehicle, const RailVehicleSensor& sensor,
                          const std::string& name) {
  const DesignLine& line = run.model().design_line;
  const auto& bodies = vehicle.runner.bodies;
  const auto& centre = bodies[sensor.body].centre;
  const double behind = centre[0] - bodies.front().centre[0];
  const Vector arm{sensor.point[0], centre[1] + sensor.point[1], centre[2] + sensor.point[2]};
  FeltAccelerations felt{rows.column(name + ".ay_m_per_s2"), rows.column(name + ".az_m_per_s2")};
  const std::vector<double> roll = rows.column(body_name(vehicle, sensor.body) + ".roll_rad");
  for (std::size_t r = 0; r < rows.rows(); ++r) {
    Vector feels{0., felt.y[r], felt.z[r]};
    if (is_there(line)) {
      const OnLine& at = way.at[r];
      // Rates that jump do so within a step, as the step has it.
      const FrameMotion frame = frame_motion(line, at.place + behind, at.speed, at.faster,
                                             run.model().scheme.dt, vehicle.gravity);
      const Vector of_frame = carried(frame, arm);
      feels.y += of_frame.y;
      feels.z += of_frame.z;
    }
    const double rolls = roll.empty() ? 0. : roll[r];
    felt.y[r] = feels.y + rolls * (vehicle.gravity + feels.z);
    felt.z[r] = feels.z - rolls * feels.y;
  }
  return felt;
}

}  // namespace railstep
