#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "online/math/tiny.h"
#include "online/step/step.h"
#include "run/simulation.h"
#include "support/sanitized.h"

using namespace railstep;

namespace {

#if defined(RAILSTEP_SANITIZED) || !defined(__OPTIMIZE__)
constexpr std::int64_t kSteps = 100'000;
#else
constexpr std::int64_t kSteps = 1'000'000;
#endif

bool is_subnormal(double x) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &x, sizeof bits);
  return (bits & 0x7ff0000000000000u) == 0 && (bits & 0x000fffffffffffffu) != 0;
}

std::int64_t subnormals(const double* from, std::int64_t count) {
  std::int64_t found = 0;
  for (std::int64_t i = 0; i < count; ++i) found += is_subnormal(from[i]) ? 1 : 0;
  return found;
}

/// Count of numbers that a state should have set to 0, as they are below kTiny.
std::int64_t tiny(const double* from, std::int64_t count) {
  std::int64_t found = 0;
  for (std::int64_t i = 0; i < count; ++i)
    found += from[i] != 0. && std::abs(from[i]) < kTiny ? 1 : 0;
  return found;
}

double largest(const double* from, std::int64_t count) {
  double most = 0.;
  for (std::int64_t i = 0; i < count; ++i) most = std::max(most, std::abs(from[i]));
  return most;
}

/// Steps a scene on for kSteps after its loads are gone.
struct Decayed {
  std::int64_t subnormal = 0;  // numbers of state and workspace, summed over steps
  std::int64_t tiny = 0;       // numbers of the state, summed over steps
  double before = 0., after = 0.;
  std::int64_t zero_from = -1;  // the step from which the whole state is 0
};
Decayed decayed(const std::string& name, const std::vector<std::string>& overrides) {
  const auto run = simulation_of(
      read_any_scene(std::string(RAILSTEP_SOURCE) + "/config/scenes/" + name + ".toml", overrides));
  Model single = run->model();
  single.steps_per_frame = 1;
  Outputs outputs{};
  publish_start(single, run->state, outputs);
  const std::int64_t state = state_doubles(single), scratch = workspace_doubles(single);
  Decayed found;
  for (int n = 0; n < 20; ++n)
    static_cast<void>(advance_frame(single, run->state, run->workspace, outputs));
  found.before = largest(run->state.u, single.unknowns);
  for (std::int64_t n = 0; n < kSteps; ++n) {
    static_cast<void>(advance_frame(single, run->state, run->workspace, outputs));
    found.subnormal += subnormals(run->state.u, state);
    found.tiny += tiny(run->state.u, state);
    if (n % 16 == 0) found.subnormal += subnormals(run->workspace.u_star, scratch);
    if (found.zero_from < 0 && n % 1000 == 0 && largest(run->state.u, state) == 0.)
      found.zero_from = n;
  }
  found.after = largest(run->state.u, state);
  return found;
}

}  // namespace

TEST_CASE("the bits of a subnormal number are recognised", "[decay]") {
  CHECK(is_subnormal(1e-310));
  CHECK(is_subnormal(-5e-324));
  CHECK_FALSE(is_subnormal(0.));
  CHECK_FALSE(is_subnormal(-0.));
  CHECK_FALSE(is_subnormal(2.3e-308));
}

TEST_CASE("a track without load comes to rest without a subnormal number", "[decay]") {
  // The force ends after 10 steps of 1 ms; from then on dampers alone act.
  const std::string gone =
      "load=[{name=\"a\", rail=\"left\", start_m=4.5, speed_m_per_s=0, "
      "force_z_n=-50e3, table=[[0, 1], [0.0099, 1], [0.01, 0]]}]";
  for (const char* kind : {"full", "modal"})
    for (const char* unknowns : {"vertical", "full"}) {
      if (kind == std::string("modal") && unknowns == std::string("full")) continue;
      const Decayed found = decayed(
          "moving_load", {gone, "step.dt_s=1e-3", std::string("condense.kind=\"") + kind + "\"",
                          std::string("track.unknowns=\"") + unknowns + "\""});
      CAPTURE(kind, unknowns, found.before, found.after, found.zero_from);
      CHECK(found.subnormal == 0);
      CHECK(found.tiny == 0);
      CHECK(found.before > 1e-5);
      CHECK(found.after == 0.);
      CHECK(found.zero_from > 0);
    }
}
