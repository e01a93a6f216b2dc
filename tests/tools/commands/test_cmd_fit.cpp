#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "section/profile.h"
#include "section/section_file.h"
#include "section/section_fit.h"
#include "support/bad_input.h"
#include "support/profiles.h"
#include "text/read.h"

using namespace railstep;
using Catch::Contains;
using Catch::WithinAbs;
using Catch::WithinRel;
using nlohmann::json;

namespace {

/// What `railstep fit` says with these arguments.
Ran fit(const std::string& arguments) { return railstep_program("fit " + arguments); }

/// Width and height of a path on a report, mm.
std::pair<double, double> drawn_size(const std::string& html, const std::string& path) {
  const std::string start = "class=\"" + path + "\" d=\"M";
  const std::size_t at = html.find(start);
  REQUIRE(at != std::string::npos);
  std::istringstream points(html.substr(at + start.size(), html.find('Z', at) - at - start.size()));
  double least[2] = {1e9, 1e9}, most[2] = {-1e9, -1e9};
  char comma = 0;
  for (double p[2]; points >> p[0] >> comma >> p[1];)
    for (int i = 0; i < 2; ++i) {
      least[i] = std::min(least[i], p[i]);
      most[i] = std::max(most[i], p[i]);
    }
  return {most[0] - least[0], most[1] - least[1]};
}

/// The outline of a profile as a list of points, in units of `metre`.
std::string points_of(const char* name, double metre, const char* separator, const char* newline,
                      bool backwards) {
  std::vector<Point> points = polygon(read_profile(profile_file(name)).outline, 1e-7);
  if (backwards) std::reverse(points.begin(), points.end());
  std::ostringstream text;
  text.precision(12);
  for (const Point& p : points)
    text << metre * p[0] + 5 << separator << metre * p[1] << newline;  // off the axis
  return text.str();
}

}  // namespace

TEST_CASE("fit prints one JSON object with the contract's keys", "[cli]") {
  for (const char* name : kProfiles) {
    INFO(name);
    const Ran ran = fit(profile_file(name).string() + " --json");
    REQUIRE(ran.code == 0);
    CHECK(ran.err.empty());
    const json all = json::parse(ran.out);
    for (const char* part : {"outline", "section"}) {
      CHECK(all[part].size() == 9);
      for (const char* key :
           {"area_m2", "height_m", "centroid_height_m", "inertia_y_m4", "inertia_z_m4",
            "torsion_m4", "shear_factor_y", "shear_factor_z", "shear_centre_height_m"})
        CHECK(all[part][key].get<double>() > 0.0);
    }
    const json& d = all["dimensions"];
    // Doubles are printed with all digits, so the heights add up to the section's.
    CHECK_THAT(d["foot_height_m"].get<double>() + d["web_height_m"].get<double>() +
                   d["head_height_m"].get<double>(),
               WithinAbs(all["outline"]["height_m"].get<double>(), 1e-15));
    for (const char* key : {"foot_width_m", "web_width_m", "head_width_m"})
      CHECK(d[key].get<double>() > 0.0);
    for (const char* key : {"area", "inertia_y", "inertia_z", "centroid_height"})
      CHECK(std::abs(all["relative_errors"][key].get<double>()) < 1e-9);  // the contract's bound
    CHECK(all["symmetric_difference_m2"].get<double>() > 0.0);
    CHECK(all["symmetric_difference_m2"] < 0.2 * all["outline"]["area_m2"].get<double>());
    CHECK(all["solver"].contains("iterations"));
    // The published J, where there is one (2.212e6 mm4 for 60E1, by another program: 0.5 %).
    const Published published = read_profile(profile_file(name)).published;
    if (!std::isnan(published.torsion))
      CHECK_THAT(all["outline"]["torsion_m4"].get<double>(), WithinRel(published.torsion, 5e-3));
  }
}

TEST_CASE("the outline's torsion constant agrees with finite differences", "[cli]") {
  // Torsion constants in cm4 by Prandtl finite differences on a 0.5 mm grid, stated to 1 %.
  const std::pair<const char*, double> known[] = {
      {"60e1", 221.0}, {"54e1", 189.0}, {"136re", 273}, {"115re", 186}};
  for (const auto& [name, torsion] : known) {
    const json all = json::parse(fit(profile_file(name).string() + " --json").out);
    CHECK_THAT(all["outline"]["torsion_m4"].get<double>(), WithinRel(1e-8 * torsion, 0.01));
  }
}

TEST_CASE("a list of points fits as its profile in every way of writing it", "[cli]") {
  const BadInput folder("fit");
  const json want = json::parse(fit(profile_file("60e1").string() + " --json").out);
  const std::string plain = points_of("60e1", 1e3, ",", "\n", false);
  const std::string variants[] = {
      folder.file("a.csv", plain) + " --unit mm",
      folder.file("b.csv", points_of("60e1", 1.0, " ", "\n", false)) + " --unit m",
      folder.file("c.csv", "\xEF\xBB\xBFy,z\r\n" + points_of("60e1", 1e3, "\t", "\r\n", true)) +
          " --unit mm",
      // This outline is closed: the first line stands again at the end.
      folder.file("d.csv", plain + plain.substr(0, plain.find('\n') + 1)) + " --unit mm"};
  for (const std::string& arguments : variants) {
    const Ran ran = fit(arguments + " --json");
    INFO(arguments << ran.err);
    REQUIRE(ran.code == 0);
    const json got = json::parse(ran.out);
    // Chords up to 1e-7 m off arcs of 0.3 m miss up to 2e-8 m2 of 7.7e-3 m2: 3e-6.
    CHECK_THAT(got["outline"]["area_m2"].get<double>(),
               WithinRel(want["outline"]["area_m2"].get<double>(), 3e-6));
    // The fit moves by the error times its sensitivity, at most 0.44 m, times four properties:
    // 5e-6.
    for (const auto& [key, value] : want["dimensions"].items())
      CHECK_THAT(got["dimensions"][key].get<double>(), WithinAbs(value.get<double>(), 5e-6));
    CHECK_THAT(got["outline"]["torsion_m4"].get<double>(),
               WithinRel(want["outline"]["torsion_m4"].get<double>(), 4e-4));  // its own bounds
  }
}

TEST_CASE("targets without an outline give the section of the reference table", "[cli]") {
  const Ran ran =
      fit("--target area_m2=8700e-6,inertia_y_m4=39e-6,inertia_z_m4=6e-6,centroid_height_m=0.085,"
          "height_m=0.1857375 --head-width-m 0.07461 --json");
  REQUIRE(ran.code == 0);
  const json all = json::parse(ran.out);
  CHECK_THAT(all["dimensions"]["foot_width_m"].get<double>(), WithinAbs(137.8995e-3, 5.01e-8));
  CHECK_THAT(all["section"]["torsion_m4"].get<double>(), WithinRel(2.019e-6, 3e-3));
  CHECK_THAT(all["section"]["shear_factor_z"].get<double>(), WithinAbs(.463, 1e-3));
  CHECK(all["symmetric_difference_m2"].is_null());
  CHECK(all["outline"]["torsion_m4"].is_null());
  CHECK(all["outline"]["area_m2"] == 8700e-6);
}

TEST_CASE("the written section reads back bit for bit and the page loads no other file", "[cli]") {
  const BadInput folder("fit");
  const std::string out = folder.path("section.toml");
  const std::string page = folder.path("page.html");
  const Ran ran =
      fit(profile_file("136re").string() + " --json --out " + out + " --report " + page);
  REQUIRE(ran.code == 0);
  const json all = json::parse(ran.out);
  const Table root = read_toml(out);
  for (const char* part : {"section", "outline", "dimensions", "relative_errors"}) {
    const Table table = root.table(part);
    for (const auto& [key, value] : all[part].items())
      CHECK(table.number(key, any_number()) == value.get<double>());
  }
  const Outline outline = read_profile(profile_file("136re")).outline;
  const Section section = read_section(out),
                again = fitted_section(fit_section(outline), outline.height);
  CHECK(section.area.inertia_y == all["section"]["inertia_y_m4"].get<double>());
  CHECK(section.shear.torsion == again.shear.torsion);
  CHECK(section.shear.shear_centre_height == again.shear.shear_centre_height);
  CHECK(section.height == all["section"]["height_m"].get<double>());
  const std::string html = text_of(page);
  CHECK_THAT(html, Contains("136RE, 10 in crown"));
  // The outline is 7 5/16 in by 6 in; the rectangles are as high, and as wide as the foot.
  const auto [width, height] = drawn_size(html, "outline");
  CHECK_THAT(width, WithinAbs(6. * 25.4, 2e-3));  // written to a micrometre
  CHECK_THAT(height, WithinAbs(7.3125 * 25.4, 2e-3));
  const auto [foot, all_three] = drawn_size(html, "rectangles");
  CHECK_THAT(foot, WithinAbs(1e3 * all["dimensions"]["foot_width_m"].get<double>(), 2e-3));
  CHECK_THAT(all_three, WithinAbs(1e3 * section.height, 2e-3));
  CHECK_THAT(html, !Contains("http") && !Contains("src="));
  CHECK(folder.content().size() == 2);  // no other file is left beside them
  const Ran table = fit(profile_file("136re").string());
  CHECK_THAT(table.out, Contains("outline") && Contains("head height, mm"));
}

TEST_CASE("a usage error ends with 2 and names the option", "[cli][bad_input]") {
  const std::pair<const char*, const char*> cases[] = {
      {"", "--target"},
      {"no_such_file.toml", "no_such_file.toml"},
      {"no_such_file.csv --unit inch", "unit"},
      {"--target area_m2=1", "E-FIT-09"},
      {"--target area=1 --head-width-m 0.07", "E-FIT-03"},
      {"--target area_m2=-1 --head-width-m 0.07", "E-FIT-01"},
      {"--target area_m2=8e-3 --head-width-m 0.07", "E-FIT-05"},
      {"--target area_m2=8e-3,area_m2=8e-3 --head-width-m 0.07", "E-FIT-04"},
      {"--target area_m2=8e-3 --head-width-m nan_", "--head-width-m"}};
  for (const auto& [arguments, words] : cases) {
    const Ran ran = fit(arguments);
    INFO(arguments << ": " << ran.err);
    CHECK(ran.code == 2);
    CHECK(ran.out.empty());
    CHECK_THAT(ran.err, Contains(words));
  }
}

TEST_CASE("a plain rectangle is fitted by three rectangles of the same width", "[cli]") {
  const BadInput folder("fit");
  const std::string file = folder.file("bar.csv", "0 0\n30 0\n30 20\n0 20\n");
  const Ran ran = fit(file + " --unit mm --json");
  REQUIRE(ran.code == 0);
  CHECK(ran.err.empty());
  const json all = json::parse(ran.out);
  for (const char* key : {"foot_width_m", "web_width_m", "head_width_m"})
    CHECK_THAT(all["dimensions"][key].get<double>(), WithinAbs(0.03, 1e-9));  // the fit's own 1e-9
  CHECK_THAT(all["symmetric_difference_m2"].get<double>(), WithinAbs(0.0, 1e-10));
}

TEST_CASE("an output path that cannot be written is refused and named", "[cli]") {
  const Ran ran = fit(profile_file("60e1").string() + " --out /no/such/folder/section.toml");
  CHECK(ran.code == 2);
  CHECK_THAT(ran.err, Contains("/no/such/folder/section.toml"));
}
