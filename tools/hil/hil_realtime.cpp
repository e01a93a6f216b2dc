#include "hil/hil_realtime.h"

#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "online/step/step.h"

namespace railstep {
namespace {

/// @param code  0 or what errno says
RealtimeSetting outcome(const char* name, int code) {
  return {name, code == 0, code == 0 ? std::string() : std::strerror(code)};
}

/// Locks present and future pages: no page of the run is missing when it is needed.
RealtimeSetting lock_memory() {
  return outcome("memory_locked", mlockall(MCL_CURRENT | MCL_FUTURE) == 0 ? 0 : errno);
}

/// Twice what a frame may need, a write to each page.
[[gnu::noinline]] RealtimeSetting touch_stack() {
  constexpr std::size_t kPage = 4096;
  volatile unsigned char stack[2 * kStepStack];
  for (std::size_t at = 0; at < sizeof stack; at += kPage) stack[at] = 1;
  return {"stack_touched", stack[0] == 1, ""};
}

/// Threads of ordinary priority are else woken up to 50 us late, to save power.
RealtimeSetting drop_timer_slack() {
  return outcome("timer_slack_1ns", prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL) == 0 ? 0 : errno);
}

RealtimeSetting pin(int cpu) {
  cpu_set_t only;
  CPU_ZERO(&only);
  CPU_SET(static_cast<std::size_t>(cpu), &only);
  return outcome("cpu_pinned", sched_setaffinity(0, sizeof only, &only) == 0 ? 0 : errno);
}

RealtimeSetting take_priority(int priority) {
  sched_param wanted{};
  wanted.sched_priority = priority;
  return outcome("sched_fifo", sched_setscheduler(0, SCHED_FIFO, &wanted) == 0 ? 0 : errno);
}

}  // namespace

std::vector<int> allowed_cpus() {
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  std::vector<int> cpus;
  if (sched_getaffinity(0, sizeof allowed, &allowed) != 0) return cpus;
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu)
    if (CPU_ISSET(static_cast<std::size_t>(cpu), &allowed)) cpus.push_back(cpu);
  return cpus;
}

std::vector<RealtimeSetting> become_realtime(const RealtimeWish& wish) {
  std::vector<RealtimeSetting> made = {lock_memory(), touch_stack(), drop_timer_slack()};
  if (wish.cpu) made.push_back(pin(*wish.cpu));
  if (wish.priority > 0) made.push_back(take_priority(wish.priority));
  return made;
}

void unlock_memory() { munlockall(); }

void keep_off(int cpu) {
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  if (sched_getaffinity(0, sizeof allowed, &allowed) != 0) return;
  CPU_CLR(static_cast<std::size_t>(cpu), &allowed);
  // of a single CPU nothing is left, and the thread stays where it is
  if (CPU_COUNT(&allowed) > 0) sched_setaffinity(0, sizeof allowed, &allowed);
}

bool is_virtual_machine() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("flags")) return line.find(" hypervisor") != std::string::npos;
  return false;
}

}  // namespace railstep
