#pragma once
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hard/hard_case.h"
#include "offline/energy/energy_account.h"
#include "run/simulate.h"

namespace railstep {

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// A scene of the suite, run from its start to its end, and the trace of it.
class HardRun {
 public:
  /// @param overrides  as of `railstep run --set`
  /// Throws InputError, also for a name that is not a column of the trace.
  explicit HardRun(const std::filesystem::path& scene,
                   const std::vector<std::string>& overrides = {}, const FrameInputs& inputs = {});

  /// A value for each row; the start's is the first.
  [[nodiscard]] std::vector<double> column(const std::string& name) const;
  [[nodiscard]] std::vector<double> time() const { return column("time_s"); }
  [[nodiscard]] double first(const std::string& name) const { return column(name).front(); }
  [[nodiscard]] double last(const std::string& name) const { return column(name).back(); }
  /// The row that is nearest in time.
  [[nodiscard]] double at(double time_s, const std::string& name) const;
  [[nodiscard]] double largest(const std::string& name) const;
  [[nodiscard]] double smallest(const std::string& name) const;

  [[nodiscard]] const Simulation& simulation() const { return *run_; }
  [[nodiscard]] const RunRecord& record() const { return record_; }
  /// Names of all bits that were set, with blanks between them; empty when all was well.
  [[nodiscard]] std::string status() const;
  [[nodiscard]] double frame_us() const { return quantile(record_.frame_us, .5); }
  /// From a second run; nothing where energies are not known.
  [[nodiscard]] std::optional<EnergyBalance> energy() const;
  /// A curve of the picture: a column over time, times `scale`.
  [[nodiscard]] HardCurve curve(const std::string& name, const std::string& title,
                                double scale = 1.) const;

 private:
  std::unique_ptr<Simulation> run_;
  RunRecord record_;
  FrameInputs inputs_;
};

/// `condense.kind=...`, as an override.
std::string condensed_to(const char* kind);

bool all_finite(const std::vector<double>& values);
bool same_bits(const std::vector<double>& a, const std::vector<double>& b);

/// The message of the program where it refuses a scene; empty where it does not.
std::string refusal(const std::filesystem::path& scene, const std::vector<std::string>& overrides);

}  // namespace railstep
