#include <catch2/catch.hpp>
#include <cmath>

#include "support/static_program.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

/// Words of a case, displacements of the tip and their bounds by the printed digits.
struct Row {
  std::string words;
  double z, x;          // m
  double off_z, off_x;  // m
};

const std::string kNoShear = "--set rail.shear_factor_z=1 --set rail.shear_factor_y=1 ";
const std::string kSplit = "--set 'rail.rule.shear=\"twist\"' ";
const std::string kPrinted =  // the paper's printed dimensions, section P
    "--set rail.rectangles.foot_width_m=0.140 --set rail.rectangles.foot_height_m=0.022 "
    "--set rail.rectangles.web_width_m=0.024 --set rail.rectangles.web_height_m=0.130 "
    "--set rail.rectangles.head_width_m=0.078 --set rail.rectangles.head_height_m=0.032 ";

/// Timoshenko's cantilever of the scenes: F L^3/(3 E I) + F L/(k G A), m.
double timoshenko_tip(double area, double inertia_y, double shear_factor_z) {
  const double F = -63e3, L = 2., E = 210e9, G = E / 2.6;
  return F * L * L * L / (3. * E * inertia_y) + F * L / (shear_factor_z * G * area);
}

}  // namespace

TEST_CASE("cantilevers agree with the rows of reference.md", "[static]") {
  // Half a unit of the last printed digit is 5e-8 in z and 5e-10 in x. The linear rows have k_z =
  // .472 (printed to 5e-5, which moves z by 4.0e-8): 9e-8. The nonlinear rows have ten elements and
  // the section's shear unsplit. The split moves x by up to 9e-10 (7e-6 of it): the shear's
  // variation over the section, of second order in the load, then keeps the whole G.
  const Row row = GENERATE(
      Row{shipped_word("cantilever_rectangle"), -2.06522e-2, -1.27763e-4, 5e-8, 5e-10},
      Row{shipped_word("cantilever_rectangle") + kSplit, -2.06522e-2, -1.27763e-4, 5e-8,
          5e-10 + 9e-10},
      Row{shipped_word("cantilever_rail"), -2.08871e-2, -1.30243e-4, 5e-8, 5e-10},
      Row{shipped_word("cantilever_rail") + kSplit, -2.08871e-2, -1.30243e-4, 5e-8, 5e-10 + 9e-10},
      Row{shipped_word("cantilever_rail_linear"), -2.08927e-2, 0., 9e-8, 1e-15},
      Row{shipped_word("cantilever_beam"), -2.08927e-2, 0., 9e-8, 1e-15},
      Row{shipped_word("cantilever_rail") + kNoShear, -2.06866e-2, -1.28161e-4, 5e-8, 5e-10},
      Row{shipped_word("cantilever_rail") + kNoShear + "--model linearised", -2.06921e-2, 0., 5e-8,
          1e-15},
      Row{shipped_word("cantilever_beam") + kNoShear, -2.06921e-2, 0., 5e-8, 1e-15});
  INFO(row.words);
  const nlohmann::json result = solved(row.words);
  const auto [x, y, z] = point(result);
  CHECK_THAT(z, WithinAbs(row.z, row.off_z));
  CHECK_THAT(x, WithinAbs(row.x, row.off_x));
  CHECK(std::abs(y) < 1e-15);
  // Newton ends at the tolerance or where round-off of the positions (condition 1e8) stops it.
  CHECK(result["residual"].get<double>() < 1e-8);
  CHECK((result["iterations"].get<int>() > 1) == (row.x != 0.));
}

TEST_CASE("forty elements agree with the converged result of other code", "[static]") {
  // reference.md: Chrono's ANCF 3333 with 40 elements, six digits in x, seven in z.
  const auto [x, y, z] =
      point(solved(shipped_word("cantilever_rectangle") + "--set track.elements_per_bay=4"));
  CHECK_THAT(z, WithinAbs(-2.065221e-2, 2e-8));  // its three axial points still lock by 1e-6
  CHECK_THAT(x, WithinAbs(-1.27764e-4, 5e-10));
}

TEST_CASE("the linearised cantilever agrees with Timoshenko's closed form", "[static]") {
  // Bound 1e-7: the rectangles' printed digits (11) cause less, round-off of condition 1e8 1e-8.
  const double f = timoshenko_tip(8700e-6, 39.0e-6, .4721);
  CHECK_THAT(point(solved(shipped_word("cantilever_rail_linear")))[2], WithinRel(f, 1e-7));
  CHECK_THAT(point(solved(shipped_word("cantilever_beam")))[2], WithinRel(f, 1e-7));
  // Section P has area and inertia to the digits of reference.md, 1e-4 and 1.3e-4 of the inertia.
  const double p = timoshenko_tip(8696e-6, 38.78e-6, .4458);
  const std::string printed = shipped_word("cantilever_rail") + kSplit + kPrinted +
                              "--set rail.shear_factor_z=0.4458 --model ";
  for (const char* model : {"linearised", "timoshenko"}) {
    std::string words = printed;
    words.append(model);
    CHECK_THAT(point(solved(words))[2], WithinRel(p, 1.5e-4));
  }
}

TEST_CASE("the neutral axis moves the same for every place of the nodes", "[static]") {
  const std::string scene = shipped_word("cantilever_rail") + kSplit;
  const auto centroid = point(solved(scene));
  for (const char* line : {"mid-height", "foot", "head"}) {
    const std::string words = scene + "--set 'track.reference_line=\"" + line + "\"' ";
    INFO(words);
    const auto tip = point(solved(words));
    // The interpolation is linear over the section, so a shifted line is a change of unknowns of
    // the same discrete problem. They agree to 1e-9, where round-off stops Newton's method.
    CHECK_THAT(tip[2], WithinRel(centroid[2], 1e-9));
    CHECK_THAT(tip[0], WithinRel(centroid[0], 1e-7));
    // With the Poisson coupling on that line, as Eq. 18 reads, it is another, stiffer beam.
    const auto stiff = point(solved(words + "--set 'rail.rule.coupling=\"axis\"'"));
    CHECK(stiff[2] / centroid[2] < 1. - 1e-5);
    CHECK(stiff[2] / centroid[2] > .97);
  }
}

TEST_CASE("a point off the neutral axis moves along x by the section's turn", "[static]") {
  // Linear beam: the end section turns by theta = F L^2/(2 E I), and x = theta z.
  const double theta = 63e3 * 4. / (2. * 210e9 * 39e-6);
  for (const auto& [at, z] : {std::pair("head", .1007375), std::pair("foot", -.085)})
    CHECK_THAT(point(solved(shipped_word("cantilever_rail_linear") + "--set 'sensor[0].at=\"" + at +
                            "\"'"))[0],
               WithinRel(theta * z, 1e-6));
}

TEST_CASE("a thin cantilever bends as the elastica", "[static]") {
  // reference.md, F L^2/(E I) = 4: w/L .66996, u/L .32894, half a digit 5e-6. For a plate 4 mm high
  // and 2 m long shear adds F/(k G A) = 4e-6.
  const std::string thin =
      "--set rail.rectangle.height_m=0.004 --set rail.rectangle.width_m=0.1 "
      "--set 'load[0].force_z_n=-112.0' --set track.elements_per_bay=4";
  const auto [x, y, z] = point(solved(shipped_word("cantilever_rectangle") + thin));
  CHECK_THAT(z / 2., WithinAbs(-.66996, 9e-6));
  CHECK_THAT(x / 2., WithinAbs(-.32894, 9e-6));
}

TEST_CASE("a section is integrated by points per rectangle or by its outline", "[static]") {
  const std::string linear = shipped_word("cantilever_rail_linear");
  const auto with = [&](const std::string& more) { return point(solved(linear + more))[2]; };
  CHECK_THAT(with("--set rail.rule.section_points=3"), WithinRel(with(""), 1e-9));
  // One point in each rectangle misses the rectangle's own w h^3/12.
  const double w[] = {.1380985536, .02522171327, .07720505094};
  const double h[] = {.020996636, .13308941227, .03165145173};
  double inertia = 39.0e-6;
  for (int i = 0; i < 3; ++i) inertia -= w[i] * h[i] * h[i] * h[i] / 12.;
  CHECK_THAT(with("--set rail.rule.section_points=1 --set 'track.unknowns=\"vertical\"'"),
             WithinRel(timoshenko_tip(8700e-6, inertia, .4721), 1e-6));

  const std::string profile = RAILSTEP_SOURCE "/config/profiles/60e1.toml";
  const nlohmann::json fit =
      nlohmann::json::parse(railstep_program("fit '" + profile + "' --json").out);
  for (const auto& [outline, key] :
       {std::pair("fitted", "section"), std::pair("exact", "outline")}) {
    const OwnScene own(
        "schema = 1\n"

        "[track]\nunknowns = \"full\"\nrails = 1\nbays = 10\nbay_m = 0.2\n"
        "elements_per_bay = 1\nends = [\"clamped\", \"free\"]\n[rail]\nprofile = \"" +
        profile + "\"\noutline = \"" + outline +
        "\"\n[[load]]\nname = \"end\"\nstart_m = 2.0\nforce_z_n = -63.0e3\n"
        "[[sensor]]\nname = \"tip\"\non = \"rail\"\nposition_m = 2.0\n");
    const double expected =
        timoshenko_tip(fit[key]["area_m2"], fit[key]["inertia_y_m4"], fit[key]["shear_factor_z"]);
    const auto linear_tip = point(solved(own.words()));
    CHECK_THAT(linear_tip[2], WithinRel(expected, 1e-7));
    const auto tip = point(solved(own.words() + "--model nonlinear"));
    // As for section F, the beam is 2.7e-4 stiffer; this one bends by 1.3 times as much, squared.
    CHECK_THAT(tip[2], WithinRel(expected, 6e-4));
    CHECK(std::abs(tip[2]) < std::abs(linear_tip[2]));
    CHECK(tip[0] < -1e-4);
  }
}
