#include "run/simulate.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "offline/math/larger.h"
#include "online/math/finite.h"
#include "online/model/system_workspace.h"
#include "online/step/step.h"
#include "online/step/trace_row.h"
#include "online/track/line.h"
#include "run/heap_count.h"

namespace railstep {
namespace {

/// Axes of the rails that the model's lines carry.
void keep_shapes(const Simulation& run, std::vector<RailSnapshot>& shapes) {
  const Model& model = run.model();
  if (model.elements == 0) return;  // a system alone has no rails
  const Configuration at{run.state.u, {run.state.u, run.state.v}};
  for (const int rail : {0, 1}) {
    RailSnapshot shape{static_cast<double>(run.state.steps) * model.scheme.dt, rail,
                       model.elements * model.element_length,
                       std::vector<double>(2 * static_cast<std::size_t>(model.elements) + 1, 0.)};
    bool carried = false;
    for (std::int32_t l = 0; l < model.lines; ++l)
      carried = carried || model.line[l].rail_factor[rail] != 0.;
    for (std::size_t node = 0; node < shape.z.size(); ++node) {
      const ElementNode own = element_node(static_cast<std::int32_t>(node));
      shape.z[node] = axis_height(model, rail, own.element, own.node - 1., at);
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

/// Where there are too many, every second one goes, and the stride doubles.
void keep_time(double us, std::int64_t frame, RunRecord& record) {
  record.slowest_us = std::max(record.slowest_us, us);
  if (frame % record.frame_stride != 0) return;
  std::vector<double>& kept = record.frame_us;
  if (kept.size() == kMostTimes) {
    for (std::size_t i = 0; 2 * i < kept.size(); ++i) kept[i] = kept[2 * i];
    kept.resize(kMostTimes / 2);
    record.frame_stride *= 2;
    if (frame % record.frame_stride != 0) return;
  }
  kept.push_back(us);
}

/// A model file has no names: its joints are numbered as the scene has them.
std::string joint_name(const Simulation& run, std::int32_t joint) {
  return run.system() != nullptr ? run.system()->names.joints[static_cast<std::size_t>(joint)]
                                 : fmt::format("joint[{}]", joint);
}

void note_redundant(const Simulation& run, const Outputs& outputs, RunRecord& record) {
  for (int i = 0; i < std::min(outputs.redundant_rows, kMostNamedRows); ++i) {
    const RowModel& row = run.model().system.row[outputs.redundant_row[i]];
    record.redundant.insert(joint_name(run, row.joint));
  }
}

/// The lowest of a rail's points under loads and wheels, up, m; 0 where none sank.
double lowest(const Model& model, const Outputs& outputs) {
  double least = 0.;
  for (std::int32_t i = 0; i < model.loads; ++i)
    least = std::min(least, outputs.load_deflection[i]);
  for (const ContactId i : wheels(model)) least = std::min(least, outputs.contact_rail_z[i]);
  for (std::int32_t i = 0; i < model.external_wheels; ++i)
    least = std::min(least, outputs.external_displacement[i][2]);
  return least;
}

}  // namespace

RunRecord simulate(Simulation& run, std::int64_t frames, const RowSink& sink, bool keep_rows,
                   const std::function<void(std::int64_t)>& after, const FrameInputs& inputs) {
  RunRecord record;
  Outputs outputs{};
  std::vector<double> row(static_cast<std::size_t>(trace_columns(run.model())));
  const auto take = [&] {
    record.status = record.status | outputs.status;
    record.first_bad_unknown = outputs.first_bad_unknown;
    record.iterations = std::max(record.iterations, outputs.iterations);
    record.constraint_violation = larger(record.constraint_violation, outputs.constraint_violation);
    record.deepest = std::min(record.deepest, lowest(run.model(), outputs));
    note_redundant(run, outputs, record);
    if (!sink && !keep_rows) return;
    trace_row(run.model(), run.state, outputs, row.data());
    if (sink) sink(row);
    if (!keep_rows) return;
    record.rows.insert(record.rows.end(), row.begin(), row.end());
    record.violations.push_back(outputs.constraint_violation);
  };
  publish_start(run.model(), run.state, outputs);
  take();
  for (std::int64_t n = 0; n < frames && record.first_bad_unknown < 0; ++n) {
    keep_time(timed_frame(run, inputs, n, outputs, record.allocations), n, record);
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
  for (const StatusText& text : kStatusTexts)
    if (has(status, text.bit)) names.emplace_back(text.name);
  return names;
}

std::string status_sentence(const std::string& name, const RunRecord& record) {
  for (const StatusText& text : kStatusTexts)
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
    if (model.form == Form::condensed)
      return fmt::format("mode {} of the track's line {}", unknown - line.first, l);
    for (const std::int32_t* table : line.unknown_of)
      for (std::int32_t i = 0; i < 27 * model.elements; ++i)
        if (table[i] == unknown - line.first)
          return fmt::format("{} of rail node {}", kNodeUnknowns[i % 9], 2 * (i / 27) + i % 27 / 9);
    break;
  }
  return unknown < model.line_unknowns ? "a sleeper's motion"
                                       : "a wheelset's or a vehicle's coordinate";
}

/// @param unknown  from the system's first on
/// @param names    null for a model file
std::string place_in_system(const SystemModel& system, const SystemNames* names,
                            std::int32_t unknown) {
  static const char* const of_body[6] = {"x position of",   "y position of",   "z position of",
                                         "turn about x of", "turn about y of", "turn about z of"};
  const auto named = [](const char* what, const std::vector<std::string>* all, std::int32_t index) {
    return all != nullptr ? fmt::format("{} \"{}\"", what, (*all)[static_cast<std::size_t>(index)])
                          : fmt::format("{}[{}]", what, index);
  };
  for (std::int32_t b = 0; b < system.bodies; ++b)
    for (int c = 0; c < 6; ++c)
      if (const std::int32_t column = system.body[b].column[c];
          column >= 0 && system.body[b].first + column == unknown)
        return fmt::format("{} {}", of_body[c], named("body", names ? &names->bodies : nullptr, b));
  for (std::int32_t b = 0; b < system.beams; ++b) {
    const BeamChainModel& beam = system.beam[b];
    const std::int32_t at = unknown - beam.first, width = beam_width(beam);
    if (at < 0 || at >= beam.unknowns) continue;
    const int which = beam.planar != 0 ? kPlanarOf[at % width] : at % width;
    return fmt::format("{} of node {} of {}", kNodeUnknowns[which], at / width,
                       named("beam", names ? &names->beams : nullptr, b));
  }
  for (std::int32_t p = 0; p < system.ports; ++p)
    if (unknown >= system.port[p].first && unknown < system.port[p].first + 9)
      return fmt::format("a place of the {} rail that a joint or spring pulls at",
                         system.port[p].rail == 0 ? "left" : "right");
  return "padding of the system";
}

}  // namespace

std::string unknown_place(const Simulation& run, std::int32_t unknown) {
  const SystemModel& system = run.model().system;
  if (system.unknowns == 0 || unknown < system.first) return place_in_track(run.model(), unknown);
  const SystemNames* const names = run.system() != nullptr ? &run.system()->names : nullptr;
  return place_in_system(system, names, unknown - system.first);
}

Message nonfinite_error(const Simulation& run, std::int32_t first_bad_unknown) {
  const std::int32_t at = first_bad_unknown;
  const bool of_track = run.model().form == Form::banded && at < run.model().line_unknowns;
  const bool itself = of_track || !is_moderate(run.state.u[at]) || !is_moderate(run.state.v[at]);
  return {"E-RUN-16",
          fmt::format(
              "nonfinite_state: at step {}, t = {:.9g} s, {}unknown {} of the state ({}){} is not "
              "finite, or beyond {}; expected a shorter step.dt_s, or smaller forces",
              run.state.steps, static_cast<double>(run.state.steps) * run.model().scheme.dt,
              itself ? "" : "what follows from ", at, unknown_place(run, at),
              itself ? "" : ", a gap, an orientation or a contact's or joint's force,",
              of_track ? "1024 m or rad" : "1.6e60")};
}

std::string nonfinite_sentence(const Simulation& run, std::int32_t first_bad_unknown) {
  return nonfinite_error(run, first_bad_unknown).line();
}

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double rank = std::ceil(q * static_cast<double>(values.size()));
  const auto at = static_cast<std::ptrdiff_t>(std::max(rank, 1.)) - 1;
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

}  // namespace railstep
