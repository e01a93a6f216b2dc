#include "online/model/system_workspace.h"

#include "online/math/lanes.h"
#include "online/model/beam_chain.h"

namespace railstep {

namespace {

/// Hands out a block piece by piece, each a multiple of 8 doubles; on null it only counts.
struct Cursor {
  double* at;
  std::int64_t used = 0;

  double* take(std::int64_t doubles) noexcept {
    double* const here = at == nullptr ? nullptr : at + used;
    used += (doubles + kLanes - 1) / kLanes * kLanes;
    return here;
  }
  MarkerPose* poses(std::int64_t count) noexcept {
    static_assert(sizeof(MarkerPose) == 12 * sizeof(double));
    return reinterpret_cast<MarkerPose*>(take(12 * count));
  }
};

SystemTangent tangent_from(const SystemModel& s, Cursor& cursor) noexcept {
  const std::int64_t rows = system_rows(s);
  std::int64_t factor = 0, solved = 0;
  for (std::int32_t i = 0; i < s.bodies; ++i) solved += 6LL * part_ends(s, i);
  for (std::int32_t i = 0; i < s.beams; ++i) {
    factor += beam_factor_doubles(s.beam[i]);
    solved += beam_groups(s, i) * end_group_doubles(s.beam[i]);
  }
  solved += 9LL * s.ports * part_ends(s, s.bodies + s.beams);
  SystemTangent t{};
  t.factor = cursor.take(factor);
  t.solved = cursor.take(solved);
  t.compliance = cursor.take(rows * rows);
  t.scale = cursor.take(rows);
  t.order = reinterpret_cast<std::int32_t*>(cursor.take((rows + 1) / 2));
  t.rank = cursor.take(1);
  t.age = cursor.take(1);
  return t;
}

SystemWorkspace workspace_from(const SystemModel& s, Cursor& cursor, double* kept) noexcept {
  const std::int64_t n = s.unknowns, rows = system_rows(s);
  SystemWorkspace w{};
  for (double** part : {&w.x, &w.shift, &w.v, &w.g, &w.residual, &w.change, &w.elastic, &w.inertia,
                        &w.outer, &w.nodes, &w.half_change})
    *part = cursor.take(n);
  w.free_ports = cursor.take(9LL * s.ports);
  w.quaternion = cursor.take(4LL * s.bodies);
  w.matrix = cursor.take(9LL * s.bodies);
  w.start_matrix = cursor.take(9LL * s.bodies);
  w.centre = cursor.take(3LL * s.bodies);
  for (MarkerPose** part : {&w.pose, &w.start_pose, &w.force_pose}) *part = cursor.poses(s.markers);
  w.gradient = cursor.take(std::int64_t{kMostNodeUnknowns} * s.ends);
  if (s.constraint_method == ConstraintMethod::baumgarte) {
    w.ahead = cursor.take(n);
    w.ahead_matrix = cursor.take(9LL * s.bodies);
    w.ahead_pose = cursor.poses(s.markers);
  }
  w.slope = has_slopes(s) ? cursor.take(std::int64_t{kMostNodeUnknowns} * s.ends) : w.gradient;
  for (double** part : {&w.value, &w.start_value, &w.wanted, &w.spring_lack, &w.velocity_part,
                        &w.rate[0], &w.rate[1], &w.force, &w.scratch})
    *part = cursor.take(rows);
  std::int64_t tangents = 0;
  for (std::int32_t i = 0; i < s.beams; ++i)
    if (const std::int64_t own = beam_tangent_doubles(s.beam[i]); own > tangents) tangents = own;
  w.tangents = cursor.take(tangents);
  w.tangent = kept != nullptr ? system_tangent_on(s, kept) : tangent_from(s, cursor);
  return w;
}

}  // namespace

std::int64_t system_tangent_doubles(const SystemModel& system) noexcept {
  Cursor cursor{nullptr};
  tangent_from(system, cursor);
  return cursor.used;
}

std::int64_t system_state_doubles(const SystemModel& system) noexcept {
  if (system.unknowns == 0) return 0;
  return system_start_doubles(system) +
         (system.renew == Renew::kept ? system_tangent_doubles(system) : 0);
}

std::int64_t system_workspace_doubles(const SystemModel& system) noexcept {
  if (system.unknowns == 0) return 0;
  Cursor cursor{nullptr};
  workspace_from(system, cursor, nullptr);
  return cursor.used;
}

SystemTangent system_tangent_on(const SystemModel& system, double* memory) noexcept {
  Cursor cursor{memory};
  return tangent_from(system, cursor);
}

SystemWorkspace system_workspace_on(const SystemModel& system, double* memory,
                                    double* kept) noexcept {
  Cursor cursor{memory};
  return workspace_from(system, cursor, kept);
}

}  // namespace railstep
