// The suite of hard cases by its own command: what it runs, prints and refuses. The cases
// themselves are tests of their own, `ctest -L hard`.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "hard/hard_report.h"
#include "support/program.h"

using namespace railstep;
using Catch::Contains;

namespace {

const std::filesystem::path kHardScenes = RAILSTEP_SOURCE "/config/hard";
const std::string kFolder = " --scenes '" + kHardScenes.string() + "' ";

}  // namespace

TEST_CASE("every hard case has its scene and every scene its case", "[hard]") {
  std::set<std::string> scenes, told;
  for (const auto& file : std::filesystem::directory_iterator(kHardScenes))
    if (file.is_regular_file()) scenes.insert(file.path().stem().string().substr(0, 3));
  int last = 0;
  for (const HardCase& own : hard_cases()) {
    const std::string scene = own.scene;
    const int number = std::atoi(own.id + 1);
    CAPTURE(own.id);
    CHECK(own.id[0] == 'H');
    CHECK(number == last + 1);  // H1 to the last, each once
    last = number;
    CHECK(std::stoi(scene.substr(1)) == number);
    CHECK(std::filesystem::exists(kHardScenes / (scene + ".toml")));
    CHECK_FALSE(std::string(own.title).empty());
    CHECK_FALSE(std::string(own.why).empty());
    CHECK_FALSE(std::string(own.source).empty());
    told.insert(scene.substr(0, 3));
  }
  CHECK(last >= 46);  // 36 from the list and ten or more besides
  CHECK(scenes == told);
}

TEST_CASE("a check passes at its bound and fails above it or without a figure", "[hard]") {
  CHECK(HardCheck{"error", 1e-3, 1e-3}.passed());
  CHECK_FALSE(HardCheck{"error", 1.001e-3, 1e-3}.passed());
  CHECK_FALSE(HardCheck{"error", std::nan(""), 1e-3}.passed());
  CHECK(off_by("force", 101., 100., .02).figure == Approx(.01));
  CHECK(apart_by("time", 3., 5., 1.).figure == 2.);
  CHECK(holds("finite", true).passed());
  CHECK_FALSE(holds("finite", false).passed());
  const HardResult result{{{"near", .9, 1.}, {"far", 1e-3, 1.}, {"over", 2., 1.}}, {}, 0.};
  CHECK(tightest(result).what == "over");
  CHECK_FALSE(HardOutcome{hard_cases().front(), result}.passed());
}

TEST_CASE("`hard` prints cases in JSON and draws them on a page", "[hard][cli]") {
  const std::filesystem::path folder = fresh_folder("hard");
  const std::string page = (folder / "hard.html").string();
  const Ran ran = railstep_program("hard --case H1 --case H34 --json --report " + page + kFolder);
  CAPTURE(ran.err);
  REQUIRE(ran.code == 0);
  const auto cases = nlohmann::json::parse(ran.out)["cases"];
  REQUIRE(cases.size() == 2);
  CHECK(cases[0]["id"] == "H1");
  CHECK(cases[0]["passed"] == true);
  CHECK(cases[0]["figure"].get<double>() <= cases[0]["bound"].get<double>());
  CHECK(cases[1]["checks"].size() > 1);
  const std::string html = text_of(page);
  CHECK_THAT(html,
             Contains("H34") && Contains("<svg") && Contains("margin") && Contains("us a frame"));
}

TEST_CASE("`hard` ends with exit code 1 if a figure exceeds its bound", "[hard][cli]") {
  // In this scene the damper is a tenth of the closed form's.
  const std::filesystem::path folder = fresh_folder("hard_over");
  std::string text = text_of(kHardScenes / "h01_stiff_damper.toml");
  text.replace(text.find("14.5e6"), 6, "1.45e6");
  std::ofstream(folder / "h01_stiff_damper.toml") << text;
  const Ran ran = railstep_program("hard --case H1 --scenes " + folder.string());
  CHECK(ran.code == 1);
  CHECK_THAT(ran.out, Contains("FAILED H1") && Contains("OVER"));
}

TEST_CASE("`hard` refuses a case or a folder that does not exist", "[hard][cli]") {
  const Ran none = railstep_program("hard --case H0" + kFolder);
  CHECK(none.code == 2);
  CHECK_THAT(none.err, Contains("--case H0") && Contains("E-HARD-01"));
  const Ran lost = railstep_program("hard --case H1 --scenes nowhere");
  CHECK(lost.code == 2);
  CHECK_THAT(lost.err, Contains("nowhere/h01_stiff_damper.toml") && Contains("E-FILE-04"));
}
