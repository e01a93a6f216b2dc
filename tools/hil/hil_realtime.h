#pragma once
#include <optional>
#include <string>
#include <vector>

namespace railstep {

/// Something asked of the system for the thread that steps, and what came of it.
struct Setting {
  std::string name;    // as in the JSON
  bool done;           // else refused
  std::string reason;  // why it was refused
};

/// What a run asks for.
struct RealtimeWish {
  std::optional<int> cpu;
  int priority = 0;  // of SCHED_FIFO, 1 to 99; 0: not asked for
};

/// CPUs that this thread may run on, rising.
std::vector<int> allowed_cpus();

/// For the calling thread, in the order in which they stand: memory locked (mlockall), stack
/// touched, timers without slack, pinned to a CPU, SCHED_FIFO. Nothing throws: what the system
/// refuses is said, and the rest is done all the same.
std::vector<Setting> become_realtime(const RealtimeWish& wish);

/// Lets memory go again: locked pages count against a limit that what follows may not fit.
void unlock_memory();

/// Keeps the calling thread off a CPU, where it has another one to run on.
void keep_off(int cpu);

/// Whether the processor says that it is a virtual one.
bool is_virtual_machine();

}  // namespace railstep
