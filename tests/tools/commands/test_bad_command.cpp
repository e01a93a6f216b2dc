#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/bad_input.h"
#include "support/sanitized.h"

using namespace railstep;
using Catch::Contains;

namespace {

const std::string kProfile = std::string(RAILSTEP_SOURCE) + "/config/profiles/60e1.toml";

/// Runs the program after other words of a shell command.
Ran behind(const std::string& before, const std::string& words) {
  return run_program(RAILSTEP_PROGRAM, words, before);
}

}  // namespace

TEST_CASE("a step that is not a number, is negative or is beyond doubles is refused",
          "[bad_input][cli]") {
  const BadInput bad("step");
  const std::string run = "run " + kMovingLoad + bad.old("--trace", "t.csv");
  for (const char* step : {"abc", "1e-3x", "1,5", "' 1'", "1e400", "-1e400", "nan", "inf"})
    bad.refused(run + " --step " + step, {"--step", "finite number", "E-CLI-10"});
  for (const char* step : {"-1", "0", "1e-300", "0.2"})
    bad.refused(run + " --step " + step, {"step.dt_s=", "at least 1e-07, at most 0.1", "E-KEY-05"});
  bad.refused(run + " --step", {"--step"});
  bad.refused(run + " --step 1e-3 --step 1e-3", {"--step"});
}

TEST_CASE("every option that takes a number refuses text that is not one", "[bad_input][cli]") {
  const BadInput bad("numbers");
  const std::string hil = "hil " + kWheelset + bad.old("--report", "h.html") + " ";
  const std::string paced = hil + "--rate 100 --duration 0.1 ";
  const std::vector<std::string> ranged = {"run " + kMovingLoad + " --hash-every ",
                                           hil + "--duration 1 --rate ",
                                           hil + "--rate 100 --duration ",
                                           paced + "--grace ",
                                           paced + "--cpu ",
                                           paced + "--priority ",
                                           paced + "--stall-frame ",
                                           "modes " + kMovingLoad + " --count "};
  const std::vector<std::string> others = {
      "run " + kMovingLoad + " --duration ", "fit --target area_m2=1 --head-width-m ",
      "compare a.csv b.csv --tolerance ",
      "condense " + kMovingLoad + bad.old("--out", "x.model") + " --set track.bays="};
  const auto refuses = [&bad](const std::string& command, const std::string& value) {
    const std::string option = command.substr(command.rfind("--"));
    bad.refused(command + value, {option.substr(0, option.find_first_of(" ="))});
  };
  for (const std::string value : {"abc", "nan", "1e400"}) {
    for (const std::string& command : ranged) refuses(command, value);
    for (const std::string& command : others) refuses(command, value);
  }
  for (const std::string value : {"-7", "99999999999999999999"})
    for (const std::string& command : ranged) refuses(command, value);
}

TEST_CASE("an empty word is refused", "[bad_input][cli]") {
  const BadInput bad("empty");
  const std::string run = "run " + kMovingLoad + " --duration 0.01";
  bad.refused(run + " --step ''", {"'--step'", "E-CLI-01"});
  bad.refused(run + " --set ''", {"'--set'", "E-CLI-01"});
  bad.refused(run + " --trace ''", {"'--trace'", "E-CLI-01"});
  bad.refused(run + " --step=", {"--step= ", "E-CLI-02"});
  bad.refused("run ''", {"'run'", "E-CLI-01"});
  bad.refused(run + " --set track.bays=", {"--set track.bays=", "E-SET-02"});
  bad.refused(run + " --set =", {"--set =", "E-SET-01"});
}

TEST_CASE("unknown words are refused with the nearest known ones", "[bad_input][cli]") {
  const BadInput bad("words");
  const std::string out = bad.old("--out", "section.toml");
  bad.refused("run " + kMovingLoad + " --stepp 1e-3",
              {"'--stepp'", "'--step'", "railstep run --help", "E-CLI-12"});
  bad.refused("runn " + kMovingLoad, {"'runn'", "'run'", "E-CLI-11"});
  bad.refused("", {"subcommand is required", "railstep --help"});
  bad.refused("run", {"SCENE is required"});
  bad.refused("run " + kMovingLoad + " " + kMovingLoad, {"E-CLI-13"});
  bad.refused("run " + kMovingLoad + " --model fulll", {"--model", "fulll", "full,condensed"});
  bad.refused("fit " + kProfile + " --unit inch" + out, {"--unit", "inch", "mm"});
}

TEST_CASE("a command overwrites no file that it reads or has already written", "[bad_input][cli]") {
  const BadInput bad("same");
  const std::string scene = bad.file("scene.toml", text_of(kMovingLoad));
  const std::string run = "run " + scene + " --duration 0.01 ";
  bad.refused(run + "--trace " + scene, {"SCENE and --trace", "scene.toml", "E-CLI-06"});
  bad.refused(run + "--trace " + bad.path("../") +
                  std::filesystem::path(bad.path("")).parent_path().filename().string() +
                  "/scene.toml",
              {"SCENE and --trace", "E-CLI-06"});
  bad.refused(run + "--trace " + bad.path("x") + " --record " + bad.path("x"),
              {"--trace", "--record", "E-CLI-06"});
  bad.refused("condense " + scene + " --skip-errors --out " + scene,
              {"SCENE and --out", "E-CLI-06"});
  const std::string profile = bad.file("p.toml", text_of(kProfile));
  bad.refused("fit " + profile + " --out " + profile, {"PROFILE and --out", "E-CLI-06"});
  CHECK(railstep_program(run + "--trace /dev/null --record /dev/null").code == 0);
}

TEST_CASE("a full disk ends the program with exit code 1 and the message names the file",
          "[bad_input][cli]") {
  const BadInput bad("full");
  const std::string run = "run " + kMovingLoad + " --duration 0.05 ";
  for (const std::string option : {"--trace", "--record"})
    bad.refused(run + option + " /dev/full",
                {"/dev/full: ", "No space left on device", "E-FILE-10"}, 1);
  bad.refused("condense " + kMovingLoad + " --skip-errors --out /dev/full", {"/dev/full"}, 1);
  bad.refused("fit " + kProfile + " --out /dev/full", {"/dev/full"}, 1);
  bad.refused("fit " + kProfile + " --report /dev/full", {"/dev/full"}, 1);
  const Ran told = railstep_program(run + "--json >/dev/full");
  CHECK(told.code == 1);
  CHECK_THAT(told.err, Contains("No space left on device") && Contains("E-FILE-20"));
}

TEST_CASE("a disk that fills up while tracing leaves the old trace whole", "[bad_input][cli]") {
  const BadInput bad("fills");
  const std::string trace = bad.old("--trace", "t.csv"), record = bad.old("--record", "r.bin"),
                    model = bad.old("--out", "x.model");
  const auto before = bad.content();
  const auto fails = [&](const std::string& words, const std::string& file) {
    // 8 blocks of 512 bytes hold some 40 of 301 rows.
    const Ran ran = behind("ulimit -f 8;", words);
    CAPTURE(words, ran.err);
    CHECK(ran.code == 1);
    CHECK_THAT(ran.err,
               Contains(file + ": ") && Contains("File too large") && Contains("E-FILE-10"));
    CHECK(std::count(ran.err.begin(), ran.err.end(), '\n') == 1);
    CHECK(bad.content() == before);
  };
  fails("run " + kMovingLoad + trace, "t.csv");
  fails("run " + kMovingLoad + " --duration 0.05" + record, "r.bin");
  fails("condense " + kMovingLoad + " --skip-errors" + model, "x.model");
}

TEST_CASE("an output path that is a folder or lies in no folder is refused before the run",
          "[bad_input][cli]") {
  const BadInput bad("places");
  std::filesystem::create_directory(bad.path("folder"));
  // The run would simulate a year, so the message has to come before its end.
  const std::string run = "run " + kMovingLoad + " --set step.duration_s=3e7 ";
  const std::vector<std::string> writers = {
      run + "--trace",
      run + "--record",
      run + "--report",
      "condense " + kMovingLoad + " --out",
      "condense " + kMovingLoad + " --out x.model --emit-c",
      "fit " + kProfile + " --out",
      "fit " + kProfile + " --report",
      "static " + kMovingLoad + " --shape",
      "hil " + kWheelset + " --rate 1 --duration 1e6 --record",
      "pareto " + kMovingLoad + " --csv",
      "hard --report"};
  for (const std::string& writer : writers) {
    const std::string option = writer.substr(writer.rfind("--"));
    bad.refused(writer + " " + bad.path("folder"), {option, "folder: ", "E-CLI-03"});
    bad.refused(writer + " " + bad.path("none/x"), {option, "none/x: ", "E-CLI-05"});
  }
}

TEST_CASE("an option that has no effect without another is refused", "[bad_input][cli]") {
  const BadInput bad("needs");
  const std::string hil = "hil " + kWheelset + " --rate 100 --duration 0.1 ";
  bad.refused("run " + kMovingLoad + " --hash-every 3", {"--hash-every requires --record"});
  bad.refused(hil + "--stall-us 100", {"--stall-us requires --stall-frame"});
  bad.refused(hil + "--stall-frame 3", {"--stall-frame requires --stall-us"});
  bad.refused(hil + "--ramp 0.2", {"--ramp requires --silence"});
  bad.refused(hil + "--grace 0.2", {"--grace 0.2", "--duration, 0.1", "E-HIL-02"});
}

#if !defined(RAILSTEP_SANITIZED)  // these take all addresses
TEST_CASE("work that does not fit into memory is refused in one sentence", "[bad_input][cli]") {
  const BadInput bad("memory");
  const auto refused = [&bad](const std::string& words, const std::string& said) {
    const auto before = bad.content();
    const Ran ran = behind("ulimit -v 200000;", words);
    CAPTURE(words, ran.err);
    CHECK(ran.code == 2);
    CHECK(ran.out.empty());
    CHECK_THAT(ran.err, Contains(said) && !Contains("bad_alloc"));
    CHECK(std::count(ran.err.begin(), ran.err.end(), '\n') == 1);
    CHECK(bad.content() == before);
  };
  const std::string input =
      " --set 'wheelset[0].force=[{direction=\"y\", input=\"push\", limit_n=1e3}]' ";
  const std::string record = bad.old("--record", "r.bin");
  refused("hil " + kWheelset + input + "--rate 1e6 --duration 900" + record,
          "keeps 900000000 numbers, which take 14400000000 bytes");
  refused("run " + kWheelset + input + "--set step.duration_s=9e5" + record, "E-RUN-06");
  refused("static " + kMovingLoad + " --set track.bays=1000 --set track.elements_per_bay=50" +
              bad.old("--shape", "s.csv"),
          "E-RUN-90");
}
#endif

TEST_CASE("a quoted word stays on one line of the message", "[bad_input][cli]") {
  const BadInput bad("lines");
  const std::string hil = "hil " + kWheelset + " --rate 100 --duration 0.1 ";
  bad.refused(hil + "--udp \"$(printf 'a\\nb')\"", {"--udp a?b: ", "E-HIL-13"});
  bad.refused(hil + "--shm \"$(printf 'a\\nb')\"", {"--shm a?b: ", "E-HIL-11"});
}

TEST_CASE("a processor that is not there is refused", "[bad_input][cli]") {
  const BadInput bad("cpu");
  const std::string hil =
      "hil " + kWheelset + " --rate 100 --duration 0.1" + bad.old("--report", "h.html");
  bad.refused(hil + " --cpu 9999", {"--cpu 9999", "E-HIL-03"});
  bad.refused(hil + " --cpu -1", {"--cpu", "-1"});
  bad.refused(hil + " --cpu 99999999999", {"--cpu", "99999999999"});
}

TEST_CASE("a run without the right to a priority warns and goes on", "[bad_input][cli]") {
  // Root has the right by a capability, which is removed here.
  std::string before = "ulimit -r 0;";
  if (geteuid() == 0) before += " setpriv --inh-caps=-sys_nice --bounding-set=-sys_nice";
  const Ran ran =
      behind(before, "hil " + kWheelset + " --rate 100 --duration 0.1 --priority 90 --json");
  CAPTURE(ran.err);
  CHECK(ran.code == 0);
  CHECK_THAT(ran.err, Contains("warning: ") && Contains("sched_fifo") && Contains("W-HIL-01"));
  const auto told = nlohmann::json::parse(ran.out);
  CHECK_THAT(told["realtime"]["sched_fifo"].get<std::string>(), Contains("refused: "));
  CHECK(told["frames"].get<int>() + told["skipped"].get<int>() == 10);
}
