#include <malloc.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <new>

#include "online/step/step.h"
#include "simulate.h"

using namespace railstep;

namespace {

std::atomic<long> allocations{0};

}  // namespace

// Every new of the program comes here; malloc itself is watched by the allocator's own account. Not
// inlined: g++ that sees half of a pair takes free for the wrong end of new and refuses it. And a
// sanitizer brings its own form that does not throw, which Catch2 uses: its memory comes back here
// too.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++allocations;
  return std::malloc(size == 0 ? 1 : size);
}
[[gnu::noinline]] void* operator new[](std::size_t size) { return ::operator new(size); }
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete[](void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

namespace {

/// What the heap is known to have given out: calls of new, and bytes by malloc's account.
struct Heap {
  long news = allocations;
  std::size_t bytes = mallinfo2().uordblks + mallinfo2().hblkhd;
  std::size_t free_chunks = mallinfo2().ordblks + mallinfo2().smblks;
  bool operator==(const Heap&) const = default;
};

}  // namespace

TEST_CASE("the account sees one allocation, so it could fail", "[no_heap]") {
  const Heap before;
  double* volatile by_new = new double[3];  // volatile: a compiler may leave out an unused pair
  const Heap after_new;
  CHECK(after_new.news == before.news + 1);
  delete[] by_new;
  const Heap between;
  void* volatile by_malloc = std::malloc(100'000);
  const Heap after_malloc;
  std::free(by_malloc);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // they keep their own heap
  CHECK(after_malloc.bytes > between.bytes);
#endif
}

TEST_CASE("a thousand frames take nothing from the heap", "[no_heap]") {
  for (const char* unknowns : {"vertical", "full"}) {
    const Scene scene =
        read_scene(std::string(RAILSTEP_SOURCE) + "/config/scenes/moving_load.toml",
                   {std::string("track.unknowns=\"") + unknowns + "\"",
                    "load[0].table=[[0, 0], [0.1, 1]]", "load[1].may_leave_rail=true"});
    Simulation run(scene);
    Outputs outputs{};
    Status met = Status::ok;
    const Heap before;
    for (int frame = 0; frame < 1000; ++frame)
      met = met | advance_frame(run.model(), run.state, run.workspace, outputs);
    const Heap after;
    CHECK(after.news == before.news);
    CHECK(after.bytes == before.bytes);
    CHECK(after.free_chunks == before.free_chunks);
    CHECK(run.state.steps == 1000);
    CHECK(has(met, Status::off_rail));  // the way out past the rail's end was among the frames
  }
}

TEST_CASE("shipped scenes take nothing from the heap, contact included", "[no_heap]") {
  for (const char* name : {"moving_load", "wheelset_on_track", "ballasted_track"}) {
    const Scene scene =
        read_scene(std::string(RAILSTEP_SOURCE) + "/config/scenes/" + name + ".toml");
    Simulation run(scene);
    Outputs outputs{};
    const Heap before;
    for (int frame = 0; frame < 100; ++frame)
      (void)advance_frame(run.model(), run.state, run.workspace, outputs);
    const Heap after;
    CAPTURE(name);
    CHECK(after.news == before.news);
    CHECK(after.bytes == before.bytes);
  }
}
