#pragma once
#include <string>
#include <vector>

#include "online/runner/frames.h"
#include "run/simulate.h"
#include "scene/scene.h"

namespace railstep {

/// The rows of a trace by their columns.
class TraceRows {
 public:
  TraceRows(const Simulation& run, const RunRecord& record);
  [[nodiscard]] std::vector<double> column(const std::string& name) const;
  [[nodiscard]] std::size_t rows() const { return rows_; }
  [[nodiscard]] double interval() const { return interval_; }  // s
 private:
  const std::vector<std::string>& columns_;
  const std::vector<double>& values_;
  std::size_t rows_;
  double interval_;
};

/// How the first body of a rail vehicle goes along the track, at each row.
struct Way {
  std::vector<OnLine> at;
  std::vector<double> distance;  // m since the start; never falls
  double direction;              // 1 along the track, -1 against it
  [[nodiscard]] double length() const { return distance.back(); }
};
Way way_of(const Simulation& run, const TraceRows& rows, std::size_t vehicle,
           const RailVehicleScene& scene);

/// A signal over the distance, at rows or at the middles of windows.
struct OverWay {
  std::vector<double> distance, value;
};
/// The rows at which a vehicle is further than before.
OverWay over_way(const Way& way, const std::vector<double>& values);

/// Accelerations along y and z that a sensor feels in its body's axes, beyond those on straight,
/// level track, m/s2: of the body in its frame, of the frame, and of its part of gravity by roll.
struct FeltAccelerations {
  std::vector<double> y, z;
};
FeltAccelerations felt_at(const Simulation& run, const TraceRows& rows, const Way& way,
                          const RailVehicleScene& vehicle, const RailVehicleSensor& sensor,
                          const std::string& name);

}  // namespace railstep
