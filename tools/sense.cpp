#include "sense.h"

#include <fmt/core.h>

#include "build.h"

namespace railstep {
namespace {

double product(const std::vector<std::pair<int, double>>& row, const double* values) {
  double sum = 0.;
  for (const auto& [unknown, coefficient] : row) sum += coefficient * values[unknown];
  return sum;
}

}  // namespace

Sensors::Row Sensors::rail_row(const RailPoint& point) const {
  Row row;
  for (std::size_t l = 0; l < lines_.size(); ++l) {
    const Eigen::SparseVector<double> part = point_row(track_, lines_[l], point);
    for (Eigen::SparseVector<double>::InnerIterator entry(part); entry; ++entry)
      row.emplace_back(model_.line[l].first + static_cast<int>(entry.index()), entry.value());
  }
  return row;
}

Sensors::Row Sensors::sleeper_row(int rail, int seat, int direction) const {
  Row row;
  for (std::size_t l = 0; l < lines_.size(); ++l) {
    const int unknown = lines_[l].sleeper_unknown_of[static_cast<std::size_t>(seat)]
                                                    [static_cast<std::size_t>(direction)];
    const double factor = lines_[l].rail_factor[static_cast<std::size_t>(rail)];
    const bool flips = lines_[l].mirrored && rail == 1 && direction == 1;
    if (unknown >= 0 && factor != 0.)
      row.emplace_back(model_.line[l].first + unknown, flips ? -factor : factor);
  }
  return row;
}

Sensors::Point Sensors::point_of(const RailSensor& sensor, double z) const {
  const int rail = sensor.rail == Side::right ? 1 : 0;
  Point point{{sensor.position, model_.rail_y[rail], z}, {}};
  for (int d = 0; d < 3; ++d)
    point.direction[static_cast<std::size_t>(d)] = rail_row({rail, sensor.position, 0., z, d});
  return point;
}

Sensors::Point Sensors::point_of(const SleeperSensor& sensor, double z) const {
  const int seat = static_cast<int>(sensor.sleeper);
  Point point{{seat * track_.bay_length, 0., z}, {}};
  if (sensor.rail) point.rest[1] = model_.rail_y[*sensor.rail == Side::right ? 1 : 0];
  for (int d = 0; d < 3; ++d) {
    Row& row = point.direction[static_cast<std::size_t>(d)];
    if (sensor.rail) {
      row = sleeper_row(*sensor.rail == Side::right ? 1 : 0, seat, d);
      continue;
    }
    for (int rail = 0; rail < track_.rails; ++rail)  // the centre: the mean of its ends
      for (const auto& [unknown, coefficient] : sleeper_row(rail, seat, d))
        row.emplace_back(unknown, coefficient / track_.rails);
  }
  return point;
}

Sensors::Sensors(const Scene& scene, const Track& track, const Model& model)
    : track_(track), model_(model), lines_(assemble(track)) {
  const Section section = section_of(scene);
  const double foot = -section.area.centroid_height;
  for (const SensorScene& sensor : scene.sensors) {
    for (const char* quantity : {"x_m", "y_m", "z_m", "dx_m", "dy_m", "dz_m", "vz_m_per_s"})
      columns_.push_back(sensor.name + "." + quantity);
    if (const auto* rail = std::get_if<RailSensor>(&sensor.on)) {
      const double z = rail->at == Height::axis   ? 0.
                       : rail->at == Height::foot ? foot
                                                  : foot + section.height;
      points_.push_back(point_of(*rail, z));
    } else if (const auto* sleeper = std::get_if<SleeperSensor>(&sensor.on)) {
      points_.push_back(point_of(*sleeper, foot));
    } else {
      const WheelsetModel& w = model.wheelset[std::get<WheelsetSensor>(sensor.on).wheelset];
      Point point{{w.start, 0., w.rest_z}, {}};
      for (int d = 0; d < 3; ++d)
        point.direction[static_cast<std::size_t>(d)] = {{w.first + d, 1.}};
      points_.push_back(point);
    }
  }
  if (!scene.trace_supports) return;
  for (int rail = 0; rail < track.rails; ++rail)
    for (int seat = 0; seat <= track.bays; ++seat) {
      columns_.push_back(fmt::format("support_{}{}.force_z_n", rail == 0 ? "" : "right_", seat));
      Row gap = rail_row({rail, seat * track.bay_length, 0., track.support.height_z, 2});
      for (const auto& [unknown, coefficient] : sleeper_row(rail, seat, 2))
        gap.emplace_back(unknown, -coefficient);
      supports_.push_back(std::move(gap));
    }
}

void Sensors::read(const State& state, std::vector<double>& row) const {
  for (const Point& point : points_) {
    std::array<double, 3> moved;
    for (std::size_t d = 0; d < 3; ++d) moved[d] = product(point.direction[d], state.u);
    for (std::size_t d = 0; d < 3; ++d) row.push_back(point.rest[d] + moved[d]);
    row.insert(row.end(), moved.begin(), moved.end());
    row.push_back(product(point.direction[2], state.v));
  }
  for (const Row& gap : supports_)
    row.push_back(-track_.support.stiffness[2] * product(gap, state.u) -
                  track_.support.damping[2] * product(gap, state.v));
}

}  // namespace railstep
