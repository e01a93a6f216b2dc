#pragma once

namespace railstep {

// Caps of those loops of a step that are the same in every model; a model states its own others.
inline constexpr int kLocateSteps = 8;  // evaluations of one search for a contact
inline constexpr int kPortSweeps = 8;   // Newton iterations of one solve of all contacts

// Sizes of one solve of all contacts.
inline constexpr int kMaxWheels = 32;      // of wheelsets and vehicles; a flange counts as one
inline constexpr int kMaxFixedPorts = 32;  // one-sided springs of the track
inline constexpr int kPorts = kMaxWheels + kMaxFixedPorts;

}  // namespace railstep
