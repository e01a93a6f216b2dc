#pragma once
#include <Eigen/Core>

namespace railstep {

/// Eigen blocks its products by the processor's caches; by these, the bits are the same on all. It
/// keeps them in one place for all threads, so they are set by the first call alone.
inline void fix_cache_sizes() {
  static const bool set = [] {
    Eigen::setCpuCacheSizes(32 << 10, 256 << 10, 2 << 20);
    return true;
  }();
  static_cast<void>(set);
}

}  // namespace railstep
