#include <catch2/catch.hpp>

#include "text/progress_bar.h"

using namespace railstep;

TEST_CASE("the time left follows the pace of the last tenth", "[progress]") {
  Pace pace;
  CHECK(pace.left() == 0.);
  pace.reached(0, 1.);
  CHECK(pace.left() == 0.);
  pace.reached(2, 4.);
  CHECK(pace.left() == Approx(4. * 98 / 2));
  // Half of it exists already; after that, each percent takes 3 s.
  pace.reached(50, 4.);
  for (int p = 51; p <= 70; ++p) pace.reached(p, 4. + 3. * (p - 50));
  CHECK(pace.left() == Approx(3. * 30));
  pace.reached(100, 200.);
  CHECK(pace.left() == 0.);
}

TEST_CASE("durations are written in words", "[progress]") {
  CHECK(duration_text(39.6) == "40 s");
  CHECK(duration_text(100.) == "2 min");
  CHECK(duration_text(5999.) == "1 h 40 min");
  CHECK(duration_text(7800.) == "2 h 10 min");
}
