// Wheels so close that tables of the residual flexibility between places round its kink off. The
// flexibility under both must stay positive: two forces may not gain energy.
#include <fmt/core.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "online/step/step.h"
#include "run/simulation.h"

using namespace railstep;

namespace {

struct Carried {
  double together = 0., most = 0.;  // N: mean of the sum in the last half, and largest force of all
  Status seen = Status::ok;
};

/// One mass, or two halves of it `apart` from each other, over 24 bays for 50 ms.
Carried ride(const std::string& contact, int masses, double apart, const std::string& kind) {
  std::string vehicles;
  for (int i = 0; i < masses; ++i)
    vehicles += fmt::format(
        "{{name=\"m{}\", type=\"mass\", mass_kg={:g}, start_m={:.17g}, speed_m_per_s=20.0{}}},", i,
        1800. / masses, 5. + i * apart, contact);
  Simulation run(read_scene(RAILSTEP_SOURCE "/config/scenes/bogie_at_speed.toml",
                            {"sensor=[]", "track.bays=24", "vehicle=[" + vehicles + "]",
                             "condense.kind=\"" + kind + "\"", "step.duration_s=0.05"}));
  Carried found;
  const int frames = 100;
  for (int frame = 0; frame < frames; ++frame) {
    Outputs outputs{};
    found.seen = found.seen | advance_frame(run.model(), run.state, run.workspace, outputs);
    for (int i = 0; i < masses; ++i) {
      found.most = std::max(found.most, std::abs(outputs.contact_force[i]));
      if (2 * frame >= frames) found.together += outputs.contact_force_mean[i] / (.5 * frames);
    }
  }
  return found;
}

}  // namespace

TEST_CASE("two masses at one place ride as one mass", "[vehicle][contact]") {
  // The track moves equally under both. Only the tables between places differ, whose error is some
  // percent of the residual flexibility.
  const std::string kind = GENERATE(as<std::string>(), "full", "modal");
  const std::string contact =
      GENERATE(as<std::string>(), ", contact=\"bonded\"",
               ", contact=\"linear\", contact_stiffness_n_per_m=1e13", ", contact=\"hertz\"");
  const Carried one = ride(contact, 1, 0., kind);
  for (const double apart : {0., 1e-6, .01, .03}) {
    const Carried two = ride(contact, 2, apart, kind);
    CAPTURE(kind, contact, apart, one.together, two.together, one.most, two.most);
    CHECK(!has(two.seen, Status::cap_reached));
    CHECK(std::abs(two.together / one.together - 1.) < .01);
    // Each has half of it; the tables' error shifts a little from one to the other.
    CHECK(two.most < one.most);
  }
}
