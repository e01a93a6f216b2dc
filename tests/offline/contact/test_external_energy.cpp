// Energy balance where wheels of a vehicle outside the model press on the track.
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "offline/energy/energy_account.h"
#include "online/step/step.h"
#include "run/simulate.h"
#include "support/program.h"
#include "support/shipped.h"
#include "support/traced.h"

using namespace railstep;

namespace {

const std::string kTwoWheels =
    "external_wheel=[{name=\"a\", rail=\"left\", limit_n=1e6}, {name=\"b\", rail=\"right\", "
    "limit_n=1e6}]";

std::vector<std::string> words_of(const std::string& kind, const std::string& unknowns,
                                  const std::string& dt) {
  return {"load=[]",
          kTwoWheels,
          "track.unknowns=\"" + unknowns + "\"",
          "condense.kind=\"" + kind + "\"",
          "step.dt_s=" + dt,
          "step.frame_s=" + dt,
          "step.duration_s=0.3",
          "support.stiffness_roll_n_m_per_rad=1e6"};
}

/// Two wheels that run at 20 m/s, or stand, under forces that oscillate along all three axes.
struct Ride {
  double speed, dt;
  std::vector<double> in = std::vector<double>(10);

  const double* at(std::int64_t frame) {
    const double t = static_cast<double>(frame + 1) * dt, swing = std::sin(200. * t);
    const double press = -4e4 * (1. - std::cos(60. * t));
    in = {3.03 + speed * t, .002, 3e3 * swing,  4e3 * swing, press,
          4.1 + speed * t,  0.,   -1e3 * swing, 2e3,         .5 * press};
    return in.data();
  }
};

EnergyBalance balance(const Simulation& run, Ride ride, std::int64_t frames) {
  return balance_of(*run.packed(), run.model(), frames, {},
                    [&ride](std::int64_t frame) { return ride.at(frame); });
}

}  // namespace

TEST_CASE("external forces do work on the path of the points under them", "[external][energy]") {
  for (const char* kind : {"full", "modal"}) {
    // Without residual flexibility the published path is that of the track's unknowns.
    std::vector<std::string> words = words_of(kind, "full", "1e-4");
    if (kind == std::string("modal")) words.emplace_back("condense.residual_flexibility=false");
    Simulation run(read_scene(kScenes + "moving_load.toml", words));
    EnergyAccount account(*run.packed(), run.model(), run.state);
    Outputs outputs{};
    publish_start(run.model(), run.state, outputs);
    Ride ride{0., 1e-4};
    double before[6] = {}, force[6] = {}, work = 0., size = 0.;
    for (int n = 0; n < 1000; ++n) {
      const double* const in = ride.at(n);
      REQUIRE(advance_frame(run.model(), in, run.state, run.workspace, outputs) == Status::ok);
      account.follow(run.state);
      for (int i = 0; i < 6; ++i) {
        const double f = in[5 * (i / 3) + 2 + i % 3];
        const double at = outputs.external_displacement[i / 3][i % 3];
        const double mean = kind == std::string("modal") ? f : .5 * (force[i] + f);
        work += mean * (at - before[i]);
        size += std::abs(mean * (at - before[i]));
        force[i] = f;
        before[i] = at;
      }
    }
    CAPTURE(kind);
    CHECK(std::abs(work) > 1.);
    // Heights also hold terms of second order in the rail's roll: 1e-4 rad here.
    CHECK(std::abs(account.flow().outside - work) < 1e-4 * size);
  }
}

TEST_CASE("energies balance under external wheels", "[external][energy]") {
  for (const char* kind : {"full", "modal"})
    for (const char* unknowns : {"vertical", "full"}) {
      const Simulation run(
          read_scene(kScenes + "moving_load.toml", words_of(kind, unknowns, "1e-4")));
      const EnergyBalance found = balance(run, {20., 1e-4}, 2000);
      CAPTURE(kind, unknowns, found.error, found.numerical_loss);
      CHECK(found.error > 0.);
      // In full order the scheme's loss is the whole error, to rounding. Condensed lines add the
      // quadrature of dissipation, which falls with the step.
      CHECK(found.error < 1e-3);
      if (kind == std::string("full"))
        CHECK(std::abs(found.error - std::abs(found.numerical_loss)) < 1e-9);
      const Simulation fine(
          read_scene(kScenes + "moving_load.toml", words_of(kind, unknowns, "2.5e-5")));
      CHECK(balance(fine, {20., 2.5e-5}, 8000).error < .5 * found.error);
    }
}

TEST_CASE("run prints the energies of a scene with external wheels", "[external][energy][cli]") {
  const auto folder = fresh_folder("external_energy");
  {
    std::ofstream table(folder / "in.csv");
    table << "time_s,wheel.x_m,wheel.force_z_n\n";
    for (int n = 0; n < 1000; ++n) {
      const double t = 1e-4 * n;
      table << t << ',' << 3. + 30. * t << ',' << -4e4 * (1. - std::cos(60. * t)) << '\n';
    }
  }
  const auto result =
      told(kScenes + "open_track.toml --duration 0.1 --inputs " + (folder / "in.csv").string());
  REQUIRE(result["energy_balance_error"].is_number());
  CHECK(result["energy_balance_error"].get<double>() > 0.);
  CHECK(result["energy_balance_error"].get<double>() < 1e-3);
  CHECK(result["numerical_loss"].is_number());
}
