#include <fmt/core.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <string>

#include "run/simulation.h"
#include "support/program.h"
#include "support/traced.h"

using namespace railstep;

namespace {

const std::string kOpenTrack = std::string(RAILSTEP_SOURCE) + "/config/scenes/open_track.toml";
/// The vehicle of tools/examples/own_vehicle.c as a part of the model.
const std::string kInside =
    " --set 'external_wheel=[]' --set 'vehicle=[{name=\"v\", type=\"sprung_mass\", mass_kg=5000, "
    "unsprung_mass_kg=900, stiffness_n_per_m=1e6, damping_n_s_per_m=2e4, start_m=0.3, "
    "speed_m_per_s=30}]'";

/// Options of `run` for steps of this length, one step a frame.
std::string stepped(const std::string& dt) { return " --step " + dt + " --set step.frame_s=" + dt; }

/// The constant of that vehicle's Hertz contact, N/m^1.5.
double hertz_of_inside() {
  const auto run = simulation_of(read_any_scene(
      kOpenTrack,
      {"external_wheel=[]",
       "vehicle=[{name=\"v\", type=\"sprung_mass\", mass_kg=5000, unsprung_mass_kg=900, "
       "stiffness_n_per_m=1e6, damping_n_s_per_m=2e4, start_m=0.3, speed_m_per_s=30}]"}));
  return run->model().contact[0].law.hertz;
}

/// Rows that the program in C prints of its ride over the track.
Rows ride_outside(const std::string& dt, const std::string& seconds, const char* way = "") {
  const auto folder = fresh_folder("own_vehicle");
  const std::string model = (folder / "track.model").string();
  const Ran made = railstep_program("condense " + kOpenTrack + " --set step.dt_s=" + dt +
                                    " --set step.frame_s=" + dt +
                                    " --set step.duration_s=" + seconds + " --out " + model);
  CAPTURE(made.err);
  REQUIRE(made.code == 0);
  char hertz[40];
  std::snprintf(hertz, sizeof hertz, "%.17g", hertz_of_inside());
  return rows_of(run_program(OWN_VEHICLE, model + " " + seconds + " " + hertz + " " + way).out);
}

/// Largest difference of the wheel's force from that of the vehicle in the model, over its peak.
double difference(const Rows& own, const Rows& inside) {
  const std::size_t force = inside.column("v.wheel_1.force_z_n");
  double most = 0., peak = 0.;
  REQUIRE(own.row.size() + 1 == inside.row.size());  // a trace has a row for the start
  for (std::size_t n = 0; n < own.row.size(); ++n) {
    const double want = inside.row[n + 1][force];
    peak = std::max(peak, std::abs(want));
    most = std::max(most, std::abs(own.row[n][1] - want));
  }
  return most / peak;
}

}  // namespace

TEST_CASE("a vehicle outside, coupled by the step's compliance, rides as the vehicle in the model",
          "[own_vehicle]") {
  for (const char* dt : {"1e-4", "1e-3"}) {
    const Rows inside =
        traced(fmt::format("{}{} --duration 0.5{}", kOpenTrack, stepped(dt), kInside));
    const Rows own = ride_outside(dt, "0.5");
    CAPTURE(dt);
    // Rounding 2^-52 times the ratio of the track's stiffness to its inertia terms (1e6 a step),
    // over thousands of steps. Both wheels' Newton iterations stop at 1e-16 of the penetration.
    CHECK(difference(own, inside) < 1e-9);
  }
}

TEST_CASE("a vehicle coupled by the force of the frame before rides differently", "[own_vehicle]") {
  const Rows inside = traced(kOpenTrack + stepped("1e-3") + " --duration 0.1" + kInside);
  const Rows own = ride_outside("1e-3", "0.1", "explicit");
  const bool lost = own.row.size() + 1 < inside.row.size();  // the ride ended beyond 1e12 N
  if (!lost) CHECK(difference(own, inside) > .5);
  const Rows fine = traced(kOpenTrack + stepped("1e-5") + " --duration 0.1" + kInside);
  CHECK(difference(ride_outside("1e-5", "0.1", "explicit"), fine) < .1);
}
