#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <string>

#include "support/loopback.h"
#include "support/program.h"
#include "support/started.h"
#include "support/traced.h"

using namespace railstep;

namespace {

const std::string kDampedScene = std::string(RAILSTEP_SOURCE) + "/tools/examples/yaw_damper.toml";

double largest(const Rows& rows, const std::string& column, std::size_t from, std::size_t to) {
  double most = 0.;
  for (std::size_t r = from; r < to; ++r)
    most = std::max(most, std::fabs(rows.row.at(r).at(rows.column(column))));
  return most;
}

}  // namespace

TEST_CASE("an active yaw damper in another process holds a vehicle as through the C interface",
          "[hil][yaw_damper][cli]") {
  const auto folder = fresh_folder("yaw_damper");
  const auto file = [&](const char* name) { return (folder / name).string(); };
  REQUIRE(
      railstep_program("condense " + kDampedScene + " --skip-errors --out " + file("model")).code ==
      0);
  const Ran inside = run_program(YAW_DAMPER, file("model") + " 4");
  REQUIRE(inside.code == 0);
  // Above its critical speed the vehicle hunts by itself; the moments end it.
  const Rows held = rows_of(inside.out), alone = traced(kDampedScene + " --duration 4");
  CHECK(largest(held, "yaw_1_rad", 0, 500) > 1e-4);
  CHECK(largest(held, "yaw_1_rad", 3500, 4000) < 2e-6);
  CHECK(largest(alone, "car.bogie_1.yaw_rad", 3500, 4000) > 5e-4);

  const Ran first = run_program(YAW_DAMPER, file("model") + " 0.1");
  // On a busy machine a frame may be made before its moments came: the test then repeats it with
  // more time for each frame.
  Ran outside{1, {}, {}};
  for (int rate = 100; rate >= 10 && outside.code != 0; rate -= 30) {
    std::filesystem::remove(file("names"));
    const std::string address = "127.0.0.1:" + std::to_string(free_port());
    Started track("hil " + file("model") + " --rate " + std::to_string(rate) + " --duration " +
                  std::to_string(130. / rate) + " --wait 60 --json --names " + file("names") +
                  " --udp " + address);
    track.await(std::filesystem::path(file("names")));
    outside = run_program(YAW_DAMPER, address + " " + file("names") + " 1e-3 0.1");
    const Ran hil = track.end();
    CAPTURE(hil.err, outside.err);
    REQUIRE(hil.code == 0);
  }
  REQUIRE(outside.code == 0);
  CHECK(outside.out == first.out);
}
