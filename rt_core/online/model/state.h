#pragma once
#include <cstdint>

#include "online/model/model.h"
#include "online/model/status.h"

namespace railstep {

/// All a replay needs, nothing else. The caller owns the memory: state_doubles() of it.
struct State {
  std::int64_t steps;  // time = steps * dt, so it never drifts
  double* u;           // [unknowns] displacement: m; slopes 1
  double* v;           // [unknowns] velocity
  double* a;           // [unknowns] the scheme's acceleration
  double* g;           // [unknowns] true acceleration
};

/// Scratch, meaningless between steps. The caller owns the memory: workspace_doubles() of it.
struct Workspace {
  double* u_star;  // [unknowns]
  double* v_star;  // [unknowns]
  double* solved;  // [unknowns] right-hand side, then the new displacement
  double* scaled;  // [unknowns]
};

/// What a frame publishes.
struct Outputs {
  Status status;
  std::int32_t first_bad_unknown;     // -1: all finite
  double load_x[kMaxLoads];           // m; where the load is, or was when taken off
  double load_deflection[kMaxLoads];  // of the loaded point, m, up positive
  double load_force[kMaxLoads];       // N, up positive
};

inline std::int64_t state_doubles(const Model& model) noexcept { return 4LL * model.unknowns; }
inline std::int64_t workspace_doubles(const Model& model) noexcept { return 4LL * model.unknowns; }

/// Views over the caller's memory, which must be aligned to doubles.
inline State state_on(const Model& model, double* memory) noexcept {
  const std::int64_t n = model.unknowns;
  return {0, memory, memory + n, memory + 2 * n, memory + 3 * n};
}
inline Workspace workspace_on(const Model& model, double* memory) noexcept {
  const std::int64_t n = model.unknowns;
  return {memory, memory + n, memory + 2 * n, memory + 3 * n};
}

/// FNV-1a over the step count and the bits of u, v, a, g: equal states have equal hashes.
std::uint64_t state_hash(const Model& model, const State& state) noexcept;

}  // namespace railstep
