#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "hard/hard_run.h"

namespace railstep {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Inputs frame by frame, by a function of the frame and of the input.
FrameInputs given(int count, std::function<double(std::int64_t, int)> value) {
  std::vector<double> room(static_cast<std::size_t>(count));
  return [room, value = std::move(value)](std::int64_t frame) mutable {
    for (std::size_t i = 0; i < room.size(); ++i) room[i] = value(frame, static_cast<int>(i));
    return room.data();
  };
}

// H26 ------------------------------------------------------------------------------------------

/// The push on the car, N; in some frames it is not a number.
double push(std::int64_t frame, bool bad) {
  const auto good = [](std::int64_t at) { return 5e3 * std::sin(.02 * static_cast<double>(at)); };
  if (300 <= frame && frame < 350) return bad ? kNan : good(299);
  if (frame == 500) return bad ? kInfinity : good(499);
  if (frame == 501) return bad ? -kInfinity : good(499);
  return good(frame);
}

/// Each twentieth point of a curve, as marks.
HardCurve some_of(const HardCurve& curve) {
  HardCurve some{curve.name, {}, {}, true};
  for (std::size_t i = 0; i < curve.x.size(); i += 20) {
    some.x.push_back(curve.x[i]);
    some.y.push_back(curve.y[i]);
  }
  return some;
}

HardResult bad_input(const std::filesystem::path& scene) {
  HardResult result;
  for (const char* kind : {"full", "modal"}) {
    const HardRun bad(scene, {condensed_to(kind)},
                      given(1, [](std::int64_t n, int) { return push(n, true); }));
    const HardRun held(scene, {condensed_to(kind)},
                       given(1, [](std::int64_t n, int) { return push(n, false); }));
    const std::string at = std::string(kind) + ": ";
    result.checks.push_back(holds(at + "the bits of a run in which the last good force was held",
                                  same_bits(bad.record().rows, held.record().rows)));
    result.checks.push_back(
        holds(at + "the status says so, and nothing else", bad.status() == "nonfinite_input"));
    result.checks.push_back(holds(at + "no status bit of the other run", held.status().empty()));
    result.checks.push_back(holds(at + "all finite", all_finite(bad.record().rows)));
    if (kind == std::string("modal")) continue;
    result.picture = {"time, s",
                      "wheel-rail force, kN",
                      {some_of(held.curve("car.wheel_1.force_z_n", "last good force held", 1e-3)),
                       bad.curve("car.wheel_1.force_z_n", "given NaN and infinity", 1e-3)}};
    result.frame_us = bad.frame_us();
  }
  return result;
}
// H48 ------------------------------------------------------------------------------------------

constexpr double kLimit = 2e4;           // N and N m, of both inputs
constexpr std::int64_t kFlooded = 1000;  // frames

/// A flood of inputs: what is given, and what of it is to be applied.
struct Flood {
  const char* name;
  std::vector<double> values, applied;  // turn by turn
  const char* status;
};

FrameInputs flood(const std::vector<double>& values) {
  return given(2, [values](std::int64_t frame, int) {
    return frame < kFlooded ? values[static_cast<std::size_t>(frame) % values.size()] : 0.;
  });
}

HardResult flooded(const std::filesystem::path& scene) {
  const Flood floods[] = {{"NaN", {kNan}, {0.}, "nonfinite_input"},
                          {"1e308", {1e308}, {kLimit}, "force_saturated"},
                          {"in turn 1e308, NaN, -1e308 and infinity",
                           {1e308, kNan, -1e308, kInfinity},
                           {kLimit, kLimit, -kLimit, -kLimit},
                           "nonfinite_input force_saturated"}};
  const HardRun quiet(scene, {}, flood({0.}));
  HardResult result;
  result.picture = {"time, s", "height of the frame, mm", {}};
  for (const Flood& own : floods) {
    const HardRun bad(scene, {}, flood(own.values)), good(scene, {}, flood(own.applied));
    const std::string at = std::string(own.name) + ": ";
    result.checks.push_back(holds(at + "all finite", all_finite(bad.record().rows)));
    result.checks.push_back(holds(at + "the bits of a run given what may be applied",
                                  same_bits(bad.record().rows, good.record().rows)));
    result.checks.push_back(
        holds(at + "the status says so, and nothing else", bad.status() == own.status));
    const auto height = bad.column("frame.z_m"), rest = quiet.column("frame.z_m");
    double most = 0.;
    for (std::size_t i = 0; i < height.size(); ++i)
      most = std::max(most, std::abs(height[i] - rest[i]));
    if (most > 0.)
      result.checks.push_back({at + "apart from the run without, at the end over the most",
                               std::abs(height.back() - rest.back()) / most, 1e-6});
    result.picture.curves.push_back(bad.curve("frame.z_m", own.name, 1e3));
    result.frame_us = bad.frame_us();
  }
  result.picture.curves.push_back(quiet.curve("frame.z_m", "zero", 1e3));
  return result;
}
}  // namespace

std::vector<HardCase> input_cases() {
  return {
      {"H26", "h26_bad_input", "A force from outside that is not a number",
       "One NaN in a state stays there for good.",
       "An invariant: the last good force is held, so the bits are those of a run that is given "
       "that.",
       bad_input},
      {"H48", "h48_flooded_inputs", "Inputs of NaN and 1e308 for 1000 frames",
       "A lasting wrong input must neither be applied nor leave anything behind.",
       "An invariant: the bits of a run that is given what may be applied, the last good value or "
       "the limit; after that the motion fades to that of no input.",
       flooded}};
}

}  // namespace railstep
