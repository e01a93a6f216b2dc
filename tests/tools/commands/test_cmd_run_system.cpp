#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "run/simulate.h"
#include "support/plotted.h"
#include "support/program.h"
#include "support/shipped.h"
#include "support/traced.h"

using namespace railstep;
using Catch::Contains;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

const std::string kPendulum = kScenes + "double_pendulum.toml",
                  kCrank = kScenes + "slider_crank.toml",
                  kSpring = kScenes + "spring_pendulum.toml";

/// Columns of the n-th sensor.
constexpr std::size_t x_of(std::size_t sensor) { return 1 + 7 * sensor; }
constexpr std::size_t z_of(std::size_t sensor) { return x_of(sensor) + 2; }

}  // namespace

TEST_CASE("the double pendulum's trace has its sensors' columns and agrees with the reference",
          "[run]") {
  const Rows trace = traced(kPendulum);
  std::string header = "time_s";
  for (const char* sensor : {"A", "B", "C"})
    for (const char* quantity : {"x_m", "y_m", "z_m", "dx_m", "dy_m", "dz_m", "vz_m_per_s"})
      header += std::string(",") + sensor + "." + quantity;
  CHECK(trace.header == header);
  REQUIRE(trace.row.size() == 1001);
  // At rest B is at 0.4 m and C at 0.8 m; interpolation rounds by an ulp.
  CHECK_THAT(trace.row[0][x_of(1)], WithinAbs(.4, 1e-16));
  CHECK_THAT(trace.row[0][x_of(2)], WithinAbs(.8, 2e-16));
  const double reference[4][5] = {{.1, .395226, -.061927, .794770, -.042493},
                                  {.2, .337426, -.214950, .736686, -.190388},
                                  {.3, .197918, -.347682, .569036, -.497033},
                                  {.4, .089146, -.390236, .099862, -.790218}};
  for (const auto& at : reference) {
    const auto& row = trace.row[static_cast<std::size_t>(std::round(at[0] * 1000.))];
    CAPTURE(at[0]);
    CHECK(row[0] == std::round(at[0] * 1000.) * 1e-3);
    // reference.md, "Double pendulum", good to 1e-5 m. The requirement for 4 elements at 1 ms is an
    // error below 0.2 mm at C up to 1 s; B has the same bound.
    CHECK_THAT(row[x_of(1)], WithinAbs(at[1], 2e-4));
    CHECK_THAT(row[z_of(1)], WithinAbs(at[2], 2e-4));
    CHECK_THAT(row[x_of(2)], WithinAbs(at[3], 2e-4));
    CHECK_THAT(row[z_of(2)], WithinAbs(at[4], 2e-4));
  }
  for (const auto& row : trace.row) {
    CHECK(std::hypot(row[x_of(0)], row[z_of(0)]) < 1e-15);            // A is pinned
    CHECK(row[x_of(2) + 3] == row[x_of(2)] - trace.row[0][x_of(2)]);  // dx = x - rest
  }
}

TEST_CASE("a planar system moves as in three dimensions, for beams and for bodies", "[run]") {
  // Both solve the same equations and differ by where Newton's method stops, so it runs to
  // round-off here. The required agreement is 1e-9 m.
  const std::string tight = " --duration 0.5 --set joints.force_tolerance=1e-12";
  const auto compare = [&](const std::string& scene) {
    const Rows space = traced(scene + tight + " --set system.planar=false"),
               plane = traced(scene + tight + " --set system.planar=true");
    REQUIRE(space.header == plane.header);
    REQUIRE(space.row.size() == plane.row.size());
    double largest = 0.;
    for (std::size_t r = 0; r < space.row.size(); ++r)
      for (std::size_t c = 0; c < space.row[r].size(); ++c) {
        const bool speed = c > 0 && c % 7 == 0;  // m/s: the bound over a frame of 1 ms
        const double apart = std::abs(space.row[r][c] - plane.row[r][c]) * (speed ? 1e-3 : 1.);
        largest = std::max(largest, apart);
      }
    CAPTURE(scene);
    CHECK(largest < 1e-9);
    CHECK(space.row.back()[x_of(0) + 1] == Approx(0.).margin(1e-12));  // nothing leaves the plane
  };
  compare(kPendulum);
  compare(kCrank);
}

TEST_CASE("in equilibrium the double pendulum hangs straight, stretched by its weight", "[run]") {
  const std::string hanging = kPendulum + " --duration 0.05 --set 'step.start=\"equilibrium\"'";
  for (const char* hold :
       {"augmented-lagrangian", "baumgarte", "gear-gupta-leimkuhler", "direct"}) {
    const Rows trace =
        traced(hanging + " --set 'joints.hold=\"" + hold + "\"' --set 'joint[0].trace=true'");
    CAPTURE(hold);
    // Each link is stretched by half its own weight, and the upper one by all of the lower one's
    // too. These strains are 3e-4; the Green strain differs by half their square, and the weight
    // acts on the stretched links.
    const double per_weight = 7900. * 9.81 * .4 * .4 / 210e6;
    CHECK(trace.row[0][z_of(1)] + .4 == Approx(-1.5 * per_weight).epsilon(1e-3));
    CHECK(trace.row[0][z_of(2)] + .8 == Approx(-2. * per_weight).epsilon(1e-3));
    CHECK_THAT(trace.row[0][x_of(2)], WithinAbs(0., 1e-9));  // 1e-9 m/s2 over (3 rad/s)^2
    // B of the hinge is the lower link, 20 x 30 mm.
    const std::size_t force = trace.column("hinge.force_z_n");
    CHECK(trace.row[0][force] == Approx(7900. * 9.81 * .4 * .02 * .03).epsilon(1e-8));
    for (const auto& row : trace.row)
      CHECK_THAT(row[z_of(2)], WithinAbs(trace.row[0][z_of(2)], 1e-11));
  }
}

TEST_CASE("a driven slider-crank is where its geometry puts it", "[run]") {
  const Rows trace = traced(kCrank);
  double largest = 0.;
  for (const auto& row : trace.row) {
    const double angle = 10. * row[0], across = .1 * std::sin(angle);
    const double piston = .1 * std::cos(angle) + std::sqrt(.09 - across * across);
    largest = std::max({largest, std::abs(row[x_of(0)] - .1 * std::cos(angle)),
                        std::abs(row[z_of(0)] + across), std::abs(row[x_of(1)] - piston),
                        std::abs(row[z_of(1)])});
  }
  // Each joint and the drive are closed to 1e-10 m or rad (joints.tolerance_m). The errors of a
  // chain of 5 add up, with a transmission of at most 1 + 0.1 / 0.3: they stay below ten of them.
  CHECK(largest < 1e-9);
}

TEST_CASE("a body below its spring moves as a damped oscillator", "[run]") {
  // Released straight below the ground's point, 0.1 m under the spring's own length: z = s + e^(-d
  // t) (a cos w t + b sin w t), s the sag, d = c / (2 m), w^2 = k / m - d^2.
  const std::string below =
      kSpring +
      " --set 'body[0].position_m=[0.0, 0.0, -1.0]' --set 'body[0].velocity_m_per_s=[0.0, 0.0, "
      "0.0]' --set 'spring[0].other_point_m=[0.0, 0.0, -1.0]' --set step.duration_s=1.0";
  const auto largest_error = [&](const std::string& step) {
    const Rows trace = traced(below + step);
    const double sag = 2. * 9.81 / 200., d = .5 / 4., w = std::sqrt(100. - d * d);
    const double a = .1 - sag, b = d * a / w;  // downwards from the equilibrium, at rest
    double largest = 0.;
    for (const auto& row : trace.row) {
      const double t = row[0];
      const double down = sag + std::exp(-d * t) * (a * std::cos(w * t) + b * std::sin(w * t));
      largest = std::max(largest, std::abs(row[z_of(0)] + .9 + down));
    }
    return largest;
  };
  // a is 1.9 mm. A second-order scheme errs by about (w dt)^2 / 12 (w t) = 8e-5 of it at 1 ms.
  // Numerical damping of rho_inf 0.9 and the damper's share stay within five times that.
  const double coarse = largest_error(""),
               fine = largest_error(" --step 5e-4 --set step.frame_s=1e-3");
  CHECK(coarse < 5. * 8e-5 * 1.9e-3 * 1.);
  CHECK(coarse / fine > 3.5);  // 4 for second order
  CHECK(coarse / fine < 4.5);
}

TEST_CASE("a system's --json prints the contract's keys, and a second run gives the same bits",
          "[run]") {
  const std::string brief = kPendulum + " --duration 0.2";
  const nlohmann::json first = told(brief);
  for (const char* key :
       {"steps", "final_time_s", "state_hash", "status", "max_constraint_violation",
        "max_iterations", "energy_balance_error", "numerical_loss", "frame_us", "steps_per_frame",
        "kernels", "allocations"})
    CHECK(first.contains(key));
  CHECK(first.at("steps") == 200);
  CHECK(first.at("final_time_s") == 200 * 1e-3);
  CHECK(first.at("status") == nlohmann::json::array());
  CHECK(first.at("max_constraint_violation") < 1e-10);  // joints.tolerance_m
  CHECK(first.at("max_iterations") >= 1);
  CHECK(first.at("allocations") == 0);
  CHECK(told(brief).at("state_hash") == first.at("state_hash"));
  CHECK(told(brief + " --set 'beam[1].length_m=0.41'").at("state_hash") != first.at("state_hash"));
  const nlohmann::json fine = told(brief + " --step 5e-4 --set step.frame_s=1e-3");
  CHECK(fine.at("steps") == 400);
  CHECK(fine.at("steps_per_frame") == 2);
}

TEST_CASE("energy-momentum keeps the energy of a system, backward Euler damps it most", "[run]") {
  const std::string half = kPendulum + " --duration 0.5";
  const nlohmann::json kept = told(half +
                                   " --set 'step.scheme=\"energy-momentum\"' --set "
                                   "joints.force_tolerance=1e-12");
  // Newton's residual, 1e-12 of the largest force, times 500 steps; and rounding of stiff slopes:
  // EA / (weight of a beam) = 126e6 / 19 turns 1e-16 into 1e-9.
  CHECK(kept.at("energy_balance_error") < 1e-8);
  const double euler =
      told(half + " --set 'step.scheme=\"backward-euler\"'").at("numerical_loss").get<double>();
  const double alpha = told(half).at("numerical_loss").get<double>();
  CHECK(euler > 1e-3);  // first order at 1 ms: it damps
  CHECK(std::abs(alpha) < .1 * euler);
}

TEST_CASE("run reports a step so long that the scheme makes energy", "[run]") {
  const std::string noted = "W-RUN-04";
  const Ran wild = railstep_program("run " + kPendulum +
                                    " --json --set step.dt_s=0.01 --set "
                                    "step.frame_s=0.01");
  CHECK_THAT(wild.err, Contains("note: ") && Contains(noted));
  const auto told = nlohmann::json::parse(wild.out);
  CHECK(told["numerical_loss"].get<double>() < -.05);
  CHECK(told["warnings"].at(0).at("id") == noted);
  CHECK_THAT(railstep_program("run " + kPendulum).err, !Contains(noted));
}

TEST_CASE("run reports an energy balance that is off for condensed tracks too", "[run]") {
  const std::string noted = "W-RUN-05";
  const std::string run = "run " + kScenes +
                          "moving_load.toml --set 'condense.kind=\"modal\"' --json "
                          "--set step.frame_s=0.005 --set step.dt_s=";
  const Ran off = railstep_program(run + "0.005");
  CHECK_THAT(off.err, Contains(noted));
  const auto told = nlohmann::json::parse(off.out);
  CHECK(told["energy_balance_error"].get<double>() > .05);
  CHECK(told["warnings"].size() == 1);
  CHECK_THAT(railstep_program(run + "0.001").err, !Contains(noted));
}

TEST_CASE("drive work and damper heat close the energy balance with every constraint method",
          "[run]") {
  // Means over a step are of second order, and so are the schemes: half the step makes a quarter of
  // the error. Its size at 10 rad/s and 1 ms is (w dt)^2 = 1e-4.
  const auto check = [](const std::string& scene) {
    const double coarse = told(scene + " --duration 0.5").at("energy_balance_error").get<double>();
    const double fine = told(scene + " --duration 0.5 --step 5e-4").at("energy_balance_error");
    CAPTURE(scene, coarse, fine);
    CHECK(coarse < 1e-4);
    CHECK(fine < .3 * coarse);
  };
  for (const std::string hold :
       {"augmented-lagrangian", "baumgarte", "gear-gupta-leimkuhler", "direct"})
    check(std::string(kCrank).append(" --set 'joints.hold=\"").append(hold).append("\"'"));
  check(kCrank + " --set 'step.scheme=\"energy-momentum\"'");
  check(kSpring);
}

TEST_CASE("bad systems are refused in one sentence with exit code 2 and nothing is written",
          "[run]") {
  const struct {
    std::string words, said;
  } cases[] = {
      {kPendulum + " --set 'joint[0].between=[\"upper\", \"louwer\"]'", "expected \"ground\""},
      {kPendulum + " --set 'joint[0].knid=\"fixed\"'", "'knid'"},
      {kPendulum + " --set 'sensor[1].position_m=[0.5, 0, 0]'", "0.5 m along beam \"upper\""},
      {kPendulum + " --set 'beam[0].material.young_pa=1'", "material"},
      {kPendulum + " --model condensed", "E-BODY-26"},
      {kPendulum + " --set track.bays=1", "[track] key 'unknowns'"},
      {kPendulum + " --step 7e-4", "E-STEP-06"},
      {kCrank + " --set 'body[1].inertia_kg_m2=[1, 1, 3]'", "E-BODY-16"},
      {kCrank + " --set 'joint[4].polynomial_rad=[0.5, 1]'", "begins at 0.5 rad"},
      {kCrank + " --set 'joints.hold=\"direct\"' --set step.rho_inf=1.0", "E-SYSTEM-56"},
      {kSpring + " --set 'spring[0].between=[\"bob\", \"bob\"]'", "E-JOINT-01"},
  };
  for (const auto& c : cases) {
    const auto folder = fresh_folder("bad");
    const Ran ran = railstep_program("run " + c.words + " --trace " + (folder / "t.csv").string());
    CAPTURE(c.words, ran.err);
    CHECK(ran.code == 2);
    CHECK_THAT(ran.err, Contains(c.said));
    CHECK(ran.out.empty());
    CHECK(entries(folder) == 0);
  }
}

TEST_CASE("static and modes say that a system is for run and condense", "[run]") {
  for (const std::string& words : {"static " + kPendulum, "modes " + kCrank}) {
    const Ran ran = railstep_program(words);
    CAPTURE(words);
    CHECK(ran.code == 2);
    CHECK_THAT(ran.err, Contains("E-SCENE-02"));
    CHECK(std::count(ran.err.begin(), ran.err.end(), '\n') == 1);
  }
}

TEST_CASE("a system's report shows the paths of its sensors and its joints' residual", "[run]") {
  const auto folder = fresh_folder("report");
  const std::string page = (folder / "r.html").string(), trace = (folder / "t.csv").string();
  const Ran ran = railstep_program("run " + kCrank + " --report " + page + " --trace " + trace);
  CAPTURE(ran.err);
  REQUIRE(ran.code == 0);
  const std::string html = text_of(page);
  CHECK_THAT(html, Contains("</html>"));
  // The piston goes to and fro on a line: its path is drawn from end to end of it.
  const Rows rows = rows_of(text_of(trace));
  double from = 1e9, to = -1e9;
  for (const auto& row : rows.row) {
    from = std::min(from, row[rows.column("piston.x_m")]);
    to = std::max(to, row[rows.column("piston.x_m")]);
  }
  const Curve path = plotted(html, "<title>paths</title>", "piston");
  CHECK_THAT(*std::min_element(path.x.begin(), path.x.end()), WithinAbs(from, 1e-3 * to));
  CHECK_THAT(*std::max_element(path.x.begin(), path.x.end()), WithinAbs(to, 1e-3 * to));
  const Curve residual = plotted(html, "<title>joints</title>", "", false, true);
  CHECK_THAT(*std::max_element(residual.y.begin(), residual.y.end()),
             WithinRel(told(kCrank).at("max_constraint_violation").get<double>(), 1e-2));
}

TEST_CASE("the first unknown that is not finite is named with its part", "[run]") {
  const auto named = [](const std::string& scene, bool planar, std::int32_t unknown) {
    Simulation run(std::get<SystemScene>(
        read_any_scene(scene, {std::string("system.planar=") + (planar ? "true" : "false")})));
    run.state.v[run.model().system.first + unknown] = std::numeric_limits<double>::quiet_NaN();
    const RunRecord record = simulate(run, 10, nullptr, false);
    CHECK(record.frame_us.empty());  // the run sees it at the start and makes no step
    REQUIRE(record.first_bad_unknown >= 0);
    CHECK(unknown_place(run, record.first_bad_unknown).find("of ") != std::string::npos);
    return unknown_place(run, run.model().system.first + unknown);
  };
  CHECK(named(kPendulum, false, 9) == "x position of node 1 of beam \"upper\"");
  CHECK(named(kPendulum, true, 6) == "height of node 1 of beam \"upper\"");
  CHECK(named(kCrank, true, 2) == "turn about y of body \"crank\"");
  CHECK(named(kCrank, false, 8) == "z position of body \"rod\"");
}

TEST_CASE("a loop in three dimensions has redundant rows, and its joints are named", "[run]") {
  // Five rows of each hinge and the guide, one of the motor: 21 on 18 unknowns with one free turn.
  const std::string spatial = kCrank + " --duration 0.01 --set system.planar=false";
  const Ran direct = railstep_program("run " + spatial + " --set 'joints.hold=\"direct\"'");
  CHECK(direct.code == 0);
  CHECK_THAT(direct.err, Contains("note: redundant_joint") && Contains("augmented Lagrangian ("));
  bool named = false;
  for (const std::string name : {"bearing", "crank_pin", "wrist_pin", "guide"})
    named = named || direct.err.find(name, direct.err.find('(')) != std::string::npos;
  CHECK(named);
  CHECK(railstep_program("run " + spatial).err.empty());
}
