#include <algorithm>
#include <cmath>
#include <sstream>

#include "support/rules_rows.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using nlohmann::json;

TEST_CASE("without the split of torsion a bar is 23 times too stiff, with shear factors 11 times",
          "[rules]") {
  const double J = study_section(0).torsion;
  const auto stiffness = [&](const std::string& rule, int elements) {
    const json r = row(rows_of("shear"), rule, .3, elements, "tip node");
    return 1. / (1. + r["twist_error"].get<double>());
  };
  // In layers at both ends, as long as the section's radius sqrt(Iy/A) = 7 cm, y and z slopes turn
  // by different angles; the layers are up to 3 % of 2 m.
  for (const int elements : {1, 4, 16}) {
    CHECK_THAT(stiffness("neither factors nor split", elements),
               WithinRel((kInertiaY + kInertiaZ) / J, .03));
    CHECK_THAT(stiffness("torsion not split", elements),
               WithinRel((.4721 * kInertiaZ + .4796 * kInertiaY) / J, .03));
    CHECK_THAT(stiffness("default", elements), WithinRel(1., kRoundOff));
  }
}

TEST_CASE("one point per rectangle loses its own inertia, two are exact in small bending",
          "[rules]") {
  const auto& parts = study::kRectangles;
  double inertia = 0., bottom = -study::kCentroidHeight;
  for (std::size_t i = 0; i < 3; ++i) {
    const double middle = bottom + parts.height[i] / 2.;
    inertia += parts.width[i] * parts.height[i] * middle * middle;
    bottom += parts.height[i];
  }
  const Material m;
  const double expected = timoshenko(m, m.young * inertia, kShearZ, study::kLength) /
                              timoshenko(m, m.young * kInertiaY, kShearZ, study::kLength) -
                          1.;
  const json& rows = rows_of("section");
  for (const int elements : {1, 16}) {
    const json one = row(rows, "1x1 per rectangle", .3, elements, "tip node");
    CHECK_THAT(one["tip_error"].get<double>(), WithinAbs(expected, 1e-6));  // centroid: 1e-9 m
    CHECK(one["rank_deficiency"] == 3);  // lateral bending has no stiffness at all
    CHECK(one["twist_error"].is_null());
    for (const std::string rule : {"2x2 per rectangle", "3x3 per rectangle"}) {
      const json r = row(rows, rule, .3, elements, "tip node");
      CHECK(std::abs(r["tip_error"].get<double>()) < kRoundOff);
      CHECK(r["rank_deficiency"] == 0);
    }
  }
}

TEST_CASE("large bending needs fourth moments, which two points per rectangle hold to 1e-4",
          "[rules]") {
  const auto error = [](const std::string& rule, int elements) {
    return row(rows_of("section"), rule, .3, elements, "large bending")["tip_error"].get<double>();
  };
  for (const int elements : {1, 4, 16}) {
    const double exact = error("default", elements);
    // The moments are the same; Newton's residual is 1e-10 of the load.
    CHECK_THAT(error("3x3 per rectangle", elements), WithinAbs(exact, 1e-9));
    // Bending strain reaches 12 %, so its square counts; the fourth moment in z is 2.4 % off.
    CHECK(error("2x2 per rectangle", elements) - exact > 1e-6);
    CHECK(error("2x2 per rectangle", elements) - exact < 1e-4);
    CHECK(error("1x1 per rectangle", elements) - exact > .03);
  }
  // A quadratic element converges so that each halving divides the error by eight or more.
  CHECK(std::abs(error("default", 8)) < std::abs(error("default", 4)) / 8.);
  CHECK(std::abs(error("default", 16)) < 1e-5);
}

TEST_CASE("large bending differs from the elastica by less than its shear deflection", "[rules]") {
  // w/L = 0.66996 for F L^2/(EI) = 4 (reference numbers); F/(k G A) without rotation.
  const Material m{.poisson = 0.};
  const double w = large_deflection(study_law({}, m), 16) / study::kLength;
  const double shear = study::kLargeLoad * m.young * kInertiaY /
                       (kShearZ * m.shear_modulus() * kArea * study::kLength * study::kLength);
  CHECK(w > .66996);
  CHECK(w < .66996 + shear);
}

TEST_CASE("Wagner's fourth moments stiffen a large twist, and two points miss them", "[rules]") {
  // A bar twisted by t per length, free to shorten and to bend, stretches by (r^2 - its linear
  // part) t^2/2 at radius r: T = G J t + E W t^3/2, W = int r^4 - (int r^2)^2/A - (int z r^2)^2/Iy.
  const auto wagner = [](const SectionMoments& m, double E, double GJ) {
    const double r4 = m.of[4][0] + 2. * m.of[2][2] + m.of[0][4], r2 = m.of[2][0] + m.of[0][2];
    const double zr2 = m.of[2][1] + m.of[0][3];
    const double W = r4 - r2 * r2 / m.area() - zr2 * zr2 / m.of[0][2];
    double t = study::kLargeTwist;
    for (int i = 0; i < 20; ++i)
      t -= (GJ * (t - study::kLargeTwist) + .5 * E * W * t * t * t) / (GJ + 1.5 * E * W * t * t);
    return t * study::kLength;
  };
  const Material m;
  const double GJ = m.shear_modulus() * study_section(0).torsion;
  const double by_hand = wagner(moments(study::kRectangles), m.young, GJ);
  const double by_two = wagner(moments(study::kRectangles, 2), m.young, GJ);
  const double exact = large_turn(study_law({}, m), 8);
  // The formula leaves out the section's change of width, about the strain t^2 r^2/2 = 0.1 %.
  CHECK_THAT(exact, WithinRel(by_hand, 2e-3));
  CHECK(by_hand < .99 * study::kLargeTwist * study::kLength);  // 1.5 % less than without W
  const double two = large_turn(study_law({.section_points = 2}, m), 8);
  CHECK_THAT(two / exact - 1., WithinRel(by_two / by_hand - 1., .1));
  const json r = row(rows_of("section"), "2x2 per rectangle", .3, 8, "large twist");
  CHECK_THAT(r["tip_error"].get<double>(), WithinRel(by_two / by_hand - 1., .1));
  CHECK(row(rows_of("section"), "1x1 per rectangle", .3, 8, "large twist")["tip_error"].is_null());
}

TEST_CASE("flops grow with the points, but not with the rule of the section", "[rules]") {
  const auto flops = [](const std::string& family, const std::string& rule) {
    return row(rows_of(family), rule, .3, 1, "tip node")["force_flops"].get<int>();
  };
  const int one = flops("axial", "1 axial points");
  CHECK(flops("axial", "default") == 2 * one);
  CHECK(flops("axial", "5 axial points") == 5 * one);
  CHECK(flops("section", "3x3 per rectangle") == 2 * one);
  const json r = row(rows_of("section"), "3x3 per rectangle", .3, 1, "tip node");
  CHECK(r["gauss_points"] == 3 * 9 * 2 + 2);
  CHECK(r["force_us"] > 0.);
  CHECK(r["tangent_us"] > r["force_us"]);
}

TEST_CASE("rules writes every row as CSV and refuses a family that it does not know", "[rules]") {
  const auto folder = fresh_folder("rules");
  const auto file = folder / "rules.csv";
  const Ran ran = railstep_program("rules --family coupling --csv '" + file.string() + "'");
  CHECK(ran.code == 0);
  CHECK_THAT(ran.out, Catch::Contains("D not split"));
  const std::string text = text_of(file);
  // A header, 5 x 5 x 2 rows of each rule, and 5 x 2 large ones of the default.
  CHECK(std::count(text.begin(), text.end(), '\n') == 1 + 100 + 10);
  CHECK_THAT(text, Catch::StartsWith("family,rule,axial_points,coupling_points,section_rule,"));
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    CHECK(std::count(line.begin(), line.end(), ',') == 19);
  const Ran bad = railstep_program("rules --family axail");
  CHECK(bad.code == 2);
  CHECK(bad.out.empty());
  CHECK_THAT(bad.err, Catch::Contains("axail"));
}
