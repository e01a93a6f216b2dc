#pragma once
#include <vector>

#include "offline/start/static_lines.h"

namespace railstep {

/// Responses of the lines in a step to forces at the system's ports on rails.
struct TrackPorts {
  std::vector<double> shapes;      // SystemModel::port_shapes
  std::vector<double> compliance;  // SystemModel::port_compliance
};
/// @param track  of condensed lines
TrackPorts track_ports(const Model& model, const PackedModel* track);

/// Forces of ports against the rails as forces on these. @param force  [9 ports]
std::vector<ContactForce> forces_of_ports(const Model& model,
                                          const std::vector<RailPortModel>& ports,
                                          const std::vector<double>& force);

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
