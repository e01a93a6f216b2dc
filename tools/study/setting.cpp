#include "study/setting.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "sweep/sweep_grid.h"
#include "text/read.h"

namespace railstep {
namespace {

std::vector<std::string> parts_of(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char c : text)
    if (c == ':')
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

bool is_number(const std::string& text) {
  char* end = nullptr;
  static_cast<void>(std::strtod(text.c_str(), &end));
  return !text.empty() && end == text.c_str() + text.size();
}

const std::vector<std::string> kKinds = {"full",          "modal",  "guyan",        "irs",
                                         "craig-bampton", "krylov", "complex-modes"};

bool is_one_of(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

[[noreturn]] void refuse_model(const std::string& model) {
  throw InputError(
      "E-STUDY-12",
      fmt::format("model \"{}\" is unknown; expected KIND[:AMOUNT][:bare][:UNKNOWNS]. KIND is "
                  "full, modal, guyan, irs, craig-bampton, krylov or complex-modes; AMOUNT is the "
                  "modes a bay (for guyan and irs the nodes a bay); bare leaves out the residual "
                  "flexibility; UNKNOWNS is vertical or rigid-section",
                  model));
}

void add_model(const std::string& model, std::vector<std::string>& overrides) {
  const std::vector<std::string> parts = parts_of(model);
  const std::string& kind = parts[0];
  if (!is_one_of(kKinds, kind)) refuse_model(model);
  overrides.push_back(fmt::format("condense.kind=\"{}\"", kind));
  const char* amount =
      kind == "guyan" || kind == "irs" ? "condense.nodes_per_bay" : "condense.modes_per_bay";
  for (std::size_t i = 1; i < parts.size(); ++i) {
    if (is_number(parts[i]) && kind != "full")
      overrides.push_back(fmt::format("{}={}", amount, parts[i]));
    else if (parts[i] == "bare")
      overrides.emplace_back("condense.residual_flexibility=false");
    else if (parts[i] == "vertical" || parts[i] == "rigid-section")
      overrides.push_back(fmt::format("track.unknowns=\"{}\"", parts[i]));
    else
      refuse_model(model);
  }
}

void add_scheme(const std::string& scheme, std::vector<std::string>& overrides) {
  const std::vector<std::string> parts = parts_of(scheme);
  const bool has_number = parts.size() == 2 && is_number(parts[1]);
  const auto with = [&](const char* name) { return parts[0] == name && has_number; };
  const auto alone = [&](const char* name) { return scheme == name; };
  const auto add = [&](const std::string& text) { overrides.push_back(text); };
  if (!alone("discrete-gradient")) add("step.contact=\"penetration\"");
  if (alone("own")) return;
  if (with("generalised-alpha")) {
    add("step.scheme=\"generalised-alpha\"");
    add("step.rho_inf=" + parts[1]);
  } else if (with("hht")) {
    add("step.scheme=\"hht\"");
    add("step.hht_alpha=" + parts[1]);
  } else if (with("held")) {
    add("step.rho_inf=" + parts[1]);
  } else if (alone("newmark") || alone("backward-euler") || alone("tr-bdf2")) {
    add(fmt::format("step.scheme=\"{}\"", scheme));
  } else if (alone("discrete-gradient")) {
    add("step.contact=\"discrete-gradient\"");
  } else {
    throw InputError(
        "E-STUDY-13",
        fmt::format("scheme \"{}\" is unknown; expected own, generalised-alpha:RHO_INF, newmark, "
                    "hht:ALPHA, backward-euler or tr-bdf2 in full order, held:RHO_INF or "
                    "discrete-gradient for condensed models",
                    scheme));
  }
}

bool has_hertz(const Scene& scene) {
  return !scene.wheelsets.empty() || !scene.rail_vehicles.empty() ||
         std::any_of(scene.vehicles.begin(), scene.vehicles.end(),
                     [](const VehicleScene& v) { return v.contact == WheelContactKind::hertz; });
}

/// The grid of the keys that are varied. Throws InputError for a key that the other lists choose,
/// and for a table that holds one.
Grid changes_of(const std::vector<std::string>& varied) {
  for (const std::string& option : varied) {
    const std::string key = read_varied(option).key;
    for (const char* const own :
         {"condense.kind", "condense.modes_per_bay", "condense.nodes_per_bay",
          "condense.residual_flexibility", "track.unknowns", "track.elements_per_bay",
          "step.contact", "step.scheme", "step.rho_inf", "step.hht_alpha", "step.dt_s",
          "step.frame_s"})
      if (key == own || std::string(own).starts_with(key + "."))
        throw InputError("E-STUDY-16",
                         fmt::format("--vary {}: the study chooses this by itself; expected "
                                     "--models, --meshes, --schemes or --steps",
                                     option));
  }
  return {{}, varied};
}

/// From a frame to half the scene's step, the longest first.
std::vector<double> default_steps(const StepScene& step) {
  std::int64_t count = 2 * step.steps_per_frame;
  std::vector<std::int64_t> counts = {count};
  while (count % 2 == 0 && counts.size() < 5) counts.push_back(count /= 2);
  if (count > 1) counts.push_back(1);
  std::reverse(counts.begin(), counts.end());
  const double frame = step.dt * static_cast<double>(step.steps_per_frame);
  std::vector<double> steps;
  steps.reserve(counts.size());
  for (const std::int64_t n : counts) steps.push_back(frame / static_cast<double>(n));
  return steps;
}

}  // namespace

bool is_condensed(const std::string& model) { return parts_of(model)[0] != "full"; }

bool is_of_condensed(const std::string& scheme) {
  return scheme == "discrete-gradient" || parts_of(scheme)[0] == "held";
}

int mesh_of(const Scene& scene) {
  return scene.track.rigid ? 0 : static_cast<int>(scene.track.elements_per_bay);
}

std::vector<std::string> overrides_of(const Setting& setting) {
  std::vector<std::string> overrides;
  add_model(setting.model, overrides);
  if (setting.elements_per_bay > 0)
    overrides.push_back(fmt::format("track.elements_per_bay={}", setting.elements_per_bay));
  add_scheme(setting.scheme, overrides);
  overrides.push_back(fmt::format("step.dt_s={:.17g}", setting.step));
  overrides.insert(overrides.end(), setting.changes.begin(), setting.changes.end());
  return overrides;
}

std::string words_of(const Setting& setting) {
  std::string words =
      fmt::format("{}, {} element{} a bay, {}, {:.6g} us", setting.model, setting.elements_per_bay,
                  setting.elements_per_bay == 1 ? "" : "s", setting.scheme, 1e6 * setting.step);
  for (const std::string& change : setting.changes) words += ", " + change;
  return words;
}

Choices filled(Choices own, const Scene& scene) {
  Choices all = default_choices(scene);
  if (!own.models.empty()) all.models = std::move(own.models);
  if (!own.meshes.empty()) all.meshes = std::move(own.meshes);
  if (!own.schemes.empty()) all.schemes = std::move(own.schemes);
  if (!own.steps.empty()) all.steps = std::move(own.steps);
  all.varied = std::move(own.varied);
  std::sort(all.steps.rbegin(), all.steps.rend());
  return all;
}

Choices default_choices(const Scene& scene) {
  Choices all;
  all.models = {"full", "modal:1", "modal:2", "modal:4"};
  if (!scene.track.endless)
    all.models.insert(all.models.end(),
                      {"irs:1", "craig-bampton:4", "complex-modes:2", "modal:2:bare"});
  const int own = mesh_of(scene);
  if (own > 1) all.meshes.push_back((own + 1) / 2);
  all.meshes.push_back(own);
  if (own > 0) all.meshes.push_back(2 * own);
  all.schemes = {fmt::format("generalised-alpha:{:g}", scene.step->rho_inf), "newmark",
                 "backward-euler", "tr-bdf2", fmt::format("held:{:g}", scene.step->rho_inf)};
  if (has_hertz(scene)) all.schemes.emplace_back("discrete-gradient");
  all.steps = default_steps(*scene.step);
  return all;
}

bool goes_with(const std::string& model, const std::string& scheme) {
  if (scheme == "own") return true;
  if (parts_of(model)[0] == "complex-modes" && scheme == "discrete-gradient") return false;
  return is_condensed(model) == is_of_condensed(scheme);
}

std::vector<Setting> settings_of(const Choices& choices) {
  const Grid changes = changes_of(choices.varied);
  std::vector<Setting> all;
  for (std::int64_t run = 0; run < changes.runs(); ++run)
    for (const std::string& model : choices.models)
      for (const int mesh : choices.meshes)
        for (const std::string& scheme : choices.schemes)
          for (const double step : choices.steps)
            if (goes_with(model, scheme))
              all.push_back({model, mesh, scheme, step, changes.changes(run)});
  return all;
}

std::string plain_scheme(const std::string& model, const StepScene& step) {
  if (is_condensed(model)) return "held:1";
  const bool other = step.scheme == TimeScheme::newmark || step.scheme == TimeScheme::hht;
  return other ? "own" : "generalised-alpha:0.6";
}

}  // namespace railstep
