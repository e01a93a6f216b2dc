#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/bad_input.h"

using namespace railstep;

namespace {

const std::string kHead = "time_s,w.z_m\n";

void compare_refuses(const std::string& a, const std::string& b,
                     const std::vector<std::string>& said) {
  const BadInput bad("traces");
  const std::string words = "compare " + bad.file("a.csv", a) + " " + bad.file("b.csv", b);
  bad.refused(words, said);
  bad.refused(words + " --json --tolerance 1e300", said);
}

/// JSON of compare for two accepted traces, with this exit code.
nlohmann::json compared(const std::string& a, const std::string& b, int code,
                        const std::string& words = "") {
  const BadInput files("compared");
  const Ran ran = railstep_program("compare --json " + files.file("a.csv", a) + " " +
                                   files.file("b.csv", b) + words);
  CAPTURE(a, b, ran.err);
  CHECK(ran.code == code);
  CHECK(ran.err.empty());
  return nlohmann::json::parse(ran.out);
}

}  // namespace

TEST_CASE("traces with different columns are refused", "[bad_input][cli]") {
  compare_refuses(kHead + "0,1\n", "time_s,w.y_m\n0,1\n",
                  {"column 1 is w.z_m in", "a.csv", "w.y_m in", "b.csv", "E-TRACE-05"});
  compare_refuses(kHead + "0,1\n", "time_s\n0\n",
                  {"a.csv has 2 columns", "b.csv has 1", "E-TRACE-04"});
  compare_refuses("w.z_m,time_s\n1,0\n", kHead + "0,1\n", {"column 0 is w.z_m in"});
}

TEST_CASE("traces with different rows are refused", "[bad_input][cli]") {
  compare_refuses(kHead + "0,1\n1,2\n2,3\n", kHead + "0,1\n1,2\n",
                  {"a.csv has 3 rows", "b.csv has 2", "E-TRACE-02"});
  compare_refuses(kHead + "0,1\n", kHead + "0,1\n1,2\n", {"a.csv has 1 rows", "b.csv has 2"});
  compare_refuses(kHead + "0\n", kHead + "0,1\n", {"a.csv:2: ", "1 values", "E-CSV-04"});
  compare_refuses(kHead + "0,1,2\n", kHead + "0,1\n", {"a.csv:2: ", "3 values", "E-CSV-04"});
}

TEST_CASE("traces with different steps are refused", "[bad_input][cli]") {
  compare_refuses(kHead + "0,1\n0.001,2\n0.002,3\n", kHead + "0,1\n0.002,2\n0.004,3\n",
                  {"a.csv has a row each 0.001 s", "b.csv each 0.002 s", "E-TRACE-01"});
  compare_refuses(kHead + "0,1\n0.001,2\n0.002,3\n", kHead + "0,1\n0.002,2\n", {"E-TRACE-01"});
  compared(kHead + "0,1\n0.001,2\n", kHead + "0,1\n0.0010000000000000002,2\n", 1);
}

TEST_CASE("empty traces and other files are refused", "[bad_input][cli]") {
  const std::string good = kHead + "0,1\n";
  compare_refuses("", good, {"a.csv: ", "E-FILE-07"});
  compare_refuses(good, "", {"b.csv: ", "E-FILE-07"});
  compare_refuses("\n\n", good, {"a.csv: ", "railstep run --trace", "E-TRACE-03"});
  compare_refuses(kHead, kHead, {"a.csv: ", "E-CSV-05"});
  compare_refuses(good, kHead, {"b.csv: ", "E-CSV-05"});
  compare_refuses("0,1\n", "0,1\n", {"a.csv: ", "E-TRACE-03"});
  compare_refuses(kHead + "0,x\n", good, {"a.csv:2: 'x'", "E-CSV-02"});
  const BadInput bad("none");
  const std::string file = bad.file("a.csv", good);
  std::filesystem::create_directory(bad.path("folder"));
  bad.refused("compare " + file + " " + bad.path("none.csv"), {"none.csv: ", "E-FILE-04"});
  bad.refused("compare " + bad.path("folder") + " " + file, {"folder: ", "E-FILE-03"});
}

TEST_CASE("NaN equals only NaN of the same bits", "[bad_input][cli]") {
  const std::string nan = kHead + "0,nan\n", minus = kHead + "0,-nan\n", one = kHead + "0,1\n";
  CHECK(compared(nan, nan, 0)["identical"] == true);
  CHECK(compared(minus, minus, 0)["identical"] == true);
  for (const auto& [a, b] :
       {std::pair(nan, minus), std::pair(minus, nan), std::pair(nan, one), std::pair(one, nan)}) {
    const auto told = compared(a, b, 1, " --tolerance 1");
    CHECK(told["identical"] == false);
    CHECK(told["first_difference"]["row"] == 0);
    CHECK(told["first_difference"]["column"] == "w.z_m");
    CHECK(told["max_relative_difference"].is_null());
  }
}

TEST_CASE("the first difference is named", "[bad_input][cli]") {
  const std::string a = "time_s,w.z_m,w.y_m\n0,4,1\n1,-8,1\n2,1,1\n";
  const auto told = compared(a, replaced(a, "-8,1\n2,1", "-8,1.5\n2,2"), 1);
  CHECK(told["first_difference"]["row"] == 1);
  CHECK(told["first_difference"]["column"] == "w.y_m");
  CHECK(told["first_difference"]["a"] == 1.);
  CHECK(told["first_difference"]["b"] == 1.5);
  CHECK(compared(a, replaced(a, "1,-8", "1,-8.0000000000000018"), 1)["first_difference"]["row"] ==
        1);
  compared(a, replaced(a, "0,4", "-0,4"), 1);
  compared(a, a, 0);
}
