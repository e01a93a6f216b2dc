// Running surfaces of wheels: the sections of EN 13715, cones, and what is refused.
#include <catch2/catch.hpp>
#include <cmath>

#include "offline/math/refuse.h"
#include "offline/profile/running_surface.h"
#include "section/running_profile.h"
#include "support/shipped.h"

using namespace railstep;
using Catch::Matchers::Contains;

namespace {

RunningSurface wheel(const std::string& name) {
  return read_wheel_profile(std::string(RAILSTEP_SOURCE) + "/config/profiles/" + name).growth;
}

SurfacePiece line(double from, double to, double height, double slope) {
  return {from, to, 0., 0., 0., {height, slope}};
}

}  // namespace

TEST_CASE("S1002 grows as its sections say", "[profile]") {
  // s, F in mm and F' from the sections of EN 13715 by another program.
  const double known[][3] = {{-50, 26.908712, -.458349},
                             {-45, 23.537706, -.922161},
                             {-42, 20.051957, -1.476177},
                             {-40, 16.290695, -2.489122},
                             {-39, 13.574952, -2.747477},
                             {-38, 10.967717, -2.152013},
                             {-36, 7.892117, -1.144432},
                             {-32, 4.792505, -.514029},
                             {-30, 3.921571, -.369793},
                             {-28, 3.270086, -.289937},
                             {-26, 2.741043, -.241693},
                             {-22, 1.919518, -.174082},
                             {-20, 1.596563, -.149686},
                             {-15, .967430, -.105107},
                             {-10, .522759, -.074408},
                             {-5, .210668, -.051429},
                             {0, 0, -.033585},
                             {5, -.132311, -.020056},
                             {10, -.208401, -.011271},
                             {15, -.255599, -.008864},
                             {20, -.311765, -.015271},
                             {25, -.425937, -.032118},
                             {30, -.646230, -.056587},
                             {40, -1.302343, -.066667},
                             {60, -2.635676, -.066667}};
  const RunningSurface growth = wheel("s1002.toml");
  for (const auto& [s, F, slope] : known) {
    CAPTURE(s);
    CHECK(1e3 * growth.at(1e-3 * s).height == Approx(F).margin(1e-6));
    CHECK(growth.at(1e-3 * s).slope == Approx(slope).margin(1e-6));
  }
}

TEST_CASE("derivatives of a surface are those of its heights", "[profile]") {
  for (const char* name : {"s1002.toml", "cone_20.toml", "cone_40.toml"}) {
    const RunningSurface growth = wheel(name);
    for (double s = -65.3e-3; s < 59e-3; s += .9e-3) {
      CAPTURE(name, s);
      const double h = 1e-6;
      const SurfacePoint at = growth.at(s), up = growth.at(s + h), down = growth.at(s - h);
      CHECK((up.height - down.height) / (2. * h) == Approx(at.slope).margin(1e-6));
      CHECK((up.slope - down.slope) / (2. * h) == Approx(at.curvature).epsilon(1e-3).margin(1e-3));
    }
  }
}

TEST_CASE("joints of the shipped wheels are smooth", "[profile]") {
  for (const char* name : {"s1002.toml", "cone_20.toml", "cone_40.toml"}) {
    const RunningSurface growth = wheel(name);
    for (std::size_t i = 1; i < growth.pieces().size(); ++i) {
      const double s = growth.pieces()[i].from;
      const RunningSurface left({growth.pieces()[i - 1]}), right({growth.pieces()[i]});
      CAPTURE(name, s);
      CHECK(std::abs(left.at(s).height - right.at(s).height) < .15e-6);
      CHECK(std::abs(left.at(s).slope - right.at(s).slope) < 1e-5);
    }
  }
}

TEST_CASE("surfaces that nothing can run on are refused with their place", "[profile]") {
  const auto refused = [](std::vector<SurfacePiece> pieces, const std::string& words) {
    CHECK_THROWS_WITH(RunningSurface(std::move(pieces)), Contains(words));
  };
  refused({}, "no piece");
  refused({line(.01, .01, 0., 0.)}, "is empty");
  refused({line(0., .01, 0., 0.), line(.011, .02, 0., 0.)}, "no gap");
  refused({line(0., .01, 0., 0.), line(.01, .02, 1e-5, 0.)}, "a step of 0.01 mm at 10 mm");
  refused({line(0., .01, 0., 0.), line(.01, .02, -.01, 1.)}, "a kink at 10 mm");
  refused({{0., .03, 0., 0., .02, {}}}, "leaves its circle");
  refused({line(0., .01, std::nan(""), 0.)}, "not a finite number");
}
