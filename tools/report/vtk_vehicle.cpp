#include "report/vtk_vehicle.h"

#include <algorithm>

#include "build/build.h"
#include "online/track/travel.h"

namespace railstep {
namespace {

// Sizes of blocks, m: beyond the outermost springs, over what bears them, across the track.
constexpr double kOverhang = .6, kGap = .1, kWidth = .9;
constexpr double kHeight[] = {.3, 1.8};  // of what stands on wheels, of what stands on that

/// Where a vehicle stands, and what of the state is its own.
struct Standing {
  const Vehicle& what;
  std::vector<int> first;    // coordinate of each body
  Eigen::VectorXd moved_by;  // its coordinates, from rest
  double x, y, z;            // of its origin; z of the railhead's top at rest, m

  /// Displacement of a point so far ahead of and over a body's middle.
  std::array<double, 3> moved(std::size_t body, double ahead, double up) const {
    const int own = first[body];
    const double pitch = what.bodies[body].pitch_inertia > 0. ? moved_by[own + 1] : 0.;
    return {up * pitch, 0., moved_by[own] - ahead * pitch};
  }
};

Standing stand(const Simulation& run, const SuspendedModel& model, int rail,
               const DrawnVehicle& drawn) {
  const Model& m = run.model();
  return {drawn.what,
          first_coordinates(drawn.what),
          Eigen::Map<const Eigen::VectorXd>(run.state.u + model.first, model.size) - drawn.rest,
          model.start + way_at(m, model.travel, run.state.steps).distance,
          m.rail_y[rail],
          m.rail_z[rail] + crown_top(m.cant[rail], m.head_z[rail], m.crown_radius[rail]).height};
}

/// 0 on the rail, 1 on springs over that, and so on.
std::size_t level_of(const Vehicle& what, std::size_t body) {
  std::size_t level = 0;
  for (const Vehicle::Suspension& spring : what.suspensions)
    if (static_cast<std::size_t>(spring.upper) == body)
      level = std::max(level, 1 + level_of(what, static_cast<std::size_t>(spring.lower)));
  return level;
}

void add_block(const Standing& at, std::size_t body, std::size_t level, VtkMesh& mesh) {
  const double middle = at.what.bodies[body].place;
  double rear = middle, front = middle, bottom = kGap;
  for (const Vehicle::Suspension& spring : at.what.suspensions)
    if (static_cast<std::size_t>(spring.upper) == body ||
        static_cast<std::size_t>(spring.lower) == body) {
      rear = std::min(rear, spring.place);
      front = std::max(front, spring.place);
    }
  double radius = 0.;
  for (const Vehicle::Wheel& wheel : at.what.wheels) radius = std::max(radius, wheel.radius);
  bottom += 2. * radius + (level > 1 ? kHeight[0] + kGap : 0.);
  const double height = kHeight[level > 1 ? 1 : 0];
  const std::array<double, 2> corner[] = {
      {-.5 * kWidth, 0.}, {.5 * kWidth, 0.}, {.5 * kWidth, height}, {-.5 * kWidth, height}};
  std::int32_t first[2];
  for (const int end : {0, 1}) {
    const double place = end == 0 ? rear - kOverhang : front + kOverhang;
    first[end] = static_cast<std::int32_t>(mesh.points());
    for (const auto& [across, up] : corner)
      mesh.add_point(vtk_vector({at.x + place, at.y + across, at.z + bottom + up}),
                     vtk_vector(at.moved(body, place - middle, up - .5 * height)));
  }
  mesh.add_prism(VtkPart::body, first[0], first[1], 4, true, true);
}

void add_wheel(const Standing& at, const Vehicle::Wheel& wheel, double force, VtkMesh& mesh) {
  const auto body = static_cast<std::size_t>(wheel.body);
  const double x = at.x + wheel.place;
  const std::array<double, 3> moved = at.moved(body, wheel.place - at.what.bodies[body].place, 0.);
  mesh.add_disc({x, at.y, at.z + wheel.radius}, wheel.radius,
                [&](double, double, double) { return moved; });
  mesh.add_force(vtk_vector({x, at.y, at.z}), vtk_vector(moved), vtk_vector({0., 0., -force}));
}

}  // namespace

DrawnVehicle drawn_vehicle(const VehicleScene& scene) {
  const Vehicle& what = scene.vehicle;
  return {what, vehicle_at_rest(vehicle_matrices(what, scene.gravity)).displacement};
}

void add_vehicle(const Simulation& run, int vehicle, const DrawnVehicle& drawn, VtkMesh& mesh) {
  const Vehicle& what = drawn.what;
  const SuspendedModel& model = run.model().vehicle[vehicle];
  std::int32_t wheel = 0;
  while (run.model().contact[vehicle_contact(run.model(), wheel)].bodies != vehicle) ++wheel;
  const ContactId first = vehicle_contact(run.model(), wheel);
  const double* force = run.state.contact_force + first;
  const Standing at = stand(run, model, run.model().contact[first].rail, drawn);
  for (const Vehicle::Wheel& own : what.wheels) add_wheel(at, own, *force++, mesh);
  for (std::size_t body = 0; body < what.bodies.size(); ++body)
    if (const std::size_t level = level_of(what, body); level > 0) add_block(at, body, level, mesh);
}

}  // namespace railstep
