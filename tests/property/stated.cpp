// Compares the errors that a model states with finer meshes and steps.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "answer/condense_error.h"
#include "offline/pack/accuracy.h"
#include "properties.h"

namespace railstep::property {
namespace {

/// The scene in full order, with elements and steps these times finer.
Document refined(const Document& scene, int elements, int steps) {
  Document other = scene;
  other.erase("condense");
  other["track"]["elements_per_bay"] =
      elements * static_cast<int>(number(scene["track"], "elements_per_bay", 2.));
  Document& step = other["step"];
  step["frame_s"] = number(step, "frame_s", number(step, "dt_s"));
  step["dt_s"] = number(step, "dt_s") / steps;
  for (const char* key : {"contact", "scheme", "rho_inf"}) step.erase(key);
  return other;
}

/// Whether a column is a deflection under a load or a height of a rail under a wheel.
bool is_judged(const std::string& column) {
  return column.ends_with(".deflection_z_m") || column.ends_with(".rail_z_m");
}

/// Largest difference of the judged columns from a row to another, over the peak of each column, or
/// over the largest peak of all, so that columns that hardly move do not count.
enum class Over { each, all };
double judged_apart(const Trace& a, const Trace& b, std::size_t from, std::size_t to, Over over,
                    std::string& where) {
  std::vector<double> peak(a.columns.size(), 0.);
  for (std::size_t c = 0; c < a.columns.size(); ++c)
    for (std::size_t frame = from; frame < to && is_judged(a.columns[c]); ++frame)
      peak[c] = std::max(peak[c], std::abs(b.at(frame, c)));
  const double largest = *std::max_element(peak.begin(), peak.end());
  double worst = 0.;
  for (std::size_t c = 0; c < a.columns.size(); ++c)
    for (std::size_t frame = from; frame < to && is_judged(a.columns[c]); ++frame) {
      const double scale = over == Over::each ? peak[c] : largest;
      const double off = std::abs(a.at(frame, c) - b.at(frame, c));
      if (off <= worst * scale) continue;
      worst = off / scale;
      where = a.columns[c];
    }
  return worst;
}

/// Places of a vehicle's wheels ahead of its middle, m.
std::vector<double> places_of(const Document& vehicle) {
  const double base = number(vehicle, "wheelbase_m"), apart = number(vehicle, "bogie_distance_m");
  if (base == 0.) return {0.};
  std::vector<double> places;
  for (const double middle : {-.5 * apart, .5 * apart}) {
    for (const double axle : {-.5 * base, .5 * base}) places.push_back(middle + axle);
    if (number(vehicle, "axles", 2.) == 3.) places.push_back(middle);
    if (apart == 0.) break;
  }
  return places;
}

/// Places of all forces by rail, m.
std::map<std::string, std::vector<double>> forces_of(const Document& scene) {
  std::map<std::string, std::vector<double>> on;
  for (const Document& load : tables(scene, "load"))
    on[word(load, "rail", "left")].push_back(number(load, "start_m"));
  for (const Document& w : tables(scene, "wheelset"))
    for (const char* rail : {"left", "right"}) on[rail].push_back(number(w, "start_m"));
  for (const Document& v : tables(scene, "vehicle"))
    for (const double place : places_of(v))
      on[word(v, "rail", "left")].push_back(number(v, "start_m") + place);
  return on;
}

/// Whether two forces on one rail are nearer than an element. The effect of one at the place of the
/// other is then interpolated across a kink: up to F / (k G A) times a quarter of an interval off.
bool has_close_forces(const Document& scene) {
  const Document& track = scene["track"];
  const double element = number(track, "bay_m") / number(track, "elements_per_bay", 2.);
  for (auto& [rail, places] : forces_of(scene)) {
    std::vector<double> along = places;
    std::sort(along.begin(), along.end());
    for (std::size_t i = 1; i < along.size(); ++i)
      if (along[i] - along[i - 1] < element) return true;
  }
  return false;
}

}  // namespace

/// Static deflections do not depend on mesh or condensation, except for the error that the model
/// states and, with supports that do not pull, the part left out there (docs/supports.md: 2e-3).
Outcome statics(const Document& own, std::uint64_t) {
  if (!is_track_alone(own) || is_endless(own)) return Outcome::none("no track with ends alone");
  Document scene = own;
  scene["step"]["start"] = "equilibrium";
  for (Document& v : scene["vehicle"])
    for (const char* key : {"drop_height_m", "drop_speed_m_per_s"}) v.erase(key);
  if (scene.contains("condense") && !scene["condense"].value("residual_flexibility", true))
    return Outcome::none("without residual flexibility the mesh shows");
  if (has_close_forces(scene)) return Outcome::none("forces nearer than an element");
  // Between a load and a one-sided support the mesh matters: by 2e-3 with two elements a bay, more
  // with one (docs/supports.md). This is the same for a condensed track and its own full order.
  const bool coarse = number(scene["track"], "elements_per_bay", 2.) < 2.;
  const int finer = has_one_sided(scene) && (is_condensed(scene) || coarse) ? 1 : 4;
  const auto run = simulation_of(scene);
  const Trace here = trace_of(*run);
  // Effects of forces on each other are left out below 1e-4 (offline/condense/flexibility.h).
  double bound = has_one_sided(scene) ? 2e-3 : 0.;
  for (const auto& [rail, places] : forces_of(scene))
    bound += 1e-4 * static_cast<double>(places.size());
  if (!has_one_sided(scene)) bound += static_error(run->track(), *run->packed());
  std::string where;
  const Trace fine = trace_of(refined(scene, finer, 1));
  const double off = judged_apart(here, fine, 0, 1, Over::all, where);
  return Outcome::of(off <= bound,
                     fmt::format("{} at t = 0 is {:.3g} off full order of {} times the elements; "
                                 "allowed {:.2g}",
                                 where, off, finer, bound));
}

Outcome stated_error(const Document& scene, std::uint64_t) {
  if (!is_track_alone(scene) || is_endless(scene)) return Outcome::none("no track with ends alone");
  const SceneFile file(scene);
  const TransientError stated = transient_error(read_scene(file.path()), {});
  const Trace here = trace_of(scene);
  const Trace fine = trace_of(refined(scene, 6, 8));
  const double frame = number(scene["step"], "frame_s", number(scene["step"], "dt_s"));
  const auto rows = static_cast<std::size_t>(std::llround(stated.window_s / frame)) + 1;
  const std::size_t from = scene["step"]["start"] == "released" ? (rows + 4) / 5 : 0;
  std::string where;
  const double off =
      judged_apart(here, fine, from, std::min(rows, here.frames()), Over::each, where);
  const double bound = 1.5 * (stated.largest + stated.reference_error) + 1e-6;
  return Outcome::of(
      off <= bound,
      fmt::format("{} is {:.3g} off; stated {:.3g}, of the reference {:.2g}, in "
                  "{:.3g} s",
                  where, off, stated.largest, stated.reference_error, stated.window_s));
}

}  // namespace railstep::property
