// The errors of a file come together, in its order, and none that only follows from another.
#include <catch2/catch.hpp>
#include <string>
#include <vector>

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
    root.each("load", [](const Table& t) {
      if (t.number("stop_m", any_number()) <= t.number("start_m", any_number()))
        t.refuse("stop_m", "E-KEY-10", "behind start_m");
    });
    root.stop_if_refused();
    root.refuse("", "E-KEY-11", "follows from the loads");
    return 0;
  };
  const std::string loads =
      "[[load]]\nstart_m = 2\nstop_m = 1\n[[load]]\nstart_m = 1\nstop_m = 2\n[[load]]\nstart_m = "
      "4\nstop_m = 3\n";
  const auto errors = errors_of(loads, read);
  CHECK(places_of(errors) == Ids{"bay.toml:3:10", "bay.toml:9:10"});
  // A bad value comes before all refusals: they may follow from it.
  const auto mixed = errors_of(loads, read, {"load[1].start_m=\"x\""});
  CHECK(ids_of(mixed) == Ids{"E-KEY-03"});
  CHECK(errors_of("[[load]]\nstart_m = 1\nstop_m = 2\n", read).size() == 1);
}

TEST_CASE("A file without errors is read as it is", "[several]") {
  CHECK(read_toml_text("a = 2\n", "bay.toml").whole([](const Table& root) {
    return root.number("a", above(0));
  }) == 2.);
}
