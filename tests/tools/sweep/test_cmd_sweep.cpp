#include <fmt/core.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "run/trace_compare.h"
#include "support/program.h"
#include "support/shipped.h"

using namespace railstep;
using Catch::Contains;

namespace {

namespace fs = std::filesystem;

const std::string kShort = " --set step.duration_s=0.01";
const std::string kSix =
    " --vary support.stiffness_z_n_per_m=2e7,3e7,5e7 --vary 'load[0].speed_m_per_s=20,30'";

/// Cells of a line of CSV, without the quotes of RFC 4180.
std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"')
      cells.back() += line[++i];
    else if (line[i] == '"')
      quoted = !quoted;
    else if (line[i] == ',' && !quoted)
      cells.emplace_back();
    else
      cells.back() += line[i];
  }
  return cells;
}

/// Rows of a table, each by its columns.
std::vector<std::map<std::string, std::string>> table_of(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  const std::vector<std::string> names = cells_of(line);
  std::vector<std::map<std::string, std::string>> rows;
  while (std::getline(in, line)) {
    const std::vector<std::string> cells = cells_of(line);
    REQUIRE(cells.size() == names.size());
    rows.emplace_back();
    for (std::size_t i = 0; i < names.size(); ++i) rows.back()[names[i]] = cells[i];
  }
  return rows;
}

Ran sweep(const std::string& words, const fs::path& out) {
  return railstep_program("sweep " + words + " --out " + out.string());
}

std::vector<fs::path> row_files(const fs::path& out) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(out / "rows")) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

TEST_CASE("the rows of a sweep equal runs made one by one", "[sweep]") {
  const auto out = fresh_folder("sweep_rows");
  const Ran ran = sweep(kMovingLoad + kShort + kSix + " --json", out);
  CAPTURE(ran.err);
  REQUIRE(ran.code == 0);
  CHECK(ran.err.empty());
  const auto json = nlohmann::json::parse(ran.out);
  CHECK(json == nlohmann::json{{"runs", 6},
                               {"failed", 0},
                               {"table", (out / "table.csv").string()},
                               {"errors", nlohmann::json::array()},
                               {"warnings", nlohmann::json::array()}});
  const auto rows = table_of(out / "table.csv");
  REQUIRE(rows.size() == 6);
  const std::vector<std::string> stiffness = {"2e7", "3e7", "5e7"}, speed = {"20", "30"};
  for (std::size_t i = 0; i < 6; ++i) {
    const std::string &k = stiffness[i / 2], &v = speed[i % 2];
    const Ran alone =
        railstep_program(fmt::format("run {}{} --json --set load[0].speed_m_per_s={} --set "
                                     "support.stiffness_z_n_per_m={}",
                                     kMovingLoad, kShort, v, k));
    REQUIRE(alone.code == 0);
    const auto one = nlohmann::json::parse(alone.out);
    auto row = rows[i];
    CHECK(row["index"] == std::to_string(i));
    CHECK(row["support.stiffness_z_n_per_m"] == k);
    CHECK(row["load[0].speed_m_per_s"] == v);
    CHECK(row["error"].empty());
    CHECK(row["status"].empty());
    CHECK(row["steps"] == std::to_string(one["steps"].get<int>()));
    CHECK(row["state_hash"] == one["state_hash"]);
    CHECK(std::stod(row["energy_balance_error"]) == one["energy_balance_error"]);
    CHECK(std::stod(row["numerical_loss"]) == one["numerical_loss"]);
  }
}

TEST_CASE("a sweep summarises the rows of a run's trace from a chosen time on", "[sweep]") {
  const auto out = fresh_folder("sweep_summary");
  const std::string file = (out / "t.csv").string();
  REQUIRE(railstep_program("run " + kMovingLoad + kShort + " --trace " + file).code == 0);
  const TraceTable trace = TraceTable::read(file);
  for (const std::size_t first : {0u, 4u}) {
    const double from = static_cast<double>(first) * 1e-3;
    REQUIRE(
        sweep(fmt::format("{}{} --vary schema=1 --from {}", kMovingLoad, kShort, from), out).code ==
        0);
    auto row = table_of(out / "table.csv").at(0);
    for (std::size_t c = 1; c < trace.columns.size(); ++c) {
      std::vector<double> column;
      column.reserve(trace.rows());
      for (std::size_t r = first; r < trace.rows(); ++r)
        column.push_back(trace.values[r * trace.columns.size() + c]);
      double sum = 0., squares = 0.;
      for (const double x : column) sum += x;
      const auto count = static_cast<double>(column.size());
      for (const double x : column) squares += (x - sum / count) * (x - sum / count);
      const auto cell = [&](const char* of) { return std::stod(row[trace.columns[c] + of]); };
      CAPTURE(first, trace.columns[c]);
      CHECK(cell(".min") == *std::min_element(column.begin(), column.end()));
      CHECK(cell(".max") == *std::max_element(column.begin(), column.end()));
      CHECK(cell(".last") == column.back());
      // Some ten roundings of numbers no larger than those of the column.
      const double scale = std::max(std::fabs(cell(".min")), std::fabs(cell(".max")));
      CHECK_THAT(cell(".mean"), Catch::WithinAbs(sum / count, 1e-14 * scale));
      CHECK_THAT(cell(".std"), Catch::WithinAbs(std::sqrt(squares / count), 1e-14 * scale));
    }
  }
}

TEST_CASE("a sweep's table has the same bytes for any number of jobs", "[sweep]") {
  const auto one = fresh_folder("sweep_one"), four = fresh_folder("sweep_four");
  REQUIRE(sweep(kMovingLoad + kShort + kSix + " --jobs 1", one).code == 0);
  REQUIRE(sweep(kMovingLoad + kShort + kSix + " --jobs 4", four).code == 0);
  CHECK(text_of(one / "table.csv") == text_of(four / "table.csv"));
  const auto files = row_files(one);
  REQUIRE(files.size() == 6);
  for (const fs::path& file : files)
    CHECK(text_of(file) == text_of(four / "rows" / file.filename()));
  CHECK(entries(one) == 2);  // the rows and the table, no other file
}

TEST_CASE("shards made separately and merged give the whole sweep", "[sweep]") {
  const auto whole = fresh_folder("sweep_whole"), merged = fresh_folder("sweep_merged");
  REQUIRE(sweep(kMovingLoad + kShort + kSix, whole).code == 0);
  for (const int shard : {1, 2})
    REQUIRE(
        sweep(fmt::format("{}{}{} --shard {}/3", kMovingLoad, kShort, kSix, shard), merged).code ==
        0);
  CHECK(table_of(merged / "table_2_of_3.csv").at(1)["index"] == "4");

  const Ran early = sweep(kMovingLoad + kShort + kSix + " --merge", merged);
  CHECK(early.code == 2);
  CHECK_THAT(early.err,
             Contains("2 of 6 runs") && Contains("the first is run 2") && Contains("E-SWEEP-06"));
  CHECK_FALSE(fs::exists(merged / "table.csv"));

  const auto elsewhere = fresh_folder("sweep_elsewhere");  // as on another machine
  const Ran third = sweep(kMovingLoad + kShort + kSix + " --shard 3/3 --json", elsewhere);
  REQUIRE(third.code == 0);
  CHECK(nlohmann::json::parse(third.out)["runs"] == 2);
  for (const fs::path& file : row_files(elsewhere)) fs::copy(file, merged / "rows");
  REQUIRE(sweep(kMovingLoad + kShort + kSix + " --merge", merged).code == 0);
  CHECK(text_of(merged / "table.csv") == text_of(whole / "table.csv"));
}

TEST_CASE("a sweep that is started again makes only the missing runs", "[sweep]") {
  const auto out = fresh_folder("sweep_resumed");
  REQUIRE(sweep(kMovingLoad + kShort + kSix, out).code == 0);
  const std::string table = text_of(out / "table.csv");
  const auto files = row_files(out);
  const auto long_ago = fs::file_time_type::clock::now() - std::chrono::hours(24);
  for (const fs::path& file : files) fs::last_write_time(file, long_ago);
  const std::string row = text_of(files[1]);
  fs::remove(files[0]);
  std::ofstream(files[1], std::ios::trunc) << row.substr(0, row.size() / 2);  // cut short
  fs::remove(out / "table.csv");
  const Ran again = sweep(kMovingLoad + kShort + kSix, out);
  REQUIRE(again.code == 0);
  CHECK_THAT(again.out, Contains("6, of which 2 were made now"));
  CHECK(text_of(out / "table.csv") == table);
  CHECK(text_of(files[1]) == row);
  for (std::size_t i = 2; i < files.size(); ++i) CHECK(fs::last_write_time(files[i]) == long_ago);
}

TEST_CASE("a changed scene uses no rows of the old one", "[sweep]") {
  const auto out = fresh_folder("sweep_changed");
  const fs::path scene = out / "scene.toml";
  fs::copy(kMovingLoad, scene);
  const std::string words = scene.string() + kShort + " --vary 'load[0].force_z_n=-1e4,-2e4'";
  REQUIRE(sweep(words, out).code == 0);
  const std::string before = text_of(out / "table.csv");
  std::string text = text_of(scene);
  text.replace(text.find("start_m = 0.3"), 13, "start_m = 0.4");
  std::ofstream(scene, std::ios::trunc) << text;
  CHECK(sweep(words + " --merge", out).code == 2);
  REQUIRE(sweep(words, out).code == 0);
  CHECK(row_files(out).size() == 4);
  CHECK(text_of(out / "table.csv") != before);
}

TEST_CASE("a run that fails has its reason in the table and the sweep goes on", "[sweep]") {
  const auto out = fresh_folder("sweep_failed");
  const Ran ran =
      sweep(kMovingLoad + kShort +
                " --vary rail.axial_force_n=0,-1e9 --vary output.supports=false,true --json",
            out);
  CHECK(ran.code == 1);
  CHECK_THAT(ran.err, Contains("2 of 4 runs") && Contains("run 2 (rail.axial_force_n=-1e9") &&
                          Contains("E-SWEEP-16"));
  const auto told = nlohmann::json::parse(ran.out);
  CHECK(told["failed"] == 2);
  REQUIRE(told["errors"].size() == 1);
  CHECK(told["errors"][0]["id"] == "E-SWEEP-16");
  auto rows = table_of(out / "table.csv");
  REQUIRE(rows.size() == 4);
  CHECK_THAT(rows[2]["error"], Contains("buckle") && Catch::StartsWith("moving_load.toml"));
  CHECK(rows[2]["state_hash"].empty());
  CHECK(rows[1]["error"].empty());
  // Only some runs have these columns.
  CHECK(rows[0]["support_0.force_z_n.max"].empty());
  CHECK_FALSE(rows[1]["support_0.force_z_n.max"].empty());
  CHECK_FALSE(rows[0]["load_left.deflection_z_m.min"].empty());
  // A failure is a result: the run is not made again.
  const Ran again = sweep(
      kMovingLoad + kShort + " --vary rail.axial_force_n=0,-1e9 --vary output.supports=false,true",
      out);
  CHECK(again.code == 1);
  CHECK_THAT(again.out, Contains("of which 0 were made now"));
}

TEST_CASE("values with commas stand in the table as they were written", "[sweep]") {
  const auto out = fresh_folder("sweep_quoted");
  const Ran ran =
      sweep(kMovingLoad + kShort + R"( --vary 'track.ends=["pinned", "free"],"free"')", out);
  CAPTURE(ran.err);
  REQUIRE(ran.code == 0);
  auto rows = table_of(out / "table.csv");
  REQUIRE(rows.size() == 2);
  CHECK(rows[0]["track.ends"] == R"(["pinned", "free"])");
  CHECK(rows[1]["track.ends"] == R"("free")");
  CHECK(rows[0]["state_hash"] != rows[1]["state_hash"]);
}

TEST_CASE("a sweep refuses bad options with exit code 2, one sentence and no files", "[sweep]") {
  struct Case {
    std::string words, said;
  };
  const std::string vary = " --vary track.bays=16,17";
  const std::vector<Case> cases = {
      {" --vary track.bay=16,17", "--vary track.bay=16"},
      {" --vary track.bays=16,0", "--vary track.bays=0: [track] bays = 0"},
      {vary + " --vary step.dt_s=25e-6,x", "--vary step.dt_s=x: 'x'"},
      {" --vary step.dt_s=25e-6,26e-6", "(run 1: step.dt_s=26e-6)"},
      {" --vary track.bays=", "value 1 is empty"},
      {" --vary track.bays=16,,17", "value 2 is empty"},
      {" --vary track.bays=16,16", "E-SWEEP-09"},
      {" --vary track.bays", "E-SWEEP-07"},
      {" --vary =1,2", "E-SWEEP-07"},
      {" --vary 'track.ends=[1,2'", "E-SET-02"},
      {vary + " --vary track.bays=18", "this changes track.bays"},
      {vary + " --set track.bays=18", "this changes track.bays"},
      {vary + " --vary track={}", "this changes track.bays"},
      {vary + " --shard=-1/2", "E-SWEEP-12"},
      {vary + " --shard 3/2", "E-SWEEP-12"},
      {vary + " --shard 0/0", "E-SWEEP-12"},
      {vary + " --shard 1", "E-SWEEP-12"},
      {vary + " --shard 1/2/3", "E-SWEEP-12"},
      {vary + " --from 0.4", "E-SWEEP-03"},
      {vary + " --merge", "E-SWEEP-06"},
  };
  for (const auto& c : cases) {
    const auto out = fresh_folder("sweep_bad") / "out";
    const Ran ran = sweep(kMovingLoad + c.words, out);
    CAPTURE(c.words, ran.err);
    CHECK(ran.code == 2);
    CHECK_THAT(ran.err, Contains(c.said));
    CHECK(std::count(ran.err.begin(), ran.err.end(), '\n') == 1);
    CHECK(ran.out.empty());
    CHECK_FALSE(fs::exists(out));
  }
  const auto out = fresh_folder("sweep_bad");
  CHECK(sweep(kMovingLoad, out).code == 2);  // there is nothing to vary
  CHECK(sweep(kMovingLoad + vary + " --merge --shard 1/2", out).code == 2);
  CHECK(sweep(kMovingLoad + vary + " --jobs 0", out).code == 2);
  CHECK(railstep_program("sweep " + kMovingLoad + vary).code == 2);  // there is no place to write
  const Ran none = sweep((out / "no_such.toml").string() + vary, out);
  CHECK(none.code == 2);
  CHECK_THAT(none.err, Contains("no_such.toml"));
  std::ofstream(out / "file") << "text";
  const Ran file = sweep(kMovingLoad + vary, out / "file");
  CHECK(file.code == 2);
  CHECK_THAT(file.err, Contains("E-SWEEP-13"));
  std::string thousand = "0";
  for (int i = 1; i < 1001; ++i) thousand.append(",").append(std::to_string(i));
  const Ran many = sweep(kMovingLoad + " --vary a=" + thousand + " --vary b=" + thousand, out);
  CHECK(many.code == 2);
  CHECK_THAT(many.err, Contains("1002001 runs") && Contains("E-SWEEP-11"));
}
