#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "report/vtk_mesh.h"
#include "report/vtk_vehicle.h"
#include "run/simulation.h"
#include "scene/scene.h"

namespace railstep {

inline constexpr std::int64_t kVtkTimes = 100;  // most intervals between times of a record

/// Files of a run of a track for ParaView: a .vtp of each of at most kVtkTimes + 1 times, evenly
/// over the run, and one .pvd that names them. Rails are their true sections swept along the nodes
/// (of a scene that gives constants alone, a rectangle of their height and area), sleepers blocks
/// of 0.25 x 2.6 x 0.2 m, wheels discs of 0.13 m, other bodies of vehicles blocks (vtk_vehicle.h).
/// Points rest where they are without load, wheels where they have rolled to; displacement_m moves
/// them.
class VtkRecord {
 public:
  /// Makes the folder. @param run must outlive the record. Throws InputError.
  VtkRecord(const Scene& scene, const Simulation& run, std::filesystem::path folder,
            std::int64_t frames);
  /// Writes the state as it stands where the time is one of the record's.
  void frame(std::int64_t done);
  /// Writes the .pvd. Throws Failed where the disk is full, as all others.
  void finish();

 private:
  VtkMesh mesh() const;

  const Simulation& run_;
  std::string name_;
  std::filesystem::path folder_;
  std::int64_t frames_;
  std::array<std::vector<std::array<double, 2>>, 2> outline_;  // of each rail: y, z from the axis
  std::vector<DrawnVehicle> vehicles_;
  std::vector<double> times_;
  std::vector<std::string> files_;
};

}  // namespace railstep
