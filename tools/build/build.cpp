#include "build/build.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "build/about.h"
#include "build/build_endless.h"
#include "build/build_irregularity.h"
#include "build/build_joints.h"
#include "build/build_sensors.h"
#include "build/build_unstepped.h"
#include "build/cache_sizes.h"
#include "build/step_scheme.h"
#include "offline/analysis/buckling.h"
#include "offline/beam/linearise.h"
#include "offline/math/refuse.h"
#include "offline/pack/artefact.h"
#include "offline/pack/travel_rows.h"
#include "offline/start/start.h"
#include "offline/start/start_impact.h"
#include "online/model/external_input.h"

namespace railstep {
namespace {

std::vector<MovingLoad> loads_of(const Scene& scene, const RailSections& sections) {
  std::vector<MovingLoad> loads;
  for (const LoadScene& own : scene.loads)
    loads.emplace_back(own).z = height_z(own.at, section_of(sections, own.rail));
  return loads;
}

std::vector<Wheelset> wheelsets_of(const Scene& scene) {
  std::vector<Wheelset> sets;
  for (const WheelsetScene& own : scene.wheelsets) sets.emplace_back(own).tread = treads_of(own);
  return sets;
}

std::vector<RunningVehicle> vehicles_of(const Scene& scene) {
  std::vector<RunningVehicle> vehicles;
  for (const VehicleScene& own : scene.vehicles) vehicles.emplace_back(own).tread = treads_of(own);
  return vehicles;
}

std::vector<RailVehicle> rail_vehicles_of(const Scene& scene) {
  std::vector<RailVehicle> vehicles;
  for (const RailVehicleScene& own : scene.rail_vehicles) vehicles.emplace_back(own);
  return vehicles;
}

std::vector<double> limits_of(const std::vector<InputScene>& inputs) {
  std::vector<double> limits;
  limits.reserve(inputs.size());
  for (const InputScene& input : inputs) limits.push_back(input.limit);
  return limits;
}

}  // namespace

Railhead railhead_of(const Scene& scene, const RailSections& sections, int rail) {
  const bool right = rail == kRightRail && scene.right_rail;
  Railhead head;
  head.top_z = height_z(Height::head, section_of(sections, rail));
  const RailScene& own = right ? *scene.right_rail : scene.rail;
  head.crown_radius = own.crown_radius;
  if (has_flanges(scene)) head.gauge_half_width = .5 * head_width(own).value();
  return head;
}

double rail_z(const Scene& scene, const RailSections& sections, const Track& track, int rail) {
  const auto top = [&](int side) {
    const Railhead head = railhead_of(scene, sections, side);
    return crown_top(track.lean(side), head.top_z, head.crown_radius).height;
  };
  return top(kLeftRail) - top(rail);
}

namespace {

/// Force in a rail at rest: its own, and what heat makes between ends that hold it, N. Gaps of
/// joints pass none until they are closed.
double axial_force_of(const RailScene& rail, double area, int side, const HeatedJoints& heated) {
  for (const RailJoint& joint : heated.joints)
    if (joint.rails[static_cast<std::size_t>(side)])
      return -heated.compression[static_cast<std::size_t>(side)];
  return rail.axial_force - rail.young * area * (rail.expansion * rail.temperature_rise);
}

/// The right rail where it differs; its pads reach down to its own foot.
void add_right_rail(const Scene& scene, const RailSection& found, const HeatedJoints& heated,
                    bool keep_moments, Track& track) {
  const RailScene& right = *scene.right_rail;
  RailBar bar{beam_section(found), {right.young, right.poisson, right.density}, 0.};
  if (!keep_moments) bar.section.moments.reset();
  bar.axial_force = axial_force_of(right, bar.section.area, 1, heated);
  if (scene.track.reference_line != ReferenceLine::centroid)
    refuse("E-RAIL-13",
           "rails that differ have their nodes on their centroids; expected "
           "track.reference_line = \"centroid\"");
  track.right = bar;
  if (!scene.support) return;
  const double height = height_z(scene.support->at, found.section, track.axis_z);
  for (int border = 0; border <= track.bays && height != track.support.height_z; ++border) {
    Seat seat = track.seat(border);
    seat.pad[1].height_z = height;
    track.changed_seats[border] = seat;
  }
}

}  // namespace

PackOptions pack_options_of(const Scene& scene) {
  const StepScene& step = *scene.step;
  if (step.steps_per_frame > std::numeric_limits<int>::max())
    throw InputError(
        "E-STEP-10",
        fmt::format("{}: a frame of {} steps is too long; expected at most {} steps",
                    scene.file.string(), step.steps_per_frame, std::numeric_limits<int>::max()));
  PackOptions options{.scheme = scene.condense.kind ? held_scheme_of(step) : scheme_of(step),
                      .steps_per_frame = static_cast<int>(step.steps_per_frame),
                      .residual_flexibility = scene.condense.residual_flexibility,
                      .gravity = scene.track.gravity ? kGravity : 0.,
                      .steps = step.steps};
  if (scene.condense.kind) options.reduction = reduction_of(scene);
  if (scene.track.endless) options.endless = EndlessTrack{bays_behind(scene)};
  return options;
}

Reduction reduction_of(const Scene& scene) {
  const CondenseScene& c = scene.condense;
  const double per_bay = c.modes_per_bay.value_or(c.highest_hz ? 1000. : 1.);
  const double modes = per_bay * static_cast<double>(scene.track.bays);
  return {.kind = c.kind.value_or(ReductionKind::modal),
          .limit = {static_cast<int>(std::min(modes, static_cast<double>(kMostModalUnknowns))),
                    c.highest_hz.value_or(std::numeric_limits<double>::infinity())},
          .nodes_per_bay = c.nodes_per_bay,
          .expansion_hz = c.expansion_hz};
}

Track track_of(const Scene& scene) { return track_of(scene, rail_section_of(scene)); }

Track track_of(const Scene& scene, const RailSection& rail) try {
  const Section& section = rail.section;
  Track track;
  track.section = beam_section(rail);
  track.material = {scene.rail.young, scene.rail.poisson, scene.rail.density};
  // Without third and fourth moments, which it does not need, a linear element keeps its bits.
  const bool keep_moments = scene.track.model == RailModel::nonlinear ||
                            scene.track.linearised_under_weight || scene.rail.section_points > 0;
  if (!keep_moments) track.section.moments.reset();
  track.rule = scene.rail.rule;
  track.axis_z = axis_z_of(scene.track.reference_line, section);
  track.unknowns = scene.track.unknowns;
  track.rails = scene.track.rails;
  track.bays = static_cast<int>(scene.track.bays);  // read_scene keeps it under kMostElements
  track.bay_length = scene.track.bay;
  track.elements_per_bay = scene.track.elements_per_bay;
  track.rail_spacing = scene.track.rail_spacing;
  track.cant = scene.rail.cant;
  track.ends = scene.track.ends;
  track.end_zone_bays = scene.track.end_zone_bays;
  track.ring = scene.track.endless;
  track.rigid = scene.track.rigid;
  if (scene.support) {
    track.support = *scene.support;
    track.support.height_z = height_z(scene.support->at, section, track.axis_z);
  }
  track.sleeper = scene.sleeper;
  const RailSection right = scene.right_rail ? rail_section_of(scene, kRightRail) : rail;
  const HeatedJoints heated = heated_joints(scene, {section.area.area, right.section.area.area},
                                            {section.height, right.section.height});
  track.axial_force = axial_force_of(scene.rail, track.section.area, 0, heated);
  track.joints = heated.joints;
  if (scene.right_rail) add_right_rail(scene, right, heated, keep_moments, track);
  change_seats(scene.seat_changes, track);
  for (const StopScene& own : scene.stops)
    track.stops.emplace_back(own).z =
        height_z(own.at, own.rail == kRightRail ? right.section : section, track.axis_z);
  if (!track.rigid) refuse_buckled(track);
  if (!scene.track.linearised_under_weight) return track;
  return linearised_under_weight(track, scene.track.gravity ? kGravity : 0.);
} catch (const Refused& error) {
  throw InputError(scene.file.string(), error);
}

namespace {

TraceNames names_of(const Scene& scene, std::vector<std::string> track_sensors) {
  TraceNames names;
  for (const LoadScene& load : scene.loads) names.loads.push_back(load.name);
  for (const WheelsetScene& wheelset : scene.wheelsets)
    for (const std::string& wheel : wheelset.wheels) {
      names.wheels.push_back(wheel);
      if (wheelset.flange) names.flanges.push_back(wheel);
    }
  for (const VehicleScene& vehicle : scene.vehicles)
    for (std::size_t i = 0; i < vehicle.vehicle.wheels.size(); ++i)
      names.wheels.push_back(fmt::format("{}.wheel_{}", vehicle.name, i + 1));
  for (const RailVehicleScene& vehicle : scene.rail_vehicles) {
    names.runners.push_back(vehicle.name);
    names.rods.insert(names.rods.end(), vehicle.rods.begin(), vehicle.rods.end());
    names.force_elements.insert(names.force_elements.end(), vehicle.force_elements.begin(),
                                vehicle.force_elements.end());
    names.traced.insert(names.traced.end(), vehicle.traced.begin(), vehicle.traced.end());
    for (const std::string& set : vehicle.wheelsets) {
      names.runner_wheelsets.push_back(set);
      names.runner_wheels.insert(names.runner_wheels.end(), {set + "_left", set + "_right"});
    }
  }
  for (const ExternalWheelScene& wheel : scene.external_wheels)
    names.external_wheels.push_back(wheel.name);
  names.track_sensors = std::move(track_sensors);
  return names;
}

}  // namespace

TracedTraffic traffic_of(const Scene& scene, const Track& track) {
  const RailSections sections = sections_of(scene);
  const Railhead head = railhead_of(scene, sections, kLeftRail);
  Sensors sensors = sensors_of(scene, track, sections, head);
  return {{.loads = loads_of(scene, sections),
           .wheelsets = wheelsets_of(scene),
           .vehicles = vehicles_of(scene),
           .rail_vehicles = rail_vehicles_of(scene),
           .head = head,
           .track_sensors = std::move(sensors.track_sensors),
           .irregularities = irregularities_of(scene),
           .input_limits = limits_of(scene.inputs),
           .external_wheels = {scene.external_wheels.begin(), scene.external_wheels.end()},
           .right_head = railhead_of(scene, sections, kRightRail),
           .design_line = scene.design_line},
          names_of(scene, std::move(sensors.columns))};
}

std::vector<std::string> input_names(const Scene& scene) {
  std::vector<std::string> names;
  for (const InputScene& input : scene.inputs) names.push_back(input.name);
  for (const ExternalWheelScene& wheel : scene.external_wheels)
    for (const char* quantity : kExternalInputNames) names.push_back(wheel.name + "." + quantity);
  return names;
}

Built::Built(const Scene& scene) try {
  fix_cache_sizes();
  refuse_unstepped(scene);
  track = track_of(scene);
  if (track.ring && !scene.condense.kind) track = window_of(std::move(track));
  TracedTraffic traced = traffic_of(scene, track);
  about = railstep::about(scene);
  inputs = input_names(scene);
  packed = std::make_unique<PackedModel>(track, traced.traffic, pack_options_of(scene));
  columns = columns_of(packed->model(), traced.names);
  const double gravity = scene.track.gravity ? kGravity : 0.;
  if (scene.step->start == Start::equilibrium)
    packed->set_start(start_in_equilibrium(track, *packed, gravity));
  if (scene.step->start == Start::released)
    packed->set_start(start_under_impact(track, *packed, gravity));
  if (scene.step->start == Start::moving) packed->set_start(start_moving(track, *packed, gravity));
} catch (const Refused& error) {
  throw InputError(scene.file.string(), error);
}

std::string block_text(const std::vector<std::string>& columns,
                       const std::vector<std::string>& inputs) {
  std::string text = fmt::format("{}", fmt::join(columns, "\n"));
  if (!inputs.empty()) text += fmt::format("\n\n{}", fmt::join(inputs, "\n"));
  return text;
}

std::vector<std::byte> block_of(const Built& built, BlockNotes notes) {
  notes.about = built.about;
  return to_block(built.packed->model(), block_text(built.columns, built.inputs), notes);
}

}  // namespace railstep
