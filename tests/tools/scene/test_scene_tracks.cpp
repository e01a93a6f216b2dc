// Shipped scenes of tracks that are struck or heated, or whose ballast changes.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include "build/build.h"
#include "build/build_sensors.h"
#include "offline/energy/energy_account.h"
#include "offline/receptance/full_order.h"
#include "support/scene_run.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

/// Mean of a column over the rows in which another column lies between two values.
double mean(const Traced& run, const std::string& column, const std::string& of, double from,
            double to) {
  const std::vector<double> value = run[column], place = run[of];
  double sum = 0.;
  int count = 0;
  for (std::size_t i = 0; i < value.size(); ++i)
    if (place[i] >= from && place[i] <= to) {
      sum += value[i];
      ++count;
    }
  REQUIRE(count > 10);
  return sum / count;
}

/// Deflection under a unit force of an endless Timoshenko beam on an even foundation under an axial
/// force: (1/2 pi) int (1 + s q2)/((EI - N s) q4 + (k s - N) q2 + k) dq, s = EI/(k_z G A), N > 0 in
/// compression, by
///   int dq/(a q4 + b q2 + c) = pi/sqrt(c (b + 2 sqrt(ac))), int q2 dq/(..) = pi/sqrt(a (..)).
double on_foundation(const RailBar& bar, double foundation, double compression) {
  const BeamSection& section = bar.section;
  const double EI = bar.material.young * section.inertia_y;
  const double s = EI / (section.shear_factor_z * bar.material.shear_modulus() * section.area);
  const double a = EI - compression * s, b = foundation * s - compression, c = foundation;
  const double root = std::sqrt(b + 2. * std::sqrt(a * c));
  return .5 * (1. / (std::sqrt(c) * root) + s / (std::sqrt(a) * root));
}

/// int f e^(-i w t) dt of samples at equal distances, by the trapezoidal rule.
std::complex<double> transformed(const std::vector<double>& value, double dt, double hz) {
  std::complex<double> sum = 0.;
  for (std::size_t i = 0; i < value.size(); ++i) {
    const double end = i == 0 || i + 1 == value.size() ? .5 : 1.;
    sum += end * dt * value[i] * std::polar(1., -2. * M_PI * hz * static_cast<double>(i) * dt);
  }
  return sum;
}

}  // namespace

TEST_CASE("impact_hammer: blow and response give the track's receptance", "[scenes]") {
  // Frequencies at which 1 % is required: the step is fine enough and the blow has force.
  // The complex solution of the same track is the independent reference.
  const Traced run("impact_hammer");
  CHECK(run.status == Status::ok);
  const Scene scene = read_scene(kScenes + "impact_hammer.toml");
  const Track track = track_of(scene);
  const std::vector<double> struck = run["struck.dz_m"], beside = run["beside.dz_m"];
  const double frame = run["time_s"][1], width = 1e-4;
  const Functional here = *functional_of(scene.sensors[0], scene, track, 2),
                   sleeper = *functional_of(scene.sensors[1], scene, track, 2);
  FullOrderReceptance full(track, {here, {here, sleeper}});
  for (const double hz : {30., 63., 100., 200., 315., 400., 500., 700.}) {
    const double half = M_PI * hz * width;
    const std::complex<double> blow =
        -5e3 * width * std::pow(std::sin(half) / half, 2) * std::polar(1., -2. * M_PI * hz * width);
    const Eigen::VectorXcd want = full.at(hz);
    CAPTURE(hz);
    CHECK(std::abs(transformed(struck, frame, hz) / blow / want[0] - 1.) < .01);
    CHECK(std::abs(transformed(beside, frame, hz) / blow / want[1] - 1.) < .01);
  }
}

TEST_CASE("heated_track: compression softens the rails as in closed form", "[scenes]") {
  const std::string step = "step.dt_s=1e-4";  // twice the scene's: the ratio is the same
  const Traced hot("heated_track", {step}),
      even("heated_track", {step, "rail.temperature_rise_k=0.0"});
  CHECK(hot.status == Status::ok);
  const Track track = track_of(read_scene(kScenes + "heated_track.toml"));
  const RailBar bar = track.bar(0);
  CHECK_THAT(bar.axial_force, WithinRel(-1.15e-5 * 50. * 210e9 * bar.section.area, 1e-9));
  const double foundation = 1. / (1. / 200e6 + 1. / 50e6) / .6;
  const double softer =
      on_foundation(bar, foundation, -bar.axial_force) / on_foundation(bar, foundation, 0.);
  REQUIRE(softer > 1.01);
  // The closed form has an even foundation in place of seats every 0.6 m. The deflections differ by
  // a few percent, and so does their ratio's distance from 1. Inertia at 30 m/s adds (30/700)^2.
  for (const char* const load : {"load_left", "load_right"}) {
    const std::string z = std::string(load) + ".deflection_z_m", x = std::string(load) + ".x_m";
    const double ratio = mean(hot, z, x, 9., 15.) / mean(even, z, x, 9., 15.);
    CHECK_THAT((ratio - 1.) / (softer - 1.), WithinAbs(1., .1));
  }
  // No lateral motion: the track is straight and both rails have the same load.
  CHECK_THAT(hot["pad.dy_m"].back(), WithinAbs(0., 1e-12));
}

TEST_CASE("transition_zone: far from the change the track moves as on even ballast", "[scenes]") {
  // Checked are the momentum of the wheelset, which is exact for the scheme's own sums, and uniform
  // tracks with either ballast, 5 m and more from the zone. There waves have decayed to less than
  // 1e-2 of those at the zone.
  const std::string step = "step.dt_s=1e-4";  // twice the scene's, in all three
  const Traced zone("transition_zone", {step});
  CHECK(zone.status == Status::ok);
  const std::string even = "support_change=[]";
  const Traced soft("transition_zone", {step, even, "step.duration_s=0.1"}),
      stiff("transition_zone",
            {even, "ballast.stiffness_z_n_per_m=200.0e6", "ballast.damping_z_n_s_per_m=160.0e3"});
  // Height of the rail under the left wheel, m, on the way between two places.
  const auto under = [](const Traced& run, double start, double from, double to) {
    return mean(run, "wheel_left.rail_z_m", "time_s", (from - start) / 60., (to - start) / 60.);
  };
  const double before = under(soft, 6.3, 7.8, 11.4), behind = under(stiff, 22.3, 25.2, 28.8);
  CHECK_THAT(under(zone, 6.3, 7.8, 11.4), WithinRel(before, 1e-2));
  CHECK_THAT(under(zone, 6.3, 25.2, 28.8), WithinRel(behind, 1e-2));
  CHECK(before < 1.3 * behind);  // both are below 0

  double impulse = 0.;
  for (const char* const wheel : {"wheel_left", "wheel_right"})
    for (const double part : zone[std::string(wheel) + ".impulse_z_n_s"]) impulse += part;
  const double weight = 10e3 * 9.81 * zone["time_s"].back();
  // The axle's momentum changes by its mass times the speed that the rail's slope leaves it, at
  // most some 0.03 m/s.
  CHECK_THAT(impulse, WithinAbs(weight, 1200. * .03));
  // The zone shakes the wheel more than the even track does.
  const auto shaken = [](const Traced& run) {
    const std::vector<double> force = run["wheel_left.force_z_peak_n"];
    return *std::max_element(force.begin() + 20, force.end()) / (10e3 * 9.81 / 2.);
  };
  CHECK(shaken(zone) > shaken(soft) + .02);
}

TEST_CASE("energies of struck, heated, changing and irregular tracks balance below 1e-3",
          "[scenes]") {
  const std::string name = GENERATE("impact_hammer", "heated_track", "transition_zone",
                                    "dipped_joint", "wheel_flat", "corrugation");
  const Scene scene = read_scene(kScenes + name + ".toml");
  const Built built(scene);
  const Model& model = built.packed->model();
  const EnergyBalance found =
      balance_of(*built.packed, model, model.steps / model.steps_per_frame / 4);
  CAPTURE(name, found.error);
  CHECK(std::abs(found.error) < 1e-3);
}
