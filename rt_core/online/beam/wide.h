#pragma once

namespace railstep {

// Vectors of the compiler's own, for speed alone: each lane is rounded as a double by itself.
using Two = double __attribute__((vector_size(16)));
#ifdef __AVX__
using Wide = double __attribute__((vector_size(32)));
#else
using Wide = Two;
#endif
inline constexpr int kWide = static_cast<int>(sizeof(Wide) / sizeof(double));

}  // namespace railstep
