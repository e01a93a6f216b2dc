// Forces of supports in the first row of a trace are those of the statics, for any damping.
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "support/scene_run.h"

using namespace railstep;

TEST_CASE("supports of strongly damped pads start with the forces of the statics", "[start]") {
  // The modes have nearly real rates, 1e7 N s/m over pads of 2e10 N/m. A speed of 6e-8 m/s at the
  // start is a force of half a newton, and with a coarse basis of hundreds of newtons.
  const std::string scene =
      "schema = 1\n"
      "track = {unknowns=\"vertical\", rails=1, bays=5, bay_m=0.6, elements_per_bay=1, "
      "ends=\"free\"}\n"
      "rail = {rectangle={height_m=0.172, width_m=0.07}, young_pa=210e9}\n"
      "support = {at=\"axis\", stiffness_z_n_per_m=2e10, damping_z_n_s_per_m=1e7}\n"
      "sleeper = {mass_kg=250}\nballast = {stiffness_z_n_per_m=2.5e6, damping_z_n_s_per_m=1e4}\n"
      "load = [{name=\"l\", rail=\"left\", start_m=2.65, force_z_n=-31.6e3}]\n"
      "step = {dt_s=1e-3, duration_s=5e-3, start=\"equilibrium\"}\n"
      "output = {supports=true}\n";
  const Traced full(scene_of(scene));
  for (const char* kind : {"modal", "guyan", "irs", "craig-bampton", "krylov"}) {
    const Traced run(scene_of(scene + "condense = {kind=\"" + kind + "\"}\n"));
    for (int support = 0; support < 6; ++support) {
      const std::string name = "support_" + std::to_string(support) + ".force_z_n";
      CAPTURE(kind, name);
      const std::vector<double> force = run[name], want = full[name];
      // Rounding of the two displacements of 5 mm at a pad, 1e-18 m, times 2e10 N/m; the basis has
      // the seats' statics to 1e-12.
      for (const double each : force) CHECK(std::abs(each - want[0]) < 1e-9 * 31.6e3);
    }
  }
}
