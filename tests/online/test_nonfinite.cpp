// A result is not a number although each unknown is one: the status says so, and the sentence names
// the part. High powers of unknowns overflow long before the unknowns do.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <string>

#include "build/build.h"
#include "online/step/step.h"
#include "run/simulate.h"
#include "support/program.h"
#include "support/shipped.h"

using namespace railstep;
using Catch::Contains;

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
const std::string kFlanged = kScenes + "wheelset_flange.toml";
const std::string kCrank = kScenes + "slider_crank.toml";

Simulation system_run(const std::string& scene) {
  return Simulation(std::get<SystemScene>(read_any_scene(scene, {})));
}

/// Outputs of publish_start() for the run's present state.
Outputs published(const Simulation& run) {
  Outputs outputs{};
  publish_start(run.model(), run.state, outputs);
  return outputs;
}

/// Checks that the status is set and that the sentence names the part whose result is lost.
void check_lost(const Simulation& run, const Outputs& outputs, std::int32_t first,
                const std::string& part) {
  CHECK(has(outputs.status, Status::nonfinite_state));
  REQUIRE(outputs.first_bad_unknown == first);
  const std::string sentence = nonfinite_sentence(run, first);
  CHECK_THAT(sentence, Contains("what follows from unknown ") && Contains(part));
}

}  // namespace

TEST_CASE("a wheelset's gaps that overflow set nonfinite_state", "[nonfinite]") {
  Simulation run(read_scene(kFlanged));
  const std::int32_t first = run.model().wheelset[0].first;
  CHECK(published(run).first_bad_unknown == -1);
  run.state.u[first + 3] = 1e53;  // roll, rad: a state below 1.6e60
  const Outputs outputs = published(run);
  const ContactId flange = flange_contact(run.model(), 0);
  CHECK_FALSE(
      (std::abs(outputs.contact_gap[0]) < 1e60 && std::abs(outputs.contact_gap[flange]) < 1e60));
  check_lost(run, outputs, first, "wheelset");
}

TEST_CASE("a contact force that is not a number sets nonfinite_state, on treads and flanges",
          "[nonfinite]") {
  const int contact = GENERATE(0, 1, 2, 3);
  Simulation run(read_scene(kFlanged));
  run.state.contact_force[contact] = kNaN;
  CAPTURE(contact);
  check_lost(run, published(run), run.model().wheelset[0].first, "wheelset");
}

TEST_CASE("an orientation that is not a number sets nonfinite_state and names its own body",
          "[nonfinite]") {
  const int body = GENERATE(0, 1);
  Simulation run = system_run(kCrank);
  CHECK(published(run).first_bad_unknown == -1);
  run.state.quaternion[4 * body + 2] = kNaN;
  check_lost(run, published(run), run.model().system.body[body].first,
             body == 0 ? "\"crank\"" : "\"rod\"");
}

TEST_CASE("a joint's force beyond 1.6e60 sets nonfinite_state", "[nonfinite]") {
  Simulation run = system_run(kCrank);
  run.state.row_force[0] = 1.7e60;
  const Outputs outputs = published(run);
  REQUIRE(outputs.first_bad_unknown >= run.model().system.first);
  check_lost(run, outputs, outputs.first_bad_unknown, "of body");
}

TEST_CASE("an unknown beyond 1.6e60 is itself named", "[nonfinite]") {
  const double bad = GENERATE(1.7e60, -1.7e60, std::numeric_limits<double>::infinity(), kNaN);
  const bool speed = GENERATE(false, true);
  Simulation run(read_scene(kFlanged));
  const std::int32_t at = run.model().wheelset[0].first + 1;
  (speed ? run.state.v : run.state.u)[at] = bad;
  const Outputs outputs = published(run);
  CAPTURE(bad, speed);
  CHECK(has(outputs.status, Status::nonfinite_state));
  REQUIRE(outputs.first_bad_unknown == at);
  CHECK_THAT(nonfinite_sentence(run, at), !Contains("what follows"));
}

TEST_CASE("a large state below 1.6e60 is not reported as lost", "[nonfinite]") {
  Simulation run = system_run(kCrank);
  run.state.v[run.model().system.first] = 1.5e60;
  CHECK(published(run).first_bad_unknown == -1);
}
