#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <iterator>
#include <limits>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "online/model/progress.h"
#include "online/model/snapshot.h"
#include "online/model/system_workspace.h"
#include "online/step/step.h"
#include "run/simulation.h"
#include "support/shipped.h"

using namespace railstep;

namespace {

using Bytes = std::vector<unsigned char>;

Bytes saved(const Model& model, const State& state) {
  Bytes bytes(snapshot_bytes(model));
  save_snapshot(model, state, bytes.data());
  return bytes;
}

/// A new state and workspace of a model, both filled with NaN.
struct Fresh {
  std::vector<double> memory, scratch;
  State state;
  Workspace workspace;
  explicit Fresh(const Model& model)
      : memory(static_cast<std::size_t>(state_doubles(model)),
               std::numeric_limits<double>::quiet_NaN()),
        scratch(static_cast<std::size_t>(workspace_doubles(model)),
                std::numeric_limits<double>::quiet_NaN()),
        state(state_on(model, memory.data())),
        workspace(workspace_on(model, scratch.data())) {}
  void foul() {
    std::fill(scratch.begin(), scratch.end(), std::numeric_limits<double>::quiet_NaN());
  }
};

/// Steps of a run at which snapshots are taken, and what was met there.
struct Instants {
  std::set<std::int64_t> steps;  // three at random, and the hardest ones
  bool airborne = false, impact = false, cap = false, shift = false;
};

/// The hardest steps of a run: a wheel in the air, its hardest impact, a cap that was reached, the
/// step before a track without end shifts its window.
Instants instants_of(const Model& single, std::int64_t steps) {
  Instants found;
  std::mt19937 random(7);
  for (int i = 0; i < 3; ++i)
    found.steps.insert(static_cast<std::int64_t>(random() % static_cast<unsigned>(steps)));
  Fresh run(single);
  Outputs outputs{};
  reset(single, run.state);
  publish_start(single, run.state, outputs);
  double hardest = 0., first = 0.;
  std::int64_t blow = 0;
  const auto note = [&](bool& met, bool now, std::int64_t at) {
    if (now && !met) found.steps.insert(at);
    met = met || now;
  };
  for (std::int64_t n = 1; n <= steps; ++n) {
    const Status met = advance_frame(single, run.state, run.workspace, outputs);
    note(found.airborne, has(met, Status::contact_lost), n);
    note(found.cap, has(met, Status::cap_reached), n);
    note(found.shift, track_offset(single, n + 1) != track_offset(single, n), n);
    double force = 0.;
    for (std::int32_t i = 0; i < wheel_count(single); ++i)
      force = std::max(force, outputs.contact_force[i]);
    if (n == 1) first = force;
    if (force > hardest) {
      hardest = force;
      blow = n;
    }
  }
  found.impact = hardest > 1.2 * first;
  if (blow > 0) found.steps.insert(blow);
  return found;
}

/// Steps to take of a scene: enough to meet its hard ones, few enough for a test.
std::int64_t steps_of(const Model& model, const std::string& name) {
  std::int64_t most = 1500;
  if (name == "wheel_flat") most = 8000;      // the flat strikes after 0.14 s
  if (name == "wheelset_flange") most = 200;  // a small track, 3 s long
  return std::min(model.steps, most);
}

/// Restores snapshots of a run into other memory that holds NaN, and goes on from each to the end.
void check_resumed(const Model& single, const std::set<std::int64_t>& at, std::int64_t steps) {
  Fresh run(single), other(single);
  Outputs outputs{}, again{};
  reset(single, run.state);
  publish_start(single, run.state, outputs);
  std::vector<std::pair<std::int64_t, Bytes>> taken;
  for (std::int64_t n = 0; n < steps; ++n) {
    if (at.count(n) != 0) taken.emplace_back(n, saved(single, run.state));
    run.foul();
    static_cast<void>(advance_frame(single, run.state, run.workspace, outputs));
  }
  const std::uint64_t end = state_hash(single, run.state);
  for (const auto& [from, bytes] : taken) {
    other = Fresh(single);
    REQUIRE(restore_snapshot(single, bytes.data(), bytes.size(), other.state) ==
            SnapshotStatus::ok);
    CHECK(other.state.steps == from);
    CHECK(saved(single, other.state) == bytes);
    for (std::int64_t n = from; n < steps; ++n)
      static_cast<void>(advance_frame(single, other.state, other.workspace, again));
    CAPTURE(from);
    CHECK(state_hash(single, other.state) == end);
    CHECK(std::equal(std::begin(again.contact_force), std::end(again.contact_force),
                     std::begin(outputs.contact_force)));
    CHECK(std::equal(std::begin(again.load_deflection), std::end(again.load_deflection),
                     std::begin(outputs.load_deflection)));
  }
}

}  // namespace

TEST_CASE("every scene goes on from a snapshot with the same bits, with a workspace of NaN",
          "[snapshot]") {
  Instants met;
  int scenes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kScenes)) {
    const std::string name = entry.path().stem().string();
    AnyScene scene = read_any_scene(entry.path());
    const Scene* const track = std::get_if<Scene>(&scene);
    if (track != nullptr && !track->step) continue;  // it is not run
    CAPTURE(name);
    const auto run = simulation_of(scene);
    Model single = run->model();
    single.steps_per_frame = 1;
    const std::int64_t steps = steps_of(single, name);
    const Instants own = instants_of(single, steps);
    check_resumed(single, own.steps, steps);
    ++scenes;
    met.impact = met.impact || own.impact;
    met.cap = met.cap || own.cap;
    met.shift = met.shift || own.shift;
  }
  CHECK(scenes >= 16);
  CHECK(met.impact);
  CHECK(met.shift);
}

TEST_CASE("a scene condensed the other way goes on from a snapshot too", "[snapshot]") {
  for (const auto& [name, kind] :
       {std::pair{"wheel_flat", "full"}, std::pair{"hanging_sleeper", "modal"},
        std::pair{"endless_track", "full"}}) {  // a window, which shifts by a bay after 400 steps
    const auto run = simulation_of(
        read_any_scene(kScenes + name + ".toml", {std::string("condense.kind=\"") + kind + "\""}));
    Model single = run->model();
    single.steps_per_frame = 1;
    CAPTURE(name);
    check_resumed(single, {0, 1, 333, 699}, 700);
  }
}

/// Checks runs of a wheelset on the paper's track that go on from their hardest steps.
Instants resumed(const std::vector<std::string>& overrides, std::int64_t steps) {
  const auto run = simulation_of(read_any_scene(kScenes + "wheelset_on_track.toml", overrides));
  Model single = run->model();
  single.steps_per_frame = 1;
  Instants own = instants_of(single, steps);
  check_resumed(single, own.steps, steps);
  return own;
}

TEST_CASE("in the air, mid-impact and at a cap a run goes on with the same bits", "[snapshot]") {
  for (const char* kind : {"full", "modal"}) {
    const std::string condense = std::string("condense.kind=\"") + kind + "\"";
    const Instants thrown = resumed({condense,
                                     "wheelset[0].force=[{direction=\"z\", table=[[0, "
                                     "3e3], [0.01, 3e3], [0.0101, 0]]}]"},
                                    1600);
    CHECK(thrown.airborne);
    CHECK(thrown.impact);
    CHECK(resumed({condense, "wheelset[0].guide.cap=1", "wheelset[0].guide.tolerance=1e-15",
                   "wheelset[0].force=[{direction=\"x\", table=[[0, 0], [0.01, 1e4]]}]"},
                  400)
              .cap);
  }
}

TEST_CASE("a snapshot with a flipped bit or another length is refused", "[snapshot]") {
  const auto run = simulation_of(read_any_scene(kScenes + "spring_pendulum.toml"));
  const Model& model = run->model();
  const Bytes bytes = saved(model, run->state);
  const std::uint64_t before = state_hash(model, run->state);
  const auto status = [&](const Bytes& of) {
    return restore_snapshot(model, of.data(), of.size(), run->state);
  };
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    Bytes flipped = bytes;
    flipped[bit / 8] = static_cast<unsigned char>(flipped[bit / 8] ^ (1u << (bit % 8)));
    if (status(flipped) == SnapshotStatus::ok) FAIL("bit " << bit << " passed");
  }
  for (std::size_t size = 0; size < bytes.size(); ++size)
    if (status(Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size))) ==
        SnapshotStatus::ok)
      FAIL("cut to " << size << " bytes it passed");
  Bytes longer = bytes;
  longer.push_back(0);
  CHECK(status(longer) == SnapshotStatus::wrong_size);
  CHECK(state_hash(model, run->state) == before);  // refused snapshots left the state alone
  CHECK(status(bytes) == SnapshotStatus::ok);
}

TEST_CASE("latched status and a state that is not finite come back to the bit", "[snapshot]") {
  const auto run = simulation_of(read_any_scene(kScenes + "moving_load.toml"));
  const Model& model = run->model();
  Outputs outputs{};
  publish_start(model, run->state, outputs);
  run->state.u[3] = -std::numeric_limits<double>::quiet_NaN();
  const Status met = advance_frame(model, run->state, run->workspace, outputs);
  REQUIRE(has(met, Status::nonfinite_state));
  const Bytes bytes = saved(model, run->state);
  const std::uint64_t hash = state_hash(model, run->state);
  reset(model, run->state);
  REQUIRE(restore_snapshot(model, bytes.data(), bytes.size(), run->state) == SnapshotStatus::ok);
  CHECK(run->state.latched == Status::nonfinite_state);
  CHECK(state_hash(model, run->state) == hash);
}

TEST_CASE("a snapshot whose kept matrix is invalid is refused", "[snapshot]") {
  const auto run =
      simulation_of(read_any_scene(kScenes + "slider_crank.toml", {"joints.tangent=\"kept\""}));
  const Model& model = run->model();
  const std::int32_t rows = system_rows(model.system);
  REQUIRE(rows > 1);
  const auto status = [&] {
    const Bytes bytes = saved(model, run->state);
    return restore_snapshot(model, bytes.data(), bytes.size(), run->state);
  };
  const SystemTangent kept = system_tangent_on(model.system, run->state.kept);
  kept.order[0] = 1 << 30;
  CHECK(status() == SnapshotStatus::ok);  // no matrix is kept at the start
  Outputs outputs{};
  publish_start(model, run->state, outputs);
  static_cast<void>(advance_frame(model, run->state, run->workspace, outputs));
  REQUIRE(*kept.age > 0.);
  CHECK(status() == SnapshotStatus::ok);
  const std::int32_t first = kept.order[0], last = kept.order[rows - 1];
  for (const std::int32_t bad : {-1, rows, 1 << 30, last}) {
    kept.order[0] = bad;
    CHECK(status() == SnapshotStatus::bad_content);
  }
  kept.order[0] = first;
  const double rank = *kept.rank;
  for (const double bad : {-1., 1e300, std::numeric_limits<double>::quiet_NaN()}) {
    *kept.rank = bad;
    CHECK(status() == SnapshotStatus::bad_content);
  }
  *kept.rank = rank;
  CHECK(status() == SnapshotStatus::ok);
}

TEST_CASE("a snapshot whose number of steps is too large to count on is refused", "[snapshot]") {
  const auto run = simulation_of(read_any_scene(kScenes + "spring_pendulum.toml"));
  const Model& model = run->model();
  for (const std::int64_t last :
       {std::int64_t{1} << 53, std::numeric_limits<std::int64_t>::max()}) {
    run->state.steps = last;
    const Bytes bytes = saved(model, run->state);
    CHECK((restore_snapshot(model, bytes.data(), bytes.size(), run->state) ==
           SnapshotStatus::bad_content) == (last > std::int64_t{1} << 53));
  }
}

TEST_CASE("a snapshot of another model is refused", "[snapshot]") {
  const std::string scene = kScenes + "moving_load.toml";
  const auto one = simulation_of(read_any_scene(scene, {"load[0].force_z_n=-50e3"}));
  const auto two = simulation_of(read_any_scene(scene, {"load[0].force_z_n=-51e3"}));
  const Bytes bytes = saved(one->model(), one->state);
  CHECK(restore_snapshot(two->model(), bytes.data(), bytes.size(), two->state) ==
        SnapshotStatus::other_model);
}
