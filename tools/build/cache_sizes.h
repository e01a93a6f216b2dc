#pragma once
#include <Eigen/Core>

namespace railstep {

/// Eigen blocks its products by the processor's cache sizes. With these fixed sizes the bits are
/// the same on all processors. Eigen keeps them in one place for all threads, so that only the
/// first call sets them.
inline void fix_cache_sizes() {
  static const bool set = [] {
    Eigen::setCpuCacheSizes(32 << 10, 256 << 10, 2 << 20);
    return true;
  }();
  static_cast<void>(set);
}

}  // namespace railstep
