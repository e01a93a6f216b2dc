#include <bit>
#include <catch2/catch.hpp>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "online/step/step.h"
#include "run/simulate.h"
#include "scene/scene.h"

using namespace railstep;

namespace {

constexpr std::uint64_t kPaint = 0x7ff8'5ca1'ab1e'0001;  // a NaN that no arithmetic makes
constexpr std::size_t kGuard = 64;

/// Painted memory between two guards that nobody may write to.
class Painted {
 public:
  explicit Painted(std::int64_t doubles)
      : size_(static_cast<std::size_t>(doubles)),
        memory_(size_ + 2 * kGuard, std::bit_cast<double>(kPaint)) {}
  double* data() { return memory_.data() + kGuard; }
  bool is_guarded() const {
    for (std::size_t i = 0; i < kGuard; ++i)
      if (!is_painted(i) || !is_painted(kGuard + size_ + i)) return false;
    return true;
  }
  /// Share of it that was written to.
  double used() const {
    std::size_t count = 0;
    for (std::size_t i = kGuard; i < kGuard + size_; ++i) count += is_painted(i) ? 0 : 1;
    return size_ == 0 ? 1. : static_cast<double>(count) / static_cast<double>(size_);
  }

 private:
  bool is_painted(std::size_t i) const {
    return std::bit_cast<std::uint64_t>(memory_[i]) == kPaint;
  }
  std::size_t size_;
  std::vector<double> memory_;
};

}  // namespace

TEST_CASE("state and workspace have the stated size and make use of it", "[memory]") {
  int scenes = 0;
  for (const char* name :
       {"moving_load", "wheelset_on_track", "ballasted_track", "bogie_at_speed", "hanging_sleeper",
        "endless_track", "wheelset_flange", "open_track", "double_pendulum", "exciter_on_track"})
    for (const char* kind : {"full", "modal", "guyan"}) {
      const std::string file = std::string(RAILSTEP_SOURCE) + "/config/scenes/" + name + ".toml";
      const std::string set = std::string("condense.kind=\"") + kind + "\"";
      AnyScene scene = read_any_scene(file);
      const Scene* const track = std::get_if<Scene>(&scene);
      if (track == nullptr && kind != std::string("full")) continue;
      if (track != nullptr && track->track.endless && kind == std::string("guyan")) continue;
      if (track != nullptr) scene = read_any_scene(file, {set, "step.duration_s=0.01"});
      const auto run = simulation_of(scene);
      const Model& model = run->model();
      Painted memory(state_doubles(model)), scratch(workspace_doubles(model));
      State state = state_on(model, memory.data());
      Workspace workspace = workspace_on(model, scratch.data());
      reset(model, state);
      Outputs outputs{};
      publish_start(model, state, outputs);
      for (int frame = 0; frame < 5; ++frame)
        static_cast<void>(advance_frame(model, state, workspace, outputs));
      CAPTURE(name, kind, memory.used(), scratch.used());
      CHECK(memory.is_guarded());
      CHECK(scratch.is_guarded());
      CHECK(memory.used() == 1.);
      // The rest is for wheels whose flanges are inactive, for the predictor of banded lines where
      // lines are condensed, for unit responses of lines that have a table beside one that has not,
      // and for the trial state of external wheels.
      CHECK(scratch.used() > .1);
      ++scenes;
    }
  CHECK(scenes == 8 * 3 - 1 + 2);
}
