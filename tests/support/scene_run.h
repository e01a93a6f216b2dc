#pragma once
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "run/simulate.h"
#include "support/shipped.h"

namespace railstep {

/// A scene that a test writes and the program reads.
inline Scene scene_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  static int count = 0;
  const auto file =
      std::filesystem::temp_directory_path() /
      ("railstep_text_" + std::to_string(getpid()) + "_" + std::to_string(count++) + ".toml");
  std::ofstream(file) << text;
  const struct Removed {
    const std::filesystem::path& file;
    ~Removed() { std::filesystem::remove(file); }
  } removed{file};
  return read_scene(file, overrides);
}

/// A run of a scene, shipped or not, with the values of each column frame by frame.
struct Traced {
  std::vector<std::string> columns;
  std::vector<double> rows;
  Status status;

  explicit Traced(const std::string& name, const std::vector<std::string>& overrides = {})
      : Traced(read_scene(kScenes + name + ".toml", overrides)) {}
  explicit Traced(const Scene& scene) {
    Simulation run(scene);
    RunRecord record =
        simulate(run, run.model().steps / run.model().steps_per_frame, nullptr, true, nullptr);
    columns = run.columns();
    rows = std::move(record.rows);
    status = record.status;
  }
  std::vector<double> operator[](const std::string& column) const {
    const auto at = std::find(columns.begin(), columns.end(), column) - columns.begin();
    REQUIRE(at < static_cast<std::ptrdiff_t>(columns.size()));
    std::vector<double> values;
    for (std::size_t i = static_cast<std::size_t>(at); i < rows.size(); i += columns.size())
      values.push_back(rows[i]);
    return values;
  }
};

inline double largest_of(const std::vector<double>& values) {
  double most = 0.;
  for (const double x : values) most = std::max(most, std::fabs(x));
  return most;
}

/// Largest difference of two columns over the largest value of the second.
inline double relative_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0.;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::fabs(a[i] - b[i]));
  return most / largest_of(b);
}

}  // namespace railstep
