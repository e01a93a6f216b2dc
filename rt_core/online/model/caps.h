#pragma once

namespace railstep {

// Caps of those loops of a step that are the same in every model; a model states its own others.
inline constexpr int kLocateSteps = 8;   // evaluations of one search for a contact
inline constexpr int kPortSweeps = 8;    // Newton iterations of one solve of all contacts
inline constexpr int kNewtonSweeps = 8;  // the same where laws are not all scalar

// Sizes of one solve of all contacts.
inline constexpr int kMaxWheels = 32;      // of wheelsets and vehicles; a flange counts as one
inline constexpr int kMaxFixedPorts = 32;  // one-sided springs of the track
inline constexpr int kPorts = kMaxWheels + kMaxFixedPorts;
inline constexpr int kMostNewton = 64;  // coordinates of laws that are not all scalar
inline constexpr int kMostLaw = 12;     // of one law: a wheelset and the rails under its wheels

}  // namespace railstep
