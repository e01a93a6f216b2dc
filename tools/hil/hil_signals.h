#pragma once
#include <atomic>

namespace railstep {

/// Set by the first SIGINT or SIGTERM after end_on_signals().
extern std::atomic<bool> interrupted_by_signal;

/// Ctrl-C ends the run between two frames, and its results are printed all the same. A second one
/// kills the program, and leaves no shared memory behind.
void end_on_signals();

}  // namespace railstep
