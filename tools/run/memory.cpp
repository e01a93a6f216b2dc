#include "run/memory.h"

#include <fmt/core.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

#include "text/read.h"

namespace railstep {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::infinity();

/// The number behind a word of a file; behind "" its first one.
double number_in(const char* file, const std::string& word, double otherwise) {
  std::ifstream in(file);
  std::string found;
  while (found != word && in >> found) {
  }
  double value = 0.;
  return in >> value ? value : otherwise;
}

}  // namespace

double available_memory() {
  const double machine = 1024. * number_in("/proc/meminfo", "MemAvailable:", kUnknown);
  const double container = number_in("/sys/fs/cgroup/memory.max", "", kUnknown);  // "max": none
  rlimit limit{};
  double own = kUnknown;
  if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
    own = static_cast<double>(limit.rlim_cur) -
          static_cast<double>(sysconf(_SC_PAGESIZE)) * number_in("/proc/self/statm", "", 0.);
  return std::max(std::min({machine, container, own}), 0.);
}

void want_recording_memory(std::int64_t numbers) {
  const double wanted = 2. * 8. * static_cast<double>(numbers), found = available_memory();
  if (wanted > found)
    throw InputError("E-RUN-06",
                     fmt::format("--record keeps {} numbers, which take {:.0f} bytes, and {:.0f} "
                                 "bytes of memory are free; expected a shorter --duration",
                                 numbers, wanted, found));
}

}  // namespace railstep
