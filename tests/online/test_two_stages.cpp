// TR-BDF2 with all that runs on a track: ports, bodies and guides are solved in each stage.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "offline/energy/energy_account.h"
#include "support/drops.h"
#include "support/scene_run.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

const std::string kTwo = "step.scheme=\"tr-bdf2\"", kFull = "condense.kind=\"full\"";

/// Largest difference of a column between runs, over its peak in the first.
double apart(const Traced& a, const Traced& b, const std::string& column) {
  const std::vector<double> one = a[column], other = b[column];
  double worst = 0., most = 0.;
  for (std::size_t i = 0; i < one.size(); ++i) {
    worst = std::max(worst, std::abs(one[i] - other[i]));
    most = std::max(most, std::abs(one[i]));
  }
  return worst / most;
}

struct StageCase {
  std::string scene, column;
  std::vector<std::string> changes;
};

}  // namespace

TEST_CASE("R2: a wheel dropped on a mass meets its reference in two stages", "[contact]") {
  // hard-cases.md R2 and H4: 1 % at 50 us, 1e-3 at 10 us.
  for (const double dt : {5e-5, 1e-5}) {
    const double bound = dt > 2e-5 ? 1e-2 : 1e-3;
    Drop drop(one_mass(3e7, 3e4), kMiddle, tr_bdf2(dt), {});
    const Impact found = impact(drop);
    CHECK_THAT(found.peak, WithinRel(33.747495e3, bound));
    CHECK_THAT(found.peak_time, WithinAbs(.7328714e-3, dt));
    CHECK_THAT(found.leaves, WithinAbs(1.5365055e-3, dt));
    CHECK_THAT(found.wheel, WithinRel(-.0692294, 2. * bound));  // up; at a step's end, 9.81 dt late
  }
}

TEST_CASE("two stages and generalised-alpha converge to the same motion", "[schemes]") {
  // The cases have all that a track in full order has: wheelsets with guides and flanges, vehicles,
  // supports that do not pull. Elements are so short that their borders excite no thickness modes,
  // which have 10 to 40 kHz and are not resolved at these steps.
  const StageCase c = GENERATE(
      StageCase{"ballasted_track",
                "wheel_left.force_z_n",
                {"track.bays=24", "track.elements_per_bay=4", "step.duration_s=0.02",
                 "step.frame_s=2e-4"}},
      StageCase{"bogie_at_speed",
                "bogie.wheel_1.force_z_n",
                {"step.duration_s=0.02", "step.frame_s=2e-4"}},
      StageCase{"hanging_sleeper",
                "front_left.deflection_z_m",
                {"step.duration_s=0.04", "step.frame_s=4e-4"}},
      StageCase{"wheelset_flange", "wheelset.dy_m", {"step.duration_s=1.5", "step.frame_s=1e-3"}});
  const auto difference = [&](const std::string& dt) {
    std::vector<std::string> changes = c.changes;
    changes.insert(changes.end(), {kFull, "step.dt_s=" + dt});
    const Traced one(c.scene, changes);
    changes.push_back(kTwo);
    const Traced two(c.scene, changes);
    CHECK_FALSE(has(two.status, Status::cap_reached));
    return apart(one, two, c.column);
  };
  const double coarse = difference("1e-4"), fine = difference("2.5e-5");
  CAPTURE(c.scene, coarse, fine);
  // At 1e-4 s the fastest motion that matters (1 kHz) has omega dt = 0.6: (omega dt)^2/12 = 3 %.
  CHECK(coarse < .03);
  // A quarter of the step leaves a 16th of the difference, but a quarter where a contact opens or a
  // wheel meets an element's border within a step.
  CHECK(fine < .5 * coarse);
}

TEST_CASE("two stages on a track without end repeat from bay to bay", "[schemes]") {
  // Loads only: the run starts in the moving steady state, each bay as the one before (H29).
  const std::vector<std::string> changes = {kFull,
                                            kTwo,
                                            "step.dt_s=1e-3",
                                            "step.duration_s=0.1",
                                            "step.frame_s=1e-3",
                                            "step.start=\"moving\"",
                                            "defect=[]",
                                            "sensor=[]"};
  const Traced run("endless_track", changes);
  const std::vector<double> force = run["wheel_left.force_z_n"];
  // At 30 m/s a bay of 0.6 m takes 20 steps. A window repeats to 1e-9 from bay to bay.
  for (std::size_t i = 21; i < force.size(); ++i)
    CHECK_THAT(force[i], WithinRel(force[i - 20], 1e-7));
}

TEST_CASE("the energy that the named schemes lose is that of their account", "[energy]") {
  const std::string scheme =
      GENERATE("\"newmark\"", "\"hht\"", "\"tr-bdf2\"", "\"backward-euler\"");
  Simulation run(
      read_scene(kScenes + "ballasted_track.toml",
                 {kFull, "step.scheme=" + scheme, "track.bays=24", "step.duration_s=0.02"}));
  Model model = run.model();
  model.steps_per_frame = 1;
  EnergyAccount energy(*run.packed(), model, run.state);
  Outputs outputs{};
  while (run.state.steps < 400) {
    CHECK(advance_frame(model, run.state, run.workspace, outputs) == Status::ok);
    energy.follow(run.state);
  }
  CAPTURE(scheme, energy.imbalance(), energy.flow().loss, energy.turned_over());
  // As test_energy.cpp for the same run with generalised-alpha: frozen normals, 1e-4.
  CHECK(std::abs(energy.imbalance() + energy.flow().loss) < 1e-4 * energy.turned_over());
}
