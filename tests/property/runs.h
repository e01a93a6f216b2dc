#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "document.h"
#include "run/simulate.h"
#include "scene/scene_system.h"

namespace railstep::property {

/// A scene in a temporary file of this process, removed with the object.
class SceneFile {
 public:
  explicit SceneFile(const Document& scene);
  ~SceneFile();
  SceneFile(const SceneFile&) = delete;
  SceneFile& operator=(const SceneFile&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// The simulation of a scene, as `railstep run` makes it. Throws InputError.
std::unique_ptr<Simulation> simulation_of(const Document& scene);
std::int64_t frames_of(const Simulation& run);

/// The trace and result of a run of a scene.
struct Trace {
  std::vector<std::string> columns;
  std::vector<double> rows;  // [frames + 1][columns]
  Status status = Status::ok;
  bool finite = true;
  std::uint64_t hash = 0;  // of the state at the end
  /// By unit: smaller values do not matter in this scene.
  std::map<std::string, double> least = {};

  std::size_t frames() const { return rows.size() / columns.size(); }
  double at(std::size_t frame, std::size_t column) const {
    return rows[frame * columns.size() + column];
  }
};
Trace trace_of(Simulation& run);
/// Throws InputError.
Trace trace_of(const Document& scene);

/// Quantity of a column by its name: the unit at its end, and whether it is a place in the scene,
/// whose change is the motion (.x_m, .y_m, .z_m beside .dx_m, .dy_m, .dz_m).
struct Quantity {
  std::string unit;  // "m", "n", "m_per_s", ...
  bool place;
};
Quantity quantity_of(const std::vector<std::string>& columns, std::size_t column);

/// Small lengths, speeds and forces of a scene by unit. With bodies: 1e8 times the tolerance of
/// joints, and the rates and forces that follow from that within a step.
std::map<std::string, double> least_of(const Document& scene);

/// Scale of each column [columns]: the largest size among all columns of its unit, at least
/// Trace::least. Places count by their change.
std::vector<double> scales_of(const Trace& trace);

/// The column of another trace that corresponds to one here: there = factor here + offset.
struct Image {
  std::string column;
  double factor = 1., offset = 0.;
};
using ImageOf = std::function<Image(const std::string& column)>;

/// How far apart two traces are.
struct Distance {
  double largest = 0.;  // over the scale of the column's quantity
  std::string column;   // where it was found
  double time = 0., here = 0., there = 0.;
  std::string text() const;
};
/// Columns without an image are left out. Throws std::runtime_error if the numbers of rows differ
/// or a column is missing.
Distance apart(const Trace& here, const Trace& there, const ImageOf& image);
Distance apart(const Trace& here, const Trace& there);

/// The scene with stiffnesses, dampings, masses, forces and places each changed by up to `part` of
/// it. The change of its motion shows the effect of rounding.
Document jiggled(const Document& scene, double part);

}  // namespace railstep::property
