#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "offline/energy/energy_account.h"
#include "offline/energy/system_account.h"
#include "online/step/step.h"
#include "run/inputs.h"
#include "run/simulate.h"
#include "support/program.h"
#include "support/shipped.h"

using namespace railstep;
using Catch::Contains;

namespace {

const char* const kPushed = "wheelset[0].force=[{direction=\"y\", input=\"push\", limit_n=1e3}]";

void write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file) << text;
}

/// y of the wheelset's centre, m, after each frame of a run.
std::vector<double> sideways(const std::string& force, const std::string& kind,
                             const FrameInputs& inputs, std::int64_t frames) {
  Simulation run(read_scene(kWheelset, {force, "condense.kind=\"" + kind + "\""}));
  const RunRecord record = simulate(run, frames, nullptr, true, {}, inputs);
  const auto& names = run.columns();
  const auto at = static_cast<std::size_t>(std::find(names.begin(), names.end(), "wheelset.y_m") -
                                           names.begin());
  REQUIRE(at < names.size());
  std::vector<double> y;
  for (std::size_t i = at; i < record.rows.size(); i += names.size()) y.push_back(record.rows[i]);
  return y;
}

}  // namespace

TEST_CASE("an input gives the same bits as a table of the same force", "[inputs]") {
  // The force is 0 up to frame 20 and 30 N from then on; a table that jumps between two steps is
  // the same force.
  const std::vector<double> none = {0.}, thirty = {30.};
  const FrameInputs inputs = [&](std::int64_t frame) {
    return (frame < 20 ? none : thirty).data();
  };
  for (const char* kind : {"full", "modal"}) {
    const auto by_input = sideways(kPushed, kind, inputs, 60);
    const auto by_table =
        sideways("wheelset[0].force=[{direction=\"y\", table=[[0.020001, 30]]}]", kind, {}, 60);
    CHECK(by_input == by_table);
    CHECK(by_input.back() != 0.);
  }
}

TEST_CASE("the last good input replaces one that is not finite, and one that is too large is cut",
          "[inputs]") {
  Simulation run(read_scene(kWheelset, {kPushed}));
  REQUIRE(run.inputs() == std::vector<std::string>{"push.force_n"});
  Outputs outputs{};
  publish_start(run.model(), run.state, outputs);
  const auto frame = [&](double value) {
    return advance_frame(run.model(), &value, run.state, run.workspace, outputs);
  };
  CHECK(frame(7.) == Status::ok);
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
        -std::numeric_limits<double>::infinity()}) {
    CHECK(has(frame(bad), Status::nonfinite_input));
    CHECK(run.state.input[0] == 7.);
    CHECK_FALSE(has(run.state.latched, Status::force_saturated));
  }
  CHECK(has(frame(5.), Status::nonfinite_input));  // the bit stays set
  CHECK(run.state.input[0] == 5.);
  CHECK(has(frame(-2e3), Status::force_saturated));
  CHECK(run.state.input[0] == -1e3);
  CHECK(
      has(frame(1e3), Status::force_saturated));  // at its limit an input is not cut; it stays set
  CHECK(run.state.input[0] == 1e3);
  reset(run.model(), run.state);
  CHECK(frame(1e3) == Status::ok);
}

TEST_CASE("a state that is no longer finite is kept, and so are the last outputs", "[inputs]") {
  Simulation run(read_scene(kWheelset, {}));
  const Model& model = run.model();
  Outputs outputs{};
  publish_start(model, run.state, outputs);
  for (int n = 0; n < 5; ++n)
    static_cast<void>(advance_frame(model, run.state, run.workspace, outputs));
  const Outputs last = outputs;
  const std::int32_t at = model.wheelset[0].first + 2;
  run.state.v[at] = std::numeric_limits<double>::infinity();
  const Status met = advance_frame(model, run.state, run.workspace, outputs);
  CHECK(has(met, Status::nonfinite_state));
  CHECK(outputs.first_bad_unknown >= 0);
  for (int i = 0; i < 2; ++i) {
    CHECK(outputs.contact_force[i] == last.contact_force[i]);
    CHECK(outputs.contact_gap[i] == last.contact_gap[i]);
    CHECK(outputs.contact_rail_z[i] == last.contact_rail_z[i]);
  }
  const std::int64_t steps = run.state.steps;
  CHECK(has(advance_frame(model, run.state, run.workspace, outputs), Status::nonfinite_state));
  CHECK(run.state.steps == steps);  // no further step is made
}

TEST_CASE("energies balance under inputs of wheelsets and of systems", "[inputs]") {
  std::vector<double> value = {0.};
  const FrameInputs swinging = [&](std::int64_t frame) {
    value[0] = 200. * std::sin(.1 * static_cast<double>(frame));
    return value.data();
  };
  for (const char* kind : {"full", "modal"}) {
    Simulation run(read_scene(kWheelset, {kPushed, std::string("condense.kind=\"") + kind + "\""}));
    const RunRecord record = simulate(run, 200, nullptr, false, {}, swinging);
    const EnergyBalance balance = balance_of(*run.packed(), run.model(), 200, {}, swinging);
    CHECK(record.first_bad_unknown < 0);
    CHECK(balance.hash == state_hash(run.model(), run.state));
    // Condensed lines hold forces over a step, which loses energy to first order. A table of the
    // same force loses as much.
    CHECK(balance.error < (kind == std::string("modal") ? 1e-2 : 1e-3));
    CHECK(std::abs(balance.error - balance.numerical_loss) < 1e-5);
  }
  for (const char* scheme : {"generalised-alpha", "energy-momentum"}) {
    const auto run = simulation_of(read_any_scene(
        kScenes + "spring_pendulum.toml",
        {"force=[{on=\"bob\", point_m=[0.3, 0.05, -0.9], direction=[1, 0, 0], input=\"fan\", "
         "limit_n=500}]",
         std::string("step.scheme=\"") + scheme + "\"", "step.dt_s=2e-4"}));
    CHECK(run->inputs() == std::vector<std::string>{"fan.force_n"});
    const FrameInputs gusts = [&](std::int64_t frame) {
      value[0] = 5. * std::sin(.002 * static_cast<double>(frame));
      return value.data();
    };
    const RunRecord record = simulate(*run, 1000, nullptr, false, {}, gusts);
    const EnergyBalance balance = balance_of(*run->system()->packed, 1000, {}, gusts);
    CAPTURE(scheme);
    CHECK(record.first_bad_unknown < 0);
    CHECK(balance.hash == state_hash(run->model(), run->state));
    CHECK(balance.error < 1e-3);
    const EnergyBalance without = balance_of(*run->system()->packed, 1000);
    CHECK(without.hash != balance.hash);
  }
}

TEST_CASE("a moment from an input turns a body as a constant moment does", "[inputs]") {
  const auto turned = [](const std::string& size, bool given) {
    const auto run =
        simulation_of(read_any_scene(kScenes + "spring_pendulum.toml",
                                     {"force=[{on=\"bob\", direction=[0, 1, 0], " + size + "}]"}));
    static const double value = .02;
    const FrameInputs inputs = [](std::int64_t) { return &value; };
    simulate(*run, 100, nullptr, false, {}, given ? inputs : FrameInputs{});
    return std::vector<double>(run->state.quaternion, run->state.quaternion + 4);
  };
  // The turn is M t^2 / (2 J), to the scheme's second order. A constant moment is in balance at t =
  // 0; the input starts with the first step and lags by half a step.
  const auto half_turn = [](double t) { return std::sin(.5 * (.5 * .02 / 8e-3 * t * t)); };
  CHECK(turned("moment_n_m=0.02", false)[2] == Approx(half_turn(.1)).epsilon(1e-4));
  CHECK(turned("input=\"motor\", limit_n_m=1", true)[2] ==
        Approx(half_turn(.1 - .5e-3)).epsilon(1e-4));
  CHECK(turned("input=\"motor\", limit_n_m=1", false)[2] == 0.);
}

TEST_CASE("a table of inputs holds each row until the next", "[inputs]") {
  const auto folder = fresh_folder("inputs");
  const std::vector<std::string> names = {"a.force_n", "b.force_n"};
  write(folder / "in.csv", "time_s,b.force_n\n0.002,1.5\n0.0030000000001,-2\n0.0045,3\n");
  const InputTable table(folder / "in.csv", names, 1e-3);
  const double want[] = {0., 0., 1.5, -2., -2., 3., 3.};
  for (std::int64_t frame = 0; frame < 7; ++frame) {
    CHECK(table.at(frame)[0] == 0.);
    CHECK(table.at(frame)[1] == want[frame]);
  }
}

TEST_CASE("bad tables of inputs and bad inputs of scenes are refused in one sentence",
          "[inputs][cli]") {
  const auto folder = fresh_folder("bad_inputs");
  const auto file = (folder / "in.csv").string();
  const auto told = [&](const std::string& text, const std::string& scene) {
    write(file, text);
    const Ran ran = railstep_program("run " + kWheelset + " --duration 0.01 --set '" + scene +
                                     "' --inputs " + file);
    CHECK(ran.code == 2);
    CHECK(ran.err.find('\n') == ran.err.size() - 1);
    return ran.err;
  };
  CHECK_THAT(told("time_s,pull.force_n\n0,1\n", kPushed),
             Contains("in.csv:1: column 'pull.force_n'") && Contains("E-INPUTS-01"));
  CHECK_THAT(told("push.force_n,time_s\n0,1\n", kPushed), Contains("E-INPUTS-03"));
  CHECK_THAT(told("time_s,push.force_n\n0,1\n0,2\n", kPushed),
             Contains("in.csv:3:") && Contains("E-INPUTS-09"));
  CHECK_THAT(told("time_s,push.force_n\n-1,1\n", kPushed), Contains("E-INPUTS-04"));
  CHECK_THAT(told("time_s,push.force_n\n1e308,1\n", kPushed),
             Contains("time_s = 1e+308") && Contains("1e+15 frames") && Contains("E-INPUTS-05"));
  CHECK_THAT(told("time_s,push.force_n\n0,nan\n", kPushed), Contains("E-CSV-01"));
  CHECK_THAT(told("time_s,push.force_n\n0\n", kPushed),
             Contains("in.csv:2: ") && Contains("1 values") && Contains("E-CSV-04"));
  CHECK_THAT(told("time_s,push.force_n\n", kPushed), Contains("E-CSV-05"));
  CHECK_THAT(told("", kPushed), Contains("E-FILE-07"));
  CHECK_THAT(told("time_s,push.force_n\n0,1\n", "wheelset[0].force=[]"), Contains("E-INPUTS-06"));
  CHECK_THAT(
      told("time_s,push.force_n\n0,1\n", "wheelset[0].force=[{direction=\"y\", input=\"push\"}]"),
      Contains("limit_n"));
  CHECK_THAT(told("time_s,push.force_n\n0,1\n",
                  "wheelset[0].force=[{direction=\"y\", input=\"push\", limit_n=0}]"),
             Contains("limit_n"));
  CHECK_THAT(
      told("time_s,push.force_n\n0,1\n",
           "wheelset[0].force=[{direction=\"y\", input=\"push\", limit_n=1, table=[[0, 1]]}]"),
      Contains("E-RUNNER-25"));
  CHECK_THAT(told("time_s,push.force_n\n0,1\n",
                  "wheelset[0].force=[{direction=\"y\", input=\"push\", limit_n=1}, "
                  "{direction=\"z\", input=\"push\", limit_n=1}]"),
             Contains("E-RUNNER-17"));
}
