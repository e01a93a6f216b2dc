#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/bad_input.h"

using namespace railstep;
using Catch::WithinRel;

namespace {

using Words = std::vector<std::string>;

const std::string kMillimetres = " --unit mm";

/// Checks that `text` is refused both as a profile and as a list of points.
void fit_refuses(const std::string& name, const std::string& text, const Words& said,
                 const std::string& unit = kMillimetres) {
  const BadInput bad("profile");
  const bool points = name.find(".csv") != std::string::npos;
  Words all = said;
  all.push_back(name);
  bad.refused("fit " + bad.file(name, text) + (points ? unit : "") +
                  bad.old("--out", "section.toml") + bad.old("--report", "page.html"),
              all);
}

std::string profile(const std::string& rows) {
  return "schema = 1\nname = \"p\"\nsource = \"s\"\nhalf_outline_mm = [" + rows + "]\n";
}

/// Properties of the outline that a fit prints.
nlohmann::json fitted(const std::string& name, const std::string& text) {
  const BadInput good("fitted");
  const bool points = name.find(".csv") != std::string::npos;
  const Ran ran =
      railstep_program("fit --json " + good.file(name, text) + (points ? kMillimetres : ""));
  CAPTURE(name, ran.err);
  REQUIRE(ran.code == 0);
  return nlohmann::json::parse(ran.out)["outline"];
}

void check_same(const nlohmann::json& a, const nlohmann::json& b) {
  CHECK(a["area_m2"] > 0.);
  for (const char* key : {"area_m2", "centroid_height_m", "inertia_y_m4", "inertia_z_m4"})
    // Sums of some ten terms of one size, in another order.
    CHECK_THAT(a[key].get<double>(), WithinRel(b[key].get<double>(), 1e-12));
}

}  // namespace

TEST_CASE("an empty profile is refused", "[bad_input][cli]") {
  fit_refuses("p.toml", "", {"E-FILE-07"});
  fit_refuses("p.toml", "\n\n", {"p.toml:1:1", "'schema'", "E-KEY-01"});
  fit_refuses("p.toml", profile(""), {"p.toml:4:", "half_outline_mm"});
  fit_refuses("p.csv", "", {"E-FILE-07"});
  for (const char* nothing : {" \n\n", "# 60E1\n", "y,z\n"})
    fit_refuses("p.csv", nothing, {"E-SECTION-12", "0 points"});
}

TEST_CASE("an outline that crosses itself is refused with both segments", "[bad_input][cli]") {
  fit_refuses("p.csv", "0,0\n100,100\n100,0\n0,100\n", {"E-SECTION-10", "rows 2 and 4"});
  fit_refuses("p.toml", profile("[0,0,0],[50,0,0],[50,90,0],[20,10,0],[60,20,0],[0,100,0]"),
              {"p.toml:4:", "E-SECTION-10", "rows 3 and 5", "mm"});
  fit_refuses("p.toml", profile("[0,0,0],[50,0,0],[-10,50,0],[50,90,0],[0,100,0]"),
              {"E-SECTION-16", "row 3", "10 mm"});
}

TEST_CASE("a gap in an outline is refused with its width", "[bad_input][cli]") {
  fit_refuses("p.toml", profile("[0,0,0],[50,0,0],[50,90,0],[10,100,0]"),
              {"p.toml:4:", "E-SECTION-15", "row 4", "10 mm"});
  fit_refuses("p.toml", profile("[5,0,0],[50,0,0],[50,90,0],[0,100,0]"),
              {"E-SECTION-15", "row 1", "5 mm"});
  fit_refuses("p.csv", "0 0\n10 0\n20 0\n20 10\n20 20\n20 30\n20 40\n20 50\n",
              {"E-SECTION-18", "53.8516 mm"});
}

TEST_CASE("a clockwise outline is read, with the area of the other direction", "[bad_input][cli]") {
  check_same(fitted("p.csv", "0 0\n0 100\n50 100\n50 0\n"),
             fitted("p.csv", "0 0\n50 0\n50 100\n0 100\n"));
  check_same(fitted("p.toml", profile("[0,100,0],[40,90,0],[50,0,0],[0,0,0]")),
             fitted("p.toml", profile("[0,0,0],[50,0,0],[40,90,0],[0,100,0]")));
}

TEST_CASE("two points, and repeated points, are refused", "[bad_input][cli]") {
  fit_refuses("p.csv", "0,0\n100,100\n", {"E-SECTION-12", "2 points"});
  fit_refuses("p.toml", profile("[0,0,0],[50,0,0]"), {"p.toml:4:", "E-SECTION-12", "2 points"});
  fit_refuses("p.csv", "0,0\n100,0\n100,0\n0,100\n", {"E-SECTION-14", "rows 2 and 3"});
  fit_refuses("p.toml", profile("[0,0,0],[50,0,0],[50,90,0],[50,90,0],[0,90,0]"),
              {"p.toml:4:", "E-SECTION-14", "rows 3 and 4"});
}

TEST_CASE("an outline with a sliver is refused before its triangles take minutes",
          "[bad_input][cli]") {
  fit_refuses("p.csv", "0,0\n30,0\n0.0003,10\n0,40\n", {"E-SECTION-27", "20000", "sliver"});
}

TEST_CASE("millimetres given as metres are refused with the unit named", "[bad_input][cli]") {
  fit_refuses("p.csv", "0,0\n75,0\n75,172\n0,172\n", {"E-SECTION-21", "172 m high"}, " --unit m");
  fit_refuses("p.csv", "0,0\n75,0\n75,0.172\n0,0.172\n", {"E-SECTION-21", "75 m wide"},
              " --unit m");
  fit_refuses("p.toml", profile("[0,0,0],[75000,0,0],[75000,172000,0],[0,172000,0]"),
              {"p.toml:4:", "E-SECTION-21", "172 m high"});
  fit_refuses("p.toml", profile("[0,0,0],[1e200,0,0],[1e200,100,0],[0,100,0]"),
              {"E-SECTION-21", "2e+197 m wide"});
  const BadInput bad("unit");
  bad.refused(
      "fit --target area_m2=8700,inertia_y_m4=39e6,inertia_z_m4=6e6,centroid_height_m=85,"
      "height_m=185.7 --head-width-m 74.6" +
          bad.old("--out", "section.toml"),
      {"height_m = 185.7", "1 m", "E-FIT-06"});
  bad.refused("run " + shipped("moving_load") + " --set rail.rectangle.height_m=231.9" +
                  bad.old("--trace", "t.csv"),
              {"[rail.rectangle] height_m = 231.9", "at most 1", "millimetres", "E-KEY-05"});
}

TEST_CASE("metres given as millimetres are refused with the unit named", "[bad_input][cli]") {
  fit_refuses("p.csv", "0,0\n.075,0\n.075,.172\n0,.172\n", {"E-SECTION-22", "0.172 mm high"});
  fit_refuses("p.toml", profile("[0,0,0],[0.075,0,0],[0.075,0.172,0],[0,0.172,0]"),
              {"p.toml:4:", "E-SECTION-22", "0.172 mm high"});
}

TEST_CASE("an outline that keeps too few points once they are rounded is refused",
          "[bad_input][cli]") {
  fit_refuses("p.toml", profile("[0,0,0],[1e-3,0,0],[1e-3,100,0],[0,100,0]"), {"E-SECTION-01"});
}

TEST_CASE("NaN, infinity and numbers over the largest are refused in a profile",
          "[bad_input][cli]") {
  for (const std::string number : {"nan", "+nan", "inf", "-inf", "1e999"})
    fit_refuses("p.csv", "0,0\n" + number + ",0\n50,50\n",
                {"p.csv:2:", "'" + number + "'", "finite"});
  for (const std::string number : {"nan", "inf", "-inf"})
    fit_refuses("p.toml", profile("[0,0,0],[50,0,0],\n[" + number + ",90,0],[0,90,0]"),
                {"p.toml:5:2", "half_outline_mm = " + number, "finite"});
  fit_refuses("p.toml", profile("[0,0,0],[50,0,0],\n[1e999,90,0],[0,90,0]"), {"p.toml:5:"});
}

TEST_CASE("an arc's radius under half its chord is refused", "[bad_input][cli]") {
  for (const char* radius : {"44", "-44"})
    fit_refuses("p.toml", profile("[0,0,0],[50,0,0],[50,90," + std::string(radius) + "],[0,100,0]"),
                {"p.toml:4:", "E-SECTION-20", "row 3", "44 mm", "90 mm", "45 mm"});
  fit_refuses("p.toml", profile("[0,0,0],[50,0,0],[50,90,20000],[0,100,0]"),
              {"E-SECTION-19", "row 3", "20000 mm", "10000 mm"});
}

TEST_CASE("without a good fit the program ends with 1 and prints the errors of the closest",
          "[bad_input][cli]") {
  const BadInput bad("no_fit");
  const std::string out = bad.old("--out", "section.toml") + bad.old("--report", "page.html");
  bad.refused(
      "fit --target area_m2=8700e-6,inertia_y_m4=90e-6,inertia_z_m4=6e-6,"
      "centroid_height_m=0.085,height_m=0.1857375 --head-width-m 0.07461" +
          out,
      {"9e-05", "E-FIT-14"}, 1);
  const std::string triangle = bad.file("p.csv", "0 0\n150 0\n75 150\n");
  const auto before = bad.content();
  const Ran ran = railstep_program("fit " + triangle + kMillimetres + out);
  CHECK(ran.code == 1);
  for (const char* words : {"0.15 m high", "0.01125 m2", "E-FIT-14", "p.csv"})
    CHECK_THAT(ran.err, Catch::Contains(words));
  CHECK_THAT(ran.out, Catch::Contains("area, mm2                          11250"));
  CHECK(bad.content() == before);
}

TEST_CASE("a byte order mark and line ends of two bytes are read", "[bad_input][cli]") {
  const std::string mark = "\xEF\xBB\xBF";
  check_same(fitted("p.csv", mark + "y,z\r\n0,0\r\n50,0\r\n50,100\r\n0,100\r\n"),
             fitted("p.csv", "0,0\n50,0\n50,100\n0,100\n"));
  const std::string rows = "[0,0,0],\n[50,0,0],\n[40,90,0],\n[0,100,0]";
  std::string windows = mark + profile(rows);
  for (std::size_t at = 0; (at = windows.find('\n', at)) != std::string::npos; at += 2)
    windows.replace(at, 1, "\r\n");
  check_same(fitted("p.toml", windows), fitted("p.toml", profile(rows)));
}

TEST_CASE("a decimal comma is refused", "[bad_input][cli]") {
  fit_refuses("p.csv", "0 0\n73,5 0\n0 100\n", {"p.csv:2", "E-CSV-03"});
  fit_refuses("p.csv", "0;0\n73,5;0,5\n0;100\n", {"p.csv:2", "E-CSV-03"});
  fit_refuses("p.toml", profile("[0,0,0],\n[73,5,0,0],[0,100,0]"),
              {"p.toml:5:1", "4 entries", "E-KEY-11"});
}

TEST_CASE("a file that is not text is refused as a profile", "[bad_input][cli]") {
  const BadInput bad("no_text");
  const std::string out = bad.old("--out", "section.toml");
  std::filesystem::create_directory(bad.path("folder.toml"));
  bad.refused("fit " + bad.path("folder.toml") + out, {"folder.toml: ", "E-FILE-03"});
  bad.refused("fit " + bad.path("none.toml") + out, {"none.toml: ", "E-FILE-04"});
  bad.refused("fit /dev/zero --unit mm" + out, {"/dev/zero: ", "1 MiB", "E-FILE-06"});
  bad.refused("fit /proc/self/mem --unit mm" + out, {"/proc/self/mem: ", "E-FILE-05"});
  fit_refuses("p.csv", "0,0\n100,abc\n0,100\n", {"p.csv:2", "'abc'", "E-CSV-02"});
  fit_refuses("p.csv", "0,0\n100,0\n0,100\n", {"E-FIT-11"}, "");
  fit_refuses("p.toml", profile("[0,0,0],[50,0,0],[0,100,0]") + "sorce = 1\n",
              {"p.toml:5:1", "'sorce'", "'source'", "E-KEY-02"});
}

TEST_CASE("a scene with a bad profile names the profile", "[bad_input][cli]") {
  const BadInput bad("of_scene");
  bad.file("p.toml", profile("[0,0,0],[50,0,0],\n[50,0,0],[0,100,0]"));
  const std::string text = text_of(shipped("moving_load"));
  const std::size_t rail = text.find("[rail.rectangle]"), support = text.find("[support]");
  const std::string scene = bad.file(
      "scene.toml", text.substr(0, rail) + "[rail]\nprofile = \"p.toml\"\n" + text.substr(support));
  bad.refused("run " + scene + bad.old("--trace", "t.csv"),
              {"p.toml:4:", "E-SECTION-14", "rows 2 and 3"});
}

TEST_CASE("points, a section and a profile in each other's place are named for what they are",
          "[bad_input][cli]") {
  const BadInput bad("stands_for");
  const std::string points = bad.file("points.csv", "y,z\n0,0\n70,0\n70,10\n");
  const std::string outline = bad.file("p.toml", profile("[0, 0, 0], [70, 0, 0], [0, 150, 0]"));
  const std::string section = bad.path("section.toml");
  REQUIRE(railstep_program("fit '" RAILSTEP_SOURCE "/config/profiles/60e1.toml' --out " + section)
              .code == 0);
  const auto refused = [&](const std::string& key, const std::string& file, const Words& said) {
    bad.refused("run " + shipped("moving_load") + " --set 'rail={" + key + "=\"" + file + "\"}'" +
                    bad.old("--trace", "t.csv"),
                said);
  };
  const Words of_points = {"points.csv: ", "`railstep fit", "E-PROFILE-02"};
  refused("profile", points, of_points);
  refused("section", points, of_points);
  refused("profile", section, {"section.toml:", "E-PROFILE-03"});
  refused("section", outline, {"p.toml:", "E-SECTION-29"});
}
