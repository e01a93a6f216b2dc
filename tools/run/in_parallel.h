#pragma once
#include <algorithm>
#include <atomic>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace railstep {

/// Calls work(i) for i = 0 .. count - 1 on up to `jobs` threads; each takes the next i that is
/// free. After a call that throws, no further call begins, and the exception of the least i is
/// thrown here. It is the same one for any number of threads, as all calls before it had begun.
template <typename Work>
void in_parallel(std::int64_t count, int jobs, const Work& work) {
  std::atomic<std::int64_t> next{0};
  std::mutex lock;
  std::int64_t first_failed = count;
  std::exception_ptr error;
  const auto take = [&] {
    for (std::int64_t i = next++; i < count; i = next++) try {
        work(i);
      } catch (...) {
        next = count;
        const std::lock_guard<std::mutex> hold(lock);
        if (i >= first_failed) continue;
        first_failed = i;
        error = std::current_exception();
      }
  };
  {
    std::vector<std::jthread> others;
    const auto threads = std::min<std::int64_t>(jobs, count);
    others.reserve(static_cast<std::size_t>(std::max<std::int64_t>(threads, 1)));
    for (std::int64_t t = 1; t < threads; ++t) others.emplace_back(take);
    take();
  }
  if (error) std::rethrow_exception(error);
}

}  // namespace railstep
