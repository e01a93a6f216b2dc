// tests/checks/check-effects includes this before every source of the online library: a function
// that promises not to throw then also promises clang not to block. Such a function calls only
// functions of its kind, allocates nothing, throws nothing, waits for no lock and makes no static
// variables as it runs. For a function defined elsewhere its declaration counts. Headers of the
// standard library come first and keep their own noexcept; clang knows memcpy, memset and sqrt.
#pragma once
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <limits>
#include <type_traits>
#include <utility>
#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#define noexcept noexcept [[clang::nonblocking]]
