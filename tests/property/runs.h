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

/// A scene in a file of this process's own, which goes with it.
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

/// Of a scene, as `railstep run` makes it. Throws InputError.
std::unique_ptr<Simulation> simulation_of(const Document& scene);
std::int64_t frames_of(const Simulation& run);

/// A trace: what a run of a scene came to.
struct Trace {
  std::vector<std::string> columns;
  std::vector<double> rows;  // [frames + 1][columns]
  Status status = Status::ok;
  bool finite = true;
  std::uint64_t hash = 0;  // of the state at the end
  /// By unit: what is smaller than this is nothing in the scene.
  std::map<std::string, double> least = {};

  std::size_t frames() const { return rows.size() / columns.size(); }
  double at(std::size_t frame, std::size_t column) const {
    return rows[frame * columns.size() + column];
  }
};
Trace trace_of(Simulation& run);
/// Throws InputError.
Trace trace_of(const Document& scene);

/// What a column's name says of it: the unit at its end, and whether it is a place in the scene, of
/// which some part moves (.x_m, .y_m, .z_m beside .dx_m, .dy_m, .dz_m).
struct Quantity {
  std::string unit;  // "m", "n", "m_per_s", ...
  bool place;
};
Quantity quantity_of(const std::vector<std::string>& columns, std::size_t column);

/// What is a small length, speed or force in a scene: of bodies what joints are held to, 1e8 times,
/// and what of forces and rates follows from that within a step.
std::map<std::string, double> least_of(const Document& scene);

/// Largest size in a trace of each column's kind of quantity: of all columns of its unit, of places
/// what they move; at least Trace::least. [columns]
std::vector<double> scales_of(const Trace& trace);

/// Where a column of one trace stands in another, and by what: there = factor here + offset.
struct Image {
  std::string column;
  double factor = 1., offset = 0.;
};
using ImageOf = std::function<Image(const std::string& column)>;

/// How far apart two traces are.
struct Distance {
  double largest = 0.;  // over the scale of the column's quantity
  std::string column;   // where it is
  double time = 0., here = 0., there = 0.;
  std::string text() const;
};
/// Columns that have no image are passed over. Throws std::runtime_error where the traces have not
/// the same rows, or a column that should be there is not.
Distance apart(const Trace& here, const Trace& there, const ImageOf& image);
Distance apart(const Trace& here, const Trace& there);

/// The scene with stiffnesses, dampings, masses, forces and places changed by up to `part` of each:
/// how far that moves it says what rounding may.
Document jiggled(const Document& scene, double part);

}  // namespace railstep::property
