#pragma once

namespace railstep {

// Of the loops of a step that are the same in every model; a model states others of its own.
inline constexpr int kLocateSteps = 8;  // evaluations of one search for a contact
inline constexpr int kPortSweeps = 8;   // Newton iterations of one solve of all contacts

}  // namespace railstep
