// The errors of a file come together, in its order, and none that only follows from another.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "scene/scene_system.h"
#include "support/bad_input.h"
#include "text/read.h"

using namespace railstep;
using Ids = std::vector<std::string>;

namespace {

template <typename Read>
std::vector<Message> errors_of(const std::string& text, Read read,
                               const std::vector<std::string>& overrides = {}) {
  try {
    read_toml_text(text, "bay.toml", overrides).whole(read);
  } catch (const InputError& error) {
    return error.messages();
  }
  return {};
}

Ids ids_of(const std::vector<Message>& messages) {
  Ids ids;
  for (const Message& message : messages) ids.push_back(message.id);
  return ids;
}

/// "bay.toml:3:5" of each message.
Ids places_of(const std::vector<Message>& messages) {
  Ids places;
  for (const Message& message : messages)
    places.push_back(message.text.substr(0, message.text.find(": ")));
  return places;
}

}  // namespace

TEST_CASE("Bad values of all tables come together, in the order of the file", "[several]") {
  const std::string text =
      "[track]\nbays = 0\nbay_m = 0.6\n[load]\nstart_m = 3.0\nforce_n = \"5\"\n"
      "[step]\ndt_s = nan\n";
  const auto read = [](const Table& root) {
    const Table step = root.table("step"), track = root.table("track"), load = root.table("load");
    (void)step.number("dt_s", above(0));  // asked for first, and last in the file
    const double length =
        static_cast<double>(track.integer("bays", 1, 1000)) * track.number("bay_m", above(0));
    (void)load.number("start_m", between(0, length));
    (void)load.number("force_n", any_number());
    return 0;
  };
  const auto errors = errors_of(text, read);
  CHECK(places_of(errors) == Ids{"bay.toml:2:8", "bay.toml:6:11", "bay.toml:8:8"});
  CHECK(ids_of(errors) == Ids{"E-KEY-05", "E-KEY-03", "E-KEY-04"});
  const auto set = errors_of(text, read, {"track.bays=-1"});
  CHECK(places_of(set) == Ids{"bay.toml:6:11", "bay.toml:8:8", "--set track.bays=-1"});
}

TEST_CASE("A number that could not be read bounds no other", "[several]") {
  const auto errors = errors_of("bay_m = \"x\"\nstart_m = 300.0\n", [](const Table& root) {
    const double bay = root.number("bay_m", above(0));
    (void)root.number("start_m", between(0, 10. * bay));
    (void)root.numbers("absent", above(0), 2, 2);
    return 0;
  });
  CHECK(ids_of(errors) == Ids{"E-KEY-01", "E-KEY-03"});
}

TEST_CASE("Unknown and missing keys of all tables come together, a misspelt key once",
          "[several]") {
  const std::string text = "[rail]\nyoung = 1\npoisson = 0.3\nx = 1\n[step]\ny = 1\n";
  const auto errors = errors_of(text, [](const Table& root) {
    (void)root.table("rail").number("young_pa", above(0));
    (void)root.table("rail").number("poisson", above(0));
    (void)root.table("step").number("duration_s", above(0));
    return 0;
  });
  CHECK(places_of(errors) == Ids{"bay.toml:2:1", "bay.toml:4:1", "bay.toml:5:1", "bay.toml:6:1"});
  CHECK(ids_of(errors) == Ids{"E-KEY-01", "E-KEY-02", "E-KEY-01", "E-KEY-02"});
}

TEST_CASE("A choice that could not be read makes no key of its table missing or unknown",
          "[several]") {
  const auto errors =
      errors_of("[v]\ntype = \"bogey\"\nwheelbase_m = 2.5\nmass_kg = -1\n", [](const Table& root) {
        const Table v = root.table("v");
        if (v.choice("type", {"mass", "bogie"}) == 1) (void)v.number("wheelbase_m", above(0));
        (void)v.number("mass_kg", above(0));
        (void)v.number("radius_m", above(0));
        return 0;
      });
  CHECK(ids_of(errors) == Ids{"E-KEY-06", "E-KEY-05"});
}

TEST_CASE("A table that could not be read is one error, not one for each of its keys",
          "[several]") {
  const auto errors = errors_of("rail = 5\n", [](const Table& root) {
    for (const char* name : {"rail", "step"}) {
      const Table t = root.table(name);
      (void)t.number("young_pa", above(0));
      (void)t.table("below").string("name");
      (void)t.tables("more").size();
      (void)t.choice("ends", {"free"});
    }
    return 0;
  });
  CHECK(ids_of(errors) == Ids{"E-KEY-01", "E-KEY-03"});
}

TEST_CASE("Refusals of several tables come together where all values are good", "[several]") {
  const auto read = [](const Table& root) {
    const bool known = root.each("load", [](const Table& t) {
      if (t.number("stop_m", any_number()) <= t.number("start_m", any_number()))
        t.refuse("stop_m", "E-KEY-10", "behind start_m");
    });
    if (!known) root.end_part();
    root.refuse("", "E-KEY-11", "builds on the loads");
    return 0;
  };
  const std::string loads =
      "[[load]]\nstart_m = 2\nstop_m = 1\n[[load]]\nstart_m = 1\nstop_m = 2\n[[load]]\nstart_m = "
      "4\nstop_m = 3\n";
  const auto errors = errors_of(loads, read);
  CHECK(places_of(errors) == Ids{"bay.toml:3:10", "bay.toml:9:10"});
  // The refusal of the last load may follow from the bad value before it.
  const auto mixed = errors_of(loads, read, {"load[1].start_m=\"x\""});
  CHECK(places_of(mixed) == Ids{"bay.toml:3:10", "--set load[1].start_m=\"x\""});
  CHECK(ids_of(mixed) == Ids{"E-KEY-10", "E-KEY-03"});
  CHECK(errors_of("[[load]]\nstart_m = 1\nstop_m = 2\n", read).size() == 1);
}

namespace {

/// Reads [step] up to frame_s where it is above dt_s, then [rail].
int read_step_and_rail(const Table& root) {
  root.attempt_alone({"step"}, [&] {
    const Table step = root.table("step");
    if (step.number("dt_s", above(0)) > step.number("frame_s", above(0)))
      step.refuse("frame_s", "E-KEY-10", "shorter than dt_s");
    (void)step.number("duration_s", above(0));
  });
  if (!(root.table("rail").number("young_pa", above(0)) >= 2.))
    root.refuse("rail", "E-KEY-11", "too soft");
  return 0;
}

}  // namespace

TEST_CASE("Unknown keys are told beside a refusal, but not where the reading ended before them",
          "[several]") {
  const std::string text =
      "foo = 1\n[step]\ndt_s = 2\nframe_s = 1\nduration_s = 5\nx = 1\n[rail]\nyoung_pa = 3\n"
      "poison = 0\n";
  const auto errors = errors_of(text, read_step_and_rail);
  CHECK(places_of(errors) == Ids{"bay.toml:1:1", "bay.toml:4:11", "bay.toml:9:1"});
  CHECK(ids_of(errors) == Ids{"E-KEY-02", "E-KEY-10", "E-KEY-02"});
  // Where the reading ends before the root was read, an unknown key is told by the root's list.
  const Table root = read_toml_text(text, "bay.toml", {"rail.young_pa=1"});
  const auto ids = [&](Table::Names keys) {
    try {
      root.whole(read_step_and_rail, keys);
    } catch (const InputError& error) {
      return ids_of(error.messages());
    }
    return Ids{};
  };
  CHECK(ids({}) == Ids{"E-KEY-10", "E-KEY-11"});
  CHECK(ids({"step", "rail", "sleeper"}) == Ids{"E-KEY-02", "E-KEY-10", "E-KEY-11"});
}

TEST_CASE("A bad value drops the refusals that build on it, and no others", "[several]") {
  const std::string text = "[step]\ndt_s = 2\nframe_s = 3\nduration_s = 5\n[rail]\nyoung_pa = 1\n";
  CHECK(ids_of(errors_of(text, read_step_and_rail, {"step.dt_s=\"x\""})) ==
        Ids{"E-KEY-11", "E-KEY-03"});
  CHECK(ids_of(errors_of(text, read_step_and_rail, {"rail.young_pa=\"x\""})) == Ids{"E-KEY-03"});
}

namespace {

/// The errors of reading a scene; none where it is read.
std::vector<Message> scene_errors(const std::string& file,
                                  const std::vector<std::string>& overrides = {}) {
  try {
    read_any_scene(file, overrides);
  } catch (const InputError& error) {
    return error.messages();
  }
  return {};
}

/// moving_load with a step that its frame does not hold, two loads of one name and an unknown
/// table.
std::string three_faults() {
  std::string text = replaced(text_of(kMovingLoad), "frame_s = 1.0e-3", "frame_s = 7.0e-5");
  text = replaced(text, "\"load_right\"", "\"load_left\"");
  return replaced(text, "[support]", "[foo]\n[support]");
}

}  // namespace

TEST_CASE("Errors of independent tables of a scene come together, in the order of the file",
          "[several][scene]") {
  const BadInput bad("three_faults");
  CHECK(ids_of(scene_errors(bad.file("all.toml", three_faults()))) ==
        Ids{"E-KEY-02", "E-RUNNER-19", "E-STEP-06"});
  CHECK(ids_of(scene_errors(kMovingLoad, {"foo.a=1", "step.frame_s=7e-5"})).size() == 2);
  // The path of a load builds on the duration, which a refused step does not give.
  CHECK(ids_of(scene_errors(kMovingLoad, {"step.frame_s=7e-5", "step.duration_s=0.4"})) ==
        Ids{"E-STEP-06"});
  // A sensor builds on the wheelsets, and a load does not.
  Ids refused = ids_of(
      scene_errors(kWheelset, {"wheelset[0].guide.alpha_per_s=1", "sensor[0].wheelset=\"none\"",
                               "stop=[{name=\"a b\"}]", "step.newmark_beta=0.3"}));
  std::sort(refused.begin(), refused.end());
  CHECK(refused == Ids{"E-RUNNER-11", "E-RUNNER-14", "E-STEP-01"});
}

TEST_CASE("No key of a shipped scene is called unknown beside another error", "[several][scene]") {
  const std::vector<std::string> faults = {
      "step.newmark_beta=0.3",
      "step.frame_s=7e-9",
      "step.dt_s=\"x\"",
      "track.rails=1",
      "track.gauge_m=1.435",
      "track.bays=1000000000",
      "track.linearised_at=\"weight\"",
      "track.unknowns=\"x\"",
      "track=5",
      "rail.profile=\"none.toml\"",
      "rail.crown_radius_m=3e8",
      "sleeper.mass_kg=3",
      "support=5",
      "condense={modes_per_bay=2, highest_hz=900}",
      "load=[{name=\"a b\"}]",
      "wheelset=5",
      "wheelset[0].name=\"a b\"",
      "vehicle=5",
      "vehicle[0].type=\"x\"",
      "vehicle[0].start_m=1e7",
      "vehicle[0].name=\"a b\"",
      "contact.kinetic_part=5",
      "contact.half_slip_m_per_s=1.0",
      "external_wheel=[{name=\"a b\"}]",
      "sensor[0].name=\"a b\"",
      "system.planar=true",
      "body[0].name=\"ground\"",
      "beam[0].name=\"a b\"",
      "joint[0].kind=\"x\"",
      "spring[0].between=[\"ground\", \"ground\"]",
  };
  std::size_t refused = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kScenes)) {
    const std::string scene = entry.path().string();
    // Contacts of profiles take a second for each scene that is read.
    if (text_of(scene).find("wheel = \"profile\"") != std::string::npos) continue;
    for (const std::string& fault : faults) {
      const std::vector<Message> errors = scene_errors(scene, {fault});
      refused += errors.empty() ? 0 : 1;
      for (const Message& error : errors) {
        INFO(fault << ": " << error.line());
        // A key that --set gives may be unknown to this scene, and a key of its file is not.
        CHECK((error.id != "E-KEY-02" || error.text.starts_with("--set")));
      }
    }
  }
  CHECK(refused > 300);
}

TEST_CASE("A file without errors is read as it is", "[several]") {
  CHECK(read_toml_text("a = 2\n", "bay.toml").whole([](const Table& root) {
    return root.number("a", above(0));
  }) == 2.);
}
