#pragma once
#include <atomic>
#include <cstdint>

namespace railstep {

/// Calls of operator new so far, by any thread; counted in the program `railstep` alone
/// (heap_count.cpp), 0 elsewhere. Direct calls of malloc are not counted: the online library does
/// not import malloc, which a test checks.
inline std::atomic<std::int64_t> heap_call_count{0};

inline std::int64_t heap_calls() noexcept {
  return heap_call_count.load(std::memory_order_relaxed);
}

}  // namespace railstep
