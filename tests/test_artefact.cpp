#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "artefact.h"
#include "block_mutations.h"
#include "build.h"
#include "offline/vehicle/kinds.h"

using namespace railstep;

namespace {

const std::string kScenes = std::string(RAILSTEP_SOURCE) + "/config/scenes/";

/// Small models of both kinds, with loads that have tables, wheelsets, vehicles, irregular rails
/// and wheels, probes and pair tables.
std::unique_ptr<PackedModel> small_model(bool modal, bool wheels) {
  Track track = wheels ? paper_track() : peers_pair(1);
  track.bays = 2;
  Traffic traffic;
  for (const double x : {.2, .5})
    traffic.loads.push_back(
        {.start = x, .speed = 10., .stop = 1., .force = -50e3, .table = {0., 0., .01, 1.}});
  if (wheels) {
    Wheelset w;
    w.mass = 100.;
    w.inertia_roll = w.inertia_yaw = 8.3;
    w.inertia_spin = 1.1;
    w.weight = 981.;
    w.radius = .148;
    w.start = 1.2;
    w.forces = {{1, {0., 10., .01, 0.}}};
    w.tread[1] = fit_signal({0., 1e-5, -1e-5}, 0., .3, true);
    w.flange = Flange{.clearance = 1e-5, .angle = 1.2, .stiffness = 1e7, .damping = 1e4};
    traffic.wheelsets = {w};
    traffic.irregularities = {{0, 2, fit_signal({0., 1e-5}, 1., .1, false)},
                              {1, 1, fit_signal({1e-5, 0., 2e-5}, 0., .5, true)}};
    traffic.head = {.1007375, .3, .038};
    RunningVehicle v;
    v.vehicle = bogie({.frame_mass = 1000.,
                       .frame_inertia = 700.,
                       .wheel_mass = 500.,
                       .wheelbase = .9,
                       .axles = 2,
                       .primary_stiffness = 1e6,
                       .primary_damping = 1e4})
                    .vehicle;
    v.start = .1;  // a wheel comes from the ground
    v.speeds = {0., 10., .01, 20.};
    v.tread = {fit_signal({0., 1e-5, -1e-5}, 0., .3, true), {}};
    traffic.vehicles = {v, v};
    traffic.vehicles[1].rail = 1;
    traffic.vehicles[1].contact = WheelContactKind::linear;
    traffic.vehicles[1].stiffness = 1e8;
    traffic.vehicles[1].damping = 1e4;
    traffic.loads[0].amplitude = 1e3;
    traffic.loads[0].frequency = 50.;
    traffic.loads[1].speeds = {0., 10., .01, 20.};
    traffic.probes = {{.displacement = 1., .wheelset = 0, .coordinate = 2},
                      {.displacement = 1., .coordinate = 1, .vehicle = 1}};
  }
  traffic.probes.push_back({.rest = .1,
                            .displacement = 1.,
                            .velocity = .01,
                            .track = {.rail = {{{0, .4, 0., 0., 2}, 1.}}}});
  PackOptions options = modal ? condensed(track, 3, 1e-4) : full_order(1e-4);
  options.residual_points = 4;
  options.steps_per_frame = 2;
  options.steps = 40;
  return std::make_unique<PackedModel>(track, traffic, options);
}

const std::string kText = "time_s\nsome.column_m";

Block small_block(bool modal, bool wheels) {
  return to_block(small_model(modal, wheels)->model(), kText);
}

}  // namespace

TEST_CASE("a model that was written and read steps to the same bits", "[artefact]") {
  for (const char* name :
       {"moving_load", "wheelset_on_track", "wheelset_flange", "ballasted_track"})
    for (const char* kind : {"full", "modal"}) {
      std::vector<std::string> overrides = {std::string("condense.kind=\"") + kind + "\""};
      if (std::string(name) == "ballasted_track") {
        overrides.insert(overrides.end(), {"track.bays=16", "sensor[0].sleeper=8",
                                           "sensor[1].position_m=4.8", "step.duration_s=0.1"});
      }
      const Built built(read_scene(kScenes + name + ".toml", overrides));
      const Block block = block_of(built);
      Model model;
      REQUIRE(read(block, model).status == LoadStatus::ok);
      LoadedRun written(built.packed->model()), found(model);
      CHECK(written.probes == found.probes);
      CHECK(written.frames(40) == found.frames(40));
      CAPTURE(name, kind);
      CHECK(state_hash(model, written.state) == state_hash(model, found.state));
      CHECK(written.probes == found.probes);
      CHECK(std::equal(written.outputs.load_deflection, written.outputs.load_deflection + kMaxLoads,
                       found.outputs.load_deflection));
      for (int i = 0; i < 2 * model.wheelsets; ++i) {
        CHECK(written.outputs.wheel_force_peak[i] == found.outputs.wheel_force_peak[i]);
        CHECK(written.outputs.wheel_gap[i] == found.outputs.wheel_gap[i]);
        CHECK(written.outputs.wheel_rail_z[i] == found.outputs.wheel_rail_z[i]);
      }
      // What was read is written as it was, and the scene built anew gives the same bytes; in
      // another heap, so that nothing is left unset.
      const LoadResult back = read(block, model);
      const bool same = to_block(model, std::string(back.text, back.text_bytes)) == block;
      CHECK(same);
      const bool again = block_of(Built(read_scene(kScenes + name + ".toml", overrides))) == block;
      CHECK(again);
    }
}

TEST_CASE("a block's text comes back, and its sum is named", "[artefact]") {
  const Block block = small_block(true, true);
  Model model;
  const LoadResult result = read(block, model);
  REQUIRE(result.status == LoadStatus::ok);
  CHECK(std::string(result.text, result.text_bytes) == kText);
  CHECK(model.steps == 40);
  CHECK(model.steps_per_frame == 2);
  const std::string sum = sum_of(block);
  REQUIRE(sum.size() == 64);
  CHECK(std::stoi(sum.substr(0, 2), nullptr, 16) == std::to_integer<int>(block[kSumAt]));
  CHECK(std::stoi(sum.substr(62), nullptr, 16) == std::to_integer<int>(block[kSumAt + 31]));
}

TEST_CASE("a block that starts between words is not placed", "[artefact]") {
  const Block block = small_block(true, false);
  std::vector<std::int64_t> room(block.size() / 8 + 1);
  Model model;
  for (std::size_t shift = 0; shift < 8; ++shift) {
    auto* at = reinterpret_cast<std::byte*>(room.data()) + shift;
    std::memcpy(at, block.data(), block.size());
    CHECK(load_model(at, block.size(), model).status ==
          (shift == 0 ? LoadStatus::ok : LoadStatus::misaligned));
  }
}

TEST_CASE("one flipped bit in a header is refused as what it is", "[artefact]") {
  const Block good = small_block(true, false);
  const auto expected = [](std::size_t byte) {
    if (byte < 8) return LoadStatus::not_a_model;
    if (byte < 16) return LoadStatus::other_version;
    return byte < 24 ? LoadStatus::wrong_size : LoadStatus::wrong_sum;
  };
  for (std::size_t byte = 0; byte < kModelFrom; ++byte)
    for (int bit = 0; bit < 8; ++bit) {
      Block bad = good;
      bad[byte] ^= std::byte{1} << bit;
      CAPTURE(byte, bit);
      CHECK(status_of(bad) == expected(byte));
    }
  for (std::size_t byte = kModelFrom; byte < good.size(); byte += 61) {
    Block bad = good;
    bad[byte] ^= std::byte{16};
    CAPTURE(byte);
    CHECK(status_of(bad) == LoadStatus::wrong_sum);
  }
}

TEST_CASE("a block cut short or run on is refused, signed anew or not", "[artefact]") {
  const Block good = small_block(true, true);
  for (std::size_t size = 0; size < good.size(); size += size < 256 ? 1 : 241) {
    Block cut(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size));
    CAPTURE(size);
    CHECK(status_of(cut) == (size < kModelFrom ? LoadStatus::not_a_model : LoadStatus::wrong_size));
    if (size < kModelFrom) continue;
    sign(cut);
    CHECK(status_of(cut) == LoadStatus::bad_content);
  }
  for (const std::size_t more : {1u, 8u, 4096u}) {
    Block longer = good;
    longer.resize(good.size() + more);
    CHECK(status_of(longer) == LoadStatus::wrong_size);
    sign(longer);
    CHECK(status_of(longer) == LoadStatus::bad_content);
  }
}

TEST_CASE("numbers out of range are refused though the sum is right", "[artefact]") {
  const Block good = small_block(true, true);
  const std::size_t counts = kModelFrom + (kText.size() + 7) / 8 * 8 + 12 * 8;  // behind the scheme
  Model model;
  REQUIRE(read(good, model).status == LoadStatus::ok);
  REQUIRE(word_of(good, counts) == model.lines);
  // lines, loads, wheelsets, vehicles and their wheels, signals, elements, unknowns, condensed,
  // bodies, steps_per_frame, steps
  for (std::size_t i = 0; i < 12; ++i)
    for (const std::int64_t value : {std::int64_t{-1}, std::numeric_limits<std::int64_t>::min(),
                                     word_of(good, counts + 8 * i) + 1}) {
      if (value > 0 && i >= 10) continue;  // more steps are a run like another
      Block bad = good;
      put_word(bad, counts + 8 * i, value);
      sign(bad);
      CAPTURE(i, value);
      CHECK(status_of(bad) == LoadStatus::bad_content);
    }
  for (const std::int64_t length : {std::int64_t{-1}, std::int64_t{1} << 40}) {  // of the text
    Block bad = good;
    put_word(bad, kSummedFrom, length);
    sign(bad);
    CHECK(status_of(bad) == LoadStatus::bad_content);
  }
}

TEST_CASE("flanges that are of no wheelset, or have no law, are refused", "[artefact]") {
  const std::unique_ptr<PackedModel> packed = small_model(false, true);
  const auto status = [&](const auto& change) {
    Model model = packed->model();
    change(model);
    return status_of(to_block(model, kText));
  };
  CHECK(status([](Model&) {}) == LoadStatus::ok);
  CHECK(status([](Model& m) { m.flange[0].wheelset = 1; }) == LoadStatus::bad_content);
  CHECK(status([](Model& m) { m.flange[0].contact.stiffness = 0.; }) == LoadStatus::bad_content);
  CHECK(status([](Model& m) { m.flange[0].contact.damping = -1.; }) == LoadStatus::bad_content);
  CHECK(status([](Model& m) { m.flange[0].contact.stiffness = std::nan(""); }) ==
        LoadStatus::bad_content);
  CHECK(status([](Model& m) { m.flange[0].contact.hertz = 1e10; }) == LoadStatus::ok);
}

TEST_CASE("a model that does not say what a frame takes is refused", "[artefact]") {
  const std::unique_ptr<PackedModel> packed = small_model(false, true);
  for (std::int64_t Cost::*const of : {&Cost::flops, &Cost::bytes, &Cost::instructions}) {
    Model model = packed->model();
    CHECK(model.cost.*of > 0);
    for (const std::int64_t value : {std::int64_t{0}, std::int64_t{-1}}) {
      model.cost.*of = value;
      CHECK(status_of(to_block(model, kText)) == LoadStatus::bad_content);
    }
  }
}

TEST_CASE("whatever loads can be stepped, whatever its numbers are", "[artefact][fuzz]") {
  std::mt19937_64 random(20240607);
  for (const bool modal : {false, true})
    for (const bool wheels : {false, true}) {
      const Block good = small_block(modal, wheels);
      int loaded = 0, refused = 0;
      for (int round = 0; round < 1500; ++round) {
        const Block bad = mutated(good, random);
        Model model;
        if (read(bad, model).status != LoadStatus::ok) {
          ++refused;
          continue;
        }
        ++loaded;
        model.steps_per_frame = std::min(model.steps_per_frame, 4);  // time alone
        LoadedRun run(model);
        // A state that stops being finite is stepped no further.
        const bool lost = has(run.frames(3), Status::nonfinite_state);
        CHECK((run.state.steps == 3 * model.steps_per_frame || lost));
        CHECK(run.state.steps % model.steps_per_frame == 0);
      }
      CHECK(loaded > 100);
      CHECK(refused > 100);
    }
}

TEST_CASE("the flops of a frame are no fewer than those counted by hand", "[artefact]") {
  const auto model_of = [](int loads, bool modal, bool residual) {
    Track track = peers_pair(1);
    track.rails = 1;
    Traffic traffic;
    for (int i = 0; i < loads; ++i)
      traffic.loads.push_back({.start = .3 + .25 * i, .stop = 9.6, .force = -1e3});
    PackOptions options = modal ? condensed(track, 1, 1e-3) : full_order(1e-3);
    options.residual_flexibility = residual;
    return std::make_unique<PackedModel>(track, traffic, options);
  };
  // Of a mode: a complex number times keep, old_force and new_force, and two sums: 3 6 + 4. A load
  // adds 3 nodes of a complex row to the forces, and reads as many: 4 each.
  const auto one = model_of(1, true, false);
  const std::int64_t n = one->model().line[0].size;
  REQUIRE(n == 40);  // 33 modes, padded
  CHECK(one->model().cost.flops >= n * (22 + 3 * 4 + 3 * 4));
  CHECK(one->model().cost.flops <= 3 * n * (22 + 3 * 4 + 3 * 4));
  // Every pair of loads reads a table of 4 x 4 points: 4 + 1 cubics of 4 products and 3 sums, and
  // the weights of 4 + 1 of them, each 4 products of three differences.
  const auto many = model_of(32, true, true);
  const std::int64_t pairs = 32 * 31 * (5 * 7 + 5 * 4 * 5);
  CHECK(many->model().cost.flops >= n * (22 + 32 * 24) + pairs);
  // Banded: 22 of predicting and correcting an unknown, products with M and C by diagonals, and per
  // panel of 8 rows a product with `left` columns forth and back, and one with an 8 x 8 block.
  const auto band = model_of(1, false, false);
  const LineModel& line = band->model().line[0];
  const std::int64_t solve = line.step.panels * (2 * 2 * 8 * std::int64_t{line.step.left} + 2 * 64);
  const std::int64_t products =
      2 * (line.mass.count + line.damping.count) * std::int64_t{line.size};
  CHECK(band->model().cost.flops >= 22 * line.size + products + solve);
  CHECK(band->model().cost.flops <= 2 * (22 * line.size + products + solve));
}
