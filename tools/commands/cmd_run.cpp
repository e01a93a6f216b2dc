#include <fmt/core.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "answer/assessment.h"
#include "commands/command.h"
#include "commands/options.h"
#include "online/beam/kernels.h"
#include "report/assessment_report.h"
#include "report/drawing.h"
#include "report/run_report.h"
#include "report/vtk_record.h"
#include "run/inputs.h"
#include "run/memory.h"
#include "run/recording.h"
#include "run/run_energy.h"
#include "run/simulate.h"
#include "run/speed_note.h"
#include "run/trace.h"
#include "run/unit_note.h"
#include "text/progress_bar.h"
#include "text/remarks.h"
#include "text/write.h"

namespace railstep {
namespace {

struct RunOptions {
  std::string input, trace, report, vtk;  // input: a scene or a model
  std::string inputs, record;
  std::int64_t hash_every = 1;  // frames of a recording
  std::string model;            // full, condensed; empty: as the scene says
  std::vector<std::string> overrides;
  std::optional<double> step, duration;  // s
  bool assess = false, json = false;
};

AnyScene scene_of(const RunOptions& o) {
  std::vector<std::string> overrides = o.overrides;
  if (o.model == "full") overrides.emplace_back("condense.kind=\"full\"");
  if (o.step) overrides.push_back(fmt::format("step.dt_s={}", *o.step));
  if (o.duration) overrides.push_back(fmt::format("step.duration_s={}", *o.duration));
  AnyScene scene = read_any_scene(o.input, overrides);
  const Scene* const track = std::get_if<Scene>(&scene);
  if (o.model != "condensed" || (track != nullptr && track->condense.kind)) return scene;
  overrides.emplace_back("condense.kind=\"modal\"");  // where the scene names no other
  return read_any_scene(o.input, overrides);
}

/// A model file cannot be changed: only its duration can be chosen.
void refuse_changes(const RunOptions& o) {
  const auto refuse = [&](bool given, const char* option) {
    if (given)
      throw InputError("E-RUN-03", fmt::format("{} changes a scene, and {} is a model; expected "
                                               "the scene. Condense it again with the change",
                                               option, o.input));
  };
  refuse(!o.overrides.empty(), "--set");
  refuse(o.step.has_value(), "--step");
  refuse(!o.model.empty(), "--model");
}

/// Frames of the run; a model file may be given another duration.
std::int64_t frames_of(const RunOptions& o, bool artefact, const Model& model) {
  const double frame = model.scheme.dt * model.steps_per_frame;
  if (!artefact || !o.duration) return model.steps / model.steps_per_frame;
  const double frames = *o.duration / frame;
  if (!(frames >= .5) || !(frames < 1e15) || std::abs(frames - std::round(frames)) > 1e-6)
    throw InputError("E-RUN-04", fmt::format("--duration {:g}: this is not a whole number of the "
                                             "model's frames; expected a multiple of {:g} s",
                                             *o.duration, frame));
  return std::llround(frames);
}

/// A value that is not known is NaN, which JSON writes as null.
nlohmann::ordered_json to_json(const Simulation& run, const RunRecord& record,
                               const std::optional<EnergyBalance>& energy) {
  const Model& model = run.model();
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  return {{"steps", run.state.steps},
          {"final_time_s", static_cast<double>(run.state.steps) * model.scheme.dt},
          {"state_hash", fmt::format("{:016x}", state_hash(model, run.state))},
          {"status", status_names(record.status)},
          {"max_constraint_violation", record.constraint_violation},
          {"max_iterations", record.iterations},
          {"energy_balance_error", energy ? energy->error : unknown},
          {"numerical_loss", energy ? energy->numerical_loss : unknown},
          {"frame_us",
           {{"median", quantile(record.frame_us, .5)},
            {"p99", quantile(record.frame_us, .99)},
            {"max", record.slowest_us}}},
          {"steps_per_frame", model.steps_per_frame},
          {"kernels", kernels_in_use().name},
          {"allocations", record.allocations}};
}

void print_run_table(const nlohmann::ordered_json& result) {
  const auto& us = result["frame_us"];
  fmt::print("steps            {}\nfinal time       {:.9g} s\nstate hash       {}\n",
             result["steps"].get<std::int64_t>(), result["final_time_s"].get<double>(),
             result["state_hash"].get<std::string>());
  fmt::print("steps per frame  {}\nframe, us        median {:.3g}, p99 {:.3g}, max {:.3g}\n",
             result["steps_per_frame"].get<int>(), us["median"].get<double>(),
             us["p99"].get<double>(), us["max"].get<double>());
  fmt::print("allocations      {}\n", result["allocations"].get<std::int64_t>());
  const double error = result["energy_balance_error"].get<double>();
  if (std::isnan(error))
    fmt::print("energy balance   not known\n");
  else
    fmt::print("energy balance   off by {:.2e}, numerical loss {:.2e}\n", error,
               result["numerical_loss"].get<double>());
}

/// A note where the scheme made more energy than a step that follows the motion does, or where the
/// balance is off by as much for another reason; nothing elsewhere.
std::optional<Message> energy_note(const std::optional<EnergyBalance>& energy) {
  constexpr double kMuch = .05;
  if (!energy) return std::nullopt;
  if (energy->numerical_loss < -kMuch)
    return Message(
        "W-RUN-04",
        fmt::format("the time scheme made energy, {:.2g} of all that was exchanged: the step is "
                    "too long for this motion. Halve it, or use a scheme that keeps energy",
                    -energy->numerical_loss));
  if (!(energy->error >= kMuch)) return std::nullopt;
  return Message("W-RUN-05",
                 fmt::format("the energy balance is off by {:.2g} of all that was exchanged, and "
                             "the time scheme lost {:.2g}: the step is too long for this motion "
                             "or, on a condensed track, for the sums of work and heat. Halve it",
                             energy->error, energy->numerical_loss));
}

/// Prints what the run met.
Exit verdict(const RunRecord& record, Remarks& remarks) {
  for (const std::string& name : status_names(record.status))
    if (name != "nonfinite_state")
      fmt::print(stderr, "note: {}: {}\n", name, status_sentence(name, record));
  remarks.print();
  return remarks.has_errors() ? Exit::not_reached : Exit::done;
}

/// The files of a run of a track for ParaView, where they are asked for.
std::optional<VtkRecord> vtk_record(const RunOptions& o, const AnyScene* scene,
                                    const Simulation& run, std::int64_t frames) {
  if (o.vtk.empty()) return std::nullopt;
  const Scene* const track = scene == nullptr ? nullptr : std::get_if<Scene>(scene);
  if (track == nullptr)
    throw InputError("E-RUN-05",
                     fmt::format("--vtk draws rails, sleepers and wheels, and {} is not a scene "
                                 "with them; expected a scene of a track without bodies",
                                 o.input));
  return std::make_optional<VtkRecord>(*track, run, o.vtk, frames);
}

/// The running behaviour of a scene's rail vehicles, for --assess and reports.
std::vector<AssessedVehicle> assessed(const RunOptions& o, const Scene* track,
                                      const Simulation& run, const RunRecord& record) {
  const bool often =
      run.model().scheme.dt * run.model().steps_per_frame <= kMostRowInterval * (1. + 1e-9);
  const bool wanted = o.assess || (!o.report.empty() && track != nullptr && often);
  if (!wanted || record.first_bad_unknown >= 0) return {};
  return assess(*track, run, record);
}

void want_vehicles(const RunOptions& o, const Scene* track, const Model& model) {
  const double frame = model.scheme.dt * model.steps_per_frame;
  if (o.assess && frame > kMostRowInterval * (1. + 1e-9))
    throw InputError("E-RUN-09",
                     fmt::format("{}: a frame of {:g} s is too long for --assess, whose "
                                 "filters go up to 20 Hz; expected step.frame_s up to "
                                 "{:g}",
                                 o.input, frame, kMostRowInterval));
  if (!o.assess || (track != nullptr && !track->rail_vehicles.empty())) return;
  throw InputError("E-RUN-08", fmt::format("--assess is of the running behaviour of vehicles, and "
                                           "{} is not a scene with one in space; expected a "
                                           "scene with a [[vehicle]] of type \"rail_vehicle\"",
                                           o.input));
}

/// The inputs of the frames, from --inputs; nothing without it.
FrameInputs inputs_of(const RunOptions& o, const Simulation& run) {
  if (o.inputs.empty()) return {};
  const double frame_s = run.model().scheme.dt * run.model().steps_per_frame;
  const auto table = std::make_shared<InputTable>(o.inputs, run.inputs(), frame_s);
  return [table](std::int64_t frame) { return table->at(frame); };
}

/// Adds a frame that was made to a recording.
void record_frame(const Simulation& run, const FrameInputs& inputs, std::int64_t done,
                  Recording& recording) {
  recording.frame(run, inputs ? inputs(done - 1) : run.state.input);
}

void write_recording(const std::string& file, const Simulation& run, Recording& recording) {
  recording.finish(run);
  const std::vector<std::byte> bytes = recording.bytes();
  write_file(file, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

Exit run(const RunOptions& o) {
  const bool artefact = is_artefact(o.input);
  if (artefact) refuse_changes(o);
  const std::optional<AnyScene> scene =
      artefact ? std::nullopt : std::make_optional<AnyScene>(scene_of(o));
  const auto simulation = artefact ? std::make_unique<Simulation>(std::filesystem::path(o.input))
                                   : simulation_of(*scene);
  const std::int64_t frames = frames_of(o, artefact, simulation->model());
  const Scene* const track = scene ? std::get_if<Scene>(&*scene) : nullptr;
  Remarks remarks;
  if (track != nullptr) {
    remarks.note(speed_note(*track, simulation->track()));
    remarks.note(constants_note(*track));
    remarks.note(lopsided_note(*track));
  }
  want_vehicles(o, track, simulation->model());
  if (!o.report.empty()) need_gnuplot();
  std::optional<Trace> trace;
  if (!o.trace.empty()) trace.emplace(o.trace, simulation->columns());
  std::optional<VtkRecord> vtk = vtk_record(o, scene ? &*scene : nullptr, *simulation, frames);
  if (vtk) vtk->frame(0);
  const FrameInputs inputs = inputs_of(o, *simulation);
  std::optional<Recording> recording;
  if (!o.record.empty()) {
    want_recording_memory(frames * simulation->model().inputs);
    recording.emplace(Recording::begin(*simulation, o.hash_every));
  }
  RowSink rows;
  if (trace) rows = [&trace](std::span<const double> row) { trace->row(row); };
  RunRecord record;
  std::optional<EnergyBalance> energy;
  {
    Progress bar(has_energies(*simulation) ? 2 * frames : frames);
    record = simulate(
        *simulation, frames, rows, !o.report.empty() || o.assess,
        [&](std::int64_t done) {
          bar(done);
          if (vtk) vtk->frame(done);
          if (recording) record_frame(*simulation, inputs, done, *recording);
        },
        inputs);
    energy = balance_of_run(*simulation, record, frames, inputs,
                            [&](std::int64_t done) { bar(frames + done); });
  }
  if (trace) trace->finish();
  if (vtk) vtk->finish();
  if (recording) write_recording(o.record, *simulation, *recording);
  const std::vector<AssessedVehicle> behaviour = assessed(o, track, *simulation, record);
  if (!o.report.empty())
    write_file(o.report, run_report(std::filesystem::path(o.input).stem().string(), *simulation,
                                    record, behaviour_html(behaviour)));
  nlohmann::ordered_json result = to_json(*simulation, record, energy);
  if (o.assess) result["assessment"] = to_json(behaviour);
  remarks.note(energy_note(energy));
  remarks.note(depth_note(record));
  if (record.first_bad_unknown >= 0)
    remarks.error(nonfinite_error(*simulation, record.first_bad_unknown));
  remarks.add_to(result);
  if (o.json)
    print_json(result);
  else
    print_run_table(result);
  if (o.assess && !o.json) fmt::print("{}", behaviour_text(behaviour));
  return verdict(record, remarks);
}

}  // namespace

Command add_run(CLI::App& app) {
  auto o = std::make_shared<RunOptions>();
  CLI::App* sub = app.add_subcommand("run", "Simulate a scene, or a model of `railstep condense`");
  sub->add_option("SCENE", o->input, "scene file (TOML) or model file")
      ->required()
      ->check(reads_file());
  sub->add_option("--model", o->model, "full or condensed, instead of the scene's")
      ->check(CLI::IsMember({"full", "condensed"}));
  sub->add_option("--step", o->step, "time step, s, instead of the scene's");
  sub->add_option("--duration", o->duration, "simulated time, s, instead of the scene's");
  sub->add_option("--trace", o->trace, "write a row a frame (CSV)")->check(writes_file());
  sub->add_option("--report", o->report, "write a page with plots (HTML; needs gnuplot)")
      ->check(writes_file());
  sub->add_option("--vtk", o->vtk,
                  "write rails, sleepers and wheels at 101 times into this folder, for ParaView")
      ->check(makes_folder());
  sub->add_option("--inputs", o->inputs,
                  "values of the scene's inputs (CSV: time_s, then inputs by name; a row holds "
                  "until the next)")
      ->check(reads_file());
  CLI::Option* record = sub->add_option("--record", o->record,
                                        "write model, inputs and hashes, for `railstep replay`")
                            ->check(writes_file());
  sub->add_option("--hash-every", o->hash_every, "frames from one hash of a recording to the next")
      ->check(within(std::int64_t{1}, std::int64_t{1} << 40))
      ->needs(record);
  add_overrides(*sub, o->overrides);
  sub->add_flag("--assess", o->assess,
                "running behaviour of vehicles in space by EN 14363, ride by EN 12299");
  sub->add_flag("--json", o->json, "one JSON object on stdout");
  sub->footer(
      "The energies come from a second pass over the run; of a model file, which has no matrices,\n"
      "they are null.\n\nExample: railstep run config/scenes/moving_load.toml --trace "
      "moving_load.csv");
  return {sub, [o] { return run(*o); }};
}

}  // namespace railstep
