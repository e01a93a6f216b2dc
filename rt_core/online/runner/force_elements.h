#pragma once
#include "online/runner/element_law.h"
#include "online/runner/wheelset_law.h"

namespace railstep {

// The force elements of a runner, whose laws Newton's method meets beside those of its wheelsets.

/// Displacements of a runner's force elements at the contacts' instant, those of friction from its
/// memory on, and in the workspace what their laws need of this step. They are
/// without what their own force does, see element_force_behind().
/// @param free, start  [element_coordinates] out
void find_elements(const RunnerStage& at, const State& s, const Workspace& w, const double* u,
                   double* free, double* start) noexcept;

/// The coordinates of an element for solve_laws(). @param first  those of all elements begin there
inline LawBlock element_block(const ForceElement& e, int first) noexcept {
  return {first + e.coordinate, 1 + e.loaded, 1};
}
/// The law of an element, for solve_laws(). @param j  among those of the runner
void evaluate_element(const RunnerModel& runner, std::int32_t j, const Workspace& w,
                      const double* z, double* force, const LawSlopes* slopes) noexcept;

/// Takes the end of a step over into the memories of friction.
/// @param z, force  [element_coordinates] of solve_laws()
void keep_elements(const RunnerModel& runner, const double* z, const double* force,
                   const Workspace& w, State& s) noexcept;

/// A force element in a state: what its law needs, and its force.
/// @param poses  of poses_of()
struct StandingElement {
  ElementStep step;
  double z;  // m or rad; of a brake with the turn by which its wheels roll along the way
  double from_memory, load;  // of friction as element_force() takes it; m
  ElementForce force;
};
StandingElement standing_element(const Model& model, const RunnerModel& runner, std::int32_t j,
                                 const State& at, const double* poses) noexcept;

}  // namespace railstep
