#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "online/model/external_input.h"
#include "online/step/step.h"
#include "run/simulation.h"
#include "support/program.h"
#include "support/shipped.h"

using namespace railstep;
using Catch::Contains;

namespace {

using Words = std::vector<std::string>;

Words both(Words a, const Words& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// A run with its last outputs.
struct Run {
  std::unique_ptr<Simulation> simulation;
  Outputs outputs{};
  explicit Run(const std::string& name, const Words& words)
      : simulation(simulation_of(read_any_scene(kScenes + name + ".toml", words))) {
    publish_start(model(), simulation->state, outputs);
  }
  const Model& model() const { return simulation->model(); }
  void start_at_rest() { std::fill_n(simulation->state.u, 4 * model().unknowns, 0.); }
  Status frame(const std::vector<double>& inputs) {
    return advance_frame(model(), inputs.empty() ? nullptr : inputs.data(), simulation->state,
                         simulation->workspace, outputs);
  }
};

Words track_of(const std::string& kind, const std::string& unknowns) {
  return {"track.unknowns=\"" + unknowns + "\"",
          "condense.kind=\"" + kind + "\"",
          "step.dt_s=1e-4",
          "step.frame_s=1e-4",
          "step.duration_s=0.3",
          "support.stiffness_roll_n_m_per_rad=1e6"};
}

const Words kTwo = {
    "load=[]",
    "external_wheel=[{name=\"a\", rail=\"left\", limit_n=1e6}, {name=\"b\", rail=\"right\", "
    "limit_n=1e6}]"};

}  // namespace

TEST_CASE("free motion and compliance give the frame's displacements for any forces",
          "[external]") {
  for (const char* kind : {"full", "modal"})
    for (const char* unknowns : {"vertical", "full"}) {
      Run run("moving_load", both(track_of(kind, unknowns), kTwo));
      const Model& model = run.model();
      REQUIRE(model.external_wheels == 2);
      REQUIRE(model.inputs == 10);
      CAPTURE(kind, unknowns);
      double free[6], compliance[36];
      std::vector<double> in(10);
      for (int n = 0; n < 40; ++n) {
        in = {4.1 + .003 * n,
              .001,
              300. * std::sin(n),
              2e3 * std::cos(n),
              -50e3 + 1e3 * (n % 7),
              4.7 + .003 * n,
              -.002,
              -150.,
              900. * std::sin(.3 * n),
              -40e3};
        const std::uint64_t before = state_hash(model, run.simulation->state);
        REQUIRE(external_response(model, in.data(), run.simulation->state,
                                  run.simulation->workspace, free, compliance) == Status::ok);
        CHECK(state_hash(model, run.simulation->state) == before);
        REQUIRE(run.frame(in) == Status::ok);
        for (int i = 0; i < 6; ++i) {
          double want = free[i], size = std::abs(free[i]);
          for (int j = 0; j < 6; ++j) {
            const int input = kExternalInputs * (j / 3) + kExternalForce + j % 3;
            const double force = in[static_cast<std::size_t>(input)];
            want += compliance[6 * i + j] * force;
            size += std::abs(compliance[6 * i + j] * force);
            CHECK(compliance[6 * i + j] == compliance[6 * j + i]);
          }
          // A solve of some hundred unknowns rounds some hundred times in the largest term.
          CHECK(std::abs(run.outputs.external_displacement[i / 3][i % 3] - want) <=
                1e-13 * size + 1e-18);
        }
        for (int i = 2; i < 6; i += 3) CHECK(compliance[6 * i + i] > 0.);
      }
    }
}

TEST_CASE("two external wheels in one bay affect each other as on a fine rail", "[external]") {
  const Words two = {"load=[]", "step.duration_s=0.5",
                     "external_wheel=[{name=\"a\", rail=\"left\", limit_n=1e6}, {name=\"b\", "
                     "rail=\"left\", limit_n=1e6}]"};
  const auto settled = [&](const char* kind, int elements, bool residual) {
    Run run("moving_load",
            both(both(track_of(kind, "vertical"), two),
                 {"track.elements_per_bay=" + std::to_string(elements),
                  std::string("condense.residual_flexibility=") + (residual ? "true" : "false")}));
    const std::vector<double> in = {4.45, 0., 0., 0., -50e3, 4.65, 0., 0., 0., 0.};
    for (int n = 0; n < 5000; ++n) REQUIRE(run.frame(in) == Status::ok);
    return run.outputs.external_displacement[1][2];  // under the wheel without force
  };
  const double want = settled("full", 8, true);
  for (const char* kind : {"full", "modal"}) {
    const double got = settled(kind, 1, true), bare = settled(kind, 1, false);
    CAPTURE(kind, want, got, bare);
    // Cubics read tables of four intervals; without tables the other wheel errs by 0.08 %.
    CHECK(std::abs(got / want - 1.) < 1e-4);
    CHECK(std::abs(bare / want - 1.) > 5e-4);
  }
}

TEST_CASE("an external force moves the rail as a load in the model does", "[external]") {
  for (const char* unknowns : {"vertical", "full"}) {
    Run inside("moving_load",
               both(track_of("full", unknowns), {"load[0].at=\"head\"", "load[1].at=\"head\""}));
    Run outside("moving_load", both(track_of("full", unknowns), kTwo));
    // The load in the model acts on the track from the start, the external force from a step later.
    inside.start_at_rest();
    for (int n = 1; n <= 500; ++n) {
      REQUIRE(inside.frame({}) == Status::ok);
      const double x = .3 + 30. * (n * 1e-4);
      REQUIRE(outside.frame({x, 0., 0., 0., -50e3, x, 0., 0., 0., -50e3}) == Status::ok);
      for (int i = 0; i < 2; ++i)
        CHECK(std::abs(outside.outputs.external_displacement[i][2] -
                       inside.outputs.load_deflection[i]) < 1e-13);
    }
    CHECK(inside.outputs.load_deflection[0] < -1e-4);
  }
}

TEST_CASE("the force of a vehicle moves the rail in the same way when it is external",
          "[external]") {
  const Words vehicle = {
      "load=[]",
      "vehicle=[{name=\"v\", type=\"sprung_mass\", rail=\"left\", mass_kg=5000, "
      "unsprung_mass_kg=900, stiffness_n_per_m=1e6, damping_n_s_per_m=2e4, start_m=0.3, "
      "speed_m_per_s=30}]",
      "step.start=\"equilibrium\""};
  for (const char* kind : {"full", "modal"}) {
    Run inside("moving_load", both(track_of(kind, "vertical"), vehicle));
    Run outside("moving_load", both(track_of(kind, "vertical"), kTwo));
    double most = 0.;
    for (int n = 1; n <= 400; ++n) {
      REQUIRE(inside.frame({}) == Status::ok);
      const double x = inside.outputs.contact_place[0];
      REQUIRE(outside.frame({x, 0., 0., 0., -inside.outputs.contact_force[0], x, 0., 0., 0., 0.}) ==
              Status::ok);
      most = std::max(most, std::abs(outside.outputs.external_displacement[0][2]));
    }
    CHECK(most > 1e-4);
    // Only the start differs: inside it is in equilibrium, outside the rail is unloaded.
    CHECK(outside.outputs.external_displacement[0][2] ==
          Approx(inside.outputs.contact_rail_z[0]).epsilon(.02));
  }
}

TEST_CASE("the rail's velocity is the rate of its displacement", "[external]") {
  for (const char* kind : {"full", "modal"}) {
    Run run("moving_load", both(track_of(kind, "vertical"), kTwo));
    double last = 0., largest = 0., missed = 0.;
    for (int n = 1; n <= 2000; ++n) {  // a force that grows smoothly at one place
      const double f = -25e3 * (1. - std::cos(3.14159265358979 * n / 2000.));
      REQUIRE(run.frame({4.3, 0., 0., 0., f, 0., 0., 0., 0., 0.}) == Status::ok);
      const double z = run.outputs.external_displacement[0][2];
      const double v = run.outputs.external_velocity[0][2];
      if (n > 200) {
        largest = std::max(largest, std::abs(v));
        missed = std::max(missed, std::abs((z - last) / 1e-4 - v));
      }
      last = z;
    }
    CAPTURE(kind);
    CHECK(largest > 1e-3);
    // Half a step's change of the velocity, and the share of the residual flexibility.
    CHECK(missed < .05 * largest);
  }
}

TEST_CASE("an external wheel off the rail moves nothing and sets its status", "[external]") {
  Run run("moving_load", both(track_of("full", "vertical"), kTwo));
  const auto place = [&](double x, double y) {
    return run.frame({x, y, 0., 0., -50e3, 1., 0., 0., 0., 0.});
  };
  for (const auto& [x, y] : {std::pair{-.1, 0.}, std::pair{9.7, 0.}, std::pair{3., .2}}) {
    CHECK(has(place(x, y), Status::off_rail));
    CHECK_FALSE(run.outputs.external_on_rail[0]);
    CHECK(run.outputs.external_displacement[0][2] == 0.);
    CHECK(run.outputs.external_displacement[1][2] == 0.);
  }
  CHECK(place(3., 0.) == Status::ok);
  CHECK(run.outputs.external_displacement[0][2] < 0.);
}

TEST_CASE("an external wheel without the limit of its force is refused in one sentence",
          "[external][cli]") {
  const Ran ran = railstep_program("run " + kScenes + "moving_load.toml " +
                                   "--set 'external_wheel=[{name=\"a\", rail=\"left\"}]'");
  CHECK(ran.code == 2);
  CHECK_THAT(ran.err, Contains("limit_n"));
}
