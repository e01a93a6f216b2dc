// Rails that do not give way, under all that runs on a track.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include "online/math/pi.h"
#include "support/bad_input.h"
#include "support/scene_run.h"

using namespace railstep;
using Catch::Matchers::WithinRel;

namespace {

const std::string kRigid = "schema = 1\n[track]\nform = \"rigid\"\n";

std::string step_of(double dt, double duration) {
  return "[step]\ndt_s = " + std::to_string(dt) + "\nduration_s = " + std::to_string(duration) +
         "\n";
}

/// A sprung mass on a wheel with a linear contact.
std::string sprung(double speed) {
  return "[[vehicle]]\nname = \"v\"\ntype = \"sprung_mass\"\nmass_kg = 4000.0\n"
         "unsprung_mass_kg = 900.0\nstiffness_n_per_m = 1.2e6\n"
         "damping_n_s_per_m = 2.0e4\ncontact = \"linear\"\n"
         "contact_stiffness_n_per_m = 1.0e9\nstart_m = 1.0\nspeed_m_per_s = " +
         std::to_string(speed) + "\n";
}

std::string wheelset() {
  return "[[wheelset]]\nname = \"w\"\nwheels = [\"left\", \"right\"]\nmass_kg = 1200.0\n"
         "inertia_roll_kg_m2 = 700.0\ninertia_spin_kg_m2 = 100.0\ninertia_yaw_kg_m2 = 700.0\n"
         "radius_m = 0.46\ncarried_mass_kg = 8800.0\nstart_m = 4.5\nspeed_m_per_s = 20.0\n";
}

}  // namespace

TEST_CASE("a sprung mass on wavy rigid rails swings as its transfer function says", "[rigid]") {
  constexpr double kWave = 2., kSpeed = 20., kDepth = 1e-4;
  const std::string rails = kRigid + "rails = 1\nlength_m = 100.0\n" + sprung(kSpeed) +
                            "[[defect]]\nkind = \"corrugation\"\nfrom_m = 2.0\nto_m = 98.0\n"
                            "wavelength_m = 2.0\namplitude_m = 1.0e-4\ncontact_patch_m = 0.0\n";
  // (k + i w c - w^2 m) of the masses over contact and spring, driven by the rail's height.
  const double w = 2. * kPi * kSpeed / kWave;
  const std::complex<double> spring{1.2e6, w * 2e4}, contact = 1e9;
  const std::complex<double> body = spring - w * w * 4000.;
  const std::complex<double> wheel = spring - w * w * 900. - spring * spring / body;
  const double wanted = std::abs(contact * wheel / (contact + wheel)) * kDepth;
  double error = 0.;
  for (const double dt : {2e-4, 1e-4}) {
    const Traced run(scene_of(rails + step_of(dt, 4.5)));
    const std::vector<double> force = run["v.wheel_1.force_z_n"];
    double least = 1e9, most = 0.;
    for (auto i = static_cast<std::size_t>(3. / dt); i < static_cast<std::size_t>(4. / dt); ++i) {
      least = std::min(least, force[i]);
      most = std::max(most, force[i]);
    }
    const double now = std::abs(.5 * (most - least) / wanted - 1.);
    if (error > 0.) CHECK(now < .5 * error);  // of higher order than the first
    error = now;
  }
  CHECK(error < 2e-3);
}

TEST_CASE("a wheelset stands on rigid rails as on the stiffest ones", "[rigid]") {
  for (const char* kind : {"full", "modal"})
    for (const char* more : {"", "length_m = 60.0\n"}) {
      const Traced run(scene_of(kRigid + more + wheelset() + step_of(1e-4, .2),
                                {std::string("condense.kind=\"") + kind + "\""}));
      CHECK(run.status == Status::ok);
      for (const char* side : {"left", "right"}) {
        const std::vector<double> force = run[std::string(side) + ".force_z_n"];
        for (const double f : force) CHECK_THAT(f, WithinRel(.5 * 1e4 * 9.81, 1e-9));
        for (const double z : run[std::string(side) + ".rail_z_m"]) CHECK(z == 0.);
      }
    }
}

TEST_CASE("rigid rails are the limit of stiff ones", "[rigid]") {
  const std::string flexible =
      "schema = 1\n[track]\nunknowns = \"vertical\"\nrails = 1\nbays = 40\nbay_m = 0.3\n"
      "elements_per_bay = 1\n[rail]\nprofile = \"" +
      std::string(RAILSTEP_SOURCE) +
      "/config/profiles/60e1.toml\"\nyoung_pa = 1.0e12\n[support]\nat = \"foot\"\n"
      "stiffness_z_n_per_m = 1.0e11\n";
  const std::string rest = sprung(10.) +
                           "[[defect]]\nkind = \"corrugation\"\nfrom_m = 2.0\nto_m = 8.0\n"
                           "wavelength_m = 0.2\namplitude_m = 1.0e-4\ncontact_patch_m = 0.0\n" +
                           step_of(1e-4, .8);
  const Traced rigid(scene_of(kRigid + "rails = 1\nlength_m = 12.0\n" + rest));
  const std::vector<double> wanted = rigid["v.wheel_1.force_z_n"];
  std::vector<double> apart;
  for (const char* stiffness : {"2.5e11", "1.0e12"}) {
    const std::string young = stiffness == std::string("2.5e11") ? "2.5e12" : "1.0e13";
    const Traced stiff(scene_of(
        flexible + rest,
        {std::string("support.stiffness_z_n_per_m=") + stiffness, "rail.young_pa=" + young}));
    const std::vector<double> force = stiff["v.wheel_1.force_z_n"];
    REQUIRE(force.size() == wanted.size());
    double swing = 0., most = 0.;
    for (std::size_t i = 0; i < force.size(); ++i) {
      swing = std::max(swing, std::abs(wanted[i] - wanted[0]));
      most = std::max(most, std::abs(wanted[i] - force[i]));
    }
    apart.push_back(most / swing);
  }
  CHECK(apart[0] < .1);
  CHECK(apart[1] < .3 * apart[0]);  // four times as stiff, a quarter as far away
}

TEST_CASE("loads and external wheels find rigid rails where they are", "[rigid]") {
  const Traced run(scene_of(kRigid +
                            "[[load]]\nname = \"l\"\nrail = \"left\"\nforce_z_n = -1.0e5\n"
                            "start_m = 1.0\nspeed_m_per_s = 20.0\n"
                            "[[external_wheel]]\nname = \"e\"\nrail = \"right\"\n"
                            "limit_n = 1.0e5\n" +
                            step_of(1e-4, .01)));
  for (const char* column : {"l.deflection_z_m", "e.dz_m"})
    for (const double z : run[column]) CHECK(z == 0.);
}

TEST_CASE("keys of a track that gives way are refused on rigid rails", "[rigid][bad_input]") {
  for (const char* key : {"track.bays=4", "track.model=\"nonlinear\"", "support.at=\"foot\"",
                          "sleeper.mass_kg=300.0"})
    CHECK_THROWS_AS(scene_of(kRigid + wheelset() + step_of(1e-4, .1), {key}), InputError);
}
