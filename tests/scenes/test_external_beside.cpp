// External wheels beside other traffic and one-sided supports: an external wheel presses as a load
// does, and the response for another program holds with all that gives way beside it.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "offline/energy/energy_account.h"
#include "online/step/step.h"
#include "run/simulation.h"
#include "support/shipped.h"

using namespace railstep;

namespace {

using Changes = std::vector<std::string>;

const std::string kWheel = "external_wheel=[{name=\"e\",rail=\"left\",limit_n=1e6}]";

Scene scene_of(const std::string& name, Changes words, const std::string& more) {
  words.push_back(more);
  return read_scene(shipped(name), words);
}

double force_at(double time) { return -3e4 * std::min(time / .01, 1.); }

}  // namespace

TEST_CASE("an external wheel beside others presses as a load at its place does",
          "[external_beside]") {
  for (const char* scene : {"bogie_at_speed", "hanging_sleeper"}) {
    INFO(scene);
    const double dt = read_scene(shipped(scene), {}).step->dt, place = 13.8;
    const Changes words{"step.duration_s=0.05", "condense.kind=\"full\"",
                        "step.frame_s=" + std::to_string(dt * 1e9) + "e-9"};
    Changes others = words;
    if (std::string(scene) == "hanging_sleeper") others.push_back("load=[]");
    Simulation loaded(
        scene_of(scene, words,
                 "load=[{name=\"e\",rail=\"left\",at=\"head\",force_z_n=-3e4,start_m=" +
                     std::to_string(place) + ",table=[[0.0,0.0],[0.01,1.0]]}]")),
        pressed(scene_of(scene, others, kWheel));
    const Model& model = pressed.model();
    REQUIRE(loaded.model().unknowns == model.unknowns);
    Outputs a{}, b{};
    publish_start(loaded.model(), loaded.state, a);
    publish_start(model, pressed.state, b);
    double most = 0., peak = 0.;
    for (std::int64_t n = 1; n <= model.steps; ++n) {
      const double input[] = {place, 0., 0., 0., force_at(static_cast<double>(n) * dt)};
      static_cast<void>(advance_frame(loaded.model(), loaded.state, loaded.workspace, a));
      static_cast<void>(advance_frame(model, input, pressed.state, pressed.workspace, b));
      for (std::int32_t i = 0; i < model.line_unknowns; ++i) {
        most = std::max(most, std::fabs(loaded.state.u[i] - pressed.state.u[i]));
        peak = std::max(peak, std::fabs(loaded.state.u[i]));
      }
      for (const ContactId i : contacts(model))
        CHECK(a.contact_force[i] == Approx(b.contact_force[i]).epsilon(1e-6));
    }
    CHECK(most < 1e-9 * peak);
  }
}

TEST_CASE("the force of an external wheel holds over both stages of a step", "[external_beside]") {
  const Changes words{"step.duration_s=0.05", "step.scheme=\"tr-bdf2\"", "step.dt_s=5e-5",
                      "step.frame_s=5e-5"};
  for (const char* scene : {"moving_load", "bogie_at_speed"}) {
    INFO(scene);
    Changes others = words;
    if (std::string(scene) == "moving_load") others.push_back("load=[]");
    others.push_back("condense.kind=\"full\"");
    Simulation loaded(scene_of(scene, others,
                               "load=[{name=\"e\",rail=\"left\",at=\"head\",force_z_n=-3e4,"
                               "start_m=4.7}]")),
        pressed(scene_of(scene, others, kWheel));
    const Model& model = pressed.model();
    REQUIRE(loaded.model().unknowns == model.unknowns);
    REQUIRE(model.scheme.stage_fraction > 0.);
    std::copy(loaded.state.numbers, loaded.state.numbers + 4 * model.unknowns,
              pressed.state.numbers);
    Outputs a{}, b{};
    const double input[] = {4.7, 0., 0., 0., -3e4};
    double most = 0., peak = 0.;
    for (std::int64_t n = 1; n <= model.steps; ++n) {
      static_cast<void>(advance_frame(loaded.model(), loaded.state, loaded.workspace, a));
      static_cast<void>(advance_frame(model, input, pressed.state, pressed.workspace, b));
      for (std::int32_t i = 0; i < model.line_unknowns; ++i) {
        most = std::max(most, std::fabs(loaded.state.u[i] - pressed.state.u[i]));
        peak = std::max(peak, std::fabs(loaded.state.u[i]));
      }
    }
    CHECK(most < 1e-9 * peak);
  }
}

TEST_CASE("an external wheel holds over the steps of a frame, and its response foretells it",
          "[external_beside]") {
  for (const char* scene : {"bogie_at_speed", "moving_load"})
    for (const char* kind : {"full", "modal"}) {
      INFO(scene << ' ' << kind);
      const bool beside = std::string(scene) == "bogie_at_speed";
      Changes words{"step.duration_s=0.04", "step.dt_s=1e-4",
                    std::string("condense.kind=\"") + kind + "\""};
      if (!beside) words.push_back("load=[]");
      Changes four = words, one = words;
      four.push_back("step.frame_s=4e-4");
      one.push_back("step.frame_s=1e-4");
      Simulation frames(scene_of(scene, four, kWheel)), steps(scene_of(scene, one, kWheel));
      Outputs outputs{};
      for (int n = 0; n < 100; ++n) {
        const double input[] = {3.7 + .02 * n, 1e-3, 0., 5e3, -3e4 * (n % 7)};
        double free[3], compliance[9];
        static_cast<void>(external_response(frames.model(), input, frames.state, frames.workspace,
                                            free, compliance));
        for (int m = 0; m < 4; ++m)
          static_cast<void>(
              advance_frame(steps.model(), input, steps.state, steps.workspace, outputs));
        static_cast<void>(
            advance_frame(frames.model(), input, frames.state, frames.workspace, outputs));
        REQUIRE(state_hash(frames.model(), frames.state) == state_hash(steps.model(), steps.state));
        const double by_force = compliance[7] * input[3] + compliance[8] * input[4];
        const double small = (beside ? 1e-3 : 1e-8) * std::fabs(by_force) + 1e-12;
        CHECK(free[2] + by_force == Approx(outputs.external_displacement[0][2]).margin(small));
      }
    }
}

TEST_CASE("the response under an external wheel holds with all that is beside it",
          "[external_beside]") {
  struct Cell {
    const char* scene;
    Changes words;
    double place, error;  // the latter over C f
  };
  // The wheelset stands 0.2 m beside the external wheel: its Hertz contact shows.
  const Cell cells[] = {{"bogie_at_speed", {"condense.kind=\"full\""}, 10., 1e-3},
                        {"bogie_at_speed", {"condense.kind=\"modal\""}, 10., 1e-3},
                        {"hanging_sleeper", {"condense.kind=\"full\""}, 9., 1e-3},
                        {"wheelset_on_track", {"condense.kind=\"modal\""}, 3., .02},
                        {"manchester_ring", {}, 10., 1e-3}};
  for (const Cell& cell : cells) {
    Changes words = cell.words;
    const double dt = read_scene(shipped(cell.scene), {}).step->dt;
    words.push_back("step.frame_s=" + std::to_string(dt * 1e9) + "e-9");
    Simulation run(scene_of(cell.scene, words, kWheel));
    const Model& model = run.model();
    INFO(cell.scene);
    Outputs outputs{};
    double largest = 0.;
    for (int n = 0; n < 40; ++n) {
      double input[] = {cell.place, 0., 0., 0., n < 20 ? 0. : -2e4};
      double free[3], compliance[9];
      static_cast<void>(
          external_response(model, input, run.state, run.workspace, free, compliance));
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) CHECK(compliance[3 * i + j] == compliance[3 * j + i]);
      const std::uint64_t before = state_hash(model, run.state);
      static_cast<void>(
          external_response(model, input, run.state, run.workspace, free, compliance));
      CHECK(state_hash(model, run.state) == before);
      static_cast<void>(advance_frame(model, input, run.state, run.workspace, outputs));
      const double told = free[2] + compliance[8] * input[4];
      largest = std::max(largest, std::fabs(told - outputs.external_displacement[0][2]) /
                                      std::max(std::fabs(compliance[8] * input[4]), 1e-12));
    }
    INFO("off by " << largest << " of C f");
    CHECK(largest < cell.error);
  }
}

TEST_CASE("the energy of external wheels beside others is balanced", "[external_beside]") {
  Simulation run(scene_of(
      "bogie_at_speed",
      {"condense.kind=\"full\"", "step.duration_s=0.1", "step.dt_s=5e-5", "step.frame_s=5e-5"},
      kWheel));
  EnergyAccount account(*run.packed(), run.model(), run.state);
  Outputs outputs{};
  for (std::int64_t n = 1; n <= run.model().steps; ++n) {
    const double input[] = {13.8, 0., 0., 0., force_at(5e-5 * static_cast<double>(n))};
    static_cast<void>(advance_frame(run.model(), input, run.state, run.workspace, outputs));
    account.follow(run.state);
  }
  // The account leaves out what they move each other by residual flexibility.
  CHECK(account.balance_error() < 2e-5);
}
