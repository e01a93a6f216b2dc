// Clang must refuse each of these violations, which proves that the check works.
#include <cstdlib>
#include <new>

double* elsewhere(int n);

#if VIOLATION == 1
void* violate(int n) noexcept { return std::malloc(static_cast<std::size_t>(n)); }
#elif VIOLATION == 2
double* violate(int n) noexcept { return new double[static_cast<std::size_t>(n)]; }
#elif VIOLATION == 3
void violate(int n) noexcept {
  if (n > 0) throw n;
}
#elif VIOLATION == 4
double* violate(int n) noexcept { return elsewhere(n); }
#elif VIOLATION == 5
int violate(int n) noexcept {
  static const int first = n;
  return first;
}
#elif VIOLATION == 6
// Through a function that promises nothing itself, but whose body clang sees.
void* within(int n) { return std::malloc(static_cast<std::size_t>(n)); }
void* violate(int n) noexcept { return within(n); }
#else
int violate(int n) noexcept { return n; }  // this one is right
#endif
