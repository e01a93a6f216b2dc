#include <Eigen/Dense>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "offline/math/gauss.h"
#include "program.h"
#include "rules_beam.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using nlohmann::json;

namespace {

// An error of 0 is round-off. The stress at rest is eps of Lame's lambda (167 E at nu = .499), a
// spring against rotation of eps lambda A all along: 1e-11 of 3 E Iy/L^2. Measured: 2e-11.
constexpr double kRoundOff = 1e-9;

constexpr double kInertiaY = 39.0e-6, kInertiaZ = 6.0e-6, kArea = 8700e-6, kShearZ = .4721;
// Those of the rectangles' printed digits differ by less.
constexpr double kPrinted = 1e-9;

/// The rows of a family, the default's first, by the program.
const json& rows_of(const std::string& family) {
  static std::map<std::string, json> known;
  if (known.count(family) == 0) {
    const Ran ran = railstep_program("rules --json --family " + family);
    REQUIRE(ran.code == 0);
    known[family] = json::parse(ran.out).at("rows");
  }
  return known[family];
}

json row(const json& rows, const std::string& rule, double poisson, int elements,
         const std::string& load) {
  for (const json& r : rows)
    if (r["rule"] == rule && r["poisson"] == poisson && r["elements"] == elements &&
        r["load"] == load)
      return r;
  FAIL("no row of " << rule << ", " << poisson << ", " << elements << ", " << load);
  return {};
}

/// A cantilever of quadratic Timoshenko elements of two unknowns per node, w and psi, with `points`
/// Gauss points each: none of the code under test. Deflection under a unit load at x.
double twin_compliance(const Material& m, double shear_factor, int points, int elements, double x) {
  const double length = study::kLength / elements, bending = m.young * kInertiaY;
  const double shear = shear_factor * m.shear_modulus() * kArea;
  const int n = 2 * (2 * elements + 1);
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n);
  const auto N = [](double xi) {
    return Eigen::Vector3d(xi * (xi - 1.) / 2., 1. - xi * xi, xi * (xi + 1.) / 2.);
  };
  for (int e = 0; e < elements; ++e)
    for (const GaussPoint& g : gauss(points)) {
      const Eigen::Vector3d slope =
          Eigen::Vector3d(g.xi - .5, -2. * g.xi, g.xi + .5) * (2. / length);
      Eigen::VectorXd gamma = Eigen::VectorXd::Zero(n), kappa = gamma;
      for (int i = 0; i < 3; ++i) {
        gamma[4 * e + 2 * i] = slope[i];
        gamma[4 * e + 2 * i + 1] = -N(g.xi)[i];
        kappa[4 * e + 2 * i + 1] = slope[i];
      }
      const double w = g.weight * length / 2.;
      K += w * (bending * kappa * kappa.transpose() + shear * gamma * gamma.transpose());
    }
  const int e = std::min(static_cast<int>(x / length), elements - 1);
  Eigen::VectorXd row = Eigen::VectorXd::Zero(n);
  for (int i = 0; i < 3; ++i) row[4 * e + 2 * i] = N(2. * (x - e * length) / length - 1.)[i];
  const Eigen::VectorXd load = row.tail(n - 2);
  return load.dot(K.bottomRightCorner(n - 2, n - 2).fullPivLu().solve(load));
}

double timoshenko(const Material& m, double bending, double shear_factor, double x) {
  return x * x * x / (3. * bending) + x / (shear_factor * m.shear_modulus() * kArea);
}

}  // namespace

TEST_CASE("the default rule is exact at the tip with one element, for every Poisson's ratio",
          "[rules]") {
  int seen = 0;
  for (const json& r : rows_of("axial"))
    if (r["rule"] == "default" && r["load"] == "tip node") {
      INFO("nu " << r["poisson"] << ", elements " << r["elements"]);
      CHECK(std::abs(r["tip_error"].get<double>()) < kRoundOff);
      // The same spring against torsion, eps lambda A L^2/(G J), is 2e-9 at nu = .499.
      CHECK(std::abs(r["twist_error"].get<double>()) < (r["poisson"] == .499 ? 1e-8 : kRoundOff));
      CHECK(r["rank_deficiency"] == 0);
      CHECK(r["negative_eigenvalues"] == 0);
      ++seen;
    }
  CHECK(seen == 25);
}

TEST_CASE("every number of axial points errs as a Timoshenko element of two unknowns per node does",
          "[rules]") {
  for (const int points : {2, 3, 4, 5})
    for (const int elements : {1, 2, 8})
      for (const double nu : {0., .3, .499}) {
        INFO(points << " points, " << elements << " elements, nu " << nu);
        const std::string rule = points == 2 ? "default" : std::to_string(points) + " axial points";
        const Material m{.poisson = nu};
        for (const std::string load : {"tip node", "between nodes"}) {
          const json r = row(rows_of("axial"), rule, nu, elements, load);
          const double x = r["load_x_m"];
          const double twin = twin_compliance(m, kShearZ, points, elements, x) /
                                  timoshenko(m, m.young * kInertiaY, kShearZ, x) -
                              1.;
          CHECK_THAT(r["tip_error"].get<double>(), WithinAbs(twin, kPrinted));
        }
      }
}

TEST_CASE("three axial points lock by 21 % with one element and 0.4 % with four", "[rules]") {
  // k = 1, nu = .3: two figures of an independent prototype, of two and one digits.
  const Material m;
  const auto error = [&](int elements) {
    const BeamLaw law = study_law({.element = {.axial_points = 3, .shear = Shear::published}}, m);
    return vertical_compliance(law, elements).tip /
               timoshenko(m, m.young * kInertiaY, 1., study::kLength) -
           1.;
  };
  CHECK_THAT(error(1), WithinAbs(-.21, .005));
  CHECK_THAT(error(4), WithinAbs(-.004, .0005));
}

TEST_CASE("one axial point strains in 12 ways, so 9 modes of 27 are free beside the rigid ones",
          "[rules]") {
  for (const json& r : rows_of("axial"))
    if (r["rule"] == "1 axial points") {
      CHECK(r["rank_deficiency"] == 9);
      CHECK(r["tip_error"].is_null());
      CHECK(r["twist_error"].is_null());
    }
}

TEST_CASE("a load between two nodes converges as the element's length, and no faster", "[rules]") {
  // What is left is the kink of shear under the load, F l/(k G A) times a constant.
  const auto error = [](int n) {
    return row(rows_of("axial"), "default", .3, n, "between nodes")["tip_error"].get<double>();
  };
  CHECK(error(1) > .05);  // reduced integration of one long element is too soft there
  for (const int n : {2, 4, 8, 16}) CHECK(error(n) < 0.);
  // 16 against 8: half, less what the deflection at x itself changes and the l^3 of bending.
  CHECK_THAT(error(16) / error(8), WithinAbs(.5, .1));
}

TEST_CASE("Dv at points where D0 is not looked at makes the stiffness indefinite", "[rules]") {
  std::set<std::string> indefinite, others;
  for (const json& r : rows_of("coupling-points"))
    if (r["poisson"] == .3 && r["elements"] == 1)
      (r["negative_eigenvalues"] > 0 ? indefinite : others).insert(r["rule"].get<std::string>());
  CHECK(indefinite == std::set<std::string>{"D0 at 1 and Dv at 2", "D0 at 1 and Dv at 3",
                                            "D0 at 2 and Dv at 1", "D0 at 2 and Dv at 3",
                                            "D0 at 2 and Dv at 4", "D0 at 2 and Dv at 5"});
  CHECK(others == std::set<std::string>{"default", "D0 at 3 and Dv at 1", "D0 at 3 and Dv at 2",
                                        "D0 at 3 and Dv at 4", "D0 at 4 and Dv at 2"});
}

TEST_CASE("the mode of negative energy is a section that widens as it flattens, by hand",
          "[rules]") {
  // E22 = -E33 = 1 - 3 xi^2 is 0 at both points of D0, where only its slopes cost energy:
  //   2U = G (Iy + Iz) 48/L - E nu/(1 + nu) 2 A L f, f = 1 with Dv at one point, 4/5 at three.
  const Material m;
  for (const int points : {1, 3})
    for (const double L : {2., .5, .125}) {
      const BeamLaw law = study_law({.element = {.coupling_points = points}}, m);
      const ElementMatrices e = element_matrices(study_section(0), law, L);
      Vector27 u = Vector27::Zero();
      for (int i = 0; i < 3; ++i) {
        u[9 * i + 4] = i == 1 ? 1. : -2.;
        u[9 * i + 8] = -u[9 * i + 4];
      }
      const double f = points == 1 ? 1. : .8;
      const double by_hand = m.shear_modulus() * (kInertiaY + kInertiaZ) * 48. / L -
                             m.young * m.poisson / (1. + m.poisson) * 2. * kArea * L * f;
      // Round-off of terms of E A L and G (Iy + Iz) 48/L.
      CHECK_THAT(u.dot(e.stiffness * u), WithinAbs(by_hand, kPrinted * m.young * kArea));
      CHECK((by_hand < 0.) == (L > .5 || (L == .5 && points == 1)));
    }
}

TEST_CASE("D that is not split locks, the more the nearer nu is to 1/2, on every mesh", "[rules]") {
  double previous = 0.;
  for (const double nu : {0., .3, .45, .49, .499}) {
    // Sections that cannot strain in their plane bend with the uniaxial-strain modulus.
    const Material m{.poisson = nu};
    const double modulus = m.young * (1. - nu) / ((1. + nu) * (1. - 2. * nu));
    const double expected = timoshenko(m, modulus * kInertiaY, kShearZ, study::kLength) /
                                timoshenko(m, m.young * kInertiaY, kShearZ, study::kLength) -
                            1.;
    for (const int elements : {1, 4, 16})
      CHECK_THAT(row(rows_of("coupling"), "D not split", nu, elements, "tip node")["tip_error"]
                     .get<double>(),
                 WithinAbs(expected, kPrinted));
    CHECK(expected <= previous);
    previous = expected;
  }
  CHECK_THAT(previous, WithinAbs(-.973, .0005));
}

TEST_CASE("Dv on a reference line off the centroid stiffens, at the centroid it does not",
          "[rules]") {
  const json& rows = rows_of("reference-line");
  const auto error = [&](const std::string& rule, double nu) {
    return row(rows, rule, nu, 16, "tip node")["tip_error"].get<double>();
  };
  for (const double nu : {0., .3, .499})
    CHECK(std::abs(error("reference line at foot", nu)) < kRoundOff);
  CHECK(std::abs(error("reference line and Dv at foot", 0.)) < kRoundOff);
  // An independent prototype: up to 2 %.
  CHECK_THAT(error("reference line and Dv at foot", .3), WithinAbs(-.015, .005));
  CHECK(error("reference line and Dv at foot", .499) < -.02);
  CHECK(std::abs(error("reference line and Dv at mid-height", .3)) < 1e-3);
}

TEST_CASE("nine tenths and more of what Dv off the centroid stiffens is the clamp's", "[rules]") {
  // Bent, the section at rest on a line z off the centroid widens by nu z kappa for nothing; only
  // its change along the beam costs, G (Iy + Iz) (nu z kappa')^2, if the clamp lets it widen: then
  // the tip sinks less by 3 G (Iy + Iz) nu^2 z^2 / (E Iy L^2).
  const Material m;
  const double z = -study::kCentroidHeight, L = study::kLength, nu = m.poisson;
  const BeamLaw law =
      study_law({.element = {.coupling = Coupling::axis}, .reference_height = z}, m);
  Structure s = study_cantilever(law, 16, Motion::vertical);
  for (const int i : {2, 4, 8}) s.held[static_cast<std::size_t>(i)] = false;  // r_z, a_y, b_z
  const Eigen::MatrixXd K = free_part(s, tangent(s, s.rest));
  Eigen::VectorXd tip = Eigen::VectorXd::Zero(s.unknowns());
  tip.tail(27) = point_row(1., 0., -z, 2);
  // The clamp holds the centroid: r_z = z b_z of the first node, which are its unknowns 0 and 2.
  const Eigen::Index n = K.rows();
  Eigen::MatrixXd tie = Eigen::MatrixXd::Zero(n, n - 1);
  tie.bottomRows(n - 1).setIdentity();
  tie(0, 1) = z;
  const Eigen::VectorXd row = tie.transpose() * free_part(s, tip);
  const double found = row.dot((tie.transpose() * K * tie).fullPivLu().solve(row));
  const double error = found / exact_compliance(m, L) - 1.;
  const double by_hand = -3. * m.shear_modulus() * (kInertiaY + kInertiaZ) * nu * nu * z * z /
                         (m.young * kInertiaY * L * L);
  // The free tip saves it in a layer sqrt(G Iy/(E A)) = 5 cm of the 2 m: a few parts in a hundred.
  CHECK_THAT(error, WithinRel(by_hand, .1));
  CHECK(std::abs(error) < .1 * .012);
}

TEST_CASE("without the split of torsion the bar is 23 times too stiff, by shear factors 11 times",
          "[rules]") {
  const double J = study_section(0).torsion;
  const auto stiffness = [&](const std::string& rule, int elements) {
    const json r = row(rows_of("shear"), rule, .3, elements, "tip node");
    return 1. / (1. + r["twist_error"].get<double>());
  };
  // Layers at both ends, of the section's radius sqrt(Iy/A) = 7 cm, in which y and z slopes turn
  // by different angles, are up to 3 % of 2 m.
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

TEST_CASE("in large bending fourth moments count, and two points per rectangle hold them to 1e-4",
          "[rules]") {
  const auto error = [](const std::string& rule, int elements) {
    return row(rows_of("section"), rule, .3, elements, "large bending")["tip_error"].get<double>();
  };
  for (const int elements : {1, 4, 16}) {
    const double exact = error("default", elements);
    // The same moments; Newton's residual, 1e-10 of the load.
    CHECK_THAT(error("3x3 per rectangle", elements), WithinAbs(exact, 1e-9));
    // F's bending strain reaches 12 %, its square counts; the fourth moment in z is 2.4 % off.
    CHECK(error("2x2 per rectangle", elements) - exact > 1e-6);
    CHECK(error("2x2 per rectangle", elements) - exact < 1e-4);
    CHECK(error("1x1 per rectangle", elements) - exact > .03);
  }
  // Order of a quadratic element: eight times less and more at each halving.
  CHECK(std::abs(error("default", 8)) < std::abs(error("default", 4)) / 8.);
  CHECK(std::abs(error("default", 16)) < 1e-5);
}

TEST_CASE("large bending lies above the elastica by less than its shear", "[rules]") {
  // w/L = 0.66996 for F L^2/(EI) = 4 (reference numbers); F/(k G A) of a beam that does not turn.
  const Material m{.poisson = 0.};
  const double w = large_deflection(study_law({}, m), 16) / study::kLength;
  const double shear = study::kLargeLoad * m.young * kInertiaY /
                       (kShearZ * m.shear_modulus() * kArea * study::kLength * study::kLength);
  CHECK(w > .66996);
  CHECK(w < .66996 + shear);
}

TEST_CASE("a large twist stiffens by Wagner's fourth moments, which two points miss", "[rules]") {
  // Free to shorten and to bend, a bar twisted by t per length stretches by (r^2 - its linear part)
  // t^2/2 at radius r: T = G J t + E W t^3/2, W = int r^4 - (int r^2)^2/A - (int z r^2)^2/Iy.
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
  // The section's change of width, of the order of the strain t^2 r^2/2 = 0.1 %, is not in it.
  CHECK_THAT(exact, WithinRel(by_hand, 2e-3));
  CHECK(by_hand < .99 * study::kLargeTwist * study::kLength);  // 1.5 % less than without W
  const double two = large_turn(study_law({.section_points = 2}, m), 8);
  CHECK_THAT(two / exact - 1., WithinRel(by_two / by_hand - 1., .1));
  const json r = row(rows_of("section"), "2x2 per rectangle", .3, 8, "large twist");
  CHECK_THAT(r["tip_error"].get<double>(), WithinRel(by_two / by_hand - 1., .1));
  CHECK(row(rows_of("section"), "1x1 per rectangle", .3, 8, "large twist")["tip_error"].is_null());
}

TEST_CASE("flops grow with the points, not with the rule of the section", "[rules]") {
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

TEST_CASE("rules writes every row as CSV, and refuses a family it does not know", "[rules]") {
  const auto folder = fresh_folder("rules");
  const auto file = folder / "rules.csv";
  const Ran ran = railstep_program("rules --family coupling --csv '" + file.string() + "'");
  CHECK(ran.code == 0);
  CHECK_THAT(ran.out, Catch::Contains("D not split"));
  const std::string text = text_of(file);
  // A header; 5 x 5 x 2 rows of each rule, 5 x 2 of the default's large ones.
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
