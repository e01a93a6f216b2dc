#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace railstep {

/// A column of a trace over its rows.
struct ColumnSummary {
  std::string name;
  double least, most, mean;
  double deviation;  // standard deviation: rms about the mean
  double last;
};

/// The result of a run of a sweep. Nothing in it depends on the machine or on the time that the run
/// took. Where a run failed, only `error`, status and steps have a meaning.
struct SweepRow {
  std::string error;                // empty: the run was made
  std::vector<std::string> status;  // status_names()
  std::int64_t steps = 0;
  std::string state_hash;
  int iterations = 0;
  double constraint_violation = 0., energy_balance_error = 0., numerical_loss = 0.;
  std::vector<ColumnSummary> columns;
};

/// A folder of rows, a file each: rows/<key>.json, by the key of sweep_key.h.
class RowStore {
 public:
  explicit RowStore(const std::filesystem::path& folder) : rows_(folder / "rows") {}
  /// Makes the folder. Throws InputError where a file is in its place.
  void create() const;
  /// Throws as write_file().
  /// @param about  words on the run, for who reads the file
  void write(const std::string& key, const std::string& about, const SweepRow& row) const;
  /// Nothing where there is no whole row of this key.
  std::optional<SweepRow> find(const std::string& key) const;

 private:
  std::filesystem::path file(const std::string& key) const { return rows_ / (key + ".json"); }
  std::filesystem::path rows_;
};

}  // namespace railstep
