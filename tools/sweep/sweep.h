#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "sweep/sweep_grid.h"
#include "sweep/sweep_key.h"
#include "sweep/sweep_row.h"

namespace railstep {

/// A scene over a grid of its keys, and a folder for what its runs leave.
struct SweepPlan {
  std::filesystem::path scene, out;
  Grid grid;
  double from;  // s, of each run, from which its trace is summed up
  int jobs;
};

/// The content of the table.
struct SweepResult {
  std::vector<std::int64_t> runs;    // which of the grid
  std::vector<std::int64_t> failed;  // of these
  std::int64_t made = 0;             // here; the others' rows were there
  std::string first_error;           // of the first that failed
  std::filesystem::path table;
};

class Sweep {
 public:
  /// Reads the scenes of all runs, so that what is wrong with one is known before any is made.
  /// Throws InputError, naming the run.
  explicit Sweep(SweepPlan plan);

  /// Makes the runs of a shard whose rows are not there, each row kept at once, then the table of
  /// the shard.
  SweepResult run(const Shard& shard);
  /// The table of all runs. Throws InputError where one has no row.
  SweepResult merge();

 private:
  std::string key_of(std::int64_t run);
  void make(std::int64_t run);
  std::vector<std::int64_t> without_row(const std::vector<std::int64_t>& runs) const;
  SweepResult finish(const std::vector<std::int64_t>& runs, const std::string& table) const;

  SweepPlan plan_;
  RunKeys keys_;
  RowStore rows_;
  std::vector<std::string> key_;  // [runs]
};

}  // namespace railstep
