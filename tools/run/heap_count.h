#pragma once
#include <atomic>
#include <cstdint>

namespace railstep {

/// Calls of operator new so far, by any thread; counted in the program `railstep` alone
/// (heap_count.cpp), 0 elsewhere. What calls malloc itself is not seen: the online library does not
/// import it, which a test holds.
inline std::atomic<std::int64_t> heap_call_count{0};

inline std::int64_t heap_calls() noexcept {
  return heap_call_count.load(std::memory_order_relaxed);
}

}  // namespace railstep
