#pragma once

namespace railstep {

// Of the loops of a step that are the same in every model; a model states others of its own.
inline constexpr int kLocateSteps = 8;  // evaluations of one search for a contact
inline constexpr int kPortSweeps = 8;   // Newton iterations of one solve of all contacts

// What one solve of all contacts may hold.
inline constexpr int kMaxWheels = 32;      // of wheelsets and vehicles, a flange as another
inline constexpr int kMaxFixedPorts = 32;  // one-sided springs of the track
inline constexpr int kPorts = kMaxWheels + kMaxFixedPorts;

}  // namespace railstep
