// Wheelsets of scenes at rest: their weight, and the start of one on a track without end.
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "support/scene_run.h"

using namespace railstep;

TEST_CASE("without gravity a wheelset and its carried mass have no weight", "[wheelset]") {
  for (const bool gravity : {true, false}) {
    const Traced run("wheelset_on_track",
                     {gravity ? "wheelset[0].gravity=true" : "wheelset[0].gravity=false",
                      "wheelset[0].carried_mass_kg=1000.0", "step.duration_s=0.5"});
    const double want = gravity ? .5 * 1100. * 9.81 : 0.;
    CHECK(run["wheel_left.force_z_n"].back() == Approx(want).epsilon(1e-6).margin(1e-9));
  }
}

TEST_CASE("a wheelset that stands on a track without end starts in equilibrium", "[wheelset]") {
  for (const char* bays : {"track.bays=20", "track.bays=24"}) {
    const Traced run("endless_track", {bays, "wheelset[0].speed_m_per_s=0.0",
                                       "step.start=\"moving\"", "step.duration_s=0.01"});
    const std::vector<double> force = run["wheel_left.force_z_n"];
    CAPTURE(bays, force.front());
    CHECK(force.front() > 1e4);
    // The ring's modes find the static force to a few millionths.
    for (const double each : force) CHECK(std::abs(each / force.front() - 1.) < 1e-5);
  }
}
