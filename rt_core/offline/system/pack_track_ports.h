#pragma once
#include <vector>

#include "online/model/model.h"

namespace railstep {

/// Responses of the lines, by their step matrices S, to forces at the system's ports on rails.
struct TrackPorts {
  std::vector<double> shapes;      // [9 ports][lines' unknowns] S^-1 B', m/N
  std::vector<double> compliance;  // [9 ports][9 ports] B S^-1 B'
};
TrackPorts track_ports(const Model& model);

/// Arrays of a track over all unknowns, extended by those of a system, which follow its own.
class WidenedTrack {
 public:
  /// @param own  unknowns of the system
  void widen(std::int32_t own, Model& model);
  /// Puts the track's own start into that of both, and adds to velocities and accelerations of its
  /// lines the present motion of the ports. @param start  state of `both`
  void put_start(const Model& track, const Model& both, std::vector<double>& start) const;

 private:
  std::vector<double> constant_force_;
  std::vector<std::int32_t> track_sensor_index_;
};

}  // namespace railstep
