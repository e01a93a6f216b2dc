#include "offline/pack/pack.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "offline/analysis/free_motion.h"
#include "offline/contact/hertz.h"
#include "offline/cost/cost.h"
#include "offline/math/refuse.h"
#include "offline/pack/released.h"
#include "online/math/newton.h"
#include "online/model/external_input.h"

namespace railstep {

const double* PackedModel::keep(std::vector<double> values) {
  return reals_.emplace_back(std::make_unique<std::vector<double>>(std::move(values)))->data();
}

const std::int32_t* PackedModel::keep(std::vector<std::int32_t> values) {
  return integers_.emplace_back(std::make_unique<std::vector<std::int32_t>>(std::move(values)))
      ->data();
}

SignalModel PackedModel::keep(const Signal& signal) {
  SignalModel model = signal.model();
  if (model.intervals > 0) model.coefficient = keep(signal.coefficient);
  return model;
}

namespace {

/// Whether a force on a rail at a place that is not a node acts on a line.
bool acts_on(const Track& track, const Line& line, int rail, double y, double z, int direction) {
  const double x = .37 * track.element_length();
  return point_row(track, line, {rail, x, y, z, direction}).norm() > 0.;
}

/// How far a line closes each of the track's fixed ports; [unknowns][ports].
Eigen::SparseMatrix<double> closing_of(const Track& track, const Line& line) {
  const std::vector<FixedPort> ports = fixed_ports(track);
  Eigen::SparseMatrix<double> closing(line.unknowns(), static_cast<Eigen::Index>(ports.size()));
  for (std::size_t j = 0; j < ports.size(); ++j)
    closing.col(static_cast<Eigen::Index>(j)) = closing_row(track, line, ports[j]);
  return closing;
}

/// Whether a one-sided spring of the unloaded track is under force.
bool has_preload(const Track& track) {
  const std::vector<FixedPort> ports = fixed_ports(track);
  return std::any_of(ports.begin(), ports.end(),
                     [](const FixedPort& port) { return port.preload != 0.; });
}

bool is_moved(const Track& track, const Line& line, const Traffic& traffic, double gravity) {
  for (const MovingLoad& load : traffic.loads)
    if (acts_on(track, line, load.rail, 0., load.z, 2)) return true;
  for (const int rail : traffic.held)
    for (int direction = 0; direction < 3; ++direction)
      if (acts_on(track, line, rail, .01, .1, direction)) return true;
  for (const ExternalWheel& wheel : traffic.external_wheels)
    for (int direction = 0; direction < 3; ++direction)
      if (acts_on(track, line, wheel.rail, .01, .1, direction)) return true;
  for (const RunningVehicle& vehicle : traffic.vehicles)
    if (acts_on(track, line, vehicle.rail, 0., .1, 2)) return true;
  const bool in_space = !traffic.wheelsets.empty() || !traffic.rail_vehicles.empty();
  for (int direction = 0; direction < 3 && in_space; ++direction)
    for (int rail = 0; rail < track.rails; ++rail)
      if (acts_on(track, line, rail, .01, .1, direction)) return true;
  return gravity != 0. && weight(track, line, gravity).norm() > 0.;
}

}  // namespace

/// The index of a load point; a new one if no force has acted there yet.
std::int32_t PackedModel::load_point_at(const LoadPoint& point) {
  for (std::size_t i = 0; i < load_points_.size(); ++i)
    if (load_points_[i].rail == point.rail && load_points_[i].z == point.z &&
        load_points_[i].y == point.y)
      return static_cast<std::int32_t>(i);
  if (load_points_.size() == static_cast<std::size_t>(kMaxLoadPoints))
    refuse("E-PACK-04",
           "vertical forces act at too many heights, counted for each rail; expected at most " +
               std::to_string(kMaxLoadPoints));
  load_points_.push_back(point);
  return static_cast<std::int32_t>(load_points_.size()) - 1;
}

/// A new contact under a number, which those from it on give up.
ContactModel& PackedModel::insert_contact(ContactId at) {
  if (contacts_ == kMaxWheels)
    refuse("E-PACK-16", "there are more wheels and flanges than a model takes; expected at most " +
                            std::to_string(kMaxWheels));
  ContactModel* const place = model_.contact + at;
  std::copy_backward(place, model_.contact + contacts_, model_.contact + contacts_ + 1);
  ++contacts_;
  return *place = {};
}

/// The load point of a wheel on a rail at rest.
std::int32_t PackedModel::load_point_of_wheel(int rail) {
  const CrownTop top = crown_top(model_.cant[rail], model_.head_z[rail], model_.crown_radius[rail]);
  return load_point_at({rail, top.z, top.y});
}

void PackedModel::add_load(const Track& track, const MovingLoad& load) {
  if (model_.loads == kMaxLoads)
    refuse("E-PACK-05", "there are more loads than a model takes; expected at most " +
                            std::to_string(kMaxLoads));
  if (load.rail < 0 || load.rail >= track.rails)
    refuse("E-PACK-06",
           "a load is on a rail that the track does not have; expected rail 0, or rail 1 of two");
  LoadModel& packed = model_.load[model_.loads++];
  height_row(model_.cant[load.rail], 0., load.z, packed.row);
  packed.rail = load.rail;
  packed.start = model_.endless.origin + load.start;
  packed.travel = keep_travel(load.speed, load.speeds);
  packed.stop = load.stop;
  packed.force = load.force;
  packed.amplitude = load.amplitude;
  packed.frequency = load.frequency;
  packed.phase = load.phase;
  packed.table_points = static_cast<std::int32_t>(load.table.size() / 2);
  packed.table = keep(load.table);
  packed.load_point = load_point_at({load.rail, load.z});
}

void PackedModel::add_irregularity(const Track& track, const RailIrregularity& irregularity) {
  if (model_.signals == kMaxSignals)
    refuse(
        "E-PACK-07",
        "there are more irregularities and defects of rails than a model takes; expected at most " +
            std::to_string(kMaxSignals));
  if (irregularity.rail < 0 || irregularity.rail >= track.rails)
    refuse("E-PACK-06",
           "an irregularity is on a rail that the track does not have; expected rail 0, or rail 1 "
           "of two");
  if (irregularity.direction != 1 && irregularity.direction != 2)
    refuse("E-PACK-09", "the direction of an irregularity is " +
                            std::to_string(irregularity.direction) +
                            "; expected 1 (lateral) or 2 (vertical)");
  model_.signal[model_.signals++] = {irregularity.rail, irregularity.direction,
                                     keep(irregularity.signal)};
}

std::int32_t PackedModel::keep(const std::vector<OuterForce>& forces, BodyForce* force,
                               const char* body) {
  const std::string on = std::string(" on a ") + body;
  if (forces.size() > static_cast<std::size_t>(kMaxBodyForces))
    refuse("E-PACK-13",
           "too many forces act" + on + "; expected at most " + std::to_string(kMaxBodyForces));
  for (const OuterForce& own : forces) {
    if (own.input >= model_.inputs || (own.input >= 0) != own.table.empty())
      refuse(
          "E-PACK-14",
          "a force" + on +
              " does not have exactly one source; expected a table, or one of the model's inputs");
    *force++ = {own.direction, static_cast<std::int32_t>(own.table.size() / 2), keep(own.table),
                own.input};
  }
  return static_cast<std::int32_t>(forces.size());
}

void PackedModel::set_start(std::vector<double> state) {
  if (static_cast<std::int64_t>(state.size()) != state_doubles(model_))
    refuse("E-PACK-17", "the start has " + std::to_string(state.size()) + " numbers; expected " +
                            std::to_string(state_doubles(model_)) +
                            ", the size of a state of this model");
  model_.start = keep(std::move(state));
}

PackedModel::PackedModel(const Track& track, const Traffic& traffic, const PackOptions& options) {
  if (options.steps_per_frame < 1)
    refuse("E-PACK-18",
           "a frame has " + std::to_string(options.steps_per_frame) + " steps; expected 1 or more");
  model_.scheme = options.scheme;
  if (options.scheme.mean != 0 && !options.reduction)
    refuse("E-PACK-19",
           "the scheme averages contact forces over the step, but the track is in full order; "
           "expected a condensed track");
  model_.steps_per_frame = options.steps_per_frame;
  // A model always has a run: one frame if no length is given.
  model_.steps = options.steps > 0 ? options.steps : options.steps_per_frame;
  take_inputs(traffic.input_limits, model_);
  model_.elements = track.elements();
  model_.element_length = track.element_length();
  model_.rail_y[0] = track.rails == 2 ? track.rail_spacing / 2. : 0.;
  model_.rail_y[1] = -model_.rail_y[0];
  const std::array<Railhead, 2> heads = {traffic.head, traffic.right_head.value_or(traffic.head)};
  for (const std::size_t rail : {0u, 1u}) {
    model_.cant[rail] = track.lean(static_cast<int>(rail));
    const auto height = [&](std::size_t r) {
      return crown_top(track.lean(static_cast<int>(r)), heads[r].top_z, heads[r].crown_radius)
          .height;
    };
    model_.rail_z[rail] = height(0) - height(rail);
    model_.head_z[rail] = heads[rail].top_z;
    model_.crown_radius[rail] = heads[rail].crown_radius;
    model_.head_half_width[rail] = heads[rail].half_width;
  }
  model_.form = options.reduction ? Form::condensed : Form::banded;
  met_ = {0, track.elements()};
  is_met_.assign(static_cast<std::size_t>(track.elements()), true);
  if (options.endless) add_endless(track, traffic, options);
  add_lines(track, traffic, options);
  model_.line_unknowns = model_.unknowns;
  for (const MovingLoad& load : traffic.loads) add_load(track, load);
  for (const RailIrregularity& own : traffic.irregularities) add_irregularity(track, own);
  for (const Wheelset& wheelset : traffic.wheelsets) add_wheelset(track, wheelset, heads);
  for (const RunningVehicle& vehicle : traffic.vehicles) add_vehicle(track, vehicle, heads);
  add_design_line(traffic);
  for (const RailVehicle& vehicle : traffic.rail_vehicles) add_runner(track, vehicle);
  if (track_row_count(model_) > 0) add_responses();
  add_fixed_ports(track);
  if (newton_size(model_) > kMostNewton) refuse_many_coordinates();
  for (const ExternalWheel& wheel : traffic.external_wheels) add_external(track, wheel);
  if (options.gravity != 0. || has_preload(track) || !options.line_forces.empty())
    add_weight(track, options);
  add_track_sensors(track, traffic.track_sensors);
  if (options.residual_flexibility && !track.rigid)
    add_residual(track, traffic.track_sensors, options.residual_points);
  add_p_delta(track);
  refuse_steep_friction(track);
  std::vector<double> start = start_released(*this);
  put_falling(model_, traffic.vehicles, start);
  set_start(std::move(start));
  model_.cost = cost_of(model_);
}

void PackedModel::add_lines(const Track& track, const Traffic& traffic,
                            const PackOptions& options) {
  std::vector<Line> lines = assemble(track), moved;
  std::vector<PackedLine> kept;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const Eigen::SparseMatrix<double> closing = closing_of(track, lines[i]);
    const bool closes = closing.cols() > 0 && closing.norm() > 0.;
    if (!closes && !is_moved(track, lines[i], traffic, options.gravity)) continue;
    kept.push_back({{}, i, closing, {}, {}});
    moved.push_back(std::move(lines[i]));
  }
  if (moved.empty() && !track.rigid)
    refuse("E-PACK-21",
           "nothing moves the track; expected a load, a wheelset, a vehicle or an external wheel "
           "on it");
  // This holds for every start: the traffic would push a free track away.
  refuse_free_modes(track, moved,
                    options.reduction ? std::vector<FixedPort>{} : fixed_ports(track));
  for (std::size_t i = 0; i < moved.size(); ++i) {
    kept[i].line = std::move(moved[i]);
    add_line(track, std::move(kept[i]), options);
  }
}

void PackedModel::add_external(const Track& track, const ExternalWheel& wheel) {
  if (model_.external_wheels == kMaxExternalWheels)
    refuse("E-PACK-22", "there are more external wheels than a model takes; expected at most " +
                            std::to_string(kMaxExternalWheels));
  if (wheel.rail < 0 || wheel.rail >= track.rails)
    refuse("E-PACK-06",
           "an external wheel is on a rail that the track does not have; expected rail 0, or rail "
           "1 of two");
  for (const PackedLine& own : lines_)
    if (own.basis.flexibility.size() > 0)
      refuse("E-PACK-25",
             "external wheels run on truncated damped modes, which do not know the velocity under "
             "a wheel; expected full order, or another condense.kind than \"complex-modes\"");
  constexpr double kFar = 1e9;  // m
  const std::int32_t input = model_.inputs;
  std::vector<double> limits(kExternalInputs, wheel.limit);
  limits[kExternalX] = limits[kExternalY] = kFar;
  take_inputs(limits, model_);
  model_.external_wheel[model_.external_wheels++] = {wheel.rail, input,
                                                     load_point_of_wheel(wheel.rail)};
}

void take_inputs(const std::vector<double>& limits, Model& model) {
  for (const double limit : limits) {
    if (model.inputs == kMaxInputs)
      refuse("E-PACK-28", "there are more inputs than a model takes; expected at most " +
                              std::to_string(kMaxInputs));
    if (!(limit > 0.) || !std::isfinite(limit))
      refuse("E-PACK-29", "the limit of an input is " + std::to_string(limit) +
                              "; expected a finite number above 0");
    model.input_limit[model.inputs++] = limit;
  }
}

void PackedModel::add_weight(const Track& track, const PackOptions& options) {
  const auto n = static_cast<std::size_t>(model_.unknowns);
  std::vector<double> force(n * static_cast<std::size_t>(parts(model_.form)), 0.);
  for (std::size_t l = 0; l < lines_.size(); ++l) {
    Eigen::VectorXd own = preload(track, lines_[l].line);
    if (options.gravity != 0.) own += weight(track, lines_[l].line, options.gravity);
    if (!options.line_forces.empty()) own += options.line_forces[l];
    const auto first = static_cast<std::size_t>(model_.line[l].first);
    if (model_.form == Form::banded) {
      std::copy(own.begin(), own.end(), force.begin() + static_cast<std::ptrdiff_t>(first));
      continue;
    }
    const Eigen::VectorXcd modal = lines_[l].modes.project(lines_[l].basis.shapes.project(own));
    for (Eigen::Index k = 0; k < modal.size(); ++k) {
      force[first + static_cast<std::size_t>(k)] = modal[k].real();
      force[n + first + static_cast<std::size_t>(k)] = modal[k].imag();
    }
  }
  model_.constant_force = keep(std::move(force));
}

}  // namespace railstep
