#pragma once
#include <optional>
#include <string>
#include <vector>

namespace railstep {

/// A request to the system for the thread that steps, and its outcome.
struct RealtimeSetting {
  std::string name;    // as in the JSON
  bool done;           // else refused
  std::string reason;  // why it was refused
};

/// The requests of a run.
struct RealtimeWish {
  std::optional<int> cpu;
  int priority = 0;  // of SCHED_FIFO, 1 to 99; 0: not asked for
};

/// CPUs that this thread may run on, rising.
std::vector<int> allowed_cpus();

/// For the calling thread, in the order in which they stand: memory locked (mlockall), stack
/// touched, timers without slack, pinned to a CPU, SCHED_FIFO. Nothing throws: a request that the
/// system refuses is returned as such, and the others are done all the same.
std::vector<RealtimeSetting> become_realtime(const RealtimeWish& wish);

/// Unlocks the memory: locked pages count against a limit, which later work may exceed.
void unlock_memory();

/// Keeps the calling thread off a CPU, where it has another one to run on.
void keep_off(int cpu);

/// Whether the processor says that it is a virtual one.
bool is_virtual_machine();

}  // namespace railstep
