#include <fmt/core.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "build.h"
#include "command.h"
#include "condense_error.h"
#include "offline/pack/accuracy.h"
#include "offline/pack/artefact.h"
#include "offline/pack/cost.h"
#include "simulation.h"
#include "write.h"

namespace railstep {
namespace {

struct CondenseOptions {
  std::string scene, out;
  std::vector<std::string> overrides;
  bool json = false;
};

/// Unknowns of the track, and those that the model carries of it; wheelsets stand beside.
std::pair<int, int> unknowns_of(const Built& built) {
  int full = 0, kept = 0;
  for (const Line& line : assemble(built.track)) full += line.unknowns();
  for (const PackedLine& own : built.packed->lines())
    kept += built.packed->model().condensed != 0 ? static_cast<int>(own.basis.omega.size())
                                                 : own.line.unknowns();
  return {full, kept};
}

nlohmann::ordered_json condense(const CondenseOptions& o) {
  const Scene scene = read_scene(o.scene, o.overrides);
  const Built built(scene);
  const Model& model = built.packed->model();
  const std::vector<std::byte> block = block_of(built);
  const auto [full, kept] = unknowns_of(built);
  const TransientError transient = transient_error(scene, o.overrides);
  const auto size = [](std::int64_t doubles) { return doubles * std::int64_t{sizeof(double)}; };
  nlohmann::ordered_json result = {
      {"full_unknowns", full},
      {"kept_unknowns", kept},
      {"bytes", block.size()},
      {"state_bytes", size(state_doubles(model))},
      {"workspace_bytes", size(workspace_doubles(model))},
      {"flops_per_frame", flops_per_frame(model)},
      {"sha256", sum_of(block)},
      {"static_error", static_error(built.track, *built.packed)},
      {"receptance_error", receptance_error(built.track, *built.packed)},
      {"receptance_band_hz", {kReceptanceFrom, kReceptanceTo}},
      {"transient_error", transient.largest},
      {"transient_window_s", transient.window_s},
      {"clipped_m_per_n", built.packed->clipped()}};
  write_file(o.out, std::string_view(reinterpret_cast<const char*>(block.data()), block.size()));
  return result;
}

void print_table(const nlohmann::ordered_json& r, const std::string& file) {
  fmt::print("{}: {} of {} unknowns, {} bytes, state {}, workspace {}\n", file,
             r["kept_unknowns"].get<int>(), r["full_unknowns"].get<int>(),
             r["bytes"].get<std::int64_t>(), r["state_bytes"].get<std::int64_t>(),
             r["workspace_bytes"].get<std::int64_t>());
  fmt::print("sha256            {}\n", r["sha256"].get<std::string>());
  fmt::print("flops per frame   {}\n", r["flops_per_frame"].get<std::int64_t>());
  fmt::print("static error      {:.2e}\n", r["static_error"].get<double>());
  fmt::print("receptance error  {:.2e}, {:g} to {:g} Hz\n", r["receptance_error"].get<double>(),
             kReceptanceFrom, kReceptanceTo);
  fmt::print("transient error   {:.2e} in {:g} s\n", r["transient_error"].get<double>(),
             r["transient_window_s"].get<double>());
}

}  // namespace

Command add_condense(CLI::App& app) {
  auto o = std::make_shared<CondenseOptions>();
  CLI::App* sub = app.add_subcommand("condense", "Write a scene's model, ready to step");
  sub->add_option("SCENE", o->scene, "scene file (TOML)")->required();
  sub->add_option("--out", o->out, "model file to write")->required();
  sub->add_option("--set", o->overrides, "key.path=value, as if written in the scene; repeatable")
      ->take_all()
      ->allow_extra_args(false);
  sub->add_flag("--json", o->json, "one JSON object on stdout");
  sub->footer("Example: railstep condense config/scenes/ballasted_track.toml --out track.model");
  return {sub, [o] {
            const nlohmann::ordered_json result = condense(*o);
            if (o->json)
              fmt::print("{}\n", result.dump(2));
            else
              print_table(result, o->out);
            return Exit::done;
          }};
}

}  // namespace railstep
