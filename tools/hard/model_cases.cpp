#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "answer/static_solution.h"
#include "build/build.h"
#include "hard/hard_run.h"
#include "online/model/snapshot.h"
#include "run/recording.h"
#include "text/write.h"

namespace railstep {
namespace {

// H33 ------------------------------------------------------------------------------------------

/// A track of `count` bays with its load and its sensor `ahead` of the seat in the middle.
std::vector<std::string> bays(int count, double ahead) {
  const double middle = .3 * count + ahead;  // of an even number
  return {fmt::format("track.bays={}", count), fmt::format("load[0].start_m={:.17g}", middle),
          fmt::format("sensor[0].position_m={:.17g}", middle)};
}

/// Deflections under the load: static, and of runs without and with residual flexibility.
void add_deflections(const std::filesystem::path& scene, double ahead, HardResult& result) {
  const std::string at = ahead == 0. ? "over a seat, 10 000 bays: " : "mid-bay, 10 000 bays: ";
  const auto still = [&](int count) {
    return solve_static(read_scene(scene, bays(count, ahead))).points.at(0).displacement[2];
  };
  result.checks.push_back(off_by(at + "static deflection", still(10000), still(40), 1e-10));
  for (const char* residual : {"false", "true"}) {
    const auto run = [&](int count) {
      std::vector<std::string> overrides = bays(count, ahead);
      overrides.push_back(fmt::format("condense.residual_flexibility={}", residual));
      return HardRun(scene, overrides).last("load.deflection_z_m");
    };
    result.checks.push_back(
        off_by(fmt::format("{}after 20 steps, residual flexibility {}", at, residual), run(10000),
               run(40), 1e-10));
  }
}

HardResult long_track(const std::filesystem::path& scene) {
  HardResult result;
  add_deflections(scene, .3, result);
  result.picture = {"bays", "per bay", {}, true, true};
  HardCurve bytes{"bytes of the model", {}, {}}, flops{"flops of a frame", {}, {}},
      time{"nanoseconds of a frame", {}, {}};
  for (const int count : {1250, 2500, 5000, 10000}) {
    const HardRun run(scene, bays(count, 0.));
    const auto size = static_cast<double>(run.simulation().block().size());
    for (HardCurve* curve : {&bytes, &flops, &time}) curve->x.push_back(count);
    bytes.y.push_back(size / count);
    flops.y.push_back(static_cast<double>(run.simulation().model().cost.flops) / count);
    time.y.push_back(1e3 * run.frame_us() / count);
    result.frame_us = run.frame_us();
  }
  // Lengths are rounded up to panels of 8 unknowns, as many as a bay has: by up to one bay in 1 250
  // and one in 5 000.
  for (const HardCurve* curve : {&bytes, &flops}) {
    const auto all = [&](std::size_t i) { return curve->x[i] * curve->y[i]; };
    const double first = (all(1) - all(0)) / (curve->x[1] - curve->x[0]),
                 last = (all(3) - all(2)) / (curve->x[3] - curve->x[2]);
    result.checks.push_back(off_by(curve->name + ": what a bay adds from 5 000 to 10 000 bays",
                                   last, first, 1. / 1250. + 1. / 5000.));
  }
  result.picture.curves = {bytes, flops, time};
  return result;
}

// H35 ------------------------------------------------------------------------------------------

using Bytes = std::vector<unsigned char>;

Bytes saved(const Simulation& run) {
  Bytes bytes(snapshot_bytes(run.model()));
  save_snapshot(run.model(), run.state, bytes.data());
  return bytes;
}

/// Overwrites the state and all scratch by NaN: nothing may be left in them.
void foul(Simulation& run) {
  std::fill_n(run.state.numbers, state_doubles(run.model()), kNan);
  std::fill_n(run.workspace.u_star, workspace_doubles(run.model()), kNan);
}

/// A whole run: the trace, the hash of the state after each frame, a snapshot after one of them.
struct Whole {
  std::unique_ptr<Simulation> run;
  RunRecord record;
  std::vector<std::uint64_t> hashes;
  Bytes snapshot;
  std::int64_t frames;

  Whole(std::unique_ptr<Simulation> of, std::int64_t snapshot_after)
      : run(std::move(of)), frames(run->model().steps / run->model().steps_per_frame) {
    record = simulate(*run, frames, nullptr, true, [&](std::int64_t done) {
      hashes.push_back(state_hash(run->model(), run->state));
      if (done == snapshot_after) snapshot = saved(*run);
    });
  }
  /// Frames from here on whose state, in `other` restored to the snapshot, has other bits; all of
  /// them where it is not restored. The trace's end has to be the same too.
  std::int64_t differing(Simulation& other, std::int64_t from) const {
    foul(other);
    if (restore_snapshot(other.model(), snapshot.data(), snapshot.size(), other.state) !=
        SnapshotStatus::ok)
      return frames - from;
    std::int64_t count = 0;
    const RunRecord rest = simulate(other, frames - from, nullptr, true, [&](std::int64_t done) {
      if (state_hash(other.model(), other.state) !=
          hashes[static_cast<std::size_t>(from + done - 1)])
        ++count;
    });
    const std::size_t width = other.columns().size();
    const std::vector<double> last(rest.rows.end() - static_cast<std::ptrdiff_t>(width),
                                   rest.rows.end()),
        known(record.rows.end() - static_cast<std::ptrdiff_t>(width), record.rows.end());
    return count + (same_bits(last, known) ? 0 : 1);
  }
};

HardResult snapshots(const std::filesystem::path& scene) {
  HardResult result;
  for (const char* kind : {"full", "modal"}) {
    const auto fresh = [&] { return simulation_of(read_any_scene(scene, {condensed_to(kind)})); };
    const HardRun run(scene, {condensed_to(kind)});
    const auto force = run.column("wheel.wheel_1.force_z_n");
    const auto peak = std::max_element(force.begin(), force.end()) - force.begin();
    const auto lost =
        std::find_if(force.begin() + peak, force.end(), [](double f) { return f <= 0.; }) -
        force.begin();
    const std::string at = std::string(kind) + ": ";
    result.checks.push_back(holds(at + "the wheel strikes and leaves",
                                  peak > 1 && lost < static_cast<std::int64_t>(force.size())));
    const std::pair<const char*, std::int64_t> moments[] = {{"step 1", 1},
                                                            {"the blow's half", peak / 2},
                                                            {"its peak", peak},
                                                            {"last touch", lost - 1},
                                                            {"in the air", lost + 10}};
    for (const auto& [name, frame] : moments) {
      const Whole whole(fresh(), frame);
      const auto other = fresh();
      result.checks.push_back({fmt::format("{}restored at {}: frames of other bits", at, name),
                               static_cast<double>(whole.differing(*other, frame)), 0.});
    }
    result.picture.curves.push_back(run.curve("wheel.wheel_1.force_z_n", kind, 1e-3));
    HardCurve cuts{std::string(kind) + ", restored here", {}, {}, true};
    for (const auto& [name, frame] : moments) {
      cuts.x.push_back(run.time()[static_cast<std::size_t>(frame)]);
      cuts.y.push_back(1e-3 * force[static_cast<std::size_t>(frame)]);
    }
    result.picture.curves.push_back(cuts);
    result.frame_us = run.frame_us();
  }
  result.picture.x_label = "time, s";
  result.picture.y_label = "wheel-rail force, kN";
  return result;
}

// H36 ------------------------------------------------------------------------------------------

bool refused(const std::function<void()>& what) {
  try {
    what();
  } catch (const InputError&) {
    return true;
  }
  return false;
}

/// How many of 1000 copies of a block are taken, each with a bit of another byte changed.
double taken(const std::vector<std::byte>& block) {
  double count = 0.;
  for (std::size_t i = 0; i < 1000; ++i) {
    std::vector<std::byte> changed = block;
    const std::size_t at = i * (block.size() - 1) / 999;  // the first and the last among them
    changed[at] ^= static_cast<std::byte>(1u << (i % 8));
    if (!refused([&] { Simulation(changed, "a changed model"); })) ++count;
  }
  return count;
}

/// The first steps of a run, to be made again.
Recording recorded(const std::filesystem::path& scene) {
  const auto run = simulation_of(read_any_scene(scene));
  Recording made = Recording::begin(*run, 10);
  simulate(*run, 200, nullptr, false, [&](std::int64_t) { made.frame(*run, nullptr); });
  made.finish(*run);
  return made;
}

HardResult changed_model(const std::filesystem::path& scene) {
  const auto one = simulation_of(read_any_scene(scene));
  const auto stiffer = simulation_of(read_any_scene(scene, {"support.stiffness_z_n_per_m=3.1e7"}));
  HardResult result;
  result.checks.push_back({"blocks with a changed bit that were taken", taken(one->block()), 0.});

  const Whole run(simulation_of(read_any_scene(scene)), 500);
  const std::uint64_t before = state_hash(stiffer->model(), stiffer->state);
  const SnapshotStatus status =
      restore_snapshot(stiffer->model(), run.snapshot.data(), run.snapshot.size(), stiffer->state);
  result.checks.push_back(holds("a state of pads of 30 kN/mm is refused by a model of 31",
                                status == SnapshotStatus::other_model));
  result.checks.push_back(holds("which leaves that model's state alone",
                                state_hash(stiffer->model(), stiffer->state) == before));
  result.checks.push_back(
      {"frames of other bits on its own model", static_cast<double>(run.differing(*one, 500)), 0.});

  Recording made = recorded(scene);
  result.checks.push_back(
      holds("a recording of that model is replayed", replay(made, "its own").identical));
  made.block = stiffer->block();
  result.checks.push_back(
      holds("and refused with the other model in it", refused([&] { replay(made, "the other"); })));
  const HardRun shown(scene), other(scene, {"support.stiffness_z_n_per_m=3.1e7"});
  result.checks.push_back(holds("the two models do differ in what they do",
                                !same_bits(shown.record().rows, other.record().rows)));
  result.picture = {"time, s",
                    "wheel-rail force, kN",
                    {shown.curve("wheel.wheel_1.force_z_n", "pads of 30 kN/mm", 1e-3),
                     other.curve("wheel.wheel_1.force_z_n", "pads of 31 kN/mm", 1e-3)}};
  result.frame_us = shown.frame_us();
  return result;
}

// H47 ------------------------------------------------------------------------------------------

/// A file that is removed at the end of the scope.
struct ModelFile {
  std::filesystem::path path;
  explicit ModelFile(const std::vector<std::byte>& block)
      : path(std::filesystem::temp_directory_path() /
             fmt::format("railstep_hard_{}.model", getpid())) {
    write_file(path, {reinterpret_cast<const char*>(block.data()), block.size()});
  }
  ModelFile(const ModelFile&) = delete;
  ModelFile& operator=(const ModelFile&) = delete;
  ~ModelFile() {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
  }
};

HardResult model_file(const std::filesystem::path& scene) {
  HardResult result;
  result.picture = {"time, s", "wheel-rail force, kN", {}};
  for (const char* kind : {"full", "modal"}) {
    const Scene read = read_scene(scene, {condensed_to(kind)});
    const ModelFile file(block_of(Built(read)));
    constexpr std::int64_t kMiddle = 500;
    const Whole whole(std::make_unique<Simulation>(read), kMiddle);
    const Whole written(std::make_unique<Simulation>(file.path), kMiddle);
    Simulation other(file.path);
    const std::string at = std::string(kind) + ": ";
    result.checks.push_back(
        holds(at + "100 000 steps of the model file: the bits of the scene",
              same_bits(written.record.rows, whole.record.rows) && written.hashes == whole.hashes));
    result.checks.push_back(holds(at + "the file has the scene's columns",
                                  written.run->columns() == whole.run->columns()));
    result.checks.push_back({at + "restored in the middle: frames of other bits",
                             static_cast<double>(whole.differing(other, kMiddle)), 0.});
    result.checks.push_back(holds(at + "the motion goes on to the end",
                                  whole.hashes[whole.hashes.size() - 2] != whole.hashes.back() &&
                                      all_finite(whole.record.rows) &&
                                      whole.record.status == Status::ok));
    const std::vector<std::string>& names = whole.run->columns();
    const std::size_t column = static_cast<std::size_t>(
        std::find(names.begin(), names.end(), "car.wheel_1.force_z_n") - names.begin());
    HardCurve curve{kind, {}, {}};
    for (std::size_t i = 0; i < whole.record.rows.size(); i += names.size()) {
      curve.x.push_back(whole.record.rows[i]);
      curve.y.push_back(1e-3 * whole.record.rows[i + column]);
    }
    result.picture.curves.push_back(curve);
    result.frame_us = quantile(whole.record.frame_us, .5);
  }
  return result;
}

// H71 ------------------------------------------------------------------------------------------

HardResult flange_snapshot(const std::filesystem::path& scene) {
  const HardRun run(scene);
  const std::string aside = "car.leading_1_right.y_n";
  const std::vector<double> force = run.column(aside);
  const auto peak = std::max_element(force.begin(), force.end()) - force.begin();
  HardResult result;
  result.checks = {holds("the flange strikes with more than the wheel's weight",
                         run.largest(aside) > run.first("car.leading_1_right.q_n"))};
  for (const std::int64_t frame : {peak - 5, peak - 1, peak, peak + 1, peak + 5}) {
    const Whole whole(simulation_of(read_any_scene(scene, {})), frame);
    const auto other = simulation_of(read_any_scene(scene, {}));
    result.checks.push_back(
        {fmt::format("restored {} frames after the peak: frames of other bits", frame - peak),
         static_cast<double>(whole.differing(*other, frame)), 0.});
  }
  result.picture = {"time, s", "Y of the leading outer wheel, kN", {run.curve(aside, "Y", 1e-3)}};
  result.frame_us = run.frame_us();
  return result;
}

}  // namespace

std::vector<HardCase> model_cases() {
  return {
      {"H33", "h33_long_track", "A load on 10 000 bays", "Rounding and cost grow with the track.",
       "The same load on 40 bays, whose ends the load feels by 3e-12: 1e-10. Counted cost has to "
       "be linear: a bay adds what it adds from 1 250 to 2 500 bays.",
       long_track},
      {"H35", "h35_snapshot", "A run that is cut in two at a blow",
       "Data that a step keeps beside the state (where a search began, say) are lost there.",
       "An invariant: state and scratch of a model are overwritten by NaN, restored, and go on "
       "with the same bits.",
       snapshots},
      {"H36", "h36_changed_model", "A model changed behind its back",
       "A model carries factors of its parameters: one that is changed does not fit them, and a "
       "state does not fit another model.",
       "An invariant: refused by the sum.", changed_model},
      {"H47", "h47_model_file", "1e5 steps from the model file, restored in the middle",
       "The file must hold all of the model, to the bit.", "An invariant: the bits of the scene.",
       model_file},
      {"H71", "h71_flange_snapshot", "A run of a vehicle that is cut in two as its flange strikes",
       "Patches of three zones, creep, series dampers and friction are in the midst of a blow.",
       "An invariant: the same bits.", flange_snapshot}};
}

}  // namespace railstep
