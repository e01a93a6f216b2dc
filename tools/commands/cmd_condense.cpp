#include <fmt/core.h>

#include <array>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "answer/condense_error.h"
#include "build/build.h"
#include "build/build_system.h"
#include "commands/command.h"
#include "commands/options.h"
#include "offline/pack/accuracy.h"
#include "offline/pack/artefact.h"
#include "report/emit_c.h"
#include "run/model_size.h"
#include "run/unit_note.h"
#include "text/remarks.h"
#include "text/write.h"

namespace railstep {
namespace {

struct CondenseOptions {
  std::string scene, out, emit;
  std::vector<std::string> overrides;
  std::optional<double> window;  // s
  bool skip_errors = false;
  bool json = false;
};

/// Unknowns of bodies and beams that are not held.
int unknowns_of(const SystemModel& system) {
  int sum = -system.held;
  for (std::int32_t i = 0; i < system.bodies; ++i) sum += system.body[i].unknowns;
  for (std::int32_t i = 0; i < system.beams; ++i) sum += system.beam[i].unknowns;
  return sum;
}

/// The known properties of a model; one that is not known is null.
struct Condensed {
  const Model& model;
  std::pair<int, int> unknowns;  // full, kept
  nlohmann::ordered_json static_error, receptance_error, transient_error, window_s;
  nlohmann::ordered_json reference_error, parts;  // of the transient error
  double clipped;                                 // m/N
  std::array<double, 2> band_hz = CondenseScene{}.band_hz;
  std::int64_t bays = 0;
  // where the window begins, and how long the scene is of which it is part
  nlohmann::ordered_json from_s = nullptr, duration_s = nullptr;
  // of the receptance error: its frequency, or one without damping; what the search left open over
  // the largest; places; mesh of the reference
  nlohmann::ordered_json error_hz = nullptr, undamped_hz = nullptr, unresolved = nullptr,
                         places_m = nullptr, reference_elements = nullptr;

  void take(const ReceptanceError& error, const Track& track) {
    if (error.largest) {
      receptance_error = *error.largest;
      error_hz = error.hz;
      unresolved = error.unresolved;
    }
    if (error.undamped_hz) undamped_hz = *error.undamped_hz;
    if (!error.largest && !error.undamped_hz) return;  // nothing was asked
    places_m = receptance_places(track);
    reference_elements = receptance_refinement(track) * track.elements_per_bay;
  }

  BlockNotes notes() const {
    const auto or_not_known = [](const nlohmann::ordered_json& error) {
      return error.is_null() ? BlockNotes::kNotKnown : error.get<double>();
    };
    return {{},
            or_not_known(static_error),
            or_not_known(receptance_error),
            or_not_known(transient_error)};
  }
};

std::int64_t in_bytes(std::int64_t doubles) { return doubles * std::int64_t{sizeof(double)}; }

/// Bytes of a bay on the average; null for a system without a track.
nlohmann::ordered_json per_bay(const Condensed& made, std::size_t block) {
  if (made.bays == 0) return nullptr;
  const auto share = [&](std::int64_t bytes) { return (bytes + made.bays - 1) / made.bays; };
  return {{"model", share(static_cast<std::int64_t>(block))},
          {"state", share(in_bytes(state_doubles(made.model)))},
          {"workspace", share(in_bytes(workspace_doubles(made.model)))}};
}

nlohmann::ordered_json to_json(const Condensed& made, const std::vector<std::byte>& block) {
  return {{"full_unknowns", made.unknowns.first},
          {"kept_unknowns", made.unknowns.second},
          {"bytes", block.size()},
          {"state_bytes", in_bytes(state_doubles(made.model))},
          {"workspace_bytes", in_bytes(workspace_doubles(made.model))},
          {"bytes_per_bay", per_bay(made, block.size())},
          {"flops_per_frame", made.model.cost.flops},
          {"bytes_per_frame", made.model.cost.bytes},
          {"instructions_per_frame", made.model.cost.instructions},
          {"sha256", sum_of(block)},
          {"static_error", made.static_error},
          {"receptance_error", made.receptance_error},
          {"receptance_band_hz", made.band_hz},
          {"receptance_error_hz", made.error_hz},
          {"receptance_undamped_hz", made.undamped_hz},
          {"receptance_unresolved", made.unresolved},
          {"receptance_places_m", made.places_m},
          {"receptance_reference_elements_per_bay", made.reference_elements},
          {"transient_error", made.transient_error},
          {"transient_from_s", made.from_s},
          {"transient_window_s", made.window_s},
          {"transient_duration_s", made.duration_s},
          {"transient_reference_error", made.reference_error},
          {"transient_error_parts", made.parts},
          {"clipped_m_per_n", made.clipped},
          {"one_sided_supports", made.model.fixed.count}};
}

std::string_view bytes_of(const std::vector<std::byte>& block) {
  return {reinterpret_cast<const char*>(block.data()), block.size()};
}

nlohmann::ordered_json write(const std::vector<std::byte>& block, const Condensed& made,
                             const CondenseOptions& o) {
  write_file(o.out, bytes_of(block));
  if (!o.emit.empty())
    write_file(o.emit, emit_c(block, identifier(std::filesystem::path(o.emit).stem().string())));
  return to_json(made, block);
}

nlohmann::ordered_json condense(const Scene& scene, const CondenseOptions& o, Remarks& remarks) {
  remarks.note(lopsided_note(scene));
  remarks.print();
  const Built built(scene);
  const PackedModel& packed = *built.packed;
  Condensed made{packed.model(),
                 unknowns_of(built.track, packed),
                 {},
                 {},
                 {},
                 {},
                 {},
                 {},
                 packed.clipped(),
                 scene.condense.band_hz,
                 scene.track.bays};
  if (!o.skip_errors) {
    if (!packed.load_points().empty()) made.static_error = static_error(built.track, packed);
    made.take(receptance_error(built.track, packed, scene.condense.band_hz), built.track);
  }
  if (!o.skip_errors &&
      scene.external_wheels
          .empty()) {  // the motion of a vehicle in another program is not known here
    const TransientError transient = transient_error(scene, o.overrides, o.window);
    made.transient_error = transient.largest;
    made.window_s = transient.window_s;
    made.from_s = transient.from_s;
    made.duration_s = scene.duration();
    made.reference_error = transient.reference_error;
    made.parts = {{"mesh", transient.parts.mesh},
                  {"condensation", transient.parts.condensation},
                  {"step", transient.parts.step},
                  {"contact_law", nullptr}};
    if (transient.contact_law) made.parts["contact_law"] = *transient.contact_law;
  }
  return write(block_of(built, made.notes()), made, o);
}

/// Nothing of a system is left out: the errors are those of the track beside it, and 0 without a
/// track.
nlohmann::ordered_json condense(const SystemScene& scene, const CondenseOptions& o, Remarks&) {
  const BuiltSystem built(scene);
  const Model& model = built.packed->model();
  const int own = unknowns_of(model.system);
  Condensed made{model, {own, own}, {}, {}, {}, {}, {}, {}, 0.};
  if (!o.skip_errors) made.static_error = made.receptance_error = 0.;
  if (const PackedModel* const packed = built.packed->track()) {
    const Track track = track_of(*scene.track);
    const auto [full, kept] = unknowns_of(track, *packed);
    made.unknowns = {own + full, own + kept};
    made.band_hz = scene.track->condense.band_hz;
    made.bays = scene.track->track.bays;
    if (!o.skip_errors) {
      made.static_error = nullptr;  // bodies hold on to it by themselves: not known
      if (!packed->load_points().empty()) made.static_error = static_error(track, *packed);
      made.receptance_error = nullptr;
      made.take(receptance_error(track, *packed, made.band_hz), track);
    }
  }
  return write(block_of(built, made.notes()), made, o);
}

/// Condenses either kind of scene. A refusal by the models of the errors is one of the scene too.
nlohmann::ordered_json condense(const CondenseOptions& o) try {
  Remarks remarks;
  nlohmann::ordered_json result =
      std::visit([&](const auto& scene) { return condense(scene, o, remarks); },
                 read_any_scene(o.scene, o.overrides));
  remarks.add_to(result);
  return result;
} catch (const Refused& error) {
  throw InputError(o.scene, error);
}

std::string error_or_unknown(const nlohmann::ordered_json& error) {
  return error.is_null() ? "not known" : fmt::format("{:.2e}", error.get<double>());
}

void print_receptance_error(const nlohmann::ordered_json& r) {
  const auto& hz = r["receptance_error_hz"];
  const auto& undamped = r["receptance_undamped_hz"];
  const auto& places = r["receptance_places_m"];
  fmt::print("receptance error  {}{}, {:g} to {:g} Hz", error_or_unknown(r["receptance_error"]),
             hz.is_null() ? "" : fmt::format(" at {:.5g} Hz", hz.get<double>()),
             r["receptance_band_hz"][0].get<double>(), r["receptance_band_hz"][1].get<double>());
  if (!places.is_null())
    fmt::print(" at {:g} and {:g} m, over the largest receptance there", places[0].get<double>(),
               places[1].get<double>());
  const auto& unresolved = r["receptance_unresolved"];
  if (!unresolved.is_null() && unresolved.get<double>() > 1e-2)
    fmt::print("; known to {:.0e} of itself, where the search ended", unresolved.get<double>());
  if (!undamped.is_null())
    fmt::print("; the track swings without damping at {:.5g} Hz", undamped.get<double>());
  fmt::print("\n");
}

void print_errors_table(const nlohmann::ordered_json& r, const std::string& file) {
  fmt::print("{}: {} of {} unknowns, {} bytes, state {}, workspace {}\n", file,
             r["kept_unknowns"].get<int>(), r["full_unknowns"].get<int>(),
             r["bytes"].get<std::int64_t>(), r["state_bytes"].get<std::int64_t>(),
             r["workspace_bytes"].get<std::int64_t>());
  fmt::print("sha256            {}\n", r["sha256"].get<std::string>());
  fmt::print("a frame, at most  {} flops, {} bytes, {} instructions\n",
             r["flops_per_frame"].get<std::int64_t>(), r["bytes_per_frame"].get<std::int64_t>(),
             r["instructions_per_frame"].get<std::int64_t>());
  fmt::print("static error      {}\n", error_or_unknown(r["static_error"]));
  if (const int ports = r["one_sided_supports"].get<int>(); ports > 0)
    fmt::print(
        "  one-sided       {} supports: as springs, or where each force alone presses them\n",
        ports);
  print_receptance_error(r);
  const auto& window = r["transient_window_s"];
  fmt::print("transient error   {}{}\n", error_or_unknown(r["transient_error"]),
             window.is_null()
                 ? ""
                 : fmt::format(" from {:g} to {:g} of {:g} s", r["transient_from_s"].get<double>(),
                               window.get<double>(), r["transient_duration_s"].get<double>()));
  const auto& parts = r["transient_error_parts"];
  if (parts.is_null()) return;
  fmt::print(
      "  of the mesh     {}\n  condensation    {}\n  step            {}\n  reference       {}\n",
      error_or_unknown(parts["mesh"]), error_or_unknown(parts["condensation"]),
      error_or_unknown(parts["step"]), error_or_unknown(r["transient_reference_error"]));
  if (!parts["contact_law"].is_null())
    fmt::print("contact law       {}, against Hertz's\n", error_or_unknown(parts["contact_law"]));
}

}  // namespace

Command add_condense(CLI::App& app) {
  auto o = std::make_shared<CondenseOptions>();
  CLI::App* sub = app.add_subcommand("condense", "Write a scene's model, ready to step");
  sub->add_option("SCENE", o->scene, "scene file (TOML)")->required()->check(reads_file());
  sub->add_option("--out", o->out, "model file to write")->required()->check(writes_file());
  sub->add_option("--emit-c", o->emit, "C file to write: the model for machines without files")
      ->check(writes_file());
  add_overrides(*sub, o->overrides);
  sub->add_option("--window", o->window,
                  "seconds from the start of the scene over which the transient error is found; "
                  "without it all of them, or what of them takes some seconds")
      ->check(CLI::Range(1e-9, 1e9));
  sub->add_flag("--skip-errors", o->skip_errors,
                "write the model alone: finding its errors takes longer than making it");
  sub->add_flag("--json", o->json, "one JSON object on stdout");
  sub->footer("Example: railstep condense config/scenes/ballasted_track.toml --out track.model");
  return {sub, [o] {
            const nlohmann::ordered_json result = condense(*o);
            if (o->json)
              print_json(result);
            else
              print_errors_table(result, o->out);
            return Exit::done;
          }};
}

}  // namespace railstep
