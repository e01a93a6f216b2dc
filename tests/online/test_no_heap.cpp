#include <malloc.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <limits>
#include <new>
#include <string>
#include <vector>

#include "online/model/load_model.h"
#include "online/model/snapshot.h"
#include "online/step/self_check.h"
#include "online/step/step.h"
#include "online/system/sensor.h"
#include "online/track/track_sensor.h"
#include "run/simulate.h"
#include "support/pendulum_core.h"
#include "support/sanitized.h"

using namespace railstep;

namespace {

std::atomic<long> allocations{0};

}  // namespace

// Every `new` of the program comes here; malloc itself is watched by mallinfo2(). Not inlined: if
// g++ sees one half of a pair, it reports that free() does not match new. The nothrow form is
// replaced too: Catch2 uses it, a sanitizer has its own, and its memory is freed here.
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

/// Use of the heap: calls of new, and bytes by malloc's own count.
struct Heap {
  long news = allocations;
  std::size_t bytes = mallinfo2().uordblks + mallinfo2().hblkhd;
  std::size_t free_chunks = mallinfo2().ordblks + mallinfo2().smblks;
  bool operator==(const Heap&) const = default;
};

}  // namespace

TEST_CASE("one allocation is counted, so this test can fail", "[no_heap]") {
  const Heap before;
  double* volatile by_new = new double[3];  // volatile: a compiler may leave out an unused pair
  const Heap after_new;
  CHECK(after_new.news == before.news + 1);
  delete[] by_new;
  const Heap between;
  void* volatile by_malloc = std::malloc(100'000);
  const Heap after_malloc;
  std::free(by_malloc);
#if !defined(RAILSTEP_SANITIZED)  // they keep their own heap
  CHECK(after_malloc.bytes > between.bytes);
#endif
}

TEST_CASE("a thousand frames take nothing from the heap", "[no_heap]") {
  for (const char* unknowns : {"vertical", "full"}) {
    const Scene scene = read_scene(
        std::string(RAILSTEP_SOURCE) + "/config/scenes/moving_load.toml",
        {std::string("track.unknowns=\"") + unknowns + "\"", "load[0].table=[[0, 0], [0.1, 1]]",
         "load[1].may_leave_rail=true", "step.dt_s=1e-3"});
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
    CHECK(has(met, Status::off_rail));  // some frames went past the rail's end
  }
}

TEST_CASE("no shipped scene takes anything from the heap, not even for snapshots", "[no_heap]") {
  int scenes = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(RAILSTEP_SOURCE) + "/config/scenes"))
    for (const char* kind : {"full", "modal"}) {
      AnyScene scene = read_any_scene(entry.path());
      if (Scene* const track = std::get_if<Scene>(&scene)) {
        if (!track->step) continue;  // it is not run
        track->condense.kind =
            kind == std::string("modal") ? std::optional(ReductionKind::modal) : std::nullopt;
      } else if (kind == std::string("modal")) {
        continue;  // a system has no modes
      }
      const auto run = simulation_of(scene);
      const Model& model = run->model();
      std::vector<double> track_sensors(static_cast<std::size_t>(model.track_sensor.count) + 1);
      std::vector<unsigned char> snapshot(snapshot_bytes(model));
      Outputs outputs{};
      const Heap before;
      reset(model, run->state);
      publish_start(model, run->state, outputs);
      for (int frame = 0; frame < 60; ++frame) {
        (void)advance_frame(model, run->state, run->workspace, outputs);
        read_track_sensors(model, run->state, outputs, track_sensors.data());
      }
      const std::uint64_t hash = state_hash(model, run->state);
      save_snapshot(model, run->state, snapshot.data());
      reset(model, run->state);
      const SnapshotStatus back =
          restore_snapshot(model, snapshot.data(), snapshot.size(), run->state);
      const SnapshotStatus cut =
          restore_snapshot(model, snapshot.data(), snapshot.size() - 1, run->state);
      const Heap after;
      CAPTURE(entry.path().stem().string(), kind);
      CHECK(after == before);
      CHECK(back == SnapshotStatus::ok);
      CHECK(cut == SnapshotStatus::wrong_size);
      CHECK(hash == state_hash(model, run->state));
      reset(model, run->state);
      CHECK(hash != state_hash(model, run->state));  // it moved
      ++scenes;
    }
  CHECK(scenes >= 28);
}

TEST_CASE("a model is loaded or refused without the heap", "[no_heap]") {
  const Scene scene = read_scene(std::string(RAILSTEP_SOURCE) + "/config/scenes/moving_load.toml",
                                 {"condense.kind=\"modal\""});
  const Simulation run(scene);
  std::vector<std::byte> bad = run.block();
  bad[bad.size() / 2] ^= std::byte{1};
  Model model;
  Simulation stepped(scene);
  Outputs outputs{};
  std::vector<double> row(run.columns().size());
  const Heap before;
  const bool same =
      self_check(stepped.model(), stepped.state, stepped.workspace, outputs, row.data());
  const LoadStatus good = load_model(run.block().data(), run.block().size(), model).status;
  const LoadStatus wrong = load_model(bad.data(), bad.size(), model).status;
  const LoadStatus cut = load_model(bad.data(), bad.size() - 8, model).status;
  const Heap after;
  CHECK(after == before);
  CHECK(same);
  CHECK(stepped.model().check.frames > 0);
  CHECK(good == LoadStatus::ok);
  CHECK(wrong == LoadStatus::wrong_sum);
  CHECK(cut == LoadStatus::wrong_size);
}

TEST_CASE("errors in a run take nothing from the heap", "[no_heap]") {
  // The wheelset runs off the end, lifts off the rails on its way and ends as NaN. A guide that may
  // iterate once has not converged at its cap.
  for (const char* kind : {"full", "modal"}) {
    const Scene scene = read_scene(
        std::string(RAILSTEP_SOURCE) + "/config/scenes/wheelset_on_track.toml",
        {std::string("condense.kind=\"") + kind + "\"", "wheelset[0].start_m=6.3",
         "wheelset[0].speed_m_per_s=10", "wheelset[0].may_leave_rail=true", "step.duration_s=0.1"});
    Simulation run(scene);
    const std::int32_t first = run.model().wheelset[0].first;
    std::vector<double> track_sensors(static_cast<std::size_t>(run.model().track_sensor.count));
    Outputs outputs{};
    Model once = run.model();
    once.wheelset[0].cap = 1;
    Status capped = Status::ok, met = Status::ok;
    const Heap before;
    run.state.v[first] = 0.;  // the guide has work to do
    for (int frame = 0; frame < 2; ++frame)
      capped = capped | advance_frame(once, run.state, run.workspace, outputs);
    reset(run.model(), run.state);
    run.state.u[first + 2] += 1e-3;
    for (int frame = 0; frame < 60; ++frame)
      met = met | advance_frame(run.model(), run.state, run.workspace, outputs);
    run.state.u[0] = std::numeric_limits<double>::quiet_NaN();
    run.state.v[first + 2] = std::numeric_limits<double>::infinity();
    for (int frame = 0; frame < 3; ++frame)
      met = met | advance_frame(run.model(), run.state, run.workspace, outputs);
    read_track_sensors(run.model(), run.state, outputs, track_sensors.data());
    const Heap after;
    CAPTURE(kind);
    CHECK(after == before);
    CHECK(has(capped, Status::cap_reached));
    CHECK(has(met, Status::off_rail));
    CHECK(has(met, Status::contact_lost));
    CHECK(has(met, Status::nonfinite_state));
    CHECK(outputs.first_bad_unknown >= 0);
  }
}

TEST_CASE("a system of beams and joints takes nothing from the heap", "[no_heap][system]") {
  const bool planar = GENERATE(false, true);
  const ConstraintMethod hold =
      GENERATE(ConstraintMethod::augmented_lagrangian, ConstraintMethod::baumgarte,
               ConstraintMethod::gear_gupta_leimkuhler, ConstraintMethod::direct);
  const Renew renew = GENERATE(Renew::every_iteration, Renew::every_step, Renew::kept);
  SystemOptions options;
  options.scheme = generalised_alpha(1e-3, .9);
  options.constraint_method = hold;
  options.renew = renew;
  System scene = pendulum_system({}, 5, planar);
  scene.joints.push_back(scene.joints[0]);  // redundant: these rows get no force of their own
  const PackedSystem packed(scene, options);
  const Model& model = packed.model();
  std::vector<double> memory(static_cast<std::size_t>(state_doubles(model))),
      scratch(static_cast<std::size_t>(workspace_doubles(model)));
  Outputs outputs{};
  Status met = Status::ok;
  const Heap before;
  State state = state_on(model, memory.data());
  Workspace workspace = workspace_on(model, scratch.data());
  reset(model, state);
  for (int frame = 0; frame < 50; ++frame)
    met = met | advance_frame(model, state, workspace, outputs);
  const PointMotion end = sensor_motion(model, state, 2);
  const JointForce pull = joint_force(model, state, 0);
  state.v[0] = std::numeric_limits<double>::quiet_NaN();
  met = met | advance_frame(model, state, workspace, outputs);
  const Heap after;
  CHECK(after == before);
  CHECK(end.position[2] < -1e-3);
  CHECK(pull.force[2] != 0.);
  CHECK(has(met, Status::nonfinite_state));
  CHECK(has(met, Status::redundant_joint) == (hold != ConstraintMethod::augmented_lagrangian));
}
