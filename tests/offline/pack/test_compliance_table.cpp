#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "offline/vehicle/kinds.h"
#include "support/vehicles.h"

using namespace railstep;

TEST_CASE("the table between a line's rows gives the wheel forces of its modes", "[modal]") {
  const Track track = one_rail(40);
  Traffic traffic;
  for (int i = 0; i < 4; ++i)
    traffic.vehicles.push_back(running(sprung_mass(4000., 900., 1.2e6, 4e3), 6. + 1.1 * i, 40.));
  const PackOptions options = options_of(true, track, 1e-4);
  ModelRun tabled = from_rest(track, traffic, options), summed = from_rest(track, traffic, options);
  Model without = summed.model();
  REQUIRE(without.line[0].modal.between != nullptr);
  for (LineModel& line : without.line) line.modal.between = nullptr;
  // The responses of its modes need room of their own.
  std::vector<double> memory(static_cast<std::size_t>(workspace_doubles(without)));
  Workspace workspace = workspace_on(without, memory.data());
  Outputs outputs{};
  double least = 1e9, most = 0., apart = 0.;
  for (int step = 0; step < 2000; ++step) {
    tabled.step();
    REQUIRE(advance_frame(without, summed.state, workspace, outputs) == Status::ok);
    for (int i = 0; i < 4; ++i) {
      const double force = tabled.outputs.contact_force[i];
      least = std::min(least, force);
      most = std::max(most, force);
      apart = std::max(apart, std::abs(force - outputs.contact_force[i]));
    }
  }
  CHECK(most > 1.02 * least);  // the forces change over the seats
  CHECK(apart < 1e-9 * most);
}
