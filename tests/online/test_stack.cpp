#include <pthread.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "online/step/step.h"
#include "online/track/track_sensor.h"
#include "run/simulation.h"
#include "support/sanitized.h"

using namespace railstep;

namespace {

constexpr std::size_t kStack = std::size_t{1} << 21;
constexpr unsigned char kStackPaint = 0xa5;

void* call(void* work) {
  (*static_cast<const std::function<void()>*>(work))();
  return nullptr;
}

/// Bytes of stack that some work writes to, on a thread whose stack was painted before.
std::size_t stack_of(const std::function<void()>& work) {
  std::vector<unsigned char> memory(kStack + 4096, kStackPaint);
  auto* const from =
      memory.data() + (4096 - reinterpret_cast<std::uintptr_t>(memory.data()) % 4096);
  pthread_attr_t attributes;
  pthread_t thread;
  REQUIRE(pthread_attr_init(&attributes) == 0);
  REQUIRE(pthread_attr_setstack(&attributes, from, kStack - 4096) == 0);
  REQUIRE(pthread_create(&thread, &attributes, call, const_cast<std::function<void()>*>(&work)) ==
          0);
  REQUIRE(pthread_join(thread, nullptr) == 0);
  pthread_attr_destroy(&attributes);
  const auto* const end = from + (kStack - 4096);  // the stack grows down from here
  return static_cast<std::size_t>(
      end - std::find_if(static_cast<const unsigned char*>(from), end,
                         [](unsigned char byte) { return byte != kStackPaint; }));
}

}  // namespace

TEST_CASE("a painted stack shows how much is used, so this bound can fail", "[stack]") {
  const std::size_t little = stack_of([] {});
#if !defined(RAILSTEP_SANITIZED)  // which may put a function's arrays elsewhere
  const std::size_t much = stack_of([] {
    volatile unsigned char taken[100'000];
    for (volatile unsigned char& byte : taken) byte = 1;
  });
  CHECK(much > little + 90'000);
#endif
  CHECK(little < 100'000);  // the thread itself keeps some there
}

TEST_CASE("a frame of every scene fits the stack that the step states", "[stack]") {
  const std::size_t idle = stack_of([] {});
  std::size_t most = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(RAILSTEP_SOURCE) + "/config/scenes")) {
    const AnyScene scene = read_any_scene(entry.path());
    const Scene* const track = std::get_if<Scene>(&scene);
    if (track != nullptr && !track->step) continue;
    const auto run = simulation_of(scene);
    std::vector<double> track_sensors(static_cast<std::size_t>(run->model().track_sensor.count) +
                                      1);
    const std::size_t used = stack_of([&] {
      Outputs outputs{};
      publish_start(run->model(), run->state, outputs);
      for (int frame = 0; frame < 3; ++frame) {
        static_cast<void>(advance_frame(run->model(), run->state, run->workspace, outputs));
        read_track_sensors(run->model(), run->state, outputs, track_sensors.data());
      }
    });
    std::printf("%-20s %7zu bytes of stack\n", entry.path().stem().c_str(), used - idle);
    most = std::max(most, used - idle);
  }
#if !defined(RAILSTEP_SANITIZED) && defined(__OPTIMIZE__)
  CHECK(most <= kStepStack);
#endif
  CHECK(most > 4096);  // contacts are solved on the stack
}
