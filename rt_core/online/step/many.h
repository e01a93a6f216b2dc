#pragma once
#include "online/step/step.h"

namespace railstep {

inline constexpr int kTogether = 8;  // states that are stepped side by side

/// Scratch of states of one model that are stepped together, meaningless between calls.
struct ManyWorkspace {
  Workspace one[kTogether];  // u_star to solved and imaginary of their own, the rest is shared
  Workspace alone;           // of a state by itself
  std::ptrdiff_t stride;     // doubles from the arrays of one to those of the next
  Common* common;
  Outputs* last;  // [kTogether] what was published before the frame
};

/// Bytes that it views: those of a Workspace, kTogether times what each has of its own, and some
/// 100 kB that do not depend on the model.
std::int64_t many_bytes(const Model& model) noexcept;

/// Views over the caller's memory, which must be aligned to doubles.
ManyWorkspace many_workspace_on(const Model& model, void* memory) noexcept;

/// Advances each of `count` states by one frame, to the bits of advance_frame(), in any order of
/// steps that they stand at. What a step finds of the model and the time alone is found once for
/// all that stand at it.
[[nodiscard]] Status advance_frames(const Model& model, State* states, int count,
                                    ManyWorkspace& workspace, Outputs* outputs) noexcept;

/// The same with new inputs of each.
/// @param inputs  [count][model.inputs] N or N m
[[nodiscard]] Status advance_frames(const Model& model, const double* inputs, State* states,
                                    int count, ManyWorkspace& workspace, Outputs* outputs) noexcept;

}  // namespace railstep
