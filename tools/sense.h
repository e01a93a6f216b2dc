#pragma once
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "offline/track/track.h"
#include "online/model/state.h"
#include "scene.h"

namespace railstep {

/// Reads a scene's sensors and support forces off a state, between frames.
class Sensors {
 public:
  Sensors(const Scene& scene, const Track& track, const Model& model);

  /// Trace columns: S.x_m .. S.vz_m_per_s of each sensor, then support_<i>.force_z_n of the left
  /// rail's supports where the scene asks for them.
  const std::vector<std::string>& columns() const { return columns_; }
  /// Appends a value for each column.
  void read(const State& state, std::vector<double>& row) const;

 private:
  using Row = std::vector<std::pair<int, double>>;  // unknown of the state, coefficient
  struct Point {
    std::array<double, 3> rest;    // m
    std::array<Row, 3> direction;  // x, y, z
  };
  Row rail_row(const RailPoint& point) const;
  Row sleeper_row(int rail, int seat, int direction) const;
  Point point_of(const RailSensor& sensor, double z) const;
  Point point_of(const SleeperSensor& sensor, double z) const;

  const Track& track_;
  const Model& model_;
  std::vector<Line> lines_;
  std::vector<std::string> columns_;
  std::vector<Point> points_;
  std::vector<Row> supports_;  // gap of each seat
};

}  // namespace railstep
