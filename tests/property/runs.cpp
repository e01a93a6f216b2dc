#include "runs.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <stdexcept>

#include "draw.h"

namespace railstep::property {
namespace {

std::filesystem::path own_folder() {
  const std::filesystem::path memory = "/dev/shm";
  return std::filesystem::is_directory(memory) ? memory : std::filesystem::temp_directory_path();
}

}  // namespace

SceneFile::SceneFile(const Document& scene) {
  static int count = 0;
  path_ = own_folder() / fmt::format("railstep_property_{}_{}.toml", getpid(), count++);
  std::ofstream(path_) << text_of(scene);
}
SceneFile::~SceneFile() {
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

std::unique_ptr<Simulation> simulation_of(const Document& scene) {
  const SceneFile file(scene);
  return railstep::simulation_of(read_any_scene(file.path()));
}
std::int64_t frames_of(const Simulation& run) {
  return run.model().steps / run.model().steps_per_frame;
}

Trace trace_of(Simulation& run) {
  RunRecord record = simulate(run, frames_of(run), nullptr, true);
  return {run.columns(),
          std::move(record.rows),
          record.status,
          record.first_bad_unknown < 0,
          state_hash(run.model(), run.state),
          {}};
}
Trace trace_of(const Document& scene) {
  Trace trace = trace_of(*simulation_of(scene));
  trace.least = least_of(scene);
  return trace;
}

namespace {

/// Sum of the weights and forces on a track, N.
double applied(const Document& scene) {
  double sum = 1.;
  for (const Document& load : tables(scene, "load"))
    sum += std::abs(number(load, "force_z_n")) + std::abs(number(load, "amplitude_n"));
  for (const char* carriers : {"wheelset", "vehicle"})
    for (const Document& carrier : tables(scene, carriers))
      for (const auto& [key, value] : carrier.items())
        if (key.ends_with("mass_kg")) sum += 9.81 * value.get<double>();
  return sum;
}

}  // namespace

std::map<std::string, double> least_of(const Document& scene) {
  constexpr double kSharp = 1e8;  // over rounding, as properties compare
  const double dt = number(scene["step"], "dt_s");
  if (tables(scene, "body").empty() && tables(scene, "beam").empty())
    return {{"m", 1e-9},           {"m_per_s", 1e-9 / dt},
            {"n", applied(scene)}, {"n_s", applied(scene) * dt},
            {"pa", 1e3},           {"rad", 1e-9}};
  const double gap = kSharp * number(scene.value("joints", Document()), "tolerance_m", 1e-10);
  double mass = 0.;
  for (const Document& b : tables(scene, "body")) mass += number(b, "mass_kg");
  const double force = mass * (9.81 + 4. * gap / (dt * dt));
  return {{"m", gap}, {"m_per_s", 10. * gap / dt}, {"n", force}, {"n_m", force}, {"rad", gap}};
}

Quantity quantity_of(const std::vector<std::string>& columns, std::size_t column) {
  static const char* const units[] = {"_m_per_s2", "_m_per_s", "_n_m", "_n_s", "_n",
                                      "_m",        "_rad",     "_pa",  "_s"};
  const std::string& name = columns[column];
  Quantity q{"", false};
  for (const char* unit : units)
    if (name.ends_with(unit)) {
      q.unit = unit + 1;
      break;
    }
  const std::size_t dot = name.rfind('.');
  if (q.unit != "m" || dot == std::string::npos) return q;
  const std::string own = name.substr(dot + 1);
  const std::string moved = name.substr(0, dot + 1) + "d" + own;
  q.place = own == "x_m" || own == "y_m" ||
            (own == "z_m" && std::find(columns.begin(), columns.end(), moved) != columns.end());
  return q;
}

std::vector<double> scales_of(const Trace& trace) {
  std::map<std::string, double> of_unit = trace.least;
  std::vector<std::string> unit;
  for (std::size_t c = 0; c < trace.columns.size(); ++c) {
    const Quantity q = quantity_of(trace.columns, c);
    unit.push_back(q.unit);
    double& scale = of_unit[q.unit];
    for (std::size_t frame = 0; frame < trace.frames(); ++frame) {
      const double moved = q.place ? trace.at(frame, c) - trace.at(0, c) : trace.at(frame, c);
      if (std::isfinite(moved)) scale = std::max(scale, std::abs(moved));
    }
  }
  std::vector<double> scales;
  scales.reserve(unit.size());
  for (const std::string& own : unit) scales.push_back(of_unit[own]);
  return scales;
}

std::string Distance::text() const {
  return fmt::format("{:.3g} of its scale apart in {} at {:.6g} s: {:.17g} and {:.17g}", largest,
                     column.empty() ? "nothing" : column, time, here, there);
}

Distance apart(const Trace& here, const Trace& there, const ImageOf& image) {
  if (here.frames() != there.frames())
    throw std::runtime_error(
        fmt::format("{} rows here and {} there", here.frames(), there.frames()));
  const std::vector<double> scales = scales_of(here);
  Distance worst;
  for (std::size_t c = 1; c < here.columns.size(); ++c) {
    const Image own = image(here.columns[c]);
    if (own.column.empty()) continue;
    const auto at = std::find(there.columns.begin(), there.columns.end(), own.column);
    if (at == there.columns.end()) throw std::runtime_error("no column " + own.column);
    const auto d = static_cast<std::size_t>(at - there.columns.begin());
    for (std::size_t frame = 0; frame < here.frames(); ++frame) {
      const double expected = own.factor * here.at(frame, c) + own.offset;
      const double seen = there.at(frame, d);
      // A double of this size cannot represent smaller differences.
      const double size = std::max(std::abs(expected), std::abs(own.offset));
      const double off = std::max(0., std::abs(seen - expected) - 4e-16 * size);
      const double part = off == 0. ? 0. : off / (std::abs(own.factor) * scales[c]);
      if (!(part <= worst.largest))
        worst = {std::isnan(part) ? HUGE_VAL : part, here.columns[c], here.at(frame, 0), expected,
                 seen};
    }
  }
  return worst;
}
Distance apart(const Trace& here, const Trace& there) {
  return apart(here, there, [](const std::string& column) { return Image{column}; });
}

Document jiggled(const Document& scene, double part) {
  static const char* const continuous[] = {"_n_per_m", "_n_s_per_m", "_n_m_per_rad", "_kg",
                                           "_kg_m2",   "_n",         "_pa",          "_kg_per_m3",
                                           "start_m",  "_m4"};
  Document other = scene;
  Draw draw(1, 99);
  for_each_entry(other, [&](const std::string& key, Document& value) {
    const bool changes = std::any_of(std::begin(continuous), std::end(continuous),
                                     [&](const char* end) { return key.ends_with(end); });
    const bool place = key == "position_m" || key == "point_m" || key == "other_point_m";
    if (changes || (place && value.is_array()))
      for_each_number(value, [&](Document& n) {
        if (n.is_number_float()) n = n.get<double>() * (1. + draw.between(-part, part));
      });
  });
  return other;
}

}  // namespace railstep::property
