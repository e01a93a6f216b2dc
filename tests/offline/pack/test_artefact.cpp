#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "build/build.h"
#include "support/block_mutations.h"
#include "support/shipped.h"
#include "support/small_model.h"

using namespace railstep;

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
      CHECK(written.track_sensors == found.track_sensors);
      CHECK(written.frames(40) == found.frames(40));
      CAPTURE(name, kind);
      CHECK(state_hash(model, written.state) == state_hash(model, found.state));
      CHECK(written.track_sensors == found.track_sensors);
      CHECK(std::equal(written.outputs.load_deflection, written.outputs.load_deflection + kMaxLoads,
                       found.outputs.load_deflection));
      for (int i = 0; i < tread_count(model); ++i) {
        CHECK(written.outputs.contact_force_peak[i] == found.outputs.contact_force_peak[i]);
        CHECK(written.outputs.contact_gap[i] == found.outputs.contact_gap[i]);
        CHECK(written.outputs.contact_rail_z[i] == found.outputs.contact_rail_z[i]);
      }
      // A model that was read is written as it was. The scene built again in another heap gives the
      // same bytes, so nothing is left unset.
      const LoadResult back = read(block, model);
      const bool same =
          to_block(model, std::string(back.text, back.text_bytes), {.about = built.about}) == block;
      CHECK(same);
      const bool again = block_of(Built(read_scene(kScenes + name + ".toml", overrides))) == block;
      CHECK(again);
    }
}

TEST_CASE("reading a block returns its text, and its sum can be named", "[artefact]") {
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

TEST_CASE("a block that starts between words is refused", "[artefact]") {
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

TEST_CASE("the padding between the sections of a block is zero", "[artefact]") {
  const Block good = small_block(true, true);
  const BlockHeader header = header_of(good.data());
  int gaps = 0;
  for (std::size_t s = 0; s < kSections; ++s)
    for (std::size_t at = header.section[s].at + header.section[s].bytes; at % 8 != 0; ++at) {
      Block bad = good;
      bad[at] = std::byte{1};
      CHECK(status_of(bad) == LoadStatus::wrong_sum);
      sign(bad);
      CHECK(status_of(bad) == LoadStatus::bad_content);
      ++gaps;
    }
  CHECK(gaps > 0);
}

TEST_CASE("numbers out of range are refused even with the right sum", "[artefact]") {
  const Block good = small_block(true, true);
  const std::size_t counts = section_at(good, kWords);
  Model model;
  REQUIRE(read(good, model).status == LoadStatus::ok);
  REQUIRE(word_of(good, counts + 8) == model.lines);
  // The scheme's mean, lines, loads, wheelsets, vehicles and their wheels, signals, elements,
  // unknowns, condensed, bodies, steps_per_frame, inputs.
  for (std::size_t i = 0; i < 13; ++i)
    for (const std::int64_t value : {std::int64_t{-1}, std::numeric_limits<std::int64_t>::min(),
                                     word_of(good, counts + 8 * i) + 1}) {
      Block bad = good;
      put_word(bad, counts + 8 * i, value);
      sign(bad);
      CAPTURE(i, value);
      CHECK(status_of(bad) == LoadStatus::bad_content);
    }
}

TEST_CASE("numbers that would make a solve unsafe are refused even with the right sum",
          "[artefact]") {
  const std::unique_ptr<PackedModel> packed = small_model(false, true);
  const auto status = [&](const auto& change) {
    Model model = packed->model();
    change(model);
    return status_of(to_block(model, kText));
  };
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = 1. / 0.;
  const LoadStatus bad = LoadStatus::bad_content;
  CHECK(status([](Model&) {}) == LoadStatus::ok);
  CHECK(status([&](Model& m) { m.load[0].stop = inf; }) == LoadStatus::ok);
  for (const double value : {nan, inf, -inf}) {
    CAPTURE(value);
    CHECK(status([&](Model& m) { m.scheme.kg = value; }) == bad);
    CHECK(status([&](Model& m) { m.load[0].force = value; }) == bad);
    CHECK(status([&](Model& m) { m.rail_z[1] = value; }) == bad);
  }
  CHECK(status([&](Model& m) { m.scheme.stage_fraction = -.1; }) == bad);
  CHECK(status([&](Model& m) { m.scheme.stage_fraction = 1.; }) == bad);
  CHECK(status([&](Model& m) { m.scheme.mean = 1; }) == bad);
  CHECK(status([&](Model& m) { m.load[0].stop = nan; }) == bad);
  const double no_inertia[6] = {1., 1., 1., 0., 1., 1.};
  CHECK(status([&](Model& m) { m.wheelset[0].mass = no_inertia; }) == bad);
  CHECK(status([&](Model& m) { m.contact[1].law.hertz = -1.; }) == bad);
  CHECK(status([&](Model& m) { m.wheelset[0].radius = 0.; }) == bad);
  CHECK(status([&](Model& m) { m.wheelset[0].cap = 0; }) == bad);
  CHECK(status([&](Model& m) { m.contact[vehicle_contact(m, 0)].law = {0., 0., 0.}; }) == bad);
  CHECK(status([&](Model& m) { m.contact[vehicle_contact(m, 0)].law = {0., 1e8, -1.}; }) == bad);
  const SuspendedModel& own = packed->model().vehicle[0];
  const auto turned = [](const double* from, std::int32_t n) {  // last of a matrix's diagonal
    std::vector<double> copy(from, from + std::ptrdiff_t{n} * n);
    copy.back() = -copy.back();
    return copy;
  };
  const std::vector<double> inverse = turned(own.inverse, own.size);
  const ContactModel& wheel = packed->model().contact[vehicle_contact(packed->model(), 0)];
  std::vector<double> moved(wheel.moved, wheel.moved + own.size);
  for (double& x : moved) x = -x;
  CHECK(status([&](Model& m) { m.vehicle[0].inverse = inverse.data(); }) == bad);
  CHECK(status([&](Model& m) { m.contact[vehicle_contact(m, 0)].moved = moved.data(); }) == bad);
  CHECK(status([&](Model& m) { m.contact[vehicle_contact(m, 0)].bodies = m.vehicles; }) == bad);
  CHECK(status([&](Model& m) { m.contact[0].rail = 1; }) == bad);
  CHECK(status([&](Model& m) { m.contact[0].kind = ContactKind::wheel; }) == bad);
  std::vector<double> table(packed->model().load[0].table, packed->model().load[0].table + 4);
  table[3] = nan;
  CHECK(status([&](Model& m) { m.load[0].table = table.data(); }) == bad);
}

TEST_CASE("flanges without a wheelset or without a law are refused", "[artefact]") {
  const std::unique_ptr<PackedModel> packed = small_model(false, true);
  const auto status = [&](const auto& change) {
    Model model = packed->model();
    change(model);
    return status_of(to_block(model, kText));
  };
  CHECK(status([](Model&) {}) == LoadStatus::ok);
  CHECK(status([](Model& m) { m.flange[0].wheelset = 1; }) == LoadStatus::bad_content);
  CHECK(status([](Model& m) { m.contact[flange_contact(m, 0)].law.stiffness = 0.; }) ==
        LoadStatus::bad_content);
  CHECK(status([](Model& m) { m.contact[flange_contact(m, 0)].law.damping = -1.; }) ==
        LoadStatus::bad_content);
  CHECK(status([](Model& m) { m.contact[flange_contact(m, 0)].law.stiffness = std::nan(""); }) ==
        LoadStatus::bad_content);
  CHECK(status([](Model& m) { m.contact[flange_contact(m, 0)].law.hertz = 1e10; }) ==
        LoadStatus::ok);
}

TEST_CASE("names that a scene cannot give are refused even with the right sum", "[artefact]") {
  const std::unique_ptr<PackedModel> packed = small_model(false, false);
  const auto status = [&](const std::string& text) {
    return status_of(to_block(packed->model(), text));
  };
  for (const char* good : {"", "time_s", "a.b_m\nC-9", "a\nb\n\nb\na"})
    CHECK(status(good) == LoadStatus::ok);
  for (const char* bad : {"a,b", "a b", "a\r\nb", "a\x1b[31m", "a\"b", "a\xc3\xa4", "a\nb\na",
                          "\na", "a\n\nb\nb", "a\n\nb;c", "a\n\n\nb", "a\n"}) {
    CAPTURE(bad);
    CHECK(status(bad) == LoadStatus::bad_content);
  }
  CHECK(status(std::string("a\0b", 3)) == LoadStatus::bad_content);
  std::string many = "first";  // more than one batch of those that are compared at once
  for (int i = 0; i < 5000; ++i) many += "\nsensor_" + std::to_string(i) + ".z_m";
  CHECK(status(many) == LoadStatus::ok);
  CHECK(status(many + "\nsensor_1234.z_m") == LoadStatus::bad_content);
}

TEST_CASE("a run without whole frames is refused even with the right sum", "[artefact]") {
  const std::unique_ptr<PackedModel> packed = small_model(true, true);
  for (const std::int64_t steps : {0, 1, 39, 41, -40}) {
    Model model = packed->model();  // it has 2 steps per frame
    model.steps = steps;
    CHECK(status_of(to_block(model, kText)) == LoadStatus::bad_content);
  }
}

TEST_CASE("a model that states less work than its steps need is refused even with the right sum",
          "[artefact]") {
  for (const bool modal : {false, true})
    for (const bool wheels : {false, true}) {
      const std::unique_ptr<PackedModel> packed = small_model(modal, wheels);
      Model model = packed->model();
      CHECK(status_of(to_block(model, kText)) == LoadStatus::ok);
      model.steps_per_frame = 1 << 22;
      model.steps = model.steps_per_frame;
      CHECK(status_of(to_block(model, kText)) == LoadStatus::bad_content);
      model = packed->model();
      model.cost.flops = model.steps_per_frame * 22 * model.line_unknowns - 1;
      CHECK(status_of(to_block(model, kText)) == LoadStatus::bad_content);
    }
}

TEST_CASE("a model that does not state the work of a frame is refused", "[artefact]") {
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

TEST_CASE("every model that loads can be stepped, whatever its numbers are", "[artefact][fuzz]") {
  std::mt19937_64 random(20240607);
  for (const bool modal : {false, true})
    for (const bool wheels : {false, true}) {
      const Block good = small_block(modal, wheels);
      int loaded = 0, refused = 0;
      for (int round = 0; round < 2000; ++round) {
        const Block bad = mutated(good, random);
        Model model;
        if (read(bad, model).status != LoadStatus::ok) {
          ++refused;
          continue;
        }
        ++loaded;
        model.steps_per_frame = std::min(model.steps_per_frame, 4);  // only to save time
        LoadedRun run(model);
        // The test ends where a state is no longer finite.
        const bool lost = has(run.frames(3), Status::nonfinite_state);
        CHECK((run.state.steps == 3 * model.steps_per_frame || lost));
        CHECK(run.state.steps % model.steps_per_frame == 0);
      }
      CHECK(loaded > 100);
      CHECK(refused > 100);
    }
}

TEST_CASE("the stated flops of a frame are not fewer than those counted by hand", "[artefact]") {
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
  // A mode has a complex number times keep, old_force and new_force, and two sums: 3 6 + 4. A load
  // adds 3 nodes of a complex row to the forces and reads as many: 4 each.
  const auto one = model_of(1, true, false);
  const std::int64_t n = one->model().line[0].size;
  REQUIRE(n == 40);  // 33 modes, padded
  CHECK(one->model().cost.flops >= n * (22 + 3 * 4 + 3 * 4));
  CHECK(one->model().cost.flops <= 3 * n * (22 + 3 * 4 + 3 * 4));
  // Every pair of loads reads a table of 4 x 4 points: 4 + 1 cubics of 4 products and 3 sums. Each
  // load has the weights of a cubic, 4 products of three differences.
  const auto many = model_of(32, true, true);
  const std::int64_t pairs = 32 * (31 * 5 * 7 + 4 * 5);
  CHECK(many->model().cost.flops >= n * (22 + 32 * 24) + pairs);
  // Banded: 22 to predict and correct an unknown, products with M and C by diagonals, and for each
  // panel of 8 rows a product with `left` columns back and forth and one with an 8 x 8 block.
  const auto band = model_of(1, false, false);
  const LineModel& line = band->model().line[0];
  const std::int64_t solve = line.step.panels * (2 * 2 * 8 * std::int64_t{line.step.left} + 2 * 64);
  const std::int64_t products =
      2 * (line.mass.count + line.damping.count) * std::int64_t{line.size};
  CHECK(band->model().cost.flops >= 22 * line.size + products + solve);
  CHECK(band->model().cost.flops <= 2 * (22 * line.size + products + solve));
}
