#pragma once
#include <vector>

#include "online/model/model.h"

namespace railstep {

/// What the lines' step matrices S make of forces at the system's ports on rails.
struct TrackPorts {
  std::vector<double> shapes;      // [9 ports][lines' unknowns] S^-1 B', m/N
  std::vector<double> compliance;  // [9 ports][9 ports] B S^-1 B'
};
TrackPorts track_ports(const Model& model);

/// A track's arrays that count all unknowns, once a system's stand behind them.
class WidenedTrack {
 public:
  /// @param own  unknowns of the system
  void widen(std::int32_t own, Model& model);
  /// Puts the track's own start into that of both; to velocities and accelerations of its lines
  /// come those by which the ports already move. @param start  state of `both`
  void put_start(const Model& track, const Model& both, std::vector<double>& start) const;

 private:
  std::vector<double> constant_force_;
  std::vector<std::int32_t> track_sensor_index_;
};

}  // namespace railstep
