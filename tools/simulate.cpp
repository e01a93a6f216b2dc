#include "simulate.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "heap_count.h"
#include "online/model/system_workspace.h"
#include "online/step/line.h"
#include "online/step/probe.h"
#include "online/step/step.h"
#include "online/system/sense.h"

namespace railstep {
namespace {

struct StatusText {
  Status bit;
  const char* name;
  const char* sentence;
};
constexpr StatusText kStatus[] = {
    {Status::off_rail, "off_rail",
     "a load or wheel is off the rail and its force is 0: lengthen the track"},
    {Status::contact_lost, "contact_lost", "a wheel stood free of its rail for a while"},
    {Status::cap_reached, "cap_reached",
     "a solve of contact, guide or joints ended at its cap: shorten step.dt_s or raise the cap"},
    {Status::contact_unresolved, "contact_unresolved",
     "a wheel struck its rail for fewer than 10 steps: its peak force is not right, shorten "
     "step.dt_s"},
    {Status::redundant_joint, "redundant_joint",
     "a row of a joint hangs on others and carries no force of its own: leave it out, or hold the "
     "joints by the augmented Lagrangian"},
    {Status::large_turn, "large_turn",
     "a rail under a wheel rolled by more than 0.14 rad, where the linear rail's roll is off by 1 "
     "% "
     "and more: give the pads roll stiffness, or less lateral force"},
    {Status::nonfinite_input, "nonfinite_input",
     "an input was not a finite number, and its last good value was held"},
    {Status::force_saturated, "force_saturated",
     "an input was beyond its limit, and was cut to it: see limit_n of its force"},
    {Status::nonfinite_state, "nonfinite_state", "the state is no longer finite"},
};

/// kSensorQuantities of a system's sensors.
void append_sensors(const Simulation& run, std::vector<double>& row) {
  const std::vector<SystemSensor>& sensors = run.system()->system.sensors;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const PointMotion p = sense(run.model(), run.state, static_cast<std::int32_t>(i));
    row.insert(row.end(), p.position, p.position + 3);
    for (int d = 0; d < 3; ++d) row.push_back(p.position[d] - sensors[i].point[d]);
    row.push_back(p.velocity[2]);
  }
}

/// kJointQuantities of traced joints, then the pull of traced springs.
void append_forces(const Simulation& run, std::vector<double>& row) {
  const TracedForces& traced = run.system()->traced;
  for (const int joint : traced.joints) {
    const JointForce f = joint_force(run.model(), run.state, joint);
    row.insert(row.end(), f.force, f.force + 3);
    row.insert(row.end(), f.moment, f.moment + 3);
  }
  for (const int spring : traced.springs)
    row.push_back(run.state.row_force[run.model().system.joint_rows + spring]);
}

}  // namespace

void write_row(const Simulation& run, const Outputs& outputs, std::vector<double>& row) {
  const Model& model = run.model();
  row.assign({static_cast<double>(run.state.steps) * model.scheme.dt});
  for (std::int32_t i = 0; i < model.loads; ++i) {
    row.push_back(outputs.load_x[i]);
    row.push_back(outputs.load_deflection[i]);
  }
  for (std::int32_t i = 0; i < wheel_count(model); ++i)
    row.insert(row.end(),
               {outputs.wheel_force[i], outputs.wheel_force_mean[i], outputs.wheel_force_peak[i],
                outputs.wheel_impulse[i], outputs.wheel_gap[i], outputs.wheel_rail_z[i]});
  for (std::int32_t i = 0; i < 2 * model.flanges; ++i)
    row.insert(row.end(), {outputs.flange_force[i], outputs.flange_force_peak[i],
                           outputs.flange_impulse[i], outputs.flange_gap[i]});
  const std::size_t probes = row.size();
  row.resize(probes + static_cast<std::size_t>(model.probe.count));
  read_probes(model, run.state, outputs, row.data() + probes);
  if (run.system() == nullptr) return;
  append_sensors(run, row);
  append_forces(run, row);
}

namespace {

/// Axes of the rails that the model's lines carry.
void keep_shapes(const Simulation& run, std::vector<RailSnapshot>& shapes) {
  const Model& model = run.model();
  if (model.lines == 0) return;  // a system alone has no rails
  const Configuration at{run.state.u, {run.state.u, run.state.v}};
  for (const int rail : {0, 1}) {
    RailSnapshot shape{static_cast<double>(run.state.steps) * model.scheme.dt, rail,
                       model.elements * model.element_length,
                       std::vector<double>(2 * static_cast<std::size_t>(model.elements) + 1, 0.)};
    bool carried = false;
    for (std::int32_t l = 0; l < model.lines; ++l)
      carried = carried || model.line[l].rail_factor[rail] != 0.;
    for (std::size_t node = 0; node < shape.z.size(); ++node) {
      const auto element = static_cast<std::int32_t>(node == 0 ? 0 : (node - 1) / 2);
      const double xi = static_cast<double>(node) - 2. * element - 1.;
      shape.z[node] = axis_height(model, rail, element, xi, at);
    }
    if (carried) shapes.push_back(std::move(shape));
  }
}

double timed_frame(Simulation& run, const FrameInputs& inputs, std::int64_t frame, Outputs& outputs,
                   std::int64_t& allocations) {
  using Clock = std::chrono::steady_clock;
  const std::int64_t before = heap_calls();
  const Clock::time_point start = Clock::now();
  // the status stands in the outputs too
  static_cast<void>(make_frame(run.model(), inputs, frame, run.state, run.workspace, outputs));
  const Clock::time_point end = Clock::now();
  allocations += heap_calls() - before;
  return std::chrono::duration<double, std::micro>(end - start).count();
}

void note_redundant(const Simulation& run, const Outputs& outputs, RunRecord& record) {
  if (run.system() == nullptr) return;
  for (int i = 0; i < std::min(outputs.redundant_rows, kMostNamedRows); ++i) {
    const RowModel& row = run.model().system.row[outputs.redundant_row[i]];
    record.redundant.insert(run.system()->names.joints[static_cast<std::size_t>(row.joint)]);
  }
}

}  // namespace

RunRecord simulate(Simulation& run, std::int64_t frames, Trace* trace, bool keep_rows,
                   const std::function<void(std::int64_t)>& after, const FrameInputs& inputs) {
  RunRecord record;
  Outputs outputs{};
  std::vector<double> row;
  const auto take = [&] {
    record.status = record.status | outputs.status;
    record.first_bad_unknown = outputs.first_bad_unknown;
    record.iterations = std::max(record.iterations, outputs.iterations);
    record.constraint_violation =
        std::max(record.constraint_violation, outputs.constraint_violation);
    note_redundant(run, outputs, record);
    if (!trace && !keep_rows) return;
    write_row(run, outputs, row);
    if (trace) trace->row(row);
    if (!keep_rows) return;
    record.rows.insert(record.rows.end(), row.begin(), row.end());
    record.violations.push_back(outputs.constraint_violation);
  };
  publish_start(run.model(), run.state, outputs);
  take();
  for (std::int64_t n = 0; n < frames && record.first_bad_unknown < 0; ++n) {
    record.frame_us.push_back(timed_frame(run, inputs, n, outputs, record.allocations));
    take();
    // at 1/8, 3/8, 5/8 and 7/8 of the run
    if (keep_rows && (2 * kShapes * (n + 1)) / frames != (2 * kShapes * n) / frames &&
        (2 * kShapes * (n + 1)) / frames % 2 == 1)
      keep_shapes(run, record.shapes);
    if (after) after(n + 1);
  }
  return record;
}

std::vector<std::string> status_names(Status status) {
  std::vector<std::string> names;
  for (const StatusText& text : kStatus)
    if (has(status, text.bit)) names.emplace_back(text.name);
  return names;
}

std::string status_sentence(const std::string& name, const RunRecord& record) {
  for (const StatusText& text : kStatus)
    if (name == text.name)
      return text.bit == Status::redundant_joint && !record.redundant.empty()
                 ? fmt::format("{} ({})", text.sentence, fmt::join(record.redundant, ", "))
                 : text.sentence;
  return {};
}

namespace {

constexpr const char* kNodeUnknowns[9] = {
    "x position",         "lateral position", "height", "lateral slope a_x", "a_y", "roll a_z",
    "vertical slope b_x", "roll b_y",         "b_z"};

std::string place_in_track(const Model& model, std::int32_t unknown) {
  for (std::int32_t l = model.lines - 1; l >= 0; --l) {
    const LineModel& line = model.line[l];
    if (unknown < line.first || unknown >= line.first + line.size) continue;
    if (model.condensed != 0)
      return fmt::format("mode {} of the track's line {}", unknown - line.first, l);
    for (const std::int32_t* table : line.unknown_of)
      for (std::int32_t i = 0; i < 27 * model.elements; ++i)
        if (table[i] == unknown - line.first)
          return fmt::format("{} of rail node {}", kNodeUnknowns[i % 9], 2 * (i / 27) + i % 27 / 9);
    break;
  }
  return unknown < model.bodies ? "a sleeper's motion" : "a wheelset's or a vehicle's coordinate";
}

/// @param unknown  from the system's first on
std::string place_in_system(const SystemModel& system, const SystemNames& names,
                            std::int32_t unknown) {
  static const char* const of_body[6] = {"x position of",   "y position of",   "z position of",
                                         "turn about x of", "turn about y of", "turn about z of"};
  for (std::int32_t b = 0; b < system.bodies; ++b)
    for (int c = 0; c < 6; ++c)
      if (const std::int32_t column = system.body[b].column[c];
          column >= 0 && system.body[b].first + column == unknown)
        return fmt::format("{} body \"{}\"", of_body[c], names.bodies[static_cast<std::size_t>(b)]);
  for (std::int32_t b = 0; b < system.beams; ++b) {
    const BeamChainModel& beam = system.beam[b];
    const std::int32_t at = unknown - beam.first, width = beam_width(beam);
    if (at < 0 || at >= beam.unknowns) continue;
    const int which = beam.planar != 0 ? kPlanarOf[at % width] : at % width;
    return fmt::format("{} of node {} of beam \"{}\"", kNodeUnknowns[which], at / width,
                       names.beams[static_cast<std::size_t>(b)]);
  }
  for (std::int32_t p = 0; p < system.ports; ++p)
    if (unknown >= system.port[p].first && unknown < system.port[p].first + 9)
      return fmt::format("a place of the {} rail that a joint or spring pulls at",
                         system.port[p].rail == 0 ? "left" : "right");
  return "padding of the system";
}

}  // namespace

std::string unknown_place(const Simulation& run, std::int32_t unknown) {
  if (run.system() == nullptr || unknown < run.model().system.first)
    return place_in_track(run.model(), unknown);
  const SystemModel& system = run.model().system;
  return place_in_system(system, run.system()->names, unknown - system.first);
}

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double rank = std::ceil(q * static_cast<double>(values.size()));
  const auto at = static_cast<std::ptrdiff_t>(std::max(rank, 1.)) - 1;
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

}  // namespace railstep
