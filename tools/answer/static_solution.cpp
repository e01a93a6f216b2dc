#include "answer/static_solution.h"

#include <fmt/core.h>

#include <cmath>
#include <functional>
#include <stdexcept>

#include "build/build.h"
#include "offline/analysis/timoshenko_statics.h"
#include "offline/beam/track_structure.h"
#include "online/math/table.h"

namespace railstep {
namespace {

/// A scene's track at t = 0 and what acts on it.
struct Problem {
  Track track;
  RailSections section;
  double right_z;  // of the right rail's axis over the left one's, m
  std::vector<PointForce> forces;
  double gravity;
  double slope_length;  // half the section's height: what makes a slope comparable to a length, m
  NewtonOptions newton;
  double z(int rail, Height at) const {
    return height_z(at, section[static_cast<std::size_t>(rail)], track.axis_z);
  }
};

/// A point before it has moved.
struct Place {
  std::string name;
  std::array<double, 3> rest;
  std::array<Functional, 3> moves;  // along x, y, z
};

using Displacement = std::function<double(const Functional&)>;

void add_force(Problem& problem, int rail, double x, double y, double z, double newton) {
  if (x < 0. || x > problem.track.length()) return;  // it may leave the rail, and has
  problem.forces.push_back({{rail, x, y, z, 2}, newton});
}

/// Where a wheel stands on a rail at rest.
void add_wheel(const Scene& scene, Problem& problem, int rail, double x, double newton) {
  const RailScene& own = rail == 1 && scene.right_rail ? *scene.right_rail : scene.rail;
  const CrownTop top =
      crown_top(problem.track.lean(rail), problem.z(rail, Height::head), own.crown_radius);
  add_force(problem, rail, x, top.y, top.z, newton);
}

double value_at_start(const std::vector<double>& table) {
  return table_value(table.data(), static_cast<std::int32_t>(table.size() / 2), 0.);
}

void add_wheelset(const Scene& scene, const WheelsetScene& w, Problem& problem) {
  for (const OuterForce& force : w.forces)
    if (first_force(force) != 0.)
      throw InputError("E-STATIC-01", fmt::format("{}: static takes the weight alone of wheelset "
                                                  "{}; expected forces that are 0 at t = 0",
                                                  scene.file.string(), w.name));
  for (const int rail : {0, 1}) add_wheel(scene, problem, rail, w.start, -.5 * w.weight);
}

/// The loads of a vehicle's wheels on a level rail that does not give way.
void add_vehicle(const Scene& scene, const VehicleScene& v, Problem& problem) try {
  VehicleMatrices matrices = vehicle_matrices(v.vehicle, v.gravity);
  for (const OuterForce& force : v.forces) matrices.weight[force.direction] -= first_force(force);
  const VehicleRest rest = vehicle_at_rest(matrices);
  for (std::size_t i = 0; i < v.vehicle.wheels.size(); ++i)
    add_wheel(scene, problem, v.rail, v.start + v.vehicle.wheels[i].place,
              -rest.force[static_cast<Eigen::Index>(i)]);
} catch (const Refused& error) {
  throw InputError(fmt::format("{}: vehicle {}", scene.file.string(), v.name), error);
}

Problem problem_of(const Scene& scene) {
  const RailSection rail = rail_section_of(scene);
  const Section right =
      scene.right_rail ? rail_section_of(scene, kRightRail).section : rail.section;
  Problem problem{
      track_of(scene, rail),    {rail.section, right}, 0., {}, scene.track.gravity ? kGravity : 0.,
      .5 * rail.section.height, scene.statics};
  problem.right_z = rail_z(scene, problem.section, problem.track, kRightRail);
  for (const LoadScene& load : scene.loads)
    add_force(problem, load.rail, load.start, 0., problem.z(load.rail, load.at),
              load.force * (load.table.empty() ? 1. : value_at_start(load.table)) +
                  load.amplitude * std::sin(2. * M_PI * load.phase));
  for (const VehicleScene& v : scene.vehicles) add_vehicle(scene, v, problem);
  for (const WheelsetScene& w : scene.wheelsets) add_wheelset(scene, w, problem);
  return problem;
}

double rail_y(const Track& track, int rail) {
  return track.rails == 1 ? 0. : (rail == 0 ? .5 : -.5) * track.rail_spacing;
}

/// The place's own rest is from the left rail's centroid.
Place rail_place(const std::string& name, const Problem& problem, int rail, double x, Height at) {
  const Track& track = problem.track;
  const double z = problem.z(rail, at), axis = rail == 0 ? 0. : problem.right_z;
  const double in_section[3] = {x, 0., z + track.axis_z};
  Place place{name, {}, {}};
  to_track(track.lean(rail), in_section, place.rest.data());
  place.rest[1] += rail_y(track, rail);
  place.rest[2] += axis;
  for (int d = 0; d < 3; ++d)
    place.moves[static_cast<std::size_t>(d)].rail = {{{rail, x, 0., z, d}, 1.}};
  return place;
}

/// An end of a sleeper, or its centre: the mean of its ends.
Place sleeper_place(const std::string& name, const Problem& problem, const SleeperSensor& sensor) {
  const Track& track = problem.track;
  const int seat = static_cast<int>(sensor.sleeper);
  const double foot = height_z(Height::foot, problem.section[0]);
  Place place{name, {seat * track.bay_length, 0., foot}, {}};
  const int only = sensor.rail.value_or(-1);
  if (only >= 0) place.rest[1] = rail_y(track, only);
  for (int d = 0; d < 3; ++d)
    for (int rail = 0; rail < track.rails; ++rail)
      if (only < 0 || rail == only)
        place.moves[static_cast<std::size_t>(d)].sleeper.push_back(
            {rail, seat, d, only < 0 ? 1. / track.rails : 1.});
  return place;
}

std::vector<Place> sensor_places(const Scene& scene, const Problem& problem) {
  std::vector<Place> places;
  for (const SensorScene& sensor : scene.sensors) {
    if (const auto* rail = std::get_if<RailSensor>(&sensor.on))
      places.push_back(rail_place(sensor.name, problem, rail->rail, rail->position, rail->at));
    else if (const auto* sleeper = std::get_if<SleeperSensor>(&sensor.on))
      places.push_back(sleeper_place(sensor.name, problem, *sleeper));
  }
  return places;
}

std::vector<Place> axis_places(const Problem& problem) {
  const Track& track = problem.track;
  std::vector<Place> places;
  const int quarters = 4 * track.elements();
  for (int rail = 0; rail < track.rails; ++rail)
    for (int i = 0; i <= quarters; ++i)
      places.push_back(rail_place(rail == 0 ? "left" : "right", problem, rail,
                                  track.length() * i / quarters, Height::axis));
  return places;
}

std::vector<StaticPoint> moved(const std::vector<Place>& places, const Displacement& displacement) {
  std::vector<StaticPoint> points;
  for (const Place& place : places) {
    StaticPoint point{place.name, place.rest, {}};
    for (std::size_t d = 0; d < 3; ++d) point.displacement[d] = displacement(place.moves[d]);
    points.push_back(std::move(point));
  }
  return points;
}

struct Asked {
  std::vector<Place> points, axis;
};

void answer(const Asked& asked, const Displacement& displacement, StaticSolution& solution) {
  solution.points = moved(asked.points, displacement);
  solution.axis = moved(asked.axis, displacement);
}

StaticSolution solve_nonlinear(const Problem& problem, const Asked& asked) {
  const Statics held(problem.track);  // refuses a free rigid mode by its name
  const TrackStructure rails(problem.track);
  Structure structure = rails.structure();
  structure.slope_length = problem.slope_length;
  StructureLoad load{rails.weight(problem.gravity)};
  for (const PointForce& force : problem.forces) load.force += force.force * rails.row(force.at);
  const Equilibrium found = equilibrium(structure, load, problem.newton);
  StaticSolution solution{found.converged,
                          found.iterations,
                          found.load_steps,
                          found.residual,
                          found.history,
                          {},
                          {},
                          true};
  if (!found.converged) {
    solution.residual = found.history.back().residual;
    return solution;
  }
  solution.stable = is_stable(structure, found.q);
  const Eigen::VectorXd u = found.q - structure.rest;
  answer(
      asked, [&](const Functional& f) { return rails.row(f).dot(u); }, solution);
  return solution;
}

/// Norm of what is left of the load, over the load's, with forces on slopes over slope_length.
double linear_residual(const Problem& problem, const Statics& statics,
                       const std::vector<Eigen::VectorXd>& u) {
  double left = 0., size = 0.;
  const std::vector<Eigen::VectorXd> unbalanced =
      statics.unbalanced(u, problem.forces, problem.gravity);
  const std::vector<Eigen::VectorXd> loads = statics.loads(problem.forces, problem.gravity);
  for (std::size_t i = 0; i < u.size(); ++i) {
    const Line& line = statics.lines()[i];
    Eigen::VectorXd scale = Eigen::VectorXd::Ones(line.unknowns());
    for (const Line::RailUnknowns& rail : line.unknown_of)
      for (const auto& node : rail)
        for (std::size_t k = 3; k < 9; ++k)
          if (node[k] >= 0) scale[node[k]] = 1. / problem.slope_length;
    for (const auto& cuts : line.cuts)
      for (const auto& [node, ahead] : cuts)
        for (std::size_t k = 3; k < 9; ++k)
          if (ahead[k] >= 0) scale[ahead[k]] = 1. / problem.slope_length;
    left += unbalanced[i].cwiseProduct(scale).squaredNorm();
    size += loads[i].cwiseProduct(scale).squaredNorm();
  }
  return size > 0. ? std::sqrt(left / size) : std::sqrt(left);
}

StaticSolution solve_linearised(const Problem& problem, const Asked& asked) {
  const Statics statics(problem.track);
  const std::vector<Eigen::VectorXd> u = statics.solve(problem.forces, problem.gravity);
  StaticSolution solution{true, 1, 1, linear_residual(problem, statics, u), {}, {}, {}, true};
  const auto displacement = [&](const Functional& f) {
    double sum = 0.;
    for (std::size_t i = 0; i < u.size(); ++i)
      sum += functional_row(problem.track, statics.lines()[i], f).dot(u[i]);
    return sum;
  };
  answer(asked, displacement, solution);
  return solution;
}

StaticSolution solve_timoshenko(const Problem& problem, const Asked& asked) {
  std::vector<double> x;
  for (const PointForce& force : problem.forces) x.push_back(force.at.x);
  for (const auto* places : {&asked.points, &asked.axis})
    for (const Place& place : *places) x.push_back(place.rest[0]);
  const TimoshenkoStatics beam(problem.track, x);
  const Eigen::VectorXd u = beam.solve(problem.forces, problem.gravity);
  const double residual = beam.residual(u, problem.forces, problem.gravity, problem.slope_length);
  StaticSolution solution{true, 1, 1, residual, {}, {}, {}, true};
  answer(
      asked, [&](const Functional& f) { return beam.at(u, f.rail[0].at); }, solution);
  return solution;
}

}  // namespace

StaticSolution solve_static(const Scene& scene) try {
  // Eigen blocks its products by the processor's caches; by these, the bits are the same on all.
  Eigen::setCpuCacheSizes(32 << 10, 256 << 10, 2 << 20);
  const Problem problem = problem_of(scene);
  const Asked asked{sensor_places(scene, problem), axis_places(problem)};
  switch (scene.track.model) {
    case RailModel::nonlinear:
      return solve_nonlinear(problem, asked);
    case RailModel::timoshenko:
      return solve_timoshenko(problem, asked);
    case RailModel::linearised:
      break;
  }
  return solve_linearised(problem, asked);
} catch (const Refused& error) {
  throw InputError(scene.file.string(), error);
}

}  // namespace railstep
