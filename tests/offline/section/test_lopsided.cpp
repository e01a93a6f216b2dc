// Properties that only an outline without symmetry has, and how a fit and a scene report them.
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <vector>

#include "offline/section/saint_venant.h"
#include "online/math/pi.h"
#include "section/lopsided.h"
#include "support/profiles.h"
#include "support/program.h"
#include "support/random_outlines.h"

using namespace railstep;
using Catch::Contains;
using Catch::WithinAbs;
using Catch::WithinRel;
using nlohmann::json;
namespace fs = std::filesystem;

namespace {

std::vector<Point> turned(std::vector<Point> points, double angle) {
  for (Point& p : points)
    p = {p[0] * std::cos(angle) - p[1] * std::sin(angle),
         p[0] * std::sin(angle) + p[1] * std::cos(angle)};
  return points;
}

std::vector<Point> rectangle_points(double width, double height) {
  return {{-width / 2, -height / 2},
          {width / 2, -height / 2},
          {width / 2, height / 2},
          {-width / 2, height / 2}};
}

/// Writes a list of points as `fit` reads it, in mm.
fs::path written(const fs::path& folder, const std::vector<Point>& points) {
  fs::path file = folder / "outline.csv";
  std::ofstream out(file);
  out.precision(12);
  for (const Point& p : points) out << 1e3 * p[0] << ' ' << 1e3 * p[1] << '\n';
  return file;
}

Ran fit(const fs::path& file, const std::string& more) {
  return railstep_program("fit " + file.string() + " --unit mm " + more);
}

/// 60E1 with everything above the middle of its web moved to the right.
std::vector<Point> head_beside(double offset) {
  std::vector<Point> points = polygon(read_profile(profile_file("60e1")).outline, 1e-6);
  for (Point& p : points)
    if (p[1] > .076) p[0] += offset;
  return points;
}

}  // namespace

TEST_CASE("a section has the same torsion when it is rotated by any angle", "[saint_venant]") {
  const double w = .05, h = .1;
  const SaintVenant upright = saint_venant({{-w / 2, 0}, {w / 2, 0}, {w / 2, h}, {-w / 2, h}}, 0.3);
  for (const double angle : {0., .3, kPi / 4, 2.}) {
    const Twist found = twist(turned(rectangle_points(w, h), angle));
    CHECK_THAT(found.torsion, WithinRel(upright.torsion, 1e-4));  // the gap of the bounds
    CHECK_THAT(found.shear_centre_y, WithinAbs(0., 1e-4 * w));
    const double low = h / 2 * std::abs(std::cos(angle)) + w / 2 * std::abs(std::sin(angle));
    CHECK_THAT(found.shear_centre_height, WithinAbs(low, 1e-4 * w));
  }
}

TEST_CASE("a half disc that lies on its side has its shear centre beside its centroid",
          "[saint_venant]") {
  // Timoshenko and Goodier, semicircular bar, at nu = 0, which is Trefftz's: 8/(5 pi) r from the
  // flat side, which is at y = 0 here. 400 chords leave out 1e-5 of the area.
  const double r = .1;
  std::vector<Point> half;
  for (int i = 0; i <= 400; ++i) {
    const double angle = kPi * (i / 400. - .5);
    half.push_back({r * std::cos(angle), r * std::sin(angle)});
  }
  const Twist found = twist(half);
  CHECK_THAT(found.torsion, WithinRel((kPi / 2 - 4 / kPi) * std::pow(r, 4), 2e-4));
  CHECK_THAT(found.shear_centre_y, WithinRel(8 / (5 * kPi) * r, 2e-4));
  CHECK_THAT(found.shear_centre_height, WithinAbs(r, 1e-4 * r));
}

TEST_CASE("a thin angle has its shear centre where its legs meet", "[saint_venant]") {
  const double b = .1, t = .002;
  const Twist found = twist({{0, 0}, {b, 0}, {b, t}, {t, t}, {t, b}, {0, b}});
  // The shear flow of each leg runs along its middle, through t/2, t/2; its thickness blurs that.
  CHECK_THAT(found.shear_centre_y, WithinAbs(t / 2, t / 2));
  CHECK_THAT(found.shear_centre_height, WithinAbs(t / 2, t / 2));
  // Each leg has 1/3 b t3; open ends take and the corner adds some t4 each.
  CHECK_THAT(found.torsion, WithinAbs(2. / 3. * b * t * t * t, 1.5 * std::pow(t, 4)));
}

TEST_CASE("products of inertia and principal axes are those of the textbook", "[outline]") {
  const double w = .04, h = .1, I = w * h * (h * h - w * w) / 12;
  for (const double angle : {-.7, -.2, .1, .6}) {
    const Outline outline = RandomOutlines::of_points(turned(rectangle_points(w, h), angle));
    const double product = product_of_inertia(outline);
    CHECK_THAT(product, WithinAbs(-I * std::sin(2 * angle) / 2, 1e-13 * I));
    CHECK_THAT(principal_angle(properties(outline), product), WithinAbs(angle, 1e-12));
  }
  // A quarter of a disc has r4 (1/8 - 4/(9 pi)).
  const double r = .05;
  const OutlineRow quarter[] = {{{0, 0}, 0, 1}, {{r, 0}, 0, 2}, {{0, r}, r, 3}};
  CHECK_THAT(product_of_inertia(point_outline(quarter)),
             WithinRel(std::pow(r, 4) * (1. / 8 - 4 / (9 * kPi)), 1e-12));
  CHECK(principal_angle({1, 1, 2, 1}, 0.) == 0.);
}

TEST_CASE("the fit of a grooved rail prints what its section leaves out", "[cli][fit]") {
  const fs::path folder = fresh_folder("grooved");
  const fs::path file = written(folder, polygon(RandomOutlines::grooved(0.), 1e-6));
  const std::string section = (folder / "section.toml").string();
  const std::string page = (folder / "page.html").string();
  const Ran ran = fit(file, "--json --out " + section + " --report " + page);
  REQUIRE(ran.code == 0);
  CHECK_THAT(ran.err, Contains("W-SECTION-01") && Contains("Iyz/Iz = ") &&
                          Contains("beside the shear centre") && Contains("W-FIT-01"));
  const json all = json::parse(ran.out);
  CHECK(all["warnings"].size() >= 2);
  CHECK(all["outline"]["torsion_m4"] > 0.);
  CHECK(all["outline"]["shear_centre_height_m"] > 0.);
  CHECK(all["outline"]["shear_factor_y"].is_null());
  const json& own = all["asymmetry"];
  // Green's theorem over its corners gives this.
  CHECK_THAT(own["product_of_inertia_m4"].get<double>(),
             WithinRel(product_of_inertia(RandomOutlines::grooved(0.)), 1e-9));
  for (const char* key :
       {"share_of_area", "principal_angle_rad", "centroid_offset_m", "shear_centre_offset_m"})
    CHECK(std::abs(own[key].get<double>()) > 0.);
  CHECK_THAT(text_of(page), Contains("Warning: the outline is lopsided") && Contains("Iyz"));
  CHECK_THAT(fit(file, "").out, Contains("Iyz, 1e6 mm4") && Contains("principal axis, degrees"));
  // A scene with that section warns too, but not with the section of a symmetric rail.
  const std::string scene = std::string(RAILSTEP_SOURCE) + "/config/scenes/free_rail.toml";
  const auto modes = [&scene](const std::string& with) {
    return railstep_program("modes " + scene + " --count 1 --set 'rail={section=\"" + with +
                            "\",young_pa=2.1e11,density_kg_per_m3=7850}'");
  };
  const Ran told = modes(section);
  CHECK(told.code == 0);
  CHECK_THAT(told.err, Contains("section.toml") && Contains("W-SECTION-01"));
  REQUIRE(railstep_program("fit " + profile_file("60e1").string() + " --out " + section).code == 0);
  CHECK(modes(section).err.empty());
  fs::remove_all(folder);
}

TEST_CASE("a rail within the asymmetry of its standard gives no warning", "[cli][fit]") {
  const fs::path folder = fresh_folder("lopsided");
  const Ran ran = fit(written(folder, head_beside(1.2e-3)), "--json");
  REQUIRE(ran.code == 0);
  CHECK(ran.err.empty());
  const json all = json::parse(ran.out);
  CHECK(all["warnings"].empty());
  CHECK(all["asymmetry"]["centroid_offset_m"] > .4e-3);
  CHECK(all["outline"]["shear_factor_y"] > .3);
  CHECK_THAT(fit(written(folder, head_beside(10e-3)), "").err, Contains("W-SECTION-01"));
  fs::remove_all(folder);
}

TEST_CASE("a refused fit prints its outline all the same", "[cli][fit]") {
  const fs::path folder = fresh_folder("refused");
  const double r = .04;
  const fs::path file = written(folder, polygon(RandomOutlines::circle(r), 1e-7));
  const std::string kept = " --out " + (folder / "section.toml").string();
  const Ran ran = fit(file, "--json" + kept);
  CHECK(ran.code == 1);
  CHECK_THAT(ran.err, Contains("error: ") && Contains("outline.csv: ") && Contains("E-FIT-14"));
  const json all = json::parse(ran.out);
  CHECK(all["section"].is_null());
  CHECK_THAT(all["outline"]["area_m2"].get<double>(), WithinRel(kPi * r * r, 1e-5));
  // Chords up to 1e-5 m inside the circle take 2/3 of that over r/2 from the area, twice as much
  // from J.
  CHECK_THAT(all["outline"]["torsion_m4"].get<double>(), WithinRel(kPi / 2 * std::pow(r, 4), 7e-4));
  CHECK(all["refusal"]["id"] == "E-FIT-14");
  CHECK(!fs::exists(folder / "section.toml"));
  CHECK_THAT(fit(file, "").out, Contains("area, mm2") && !Contains("section"));
  fs::remove_all(folder);
}
