// The real-time sanitizer must see that this allocates and end it.
#include <cstdlib>

[[gnu::noinline]] void* violate(std::size_t bytes) noexcept [[clang::nonblocking]] {
  void* volatile memory = std::malloc(bytes);
  return memory;
}

int main(int count, char**) {
  std::free(violate(static_cast<std::size_t>(count)));
  return 0;
}
