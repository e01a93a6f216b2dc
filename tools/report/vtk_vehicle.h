#pragma once
#include "report/vtk_mesh.h"
#include "run/simulation.h"
#include "scene/scene.h"

namespace railstep {

/// A vehicle and its coordinates at rest on a level, rigid rail, from which its points are moved.
struct DrawnVehicle {
  Vehicle what;
  Eigen::VectorXd rest;
};
DrawnVehicle drawn_vehicle(const VehicleScene& scene);

/// Adds a vehicle of a run as it stands: a disc and the force on the rail for each wheel, and for
/// each body on springs a block over what bears it, .6 m longer at each end than its springs are
/// apart. A scene does not give the sizes of the blocks.
/// @param drawn  of which the model's vehicle was made
void add_vehicle(const Simulation& run, int vehicle, const DrawnVehicle& drawn, VtkMesh& mesh);

}  // namespace railstep
