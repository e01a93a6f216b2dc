// Included before every source of the online library by tests/checks/check-effects: what promises
// not to throw promises clang not to block, too. A function so marked calls none that is not,
// allocates nothing, throws nothing, waits for no lock and has no static variables that are made as
// it runs; of a function elsewhere the mark on its declaration counts. Headers of the standard
// library come first and keep their own words; clang knows memcpy, memset and sqrt for what they
// are.
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
