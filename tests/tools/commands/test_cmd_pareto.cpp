// Tests of railstep pareto and tune from the command line.
#include <fmt/core.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "run/trace_compare.h"
#include "scene/scene.h"
#include "support/program.h"
#include "support/shipped.h"

using namespace railstep;
using Catch::Contains;
using nlohmann::json;

namespace {

const std::string kFew =
    " --set track.bays=8 --set step.duration_s=0.14 --models full,modal:1 --meshes 1,2 --schemes "
    "generalised-alpha:0.6,held:0.6 --steps 5e-4,1e-4 --reference-levels 2";

const char* const kRing = R"(
schema = 1
[track]
unknowns = "vertical"
rails = 1
length = "endless"
bays = 16
bay_m = 0.6
elements_per_bay = 2
[rail.rectangle]
height_m = 0.17
width_m = 0.045
[support]
at = "axis"
stiffness_z_n_per_m = 5e7
damping_z_n_s_per_m = 5e4
[[load]]
name = "load"
rail = "left"
start_m = 0.2
speed_m_per_s = 30.0
force_z_n = -5e4
[step]
dt_s = 1e-4
frame_s = 1e-3
duration_s = 0.03
start = "equilibrium"
[condense]
kind = "modal"
modes_per_bay = 2
)";

Ran pareto(const std::string& words) { return railstep_program("pareto " + words); }

}  // namespace

TEST_CASE("the help says which options take lists with commas", "[pareto]") {
  for (const char* command : {"pareto", "tune"}) {
    const std::string help = railstep_program(std::string(command) + " --help").out;
    for (const char* option : {"--models MODEL,MODEL", "--meshes INT,INT", "--steps FLOAT,FLOAT",
                               "--schemes SCHEME,SCHEME"})
      CHECK_THAT(help, Contains(option));
  }
}

TEST_CASE("pareto prints error and cost of every setting", "[pareto]") {
  const auto folder = fresh_folder("pareto");
  const std::string csv = (folder / "t.csv").string(), page = (folder / "t.html").string();
  const Ran ran =
      pareto(fmt::format("{}{} --json --csv {} --report {}", kMovingLoad, kFew, csv, page));
  REQUIRE(ran.code == 0);
  const json result = json::parse(ran.out);
  CHECK_THAT(result["reference"]["how"].get<std::string>(),
             Contains("4 elements a bay") && Contains("50 us") && Contains("2 levels"));
  CHECK(result["reference"]["error"].get<double>() > 0.);
  CHECK(result["reference"]["judged"] == "deflection");
  const json& rows = result["rows"];
  REQUIRE(rows.size() == 8);
  bool front = false;
  for (const json& row : rows) {
    for (const char* key : {"model", "elements_per_bay", "kept_unknowns", "scheme", "step_s",
                            "error", "frame_us_median", "flops_per_frame", "on_front"})
      CHECK(row.contains(key));
    CHECK(row["error"].get<double>() > 0.);
    CHECK(row["error"].get<double>() < .1);
    CHECK(row["frame_us_least"].get<double>() <= row["frame_us_median"].get<double>());
    CHECK(row["frame_us_most"].get<double>() >= row["frame_us_median"].get<double>());
    CHECK(row["failure"] == "");
    front = front || row["on_front"].get<bool>();
  }
  CHECK(front);
  // Half the mesh has half the unknowns, and modes have fewer. A fifth of the step costs five times
  // the flops.
  CHECK(rows[0]["kept_unknowns"].get<int>() < rows[2]["kept_unknowns"].get<int>());
  CHECK(rows[1]["flops_per_frame"].get<double>() ==
        Approx(5. * rows[0]["flops_per_frame"].get<double>()).epsilon(.1));  // and publishing
  const std::string table = text_of(csv);
  CHECK(std::count(table.begin(), table.end(), '\n') == 9);
  CHECK_THAT(table, Contains("\nfull,1,") && Contains("\nmodal:1,2,"));
  const std::string html = text_of(page);
  CHECK_THAT(html, Contains("Which to take") && Contains("Error over frequency"));
  for (const json& row : rows) {  // the table's row of each setting, and what it costs
    const std::string setting =
        fmt::format("<td>{}</td><td>{}</td><td>{}</td><td>{}</td>", row["model"].get<std::string>(),
                    row["elements_per_bay"].get<int>(), row["kept_unknowns"].get<int>(),
                    row["scheme"].get<std::string>());
    const std::size_t at =
        html.find(setting + fmt::format("<td data-v='{:.9g}'>", 1e6 * row["step_s"].get<double>()));
    REQUIRE(at != std::string::npos);
    CHECK_THAT(
        html.substr(at, html.find("</tr>", at) - at),
        Contains(fmt::format("<td data-v='{:.9g}'>", row["error"].get<double>())) &&
            Contains(fmt::format("<td data-v='{:.9g}'>", row["flops_per_frame"].get<double>())));
  }
}

TEST_CASE("pareto's error is the one that the traces show", "[pareto]") {
  const auto folder = fresh_folder("pareto_trace");
  const std::string reference = (folder / "r.csv").string(), trace = (folder / "t.csv").string();
  const std::string run = "run " + kMovingLoad + " --set track.bays=8 --set step.duration_s=0.14";
  REQUIRE(railstep_program(run + " --set track.elements_per_bay=4 --step 2e-5 --trace " + reference)
              .code == 0);
  REQUIRE(railstep_program(run + " --model condensed --step 5e-4 --trace " + trace).code == 0);
  const TraceTable a = TraceTable::read(trace), b = TraceTable::read(reference);
  REQUIRE(a.columns == b.columns);
  double worst = 0.;
  for (std::size_t c = 0; c < a.columns.size(); ++c) {
    if (!a.columns[c].ends_with(".deflection_z_m")) continue;
    double most = 0., off = 0.;
    for (std::size_t r = 0; r < a.rows(); ++r) {
      const std::size_t at = r * a.columns.size() + c;
      if (a.values[r * a.columns.size()] < .04 - 1e-9) continue;
      most = std::max(most, std::abs(b.values[at]));
      off = std::max(off, std::abs(a.values[at] - b.values[at]));
    }
    worst = std::max(worst, off / most);
  }
  const Ran ran = pareto(fmt::format(
      "{} --set track.bays=8 --set step.duration_s=0.14 --models modal:1 --meshes 1 --schemes "
      "held:0.6 --steps 5e-4 --from 0.04 --reference {} --own-error 1e-7 --json",
      kMovingLoad, reference));
  REQUIRE(ran.code == 0);
  const json result = json::parse(ran.out);
  CHECK(result["rows"][0]["error"].get<double>() == Approx(worst).epsilon(1e-9));
  CHECK(result["reference"]["error"] == 1e-7);
  CHECK_THAT(result["reference"]["how"].get<std::string>(), Contains("r.csv"));
}

TEST_CASE("pareto varies other keys, and says what they change", "[pareto]") {
  const auto folder = fresh_folder("pareto_vary");
  const std::string csv = (folder / "t.csv").string(), page = (folder / "t.html").string();
  const Ran ran = pareto(fmt::format(
      "{} --set track.bays=8 --set step.duration_s=0.14 --models modal:2 --meshes 2 --schemes "
      "held:0.6 --steps 1e-4 --reference-levels 2 --vary support.stiffness_z_n_per_m=3e7,3.1e7 "
      "--json --csv {} --report {}",
      kMovingLoad, csv, page));
  CAPTURE(ran.err);
  REQUIRE(ran.code == 0);
  const json rows = json::parse(ran.out)["rows"];
  REQUIRE(rows.size() == 2);
  CHECK(rows[0]["changes"] == json{"support.stiffness_z_n_per_m=3e7"});
  CHECK(rows[0]["error_parts"]["changes"] == 0.);  // the scene's own
  CHECK(rows[1]["error_parts"]["changes"].get<double>() > 1e-2);
  CHECK(rows[1]["error_parts"]["changes"].get<double>() < 4e-2);
  for (const json& row : rows)
    CHECK(row["error"].get<double>() <= row["error_parts"]["sum"].get<double>() * (1. + 1e-9));
  CHECK_THAT(text_of(csv), Contains(",\"support.stiffness_z_n_per_m=3.1e7\",\n"));
  CHECK_THAT(text_of(page), Contains("<td>support.stiffness_z_n_per_m=3.1e7</td>"));
}

TEST_CASE("pareto continues where it was stopped", "[pareto]") {
  const auto folder = fresh_folder("pareto_resume");
  const std::string kept = (folder / "k.jsonl").string();
  const std::string words = kMovingLoad + kFew + " --json --resume " + kept;
  const Ran first = pareto(words);
  REQUIRE(first.code == 0);
  // The file looks as if the program had been stopped in the middle of its sixth row.
  std::istringstream lines(text_of(kept));
  std::string text, line;
  for (int n = 0; n < 7 && std::getline(lines, line); ++n) text += line + "\n";
  std::ofstream(kept) << text << "{\"row\": {\"mo";
  const Ran second = pareto(words);
  REQUIRE(second.code == 0);
  const json a = json::parse(first.out), b = json::parse(second.out);
  CHECK(a["reference"] == b["reference"]);
  REQUIRE(b["rows"].size() == 8);
  for (std::size_t i = 0; i < 8; ++i) {
    CHECK(a["rows"][i]["error"] == b["rows"][i]["error"]);
    CHECK(a["rows"][i]["error_parts"] == b["rows"][i]["error_parts"]);
    if (i < 5) CHECK(a["rows"][i]["frame_us_median"] == b["rows"][i]["frame_us_median"]);
  }
  CHECK(pareto(words + " --from 0.1").code == 2);  // this is another question
}

TEST_CASE("pareto refuses in one clear message what it cannot do", "[pareto]") {
  const std::map<std::string, std::string> refused = {
      {kMovingLoad + " --models modes", "E-STUDY-12"},
      {kMovingLoad + " --models full --schemes held:0.6", "E-STUDY-05"},
      {kMovingLoad + " --steps 7e-4", "frame_s"},
      {kMovingLoad + " --steps 1e-4,x", "--steps"},
      {kMovingLoad + " --from 1", "E-STUDY-08"},
      {kMovingLoad + " --vary step.dt_s=1e-4", "E-STUDY-16"},
      {kMovingLoad + " --vary track.bay=8", "track.bay"},
      {kMovingLoad + " --resume /no/such/folder/x", "/no/such/folder/x"},
      {kScenes + "open_track.toml", "E-STUDY-07"},
      {kScenes + "double_pendulum.toml", "E-STUDY-06"},
      {kScenes + "cantilever_rail.toml", "[step]"},
      {kScenes + "none.toml", "none.toml"}};
  for (const auto& [words, text] : refused) {
    const Ran ran = pareto(words);
    CAPTURE(words, ran.err);
    CHECK(ran.code != 0);
    CHECK(ran.out.empty());
    CHECK_THAT(ran.err, Contains(text));
  }
}

TEST_CASE("tune writes a scene that meets the error and reproduces the choice", "[tune]") {
  const auto folder = fresh_folder("tune");
  const std::string out = (folder / "tuned.toml").string();
  const Ran ran = railstep_program(fmt::format(
      "tune {}ballasted_track.toml --set track.bays=24 --set step.duration_s=0.1 --models "
      "modal:1,modal:2 --meshes 2 --steps 2e-4,1e-4,5e-5 --max-error 1e-2 --json --out {}",
      kScenes, out));
  CAPTURE(ran.err);
  REQUIRE(ran.code == 0);
  const json result = json::parse(ran.out);
  CHECK(result["scene"] == out);
  CHECK(result["verified_error"].get<double>() <= 1e-2);
  CHECK(result["verified"].size() == 4);
  const json& choice = result["choice"];
  for (const char* part : {"step", "condensation", "mesh"})
    CHECK(choice["error_parts"][part].get<double>() <= 1e-2 / 3.);
  // The scene stands in another folder and refers to the same profile: it gives the same bits.
  const Ran tuned = railstep_program("run " + out + " --json"),
            asked = railstep_program(fmt::format(
                "run {}ballasted_track.toml --json --set track.bays=24 --set step.duration_s=0.1 "
                "--set 'condense.kind=\"modal\"' --set condense.modes_per_bay={} --step {}",
                kScenes, choice["model"].get<std::string>().substr(6),
                choice["step_s"].get<double>()));
  REQUIRE(tuned.code == 0);
  REQUIRE(asked.code == 0);
  if (choice["scheme"] == "held:0.6")
    CHECK(json::parse(tuned.out)["state_hash"] == json::parse(asked.out)["state_hash"]);
}

TEST_CASE("a ring too short to be a window gets a longer reference", "[pareto][tune]") {
  const auto folder = fresh_folder("ring");
  const std::string out = (folder / "tuned.toml").string(), scene = (folder / "ring.toml").string(),
                    one = " --meshes 2 --steps 1e-4";
  std::ofstream(scene) << kRing;
  for (const std::string& words :
       {fmt::format("condense {} --out {}", scene, (folder / "ring.rsm").string()),
        fmt::format("pareto {} --models modal:1{}", scene, one),
        fmt::format("tune {} --models full --max-error 1e-2 --out {}{}", scene, out, one)}) {
    const Ran ran = railstep_program(words);
    CAPTURE(words, ran.err);
    CHECK(ran.code == 0);
  }
  CHECK(read_scene(out).track.bays > 16);  // in full order the ring is a window
}

TEST_CASE("tune refuses an error or a deadline that cannot be met", "[tune]") {
  const auto folder = fresh_folder("tune_no");
  const std::string few =
      " --set track.bays=8 --set step.duration_s=0.14 --models full,modal:1 "
      "--meshes 1 --steps 1e-3 --out " +
      (folder / "t.toml").string();
  const Ran error = railstep_program("tune " + kMovingLoad + few + " --max-error 5e-4 --json");
  CHECK(error.code == 1);
  CHECK_THAT(error.err, Contains("the mesh: ") && Contains("E-STUDY-15"));
  const json told = json::parse(error.out);
  CHECK(told["choice"].is_null());
  REQUIRE(told["errors"].size() == 1);
  CHECK(told["errors"][0]["id"] == "E-STUDY-15");
  const Ran deadline =
      railstep_program("tune " + kMovingLoad + few + " --max-error 2e-2 --deadline-us 1e-3 --json");
  CHECK(deadline.code == 1);
  CHECK_THAT(deadline.err, Contains("the deadline: ") && Contains("E-STUDY-15"));
  CHECK(json::parse(deadline.out)["best"]["frame_us_median"].get<double>() > 1e-3);
  CHECK(entries(folder) == 0);
  CHECK(railstep_program("tune " + kMovingLoad + " --max-error 0").code == 2);
  CHECK(railstep_program("tune " + kMovingLoad).code == 2);
  const Ran model = railstep_program("tune " + kMovingLoad + " --max-error 1e-2 --models modes");
  CHECK(model.code == 2);
  CHECK_THAT(model.err, Contains("\"modes\"") && Contains("E-STUDY-12"));
}
