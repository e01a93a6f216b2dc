// Forces on bodies of vehicles, by tables and given frame by frame.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "offline/energy/energy_account.h"
#include "run/inputs.h"
#include "run/simulate.h"
#include "support/program.h"
#include "support/vehicles.h"

using namespace railstep;
using Catch::Contains;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

const std::string kTrack = std::string(RAILSTEP_SOURCE) + "/config/scenes/moving_load.toml";
constexpr double kPress = 2e4;  // N
enum { kRise = 0, kTurn = 1 };  // coordinates of a bogie's frame

/// A constant force along a coordinate.
std::vector<OuterForce> constant(int coordinate, double force) {
  return {{coordinate, {0., force}, -1}};
}

ModelRun standing_bogie(bool modal, double carried, const std::vector<OuterForce>& forces,
                        double dt = 1e-4, const std::vector<double>& limits = {}) {
  BogieData data = kBogie;
  data.carried = carried;
  RunningVehicle v = running(bogie(data), 15.13, 0.);
  v.forces = forces;
  const Track track = one_rail(50);
  return from_rest(track, {.vehicles = {v}, .input_limits = limits}, options_of(modal, track, dt));
}

/// Overrides for a bogie on one rail with a force on its frame.
std::vector<std::string> bogie_scene(const std::string& kind, const std::string& force,
                                     const std::string& rail = "left") {
  return {"load=[]",
          "condense.kind=\"" + kind + "\"",
          "step.dt_s=1e-4",
          "step.frame_s=1e-3",
          "step.duration_s=0.1",
          "vehicle=[{name=\"v\", rail=\"" + rail +
              "\", type=\"bogie\", frame_mass_kg=1307.5, frame_inertia_kg_m2=738, "
              "wheel_mass_kg=906.5, wheelbase_m=1.8, primary_stiffness_n_per_m=1.22e6, "
              "primary_damping_n_s_per_m=4e3, carried_mass_kg=8000, start_m=2, speed_m_per_s=20, "
              "force=[{" +
              force + "}]}]"};
}

/// A push of 30 kN or kN m from frame 20 on.
const double* from_frame_20(std::int64_t frame) {
  static const double none = 0., pushed = 3e4;
  return frame < 20 ? &none : &pushed;
}

std::vector<double> rows_of_run(const std::vector<std::string>& words, bool given) {
  Simulation run(read_scene(kTrack, words));
  return simulate(run, 60, nullptr, true, {}, given ? FrameInputs(from_frame_20) : FrameInputs{})
      .rows;
}

/// Height of the first frame after 60 frames of bogie_scene() without a force, m.
double unforced(const std::string& kind, const std::string& rail) {
  Simulation run(read_scene(
      kTrack, bogie_scene(kind, "body=\"frame\", direction=\"z\", table=[[0.0, 0.0]]", rail)));
  simulate(run, 60, nullptr, false);
  return run.state.u[run.model().vehicle[0].first];
}

}  // namespace

TEST_CASE("a constant force on a frame acts as additional weight", "[vehicle][inputs]") {
  for (const bool modal : {false, true}) {
    ModelRun pressed = standing_bogie(modal, 8000., constant(kRise, -kPress));
    ModelRun heavier = standing_bogie(modal, 8000. + kPress / 9.81, {});
    CAPTURE(modal);
    for (int n = 0; n < 200; ++n) {
      pressed.step();
      heavier.step();
    }
    CHECK(pressed.seen == Status::ok);
    const SuspendedModel& v = pressed.model().vehicle[0];
    // Both equilibria are exact to 1e-10 of a force; rounding over 200 steps.
    for (int i = 0; i < 2; ++i)
      CHECK_THAT(pressed.outputs.contact_force[i],
                 WithinRel(heavier.outputs.contact_force[i], 1e-8));
    for (int k = 0; k < v.size; ++k)
      CHECK_THAT(pressed.state.u[v.first + k], WithinAbs(heavier.state.u[v.first + k], 1e-10));
  }
}

TEST_CASE("a force that rises on a frame is followed to the second order of the step",
          "[vehicle][inputs]") {
  for (const bool modal : {false, true}) {
    std::vector<double> height;
    for (const double dt : {8e-4, 4e-4, 2e-4}) {
      ModelRun run = standing_bogie(modal, 8000., {{kRise, {0., 0., 1., -2e6}, -1}}, dt);
      for (int n = 0; n < std::lround(.04 / dt); ++n) run.step();
      CHECK(run.seen == Status::ok);
      height.push_back(run.state.u[run.model().vehicle[0].first]);
    }
    const double ratio = (height[0] - height[1]) / (height[1] - height[2]);
    CAPTURE(modal, height[2], height[1] - height[2]);
    CHECK(ratio > 3.);
  }
}

TEST_CASE("a moment on a frame shifts force to the front wheel by moment over wheelbase",
          "[vehicle][inputs]") {
  const double moment = 6e3;
  for (const bool modal : {false, true}) {
    const ModelRun level = standing_bogie(modal, 8000., {});
    const ModelRun leant = standing_bogie(modal, 8000., constant(kTurn, moment));
    for (const int i : {0, 1})  // the forces of two wheels follow from statics
      CHECK_THAT(leant.state.contact_force[i] - level.state.contact_force[i],
                 WithinRel((i == 0 ? 1. : -1.) * moment / kBogie.wheelbase, 1e-8));
  }
}

TEST_CASE("a vehicle without weight is pressed down by a force and has no equilibrium without one",
          "[vehicle][inputs]") {
  const Track track = one_rail(20);
  RunningVehicle v = running(bogie(kBogie), 5.3, 0.);
  v.gravity = 0.;
  const PackOptions options = options_of(false, track, 1e-4);
  CHECK_THROWS_WITH(from_rest(track, {.vehicles = {v}}, options), Contains("E-START-08"));
  v.forces = constant(kTurn, 6e3);
  CHECK_THROWS_WITH(from_rest(track, {.vehicles = {v}}, options), Contains("E-START-08"));
  v.forces = constant(kRise, -kPress);
  const ModelRun run = from_rest(track, {.vehicles = {v}}, options);
  for (const int i : {0, 1}) CHECK_THAT(run.state.contact_force[i], WithinRel(.5 * kPress, 1e-8));
  // A moment does not count as weight, whatever its size.
  v.forces = {{kRise, {0., -1e4}, -1}, {kTurn, {0., 1.2e4}, -1}};
  const ModelRun leant = from_rest(track, {.vehicles = {v}}, options);
  for (const int i : {0, 1})
    CHECK_THAT(leant.state.contact_force[i],
               WithinRel(5e3 + (i == 0 ? 1. : -1.) * 1.2e4 / kBogie.wheelbase, 1e-8));
}

TEST_CASE("under a constant input a bogie settles where the same weight would hold it",
          "[vehicle][inputs]") {
  for (const bool modal : {false, true}) {
    ModelRun run = standing_bogie(modal, 8000., {{kRise, {}, 0}}, 1e-3, {1e6});
    const ModelRun heavier = standing_bogie(modal, 8000. + kPress / 9.81, {}, 1e-3);
    run.state.input[0] = -kPress;
    // The frame's bounce shrinks by e^3 each second: 1e-10 of it is left.
    for (int n = 0; n < 8000; ++n) run.step();
    CAPTURE(modal);
    for (int i = 0; i < 2; ++i)
      CHECK_THAT(run.outputs.contact_force[i], WithinRel(heavier.state.contact_force[i], 1e-7));
    const SuspendedModel& v = run.model().vehicle[0];
    for (int k = 0; k < v.size; ++k)
      CHECK_THAT(run.state.u[v.first + k], WithinAbs(heavier.state.u[v.first + k], 1e-9));
  }
}

TEST_CASE("an input on a vehicle gives the same bits as a table of the same force",
          "[vehicle][inputs]") {
  for (const char* kind : {"full", "modal"})
    for (const std::string on :
         {"body=\"frame\", direction=\"z\"", "body=\"wheel_2\", direction=\"z\"",
          "body=\"frame\", direction=\"pitch\""}) {
      std::string input = on + ", input=\"push\", limit_n";
      input += on.find("pitch") == std::string::npos ? "=1e5" : "_m=1e5";
      const auto by_input = rows_of_run(bogie_scene(kind, input), true);
      CAPTURE(kind, on);
      CHECK(by_input == rows_of_run(bogie_scene(kind, on + ", table=[[0.020001, 3e4]]"), false));
      CHECK(by_input != rows_of_run(bogie_scene(kind, on + ", table=[[0, 0]]"), false));
    }
}

TEST_CASE("one input pushes both halves of a vehicle on two rails", "[vehicle][inputs]") {
  Simulation run(read_scene(
      kTrack,
      bogie_scene("full", "body=\"frame\", direction=\"z\", input=\"push\", limit_n=1e5", "both")));
  CHECK(run.inputs() == std::vector<std::string>{"push.force_n"});
  simulate(run, 60, nullptr, false, {}, from_frame_20);
  const SuspendedModel *left = &run.model().vehicle[0], *right = left + 1;
  for (int k = 0; k < left->size; ++k)
    CHECK_THAT(run.state.u[left->first + k], WithinAbs(run.state.u[right->first + k], 1e-12));
  // 30 kN lift a frame of 1.3 t by half an acceleration of 23 m/s2 times (40 ms)^2 at most.
  const double lifted = run.state.u[left->first] - unforced("full", "both");
  CHECK(lifted > 1e-3);
  CHECK(lifted < 20e-3);
}

TEST_CASE("a block keeps the forces on its vehicles", "[vehicle][inputs]") {
  for (const char* force : {"table=[[0.020001, 3e4]]", "input=\"push\", limit_n=1e5"}) {
    Simulation run(read_scene(
        kTrack, bogie_scene("modal", std::string("body=\"frame\", direction=\"z\", ") + force)));
    Simulation loaded(run.block(), "block");
    const bool given = !run.inputs().empty();
    for (Simulation* each : {&run, &loaded}) {
      simulate(*each, 60, nullptr, false, {}, given ? FrameInputs(from_frame_20) : FrameInputs{});
      CHECK(each->state.u[each->model().vehicle[0].first] > unforced("modal", "left") + 1e-3);
    }
    CHECK(state_hash(run.model(), run.state) == state_hash(loaded.model(), loaded.state));
  }
}

TEST_CASE("forces on vehicles do work along their bodies' motion, and energies balance",
          "[vehicle][inputs][energy]") {
  for (const bool modal : {false, true})
    for (const int coordinate : {static_cast<int>(kRise), static_cast<int>(kTurn)}) {
      ModelRun run = standing_bogie(modal, 8000., {{coordinate, {}, 0}}, 1e-4, {1e6});
      EnergyAccount account(*run.packed, run.model(), run.state);
      double* const moved = run.state.u + run.model().vehicle[0].first + coordinate;
      double work = 0.;
      for (int n = 1; n <= 2000; ++n) {
        const double f0 = run.state.input[0], u0 = *moved;
        run.state.input[0] = 1e4 * std::sin(40. * n * 1e-4);
        run.step();
        account.follow(run.state);
        work += .5 * (f0 + run.state.input[0]) * (*moved - u0);
      }
      CAPTURE(modal, coordinate);
      CHECK(std::abs(work) > 10.);  // it swings near its own frequency
      CHECK_THAT(account.flow().forces, WithinRel(work, 1e-12));
      // Forces held over a step lose omega dt / 2 of their work, 40 * 1e-4 / 2. Condensed lines add
      // the quadrature error of their dampers, which is of second order in dt.
      CHECK(account.balance_error() < (modal ? 2e-3 : 1e-4));
      CHECK(std::abs(account.imbalance() + account.flow().loss) <
            (modal ? 1e-4 : 1e-7) * account.turned_over());
    }
}

TEST_CASE("bad forces on vehicles are refused in one sentence", "[vehicle][inputs][cli]") {
  const auto told = [](const std::string& force) {
    try {
      static_cast<void>(read_scene(kTrack, bogie_scene("full", force)));
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("it is read");
  };
  const std::string frame = "body=\"frame\", ", up = frame + "direction=\"z\", ";
  CHECK_THAT(told("direction=\"z\", table=[[0, 1]]"), Contains("body"));
  CHECK_THAT(told("body=\"car\", direction=\"z\", table=[[0, 1]]"),
             Contains("[vehicle[0].force[0]]") &&
                 Contains("expected one of frame, wheel_1, wheel_2 [E-VEHICLE-12]"));
  CHECK_THAT(told("body=\"wheel_1\", direction=\"pitch\", table=[[0, 1]]"),
             Contains("wheel_1 does not pitch; expected \"z\" [E-VEHICLE-13]"));
  CHECK_THAT(told(frame + "direction=\"x\", table=[[0, 1]]"),
             Contains("direction") && Contains("pitch"));
  CHECK_THAT(told(up + "tabel=[[0, 1]]"), Contains("table"));
  CHECK_THAT(told(up + "table=[[0, 1e9]]"), Contains("E-RUNNER-21"));
  CHECK_THAT(told(up + "input=\"push\""), Contains("limit_n"));
  CHECK_THAT(told(frame + "direction=\"pitch\", input=\"push\", limit_n=1"), Contains("limit_n_m"));
  CHECK_THAT(told(up + "input=\"push\", limit_n=1, table=[[0, 1]]"), Contains("E-RUNNER-25"));
  CHECK_THAT(told(up + "input=\"push\", limit_n=1}, {" + up + "input=\"push\", limit_n=1"),
             Contains("E-RUNNER-17"));
  const Track track = one_rail(20);
  RunningVehicle v = running(bogie(kBogie), 5.3, 0.);
  const auto refused = [&](std::vector<OuterForce> forces) {
    v.forces = std::move(forces);
    return [&track, &v] {
      static_cast<void>(PackedModel(track, {.vehicles = {v}}, options_of(false, track, 1e-4)));
    };
  };
  CHECK_THROWS_WITH(refused(std::vector<OuterForce>(5, {0, {0., 1.}, -1}))(),
                    Contains("on a vehicle; expected at most 4 [E-PACK-13]"));
  CHECK_THROWS_WITH(refused({{4, {0., 1.}, -1}})(), Contains("E-PACK-44"));
  CHECK_THROWS_WITH(refused({{0, {}, 0}})(), Contains("E-PACK-14"));
}

TEST_CASE("static counts a vehicle's forces at the start as weight", "[vehicle][inputs][cli]") {
  const auto sensor = [](double carried, double force) {
    std::string words = "static " + kTrack;
    for (const std::string& word : bogie_scene(
             "full", "body=\"frame\", direction=\"z\", table=[[0, " + std::to_string(force) + "]]"))
      words += " --set '" + word + "'";
    words += " --set vehicle[0].carried_mass_kg=" + std::to_string(carried);
    words += " --set 'sensor=[{name=\"at\", on=\"rail\", rail=\"left\", position_m=2}]' --json";
    const Ran ran = railstep_program(words);
    CAPTURE(words, ran.err);
    REQUIRE(ran.code == 0);
    const std::size_t at = ran.out.find("displacement_m");
    return ran.out.substr(at, 80);
  };
  CHECK(sensor(8000., -9810.) != sensor(8000., 0.));
  CHECK(sensor(8000., -9810.) == sensor(9000., 0.));
}
