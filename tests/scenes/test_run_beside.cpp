#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <limits>
#include <string>
#include <tuple>

#include "build/build.h"
#include "offline/pack/time_schemes.h"
#include "run/simulate.h"
#include "scene/scene_system.h"
#include "support/traced.h"

using namespace railstep;
using Catch::Contains;
using Catch::Matchers::WithinAbs;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// A separate scene: one or two rails of 12 bays on springs, and the given tables.
class OwnScene {
 public:
  explicit OwnScene(const std::string& name, int rails, const std::string& rest)
      : file_(fresh_folder(name) / "scene.toml") {
    std::ofstream(file_) << "schema = 1\n[track]\nunknowns = \"vertical\"\nrails = " << rails
                         << "\nbays = 12\nbay_m = 0.6\nelements_per_bay = 2\n"
                            "[rail.rectangle]\nheight_m = 0.2319\nwidth_m = 0.0375\n"
                            "[support]\nat = \"axis\"\nstiffness_z_n_per_m = 3.0e7\n"
                            "damping_z_n_s_per_m = 3.0e4\n"
                         << rest;
  }
  std::string path() const { return file_.string(); }
  SystemScene read(const std::vector<std::string>& options = {}) const {
    return std::get<SystemScene>(read_any_scene(file_, options));
  }

 private:
  std::filesystem::path file_;
};

constexpr double kPlace = 3.4, kBesideMass = 120.;

OwnScene carried_mass(const std::string& start) {
  return OwnScene("carried", 1,
                  "[step]\ndt_s = 0.5e-3\nduration_s = 0.15\nstart = \"" + start +
                      "\"\n"
                      "[[load]]\nname = \"axle\"\nstart_m = 2.0\nspeed_m_per_s = 20.0\n"
                      "force_z_n = -50.0e3\n"
                      "[[body]]\nname = \"mass\"\nmass_kg = 120.0\ninertia_kg_m2 = [5, 5, 5]\n"
                      "position_m = [3.4, 0.0, 0.0]\n"
                      "[[joint]]\nname = \"clamp\"\nkind = \"spherical\"\ntrace = true\n"
                      "between = [\"rail left\", \"mass\"]\npoint_m = [3.4, 0.0, 0.0]\n"
                      "[[sensor]]\nname = \"mass_centre\"\non = \"mass\"\n"
                      "[[sensor]]\nname = \"rail_there\"\non = \"rail\"\nposition_m = 3.4\n");
}

struct Moved {
  std::vector<double> mass, load;  // m
};

/// Motion of a rail with the mass in its matrices under the load, by dense matrices and the
/// formulas of scheme.h. The shape of a start at rest moves along with the load.
Moved by_matrices(const SystemScene& scene, bool at_rest) {
  const Track track = track_of(*scene.track);
  const std::vector<Line> lines = assemble(track);
  REQUIRE(lines.size() == 1);
  const Line& line = lines[0];
  const auto row = [&](double x) { return VectorXd(point_row(track, line, {0, x, 0., 0., 2})); };
  const VectorXd b = row(kPlace);
  const MatrixXd M = MatrixXd(line.mass) + kBesideMass * b * b.transpose(), C = line.damping,
                 K = line.stiffness;
  const double dt = scene.step.dt;
  const Scheme s = generalised_alpha(dt, scene.step.rho_inf);
  const Eigen::LDLT<MatrixXd> S(K + s.kv * C + s.kg * M), stiff(K);
  const auto force = [&](double t) {
    return VectorXd(-5e4 * row(2. + 20. * t) - kBesideMass * 9.81 * b);
  };
  VectorXd u = VectorXd::Zero(b.size()), v = u, g = u;
  if (at_rest) {
    u = stiff.solve(force(0.));
    v = stiff.solve(force(1e-5) - force(-1e-5)) / 2e-5;
  } else {
    // A track has no acceleration at the start except from the fall of the mass on it.
    g = s.kg * S.solve(VectorXd(-kBesideMass * 9.81 * b));
  }
  VectorXd a = g;
  Moved moved{{b.dot(u)}, {row(2.).dot(u)}};
  for (std::int64_t n = 1; n <= scene.step.steps; ++n) {
    const VectorXd us = u + s.uv * v + s.ua * a + s.ug * g, vs = v + s.va * a + s.vg * g;
    const double t = static_cast<double>(n) * dt;
    const VectorXd next = S.solve(force(t) + M * (s.kg * us) + C * (s.kv * us - vs));
    const VectorXd fresh = s.kg * (next - us);
    v = vs + s.kv * (next - us);
    a = s.ag * fresh + s.a0 * g + s.aa * a;
    u = next;
    g = fresh;
    moved.mass.push_back(b.dot(u));
    moved.load.push_back(row(2. + 20. * t).dot(u));
  }
  return moved;
}

/// A steel beam hinged on both rails, 1.5 m long, 60 x 60 mm.
const std::string kTie =
    "[step]\ndt_s = 1.0e-3\nduration_s = 0.02\n"
    "[[beam]]\nname = \"tie\"\nlength_m = 1.5\nelements = 4\nstart_m = [3.6, -0.75, 0.0]\n"
    "direction = [0, 1, 0]\nup = [0, 0, 1]\nrectangle = {height_m = 0.06, width_m = 0.06}\n"
    "young_pa = 210.0e9\ndensity_kg_per_m3 = 7850.0\n"
    "[[joint]]\nname = \"right_end\"\nkind = \"spherical\"\ntrace = true\n"
    "between = [\"rail right\", \"tie\"]\npoint_m = [3.6, -0.75, 0.0]\n"
    "[[joint]]\nname = \"left_end\"\nkind = \"point-on-line\"\naxis = [0, 1, 0]\ntrace = true\n"
    "between = [\"rail left\", \"tie\"]\npoint_m = [3.6, 0.75, 0.0]\n"
    "[[joint]]\nname = \"turn\"\nkind = \"point-on-plane\"\naxis = [1, 0, 0]\n"
    "between = [\"ground\", \"tie\"]\npoint_m = [3.6, 0.0, 0.03]\n"
    "[[sensor]]\nname = \"middle\"\non = \"tie\"\nposition_m = [3.6, 0.0, 0.0]\n"
    "[[sensor]]\nname = \"seat\"\non = \"rail\"\nrail = \"left\"\nposition_m = 3.6\n";

}  // namespace

TEST_CASE("a mass clamped to a rail under a moving load moves as a mass in the rail's matrices",
          "[run]") {
  for (const bool at_rest : {false, true}) {
    const OwnScene scene = carried_mass(at_rest ? "equilibrium" : "released");
    const Moved want = by_matrices(scene.read(), at_rest);
    const Rows trace = traced(scene.path());
    REQUIRE(trace.row.size() == want.mass.size());
    const std::size_t mass = trace.column("mass_centre.dz_m"),
                      rail = trace.column("rail_there.dz_m"),
                      load = trace.column("axle.deflection_z_m");
    double worst = 0., apart = 0.;
    for (std::size_t r = 0; r < want.mass.size(); ++r) {
      worst = std::max({worst, std::abs(trace.row[r][mass] - want.mass[r]),
                        std::abs(trace.row[r][load] - want.load[r])});
      apart = std::max(apart, std::abs(trace.row[r][mass] - trace.row[r][rail]));
    }
    CAPTURE(at_rest);
    // Forces converge to 1e-8 of 50 kN, over 3e7 N/m: 2e-11 m a step.
    CHECK(worst < 2e-10);
    CHECK(apart < 1e-10);  // joints.tolerance_m
    CHECK(std::abs(want.mass.back() - want.mass.front()) > 1e-5);
  }
}

TEST_CASE("a clamp carries the weight and inertia of its mass", "[run]") {
  const Rows trace = traced(carried_mass("equilibrium").path() + " --set step.rho_inf=1.0");
  const std::size_t force = trace.column("clamp.force_z_n"),
                    speed = trace.column("mass_centre.vz_m_per_s");
  CHECK_THAT(trace.row[0][force], WithinAbs(kBesideMass * 9.81, 1e-6));
  double worst = 0., most = 0.;
  for (std::size_t r = 1; r < trace.row.size(); ++r) {
    // Trapezoidal rule: m (v1 - v0) / dt is the mean of both ends' forces less weight.
    const double mean = .5 * (trace.row[r][force] + trace.row[r - 1][force]);
    const double want =
        kBesideMass * ((trace.row[r][speed] - trace.row[r - 1][speed]) / .5e-3 + 9.81);
    worst = std::max(worst, std::abs(mean - want));
    most = std::max(most, std::abs(mean - kBesideMass * 9.81));
  }
  CHECK(most > 100.);
  CHECK(worst < 1e-3);  // 1e-8 of 50 kN twice
}

TEST_CASE("a beam hinged on both rails hangs between them from the start", "[run]") {
  const OwnScene scene("tie", 2, kTie);
  const Rows trace = traced(scene.path());
  constexpr double h = .06, length = 1.5, E = 210e9, G = E / 2.6, w = 7850. * h * h * 9.81;
  const double I = h * h * h * h / 12., shear = 10. * 1.3 / (12. + 11. * .3);  // Cowper
  const double sag = 5. * w * std::pow(length, 4) / (384. * E * I) +
                     w * length * length / (8. * shear * G * h * h);
  const auto& start = trace.row[0];
  const double seat = start[trace.column("seat.dz_m")];
  // Elements of two Gauss points have Timoshenko's sag at their nodes. The difference is the square
  // of the slopes, 2e-4, and more elements do not reduce it.
  CHECK(start[trace.column("middle.dz_m")] - seat == Approx(-sag).epsilon(1e-6));
  // The joints hold the tie against its weight, upwards on part B.
  CHECK_THAT(start[trace.column("right_end.force_z_n")], WithinAbs(w * length / 2., 1e-5));
  CHECK_THAT(start[trace.column("left_end.force_z_n")], WithinAbs(w * length / 2., 1e-5));
  // Half the weight deflects each rail as a load of that size does.
  const Track track = track_of(*scene.read().track);
  double flexibility = 0.;
  for (const Line& line : assemble(track)) {
    const VectorXd b = point_row(track, line, {0, 3.6, 0., 0., 2});
    flexibility += b.dot(MatrixXd(line.stiffness).ldlt().solve(b));
  }
  CHECK(seat == Approx(-flexibility * w * length / 2.).epsilon(1e-7));
  double moved = 0.;
  for (const auto& row : trace.row)
    for (const char* column : {"middle.dz_m", "seat.dz_m"})
      moved = std::max(moved, std::abs(row[trace.column(column)] - start[trace.column(column)]));
  CHECK(moved < 1e-11);
}

TEST_CASE("a track beside a body without weight has the energies of a track alone", "[run]") {
  // Two accounts of the same flexibility: that of the track alone has its loss in closed form, that
  // of both takes the rest of the balance as loss.
  const OwnScene both = carried_mass("equilibrium");
  const OwnScene alone("alone", 1,
                       "[condense]\nresidual_flexibility = false\n"
                       "[step]\ndt_s = 0.5e-3\nduration_s = 0.15\n"
                       "[[load]]\nname = \"axle\"\nstart_m = 2.0\nspeed_m_per_s = 20.0\n"
                       "force_z_n = -50.0e3\n");
  const nlohmann::json light = told(
      both.path() + " --set 'body[0].mass_kg=1e-3' --set 'body[0].inertia_kg_m2=[1e-3,1e-3,1e-3]'");
  const nlohmann::json track = told(alone.path());
  // 1 g of some 100 kg of moving rail: 1e-5 of it.
  CHECK(light["numerical_loss"].get<double>() ==
        Approx(track["numerical_loss"].get<double>()).epsilon(1e-4));
  CHECK(light["energy_balance_error"].get<double>() ==
        Approx(track["energy_balance_error"].get<double>()).epsilon(1e-4));
}

TEST_CASE("a single rail in the plane moves as in three dimensions", "[run]") {
  const OwnScene scene = carried_mass("equilibrium");
  const std::string tight = " --set joints.force_tolerance=1e-12 --set system.planar=";
  const Rows plane = traced(scene.path() + tight + "true"),
             space = traced(scene.path() + tight + "false");
  REQUIRE(plane.row.size() == space.row.size());
  double worst = 0., moved = 0.;
  for (std::size_t r = 0; r < plane.row.size(); ++r)
    for (const char* column : {"mass_centre.dz_m", "rail_there.dz_m", "axle.deflection_z_m"}) {
      const double in_plane = plane.row[r][plane.column(column)];
      worst = std::max(worst, std::abs(in_plane - space.row[r][space.column(column)]));
      moved = std::max(moved, std::abs(in_plane - plane.row[0][plane.column(column)]));
    }
  CHECK(moved > 1e-5);
  CHECK(worst < 1e-12);  // 1e-12 of 50 kN over 3e7 N/m, and the steps' round-off
}

TEST_CASE("a scene with track and bodies reports its status with places", "[run]") {
  const OwnScene scene = carried_mass("equilibrium");
  const nlohmann::json full = told(scene.path() + " --model full");
  CHECK(full["status"].empty());
  CHECK(full["max_constraint_violation"].get<double>() < 1e-10);
  CHECK(full["energy_balance_error"].get<double>() < 1e-3);
  CHECK(full["allocations"].get<int>() == 0);
  CHECK(told(scene.path())["state_hash"] == full["state_hash"]);
  const nlohmann::json condensed = told(scene.path() + " --model condensed");
  CHECK(condensed["max_constraint_violation"].get<double>() < 1e-10);
  CHECK(condensed["energy_balance_error"].get<double>() < 1e-3);
  for (const std::string command : {"static ", "modes "}) {
    const Ran ran = railstep_program(command + scene.path());
    CHECK(ran.code == 2);
    CHECK_THAT(ran.err, Contains("E-SCENE-02"));
  }
  const auto page = fresh_folder("report") / "r.html";
  CHECK(railstep_program("run " + scene.path() + " --report " + page.string()).code == 0);
  CHECK_THAT(text_of(page),
             Contains("Left rail, its axis along the track") && Contains("Paths of the sensors"));
  Simulation run(scene.read());
  const SystemModel& s = run.model().system;
  CHECK(unknown_place(run, 0).find("rail node") != std::string::npos);
  CHECK(unknown_place(run, s.first + s.body[0].first + 2) == "z position of body \"mass\"");
  CHECK(unknown_place(run, s.first + s.port[0].first) ==
        "a place of the left rail that a joint or spring pulls at");
}

TEST_CASE("a ram moves its load as driven and the trace has its force", "[run]") {
  const auto file = fresh_folder("ram") / "ram.toml";
  std::ofstream(file) << "schema = 1\n[step]\ndt_s = 1e-3\nduration_s = 0.5\n"
                         "scheme = \"energy-momentum\"\n"
                         "[[body]]\nname = \"table\"\nmass_kg = 50.0\ninertia_kg_m2 = [1, 1, 1]\n"
                         "position_m = [0, 0, 0.8]\n"
                         "[[joint]]\nname = \"guide\"\nkind = \"prismatic\"\naxis = [0, 0, 1]\n"
                         "between = [\"ground\", \"table\"]\npoint_m = [0, 0, 0.8]\n"
                         "[[joint]]\nname = \"ram\"\nkind = \"distance\"\ntrace = true\n"
                         "between = [\"ground\", \"table\"]\npoint_m = [0, 0, 0]\n"
                         "other_point_m = [0, 0, 0.8]\npolynomial_m = [0, 0, 0.5, -0.4]\n"
                         "[[sensor]]\nname = \"top\"\non = \"table\"\n";
  // A cubic's acceleration is exact but for joints.tolerance_m over dt^2, 1e-4 m/s2. With
  // energy-momentum the force is that of the step's middle, along the line at its end: over 0.8 m
  // and at 0.21 m/s this adds 1.3e-4 of up to 600 N. The midpoint's velocities vary by dt^2 / 12 of
  // the third derivative, its accelerations by dt / 6.
  const double exact = 50. * 1e-4, mean = 600. * .26 * .5e-3 + 50. * 2.4 * 1e-3 / 6.;
  for (const auto& [scheme, late, most] :
       {std::tuple{"generalised-alpha", 0., exact}, std::tuple{"energy-momentum", .5e-3, mean}}) {
    const Rows trace = traced(file.string() + " --set 'step.scheme=\"" + scheme + "\"'");
    const std::size_t z = trace.column("top.dz_m"), force = trace.column("ram.force_z_n");
    double off = 0., wrong = 0.;
    for (std::size_t r = 1; r < trace.row.size(); ++r) {
      const double t = trace.row[r][0];
      off = std::max(off, std::abs(trace.row[r][z] - (.5 * t * t - .4 * t * t * t)));
      const double want = 50. * (9.81 + 1. - 2.4 * (t - late));
      wrong = std::max(wrong, std::abs(trace.row[r][force] - want));
    }
    CAPTURE(scheme);
    CHECK(off < 1e-9);  // joints.tolerance_m, and the distance's square over twice its length
    CHECK(wrong < most);
  }
}
