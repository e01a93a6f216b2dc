#include <algorithm>
#include <string>

#include "offline/math/refuse.h"
#include "offline/pack/pack.h"
#include "online/math/newton.h"

namespace railstep {

namespace {

/// The matrices with a coordinate without mass for each damper that is in series with a spring. The
/// first body's x is held, if it does not roll freely, then the lengths of the rods.
SuspendedMatrices extended(const RunnerMatrices& m, bool rolls_freely) {
  const Eigen::Index n = m.mass.size(), series = static_cast<Eigen::Index>(m.series.size());
  SuspendedMatrices e{Eigen::VectorXd::Zero(n + series), Eigen::VectorXd::Zero(n + series),
                      Eigen::MatrixXd::Zero(n + series, n + series),
                      Eigen::MatrixXd::Zero(n + series, n + series),
                      Eigen::MatrixXd::Zero(n + series, (rolls_freely ? 0 : 1) + m.rods.cols())};
  e.mass.head(n) = m.mass;
  e.rest.head(n) = m.rest;
  e.damping.topLeftCorner(n, n) = m.damping;
  e.stiffness.topLeftCorner(n, n) = m.stiffness;
  if (!rolls_freely) e.held(0, 0) = 1.;
  e.held.topRightCorner(n, m.rods.cols()) = m.rods;
  for (Eigen::Index i = 0; i < series; ++i) {
    const RunnerMatrices::Series& own = m.series[static_cast<std::size_t>(i)];
    Eigen::VectorXd row = Eigen::VectorXd::Zero(n + series);
    row.head(n) = own.row;
    row[n + i] = -1.;  // the spring takes what the damper does not
    e.stiffness += own.stiffness * row * row.transpose();
    e.damping(n + i, n + i) = own.damping;
  }
  for (const RunnerMatrices::Element& element : m.force_elements)
    if (element.series >= 0) e.damping(n + element.series, n + element.series) = 0.;
  return e;
}

/// The motions of all wheelsets among a runner's coordinates.
std::vector<Eigen::Index> motions_of(const RunnerModel& runner) {
  std::vector<Eigen::Index> all;
  for (std::int32_t i = 0; i < runner.wheelsets; ++i)
    for (int k = 0; k < kMotions; ++k) all.push_back(runner.wheelset[i].first + k);
  return all;
}

/// Rows of the force elements, each with that of its load, over all coordinates, [size][rows].
Eigen::MatrixXd element_rows(const RunnerMatrices& m, Eigen::Index size) {
  const Eigen::Index motions = m.mass.size();
  std::vector<Eigen::VectorXd> all;
  for (const RunnerMatrices::Element& e : m.force_elements) {
    Eigen::VectorXd& row = all.emplace_back(Eigen::VectorXd::Zero(size));
    row.head(motions) = e.row;
    if (e.series >= 0) row[motions + e.series] = 1.;
    if (e.law.loaded == 0) continue;
    Eigen::VectorXd& load = all.emplace_back(Eigen::VectorXd::Zero(size));
    load.head(motions) = e.load;
    if (e.series >= 0) load[motions + e.series] = -1.;
  }
  Eigen::MatrixXd rows(size, static_cast<Eigen::Index>(all.size()));
  for (std::size_t i = 0; i < all.size(); ++i) rows.col(static_cast<Eigen::Index>(i)) = all[i];
  return rows;
}

/// The part of the inverse for the motions of the wheelsets and the force elements, symmetric to
/// the last bit.
Eigen::MatrixXd interface_compliance(const RunnerModel& runner, const Eigen::MatrixXd& inverse,
                                     const Eigen::MatrixXd& rows) {
  const std::vector<Eigen::Index> motions = motions_of(runner);
  const auto wheels = static_cast<Eigen::Index>(motions.size());
  Eigen::MatrixXd meets = Eigen::MatrixXd::Zero(inverse.rows(), wheels + rows.cols());
  for (Eigen::Index i = 0; i < wheels; ++i) meets(motions[static_cast<std::size_t>(i)], i) = 1.;
  meets.rightCols(rows.cols()) = rows;
  const Eigen::MatrixXd part = meets.transpose() * inverse * meets;
  return .5 * (part + part.transpose());
}

/// @param keep  takes a table into the model's own memory
template <typename Keep>
void add_elements(const RunnerMatrices& m, const Keep& keep, Model& model, RunnerModel& packed) {
  if (m.force_elements.size() > std::size_t{kMaxForceElements})
    refuse("E-PACK-57", "a rail vehicle has " + std::to_string(m.force_elements.size()) +
                            " elements that are not linear, brakes among them; expected at most " +
                            std::to_string(kMaxForceElements));
  packed.first_force_element = model.runner_force_elements;
  packed.first_element_coordinate = model.element_coordinates;
  for (const RunnerMatrices::Element& e : m.force_elements) {
    ForceElement& own = packed.force_element[packed.force_elements++] = e.law;
    own.coordinate = packed.element_coordinates;
    own.memory = model.element_memory;
    own.value.points = static_cast<std::int32_t>(e.value.size() / 2);
    own.value.table = e.value.empty() ? nullptr : keep(e.value);
    own.curve.points = static_cast<std::int32_t>(e.curve.size() / 3);
    own.curve.point = e.curve.empty() ? nullptr : keep(e.curve);
    packed.element_coordinates += 1 + own.loaded;
    model.element_memory += memory_of(own.law);
  }
  model.runner_force_elements += packed.force_elements;
  model.element_coordinates += packed.element_coordinates;
}

/// Rows over all coordinates of the displacements that are published, [size][rows].
Eigen::MatrixXd traced_rows(const RunnerMatrices& m, Eigen::Index size) {
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(size, static_cast<Eigen::Index>(m.traced.size()));
  for (std::size_t i = 0; i < m.traced.size(); ++i)
    rows.col(static_cast<Eigen::Index>(i)).head(m.mass.size()) = m.traced[i].row;
  return rows;
}

std::vector<TracedElement> traced_elements(const RunnerMatrices& m, Model& model,
                                           RunnerModel& packed) {
  std::vector<TracedElement> all;
  for (const RunnerMatrices::Traced& own : m.traced) {
    all.push_back(own.element);
    if (own.element.series != 0.) all.back().deflection += static_cast<std::int32_t>(m.mass.size());
  }
  packed.first_traced = model.runner_traced;
  packed.traced_elements = static_cast<std::int32_t>(all.size());
  model.runner_traced += packed.traced_elements;
  if (packed.traced_elements > kMaxTracedElements || model.runner_traced > kMaxRunnerTraced)
    refuse("E-PACK-63",
           "elements with trace = true have more displacements than a model takes; expected at "
           "most " +
               std::to_string(kMaxTracedElements) + " of a rail vehicle and " +
               std::to_string(kMaxRunnerTraced) + " of all");
  return all;
}

void add_rods(const RunnerMatrices& m, Model& model, RunnerModel& packed) {
  packed.first_rod = model.runner_rods;
  packed.rods = static_cast<std::int32_t>(m.rods.cols());
  model.runner_rods += packed.rods;
  if (packed.rods > kMaxRodsOfRunner || model.runner_rods > kMaxRunnerRods)
    refuse("E-PACK-59", "rail vehicles have more rigid rods than a model takes; expected at most " +
                            std::to_string(kMaxRodsOfRunner) + " of one and " +
                            std::to_string(kMaxRunnerRods) + " of all");
}

/// Forces by a unit of x of all bodies: of what holds to the ground, without rounding of the rest.
Eigen::MatrixXd stiffness_by_way(const Eigen::MatrixXd& K, std::int32_t bodies) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(K.rows()), size = sum;
  for (std::int32_t b = 0; b < bodies; ++b) {
    sum += K.col(kMotions * b);
    size += K.col(kMotions * b).cwiseAbs();
  }
  return (sum.cwiseAbs().array() > 1e-9 * size.array()).select(sum, 0.);
}

void add_wheelsets(const Runner& runner, Model& model, RunnerModel& packed) {
  packed.first_wheelset = model.runner_wheelsets;
  for (std::size_t b = 0; b < runner.bodies.size(); ++b) {
    const RunnerBody& body = runner.bodies[b];
    if (!body.is_wheelset()) continue;
    const int most = model.lines > 0 ? kMaxSeatedWheelsets : kMaxRunnerWheelsets;
    if (packed.wheelsets == kMaxWheelsetsOfRunner || model.runner_wheelsets == most)
      refuse("E-PACK-53",
             "there are more wheelsets of rail vehicles than a model takes; expected at most " +
                 std::to_string(kMaxWheelsetsOfRunner) + " of a vehicle and " +
                 std::to_string(most) + " of all on such rails");
    packed.wheelset[packed.wheelsets++] = {kMotions * static_cast<std::int32_t>(b), body.centre[0],
                                           body.radius, body.inertia[1]};
    ++model.runner_wheelsets;
  }
}

}  // namespace

RunnerMatrices loaded_matrices(const RailVehicle& vehicle) {
  RunnerMatrices matrices = runner_matrices(vehicle.runner, vehicle.gravity);
  for (const OuterForce& force : vehicle.forces)
    matrices.rest[force.direction] += first_force(force);
  return matrices;
}

void PackedModel::keep_profiles(ProfilePair& pair) {
  const auto keep_all = [this](const double*& values, std::ptrdiff_t count) {
    if (count > 0) values = keep(std::vector<double>(values, values + count));
  };
  for (ProfileTable* table : {&pair.wheel, &pair.rail})
    keep_all(table->coefficient, 4 * std::ptrdiff_t{table->points});
  for (const double** places : {&pair.search_place, &pair.search_growth, &pair.search_slope})
    keep_all(*places, pair.wheel.points > 0 ? kSearchStrips : 0);
}

void PackedModel::add_runner(const Track& track, const RailVehicle& vehicle) {
  if (track.rails != 2)
    refuse("E-PACK-52", "a rail vehicle in space runs on one rail; expected a track of two");
  if (model_.runners == kMaxRunners)
    refuse("E-PACK-54",
           "there are more rail vehicles in space than a model takes; expected at "
           "most " +
               std::to_string(kMaxRunners));
  const RunnerMatrices matrices = runner_matrices(vehicle.runner, vehicle.gravity);
  const SuspendedMatrices m = extended(matrices, vehicle.rolls_freely);
  const auto n = static_cast<std::int32_t>(m.mass.size());
  if (n > kMaxRunnerUnknowns)
    refuse("E-PACK-55", "a rail vehicle has " + std::to_string(n) +
                            " coordinates; expected at "
                            "most " +
                            std::to_string(kMaxRunnerUnknowns) +
                            ": six of each body, and one of each damper in series with a spring");
  RunnerModel& packed = model_.runner[model_.runners];
  packed.bodies = static_cast<std::int32_t>(vehicle.runner.bodies.size());
  add_wheelsets(vehicle.runner, model_, packed);
  add_elements(
      matrices, [this](const std::vector<double>& table) { return keep(table); }, model_, packed);
  add_rods(matrices, model_, packed);
  traced_elements_.push_back(
      std::make_unique<std::vector<TracedElement>>(traced_elements(matrices, model_, packed)));
  packed.traced = traced_elements_.back()->data();
  packed.start = model_.lines > 0 ? model_.endless.origin + vehicle.start : vehicle.start;
  packed.rolls_freely = vehicle.rolls_freely ? 1 : 0;
  packed.start_speed = vehicle.rolls_freely ? vehicle.speed : 0.;
  packed.travel = keep_travel(vehicle.rolls_freely ? 0. : vehicle.speed, vehicle.speeds);
  packed.contact = vehicle.contact;
  keep_profiles(packed.contact.profiles.pair);
  RollingFriction& friction = packed.contact.creep.friction;
  friction.places = static_cast<std::int32_t>(vehicle.friction.size() / 3);
  friction.parts = keep(vehicle.friction);
  if (vehicle.rolls_freely)
    packed.by_way = keep(column_by_column(stiffness_by_way(m.stiffness, packed.bodies)));
  const SuspendedResponse step = add_suspended(m, vehicle.forces, packed);
  const Eigen::MatrixXd rows = element_rows(matrices, n);
  Eigen::MatrixXd compliance =
      model_.scheme.theta * interface_compliance(packed, step.inverse, rows);
  std::vector<double> own(static_cast<std::size_t>(packed.element_coordinates));
  for (std::int32_t j = 0; j < packed.force_elements; ++j) {
    const ForceElement& e = packed.force_element[j];
    double& met = compliance.diagonal()[kMotions * packed.wheelsets + e.coordinate];
    std::swap(own[static_cast<std::size_t>(e.coordinate)], met);
  }
  packed.element_compliance = keep(own);
  packed.element_row = keep(column_by_column(rows));
  packed.element_moved = keep(column_by_column(step.inverse * rows));
  packed.traced_row = keep(column_by_column(traced_rows(matrices, n)));
  packed.rod_row = keep(column_by_column(m.held.rightCols(packed.rods)));
  Eigen::MatrixXd reaction = Eigen::MatrixXd::Zero(constraint_count(packed), n);
  reaction.bottomRows(step.reaction.rows()) = step.reaction;
  reaction.bottomRows(packed.rods) *= -1.;  // a tension acts against an elongation
  packed.reaction = keep(column_by_column(reaction.transpose()));
  packed.compliance = keep(column_by_column(compliance));
  if (is_there(model_.design_line)) add_frames(vehicle, matrices, step, packed);
  ++model_.runners;
  for (const int rail : {0, 1})
    packed.load_point[rail] = model_.lines > 0 ? load_point_of_wheel(rail) : 0;
  runners_.push_back({vehicle, loaded_matrices(vehicle)});
}

void PackedModel::add_design_line(const Traffic& traffic) {
  const LineShape& shape = traffic.design_line;
  if (!shape.is_there() || traffic.rail_vehicles.empty()) return;
  double length = 0.;
  for (const RailVehicle& vehicle : traffic.rail_vehicles)
    length = std::max(length, reach_of(vehicle.runner));
  DesignLine line = design_line(shape, length);
  if (line.pieces > kMostLinePieces)
    refuse("E-PACK-61", "the design line has " + std::to_string(line.pieces) +
                            " pieces between two bodies of a vehicle; expected at most " +
                            std::to_string(kMostLinePieces) + ": rows farther from each other");
  line.curvature.value = keep(shape.curvature);
  line.cant.value = keep(shape.cant);
  line.gradient.value = keep(shape.gradient);
  model_.design_line = line;
}

void PackedModel::add_frames(const RailVehicle& vehicle, const RunnerMatrices& m,
                             const SuspendedResponse& step, RunnerModel& packed) {
  const FrameMatrices f = frame_matrices(vehicle.runner);
  const Eigen::Index n = packed.size, motions = m.mass.size(), poses = f.elements_moved.cols();
  // Dampers in series have coordinates of their own, see extended().
  Eigen::MatrixXd series = Eigen::MatrixXd::Zero(n, poses);
  for (Eigen::Index i = 0; i < f.series.rows(); ++i) {
    const RunnerMatrices::Series& own = m.series[static_cast<std::size_t>(i)];
    series.topRows(motions) += own.stiffness * own.row * f.series.row(i);
    series.row(motions + i) = -own.stiffness * f.series.row(i);
  }
  RunnerFrames& frames = packed.frames;
  frames.centre = keep(centres_of(vehicle.runner));
  if (f.elements.size() > std::size_t{kMaxFrameElements})
    refuse("E-PACK-62", "a rail vehicle has " + std::to_string(f.elements.size()) +
                            " elements between bodies; on a design line expected at most " +
                            std::to_string(kMaxFrameElements));
  frames.gravity = vehicle.gravity;
  set_pairs(f.pairs, frames);
  frame_elements_.push_back(std::make_unique<std::vector<FrameElement>>(f.elements));
  frames.elements = static_cast<std::int32_t>(f.elements.size());
  frames.element = frame_elements_.back()->data();
  frames.stiffness = keep(f.stiffness);
  frames.preload = keep(f.preload);
  if (f.series.rows() > 0) frames.series = keep(column_by_column(series));
  frames.elements_moved = keep(column_by_column(f.elements_moved.transpose()));
  frames.traced_moved = keep(column_by_column(f.traced_moved.transpose()));
  if (packed.rods == 0) return;
  const Eigen::Index held = step.held.rows();
  const Eigen::MatrixXd shorter = -f.rods;  // what the bodies' motions have to make up for
  Eigen::MatrixXd forces = Eigen::MatrixXd::Zero(constraint_count(packed), poses);
  forces.bottomRows(held) = step.held.rightCols(packed.rods) * shorter;
  forces.bottomRows(packed.rods) = -forces.bottomRows(packed.rods).eval();
  frames.rods = keep(column_by_column(f.rods.transpose()));
  frames.rod_moved = keep(column_by_column(
      Eigen::MatrixXd(-step.reaction.bottomRows(packed.rods).transpose() * shorter)));
  frames.rod_reaction = keep(column_by_column(forces.transpose()));
}

void PackedModel::refuse_many_coordinates() const {
  refuse("E-PACK-56",
         "the contacts, one-sided springs and wheelsets of rail vehicles on one track have " +
             std::to_string(newton_size(model_)) + " coordinates; expected at most " +
             std::to_string(kMostNewton) +
             ": one of each contact, spring and element that is not linear, two of friction under "
             "a load, 12 of each wheelset of a rail vehicle");
}

}  // namespace railstep
