#include <unistd.h>  // getpid: test cases run side by side, each in its own folder

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include "text/read.h"
#include "text/write.h"

using namespace railstep;
using Catch::Contains;
using Overrides = std::vector<std::string>;

namespace {

Table parse(const std::string& text, const Overrides& overrides = {}) {
  return read_toml_text(text, "bay.toml", overrides);
}

/// The sentence of the InputError that `act` throws, or "accepted" if it throws none.
std::string sentence(const std::function<void()>& act) {
  try {
    act();
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

std::string parse_sentence(const std::string& text) {
  return sentence([&] { parse(text).finish(); });
}

std::filesystem::path folder() {
  auto made =
      std::filesystem::temp_directory_path() / ("railstep_test_read_" + std::to_string(getpid()));
  std::filesystem::create_directories(made);
  return made;
}

std::string file_with(const std::string& name, const std::string& content) {
  const auto file = folder() / name;
  std::ofstream(file, std::ios::binary) << content;
  return file.string();
}

}  // namespace

TEST_CASE("a number may be written as an integer, and a string is refused with its place",
          "[read]") {
  const Table root = parse("[rail]\nyoung_pa = 210000000000\npoisson = \"0.3\"\n");
  const Table rail = root.table("rail");
  CHECK(rail.number("young_pa", above(0)) == 210e9);
  CHECK(sentence([&] { (void)rail.number("poisson", above(0)); }) ==
        "bay.toml:3:11: [rail] poisson = \"0.3\" is a string; expected a number [E-KEY-03]");
}

TEST_CASE("numbers out of range or not finite are refused with the range", "[read]") {
  const Table root = parse("a = -1.5\nb = nan\nc = inf\nd_m = 600.0\n");
  CHECK(sentence([&] { (void)root.number("a", above_upto(0, 10)); }) ==
        "bay.toml:1:5: a = -1.5 is out of range; expected above 0, at most 10 [E-KEY-05]");
  CHECK_THAT(sentence([&] { (void)root.number("b", at_least(0)); }),
             Contains("bay.toml:2:5: b = nan is not finite; expected at least 0 [E-KEY-04]"));
  CHECK_THAT(sentence([&] { (void)root.number("c", any_number()); }), Contains("E-KEY-04"));
  CHECK_THAT(sentence([&] { (void)root.number("d_m", between(0.1, 2)); }),
             Contains("was it given in millimetres?"));
  CHECK_FALSE(above(0).holds(0));
  CHECK(at_least(0).holds(0));
  CHECK_FALSE((Range{.most = 0.5, .most_itself = false}).holds(0.5));
}

TEST_CASE("each getter refuses a value of another kind", "[read]") {
  const Table root = parse("x = 1.5\nt = true\ns = \"\"\nn = 7\nm = \"stiff\"\na = [1, \"2\"]\n");
  CHECK_THAT(sentence([&] { (void)root.integer("x", 0, 9); }),
             Contains("x = 1.5") && Contains("E-KEY-03"));
  CHECK_THAT(sentence([&] { (void)root.integer("n", 0, 5); }), Contains("0 to 5 [E-KEY-05]"));
  CHECK_THAT(sentence([&] { (void)root.boolean("n"); }), Contains("E-KEY-03"));
  CHECK_THAT(sentence([&] { (void)root.string("t"); }),
             Contains("t = true") && Contains("E-KEY-03"));
  CHECK_THAT(sentence([&] { (void)root.string("s"); }), Contains("E-KEY-09"));
  CHECK_THAT(sentence([&] {
               (void)root.choice("m", {"soft", "hard"});
             }),
             Contains("m = \"stiff\"") && Contains("\"soft\", \"hard\" [E-KEY-06]"));
  CHECK_THAT(sentence([&] { (void)root.choice("n", {"soft"}); }), Contains("\"soft\" [E-KEY-03]"));
  CHECK_THAT(sentence([&] { (void)root.numbers("a", any_number()); }),
             Contains("bay.toml:6:9: a = \"2\"") && Contains("E-KEY-03"));
  CHECK_THAT(sentence([&] { (void)root.numbers("a", any_number(), 3, 4); }),
             Contains("2 entries") && Contains("3 to 4 [E-KEY-07]"));
  CHECK_THAT(sentence([&] { (void)root.rows("a", 2); }), Contains("rows of 2 numbers [E-KEY-11]"));
  CHECK_THAT(sentence([&] { (void)root.numbers("n", any_number()); }),
             Contains("n = 7") && Contains("E-KEY-03"));
  CHECK_THAT(sentence([&] { (void)root.table("n"); }), Contains("n = 7") && Contains("E-KEY-03"));
  CHECK_THAT(sentence([&] { (void)root.tables("a"); }), Contains("[[a]]") && Contains("E-KEY-12"));
}

TEST_CASE("getters return the value in the file or the default", "[read]") {
  const Table root = parse(
      "m = \"hard\"\nv = [1, 2.5]\nr = [[0, 1], [2, 3]]\nf = \"../a/b.toml\"\n[[load]]\nn=1\n"
      "[[load]]\nn=2\n");
  CHECK(root.choice("m", {"soft", "hard"}) == 1);
  CHECK(root.numbers("v", any_number()) == std::vector<double>{1, 2.5});
  CHECK(root.rows("r", 2) == std::vector<double>{0, 1, 2, 3});
  CHECK(root.number("absent", above(0), 3.0) == 3.0);
  CHECK(root.integer("absent", 0, 9, 4) == 4);
  CHECK(root.boolean("absent", true));
  CHECK(root.string("absent", "x") == "x");
  CHECK(root.choice("absent", {"soft", "hard"}, 1) == 1);
  CHECK_FALSE(root.table_if("absent"));
  const auto loads = root.tables("load");
  REQUIRE(loads.size() == 2);
  CHECK(loads[1].integer("n", 0, 9) == 2);
  CHECK(loads[1].name() == "load[1]");
  const Table elsewhere = read_toml_text("f = \"../a/b.toml\"", "config/scenes/bay.toml");
  CHECK(elsewhere.path("f") == std::filesystem::path("config/a/b.toml"));
}

TEST_CASE("an unknown key is refused with the nearest known one, in any opened table", "[read]") {
  const Table root = parse("[support]\nstifness = 3e7\n[[load]]\nname = \"a\"\nforce_z = 1\n");
  const Table support = root.table("support");
  CHECK(support.number("stiffness_z_n_per_m", at_least(0), 0.0) == 0.0);
  CHECK(support.number("at", at_least(0), 0.0) == 0.0);
  CHECK(support.number("damping_z_n_s_per_m", at_least(0), 0.0) == 0.0);
  const auto loads = root.tables("load");
  (void)loads[0].string("name");
  (void)loads[0].number("force_z_n", any_number(), 0.0);
  CHECK(sentence([&] { root.finish(); }) ==
        "bay.toml:2:1: [support] unknown key 'stifness'; did you mean 'stiffness_z_n_per_m'? "
        "[E-KEY-02] (and 1 more error)");
  const Table only = parse("[support]\nstifness = 3e7\n");
  (void)only.table("support").number("stiffness_z_n_per_m", at_least(0), 0.0);
  (void)only.table("support").number("at", at_least(0), 0.0);
  CHECK(sentence([&] { only.finish(); }) ==
        "bay.toml:2:1: [support] unknown key 'stifness'; did you mean 'stiffness_z_n_per_m'? "
        "[E-KEY-02]");
  CHECK_THAT(parse_sentence("a = 1"),
             Contains("bay.toml:1:1: ") && Contains("'a'") && Contains("E-KEY-02"));
  CHECK(parse_sentence("a = 1\nb = 2\n[c]\n") ==
        "bay.toml:1:1: unknown key 'a'; expected no key here [E-KEY-02] (and 2 more errors)");
}

TEST_CASE("a missing key is named, with a misspelt one if there is one", "[read]") {
  const Table root = parse("[step]\ndt = 0.001\n\n[rail]\nx = 1\n");
  CHECK(sentence([&] { (void)root.table("step").number("dt_s", above(0)); }) ==
        "bay.toml:2:1: [step] key 'dt_s' is missing; did you mean it by 'dt'? [E-KEY-01]");
  CHECK_THAT(
      sentence([&] { (void)root.table("rail").number("poisson", above(0)); }),
      Contains("bay.toml:4:1: [rail] key 'poisson' is missing; it has no default [E-KEY-01]"));
}

TEST_CASE("the search for the nearest key counts edits and forgives a missing end", "[read]") {
  CHECK(nearest("stifness", {"at", "half_spread_m", "stiffness_z_n_per_m"}) ==
        "stiffness_z_n_per_m");
  CHECK(nearest("posson", {"profile", "poisson", "young_pa"}) == "poisson");
  CHECK(nearest("x", {}).empty());
}

TEST_CASE("a text that is not one TOML document is refused with line and column", "[read]") {
  CHECK_THAT(parse_sentence("a = 1\na = 2\n"), Contains("bay.toml:2:"));           // row 12
  CHECK_THAT(parse_sentence("a = 9223372036854775808"), Contains("bay.toml:1:"));  // row 24, 2^63
  CHECK_THAT(parse_sentence(std::string("a = 1\nb\0c = 2\n", 14)),
             Contains("bay.toml:2:2: ") && Contains("E-FILE-08"));
  CHECK_THAT(parse_sentence("a = \"\xff\xfe\""), Contains("bay.toml:1:"));
  CHECK(parse_sentence("a = tr\n").find('\n') == std::string::npos);  // one sentence, one line
  CHECK(parse_sentence("\"a\\nb\" = 1\n").find('\n') == std::string::npos);
  CHECK_THAT(parse_sentence("a = 1,5\n"), Contains("bay.toml:1:"));  // decimal comma
  const Table marked = parse(
      "\xef\xbb\xbf"
      "a = 1\r\nb = 2\r\n");
  CHECK(marked.integer("a", 0, 9) + marked.integer("b", 0, 9) == 3);
  CHECK_NOTHROW(marked.finish());
}

TEST_CASE("deep nesting is refused without running out of stack, but not brackets in strings",
          "[read]") {
  const std::string deep(100'000, '[');  // row 25
  CHECK_THAT(parse_sentence("a = " + deep), Contains("bay.toml:1:37: ") && Contains("E-FILE-02"));
  std::string dotted = "[a";
  for (int i = 0; i < 100'000; ++i) dotted += ".a";
  CHECK_THAT(parse_sentence(dotted + "]\n"), Contains("E-FILE-02"));
  std::string quoted;
  for (int i = 0; i < 100'000; ++i) quoted += "\"=\".";
  CHECK_THAT(parse_sentence(quoted + "a = 1\n"), Contains("E-FILE-02"));
  const Table text = parse("a = \"" + deep + "\"\nb = '" + std::string(100, '.') +
                           "'\nc = \"\"\"\n" + deep + "\"\n\"\"\" # " + deep + "\n");
  CHECK(text.string("a").size() == 100'000);
  CHECK(text.string("b").size() == 100);
  CHECK(text.string("c").size() == 100'002);
}

TEST_CASE("a file that cannot be read whole is refused by name", "[read]") {
  CHECK_THAT(sentence([] { read_toml("nowhere/bay.toml"); }),
             Contains("nowhere/bay.toml: ") && Contains("E-FILE-04"));
  CHECK_THAT(sentence([] { read_toml(folder()); }), Contains("E-FILE-03"));
  CHECK_THAT(sentence([] { read_toml(file_with("empty.toml", "")); }), Contains("E-FILE-07"));
  const std::string comment = "#" + std::string(kLargestFile - 1, 'x');
  CHECK(sentence([&] { read_toml(file_with("full.toml", comment)).finish(); }) == "accepted");
  CHECK_THAT(sentence([&] { read_toml(file_with("over.toml", comment + "x")); }),
             Contains("over.toml: ") && Contains("1048576") && Contains("E-FILE-06"));
}

TEST_CASE("the option --set acts as if the key stood in the file", "[read]") {
  const std::string text =
      "[rail]\npoisson = 0.3\nv = [[1, 2], [3, 4]]\n[[load]]\nn = 1\n[[load]]\nn = 2\n";
  const Table root = parse(text, {"rail.poisson=0.25", "rail.v[1][0]=9", "load[1].n = 5",
                                  "step.dt_s=1e-3", "name=\"a=b\""});
  CHECK(root.table("rail").number("poisson", above(0)) == 0.25);
  CHECK(root.table("rail").rows("v", 2) == std::vector<double>{1, 2, 9, 4});
  CHECK(root.tables("load")[1].integer("n", 0, 9) == 5);
  CHECK(root.table("step").number("dt_s", above(0)) == 1e-3);
  CHECK(root.string("name") == "a=b");
  CHECK(sentence([&] { (void)root.table("rail").number("poisson", above(1)); }) ==
        "--set rail.poisson=0.25: [rail] poisson = 0.25 is out of range; expected above 1 "
        "[E-KEY-05]");
  const Table unknown = parse(text, {"rail.posson=0.2"});
  const Table rail = unknown.table("rail");
  (void)rail.rows("v", 2);
  (void)rail.number("poisson", above(0));
  for (const Table& load : unknown.tables("load")) (void)load.integer("n", 0, 9);
  CHECK(sentence([&] { unknown.finish(); }) ==
        "--set rail.posson=0.2: [rail] unknown key 'posson'; did you mean 'poisson'? [E-KEY-02]");
}

TEST_CASE("an option --set that cannot be applied is named in the message", "[read]") {
  const std::string text = "a = [1, 2]\n[b]\nc = 1\n";
  const auto refusal = [&](const std::string& option) {
    return sentence([&] { parse(text, {option}); });
  };
  CHECK_THAT(refusal("b.c"), Contains("--set b.c: ") && Contains("E-SET-01"));
  CHECK_THAT(refusal("b..c=1"), Contains("E-SET-01"));
  CHECK_THAT(refusal("a[x]=1"), Contains("E-SET-01"));
  CHECK_THAT(refusal("a[1=1"), Contains("E-SET-01"));
  CHECK_THAT(refusal("b.c=paper"), Contains("--set b.c=paper: 'paper'") && Contains("E-SET-02"));
  CHECK_THAT(refusal("b.c=1\nd=2"), Contains("E-SET-01"));
  CHECK_THAT(refusal("a[2]=1"),
             Contains("'a' has 2 entries") && Contains("0 to 1") && Contains("E-SET-04"));
  CHECK_THAT(refusal("b[0]=1"), Contains("'b'") && Contains("E-SET-03"));
  CHECK_THAT(refusal("z[0]=1"), Contains("'z'") && Contains("E-SET-05"));
  CHECK_THAT(refusal("b.c.d=1"), Contains("'c'") && Contains("E-SET-06"));
  CHECK_THAT(refusal("b.c=" + std::string(100'000, '[')), Contains("E-SET-02"));
}

TEST_CASE("a file is written whole or not at all", "[write]") {
  const auto own = folder() / "written";
  std::filesystem::create_directories(own);
  const auto file = own / "written.txt";
  write_file(file, "first");
  write_file(file, "second");
  CHECK(read_text(file) == "second");
  std::ptrdiff_t files = 0;  // no unfinished file is left beside it
  for (const auto& entry : std::filesystem::directory_iterator(own))
    files += entry.exists() ? 1 : 0;
  CHECK(files == 1);
  CHECK_THROWS_WITH(write_file("nowhere/a/b.txt", "x"), Contains("nowhere/a/b.txt"));
  // Linux's device that is always full stands for a full disk.
  CHECK_THROWS_WITH(write_file("/dev/full", std::string(10'000, 'x')), Contains("/dev/full"));
}
