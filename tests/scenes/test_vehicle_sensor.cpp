// [[sensor]] on = "vehicle" against Newton's law and the other columns.
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "support/program.h"
#include "support/scene_run.h"

using namespace railstep;
using Catch::Matchers::Contains;
using Catch::Matchers::WithinAbs;

namespace {

const std::string kBogieScene = kScenes + "bogie_at_speed.toml";

/// Sensors over both axle boxes, in the frame's middle and on both wheels.
const std::string kSensors =
    "sensor=[{name=\"front\", on=\"vehicle\", vehicle=\"bogie\", x_m=1.28},"
    "{name=\"rear\", on=\"vehicle\", vehicle=\"bogie\", body=\"frame\", x_m=-1.28},"
    "{name=\"middle\", on=\"vehicle\", vehicle=\"bogie\"},"
    "{name=\"first\", on=\"vehicle\", vehicle=\"bogie\", body=\"wheel_1\"},"
    "{name=\"second\", on=\"vehicle\", vehicle=\"bogie\", body=\"wheel_2\"}]";

const std::string kDip = "defect=[{kind=\"dipped_joint\", at_m=7.5, depth_m=2e-3, ramp_m=0.3}]";

Traced bogie_run(const std::string& kind, double rho) {
  return Traced("bogie_at_speed",
                {kSensors, "condense.kind=\"" + kind + "\"", "step.rho_inf=" + std::to_string(rho),
                 "step.duration_s=0.02", "step.frame_s=50.0e-6", "track.bays=30",
                 "vehicle[0].start_m=6.0", kDip});
}

std::string refusal_of(const std::string& sensor) {
  try {
    read_scene(kBogieScene, {"sensor=[{name=\"s\", on=\"vehicle\", " + sensor + "}]"});
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace

TEST_CASE("sensors on a bogie's frame agree with Newton's law and the springs over the axles",
          "[vehicle]") {
  // m a = sum of k dz + c dv over both axle boxes - weight at the end of every step. Rounding is
  // 1e-9 of the weight, from stiffnesses times heights exact to 1e-16 of .04 m.
  const double k = 1.22e6, c = 4e3, mass = 1307.5, weight = (1307.5 + 8000.) * 9.81;
  const Traced run = bogie_run("full", .6);
  const std::vector<double> a = run["middle.az_m_per_s2"], z = run["middle.z_m"];
  const std::vector<double> box[2] = {run["front.z_m"], run["rear.z_m"]},
                            wheel[2] = {run["first.z_m"], run["second.z_m"]},
                            box_v[2] = {run["front.vz_m_per_s"], run["rear.vz_m_per_s"]},
                            wheel_v[2] = {run["first.vz_m_per_s"], run["second.vz_m_per_s"]};
  double most = 0.;
  for (std::size_t i = 1; i < a.size(); ++i) {
    double force = -weight;
    for (int axle = 0; axle < 2; ++axle)
      force += k * (wheel[axle][i] - box[axle][i]) + c * (wheel_v[axle][i] - box_v[axle][i]);
    CHECK_THAT(mass * a[i], WithinAbs(force, 1e-9 * weight));
    CHECK_THAT(.5 * (box[0][i] + box[1][i]), WithinAbs(z[i], 1e-15));  // the middle lies between
    most = std::max(most, std::abs(mass * a[i]));
  }
  CHECK(most > .01 * weight);  // blow of the joint
}

TEST_CASE("sensors on a vehicle agree with its bodies' columns and their rates", "[vehicle]") {
  // Forces held over a step move bodies along parabolas: v1 - v0 = a1 dt and z1 - z0 = (v0 + v1)
  // dt/2 to rounding. The trapezoidal rule has the mean of a in place of a1.
  for (const bool modal : {false, true}) {
    const Traced run = bogie_run(modal ? "modal" : "full", 1.);
    const std::vector<double> t = run["time_s"], z = run["front.z_m"], v = run["front.vz_m_per_s"],
                              a = run["front.az_m_per_s2"], frame = run["bogie.frame.z_m"],
                              pitch = run["bogie.frame.pitch_rad"];
    CAPTURE(modal);
    double turned = 0.;
    for (std::size_t i = 1; i < t.size(); ++i) {
      const double dt = t[i] - t[i - 1], mean = modal ? a[i] : .5 * (a[i - 1] + a[i]);
      CHECK_THAT(z[i], WithinAbs(frame[i] - 1.28 * pitch[i], 1e-16));
      CHECK_THAT(v[i] - v[i - 1], WithinAbs(mean * dt, 1e-10));
      CHECK_THAT(z[i] - z[i - 1], WithinAbs(.5 * (v[i - 1] + v[i]) * dt, 1e-14));
      turned = std::max(turned, std::abs(pitch[i]));
    }
    CHECK(turned > 1e-6);
  }
}

TEST_CASE("a model file keeps a sensor on a vehicle", "[vehicle]") {
  const auto folder = fresh_folder("vehicle_sensor");
  const std::string model = (folder / "bogie.model").string(), file = (folder / "a.csv").string();
  const std::string changes = " --set '" + kSensors +
                              "' --set track.bays=30 --set 'vehicle[0].start_m=6.0' "
                              "--set step.duration_s=0.01";
  REQUIRE(railstep_program("condense " + kBogieScene + changes + " --out " + model).code == 0);
  REQUIRE(railstep_program("run " + model + " --trace " + file).code == 0);
  const std::string loaded = text_of(file);
  REQUIRE(railstep_program("run " + kBogieScene + changes + " --trace " + file).code == 0);
  CHECK(loaded.find("front.z_m,front.vz_m_per_s,front.az_m_per_s2,rear.z_m") != std::string::npos);
  CHECK(loaded == text_of(file));
}

TEST_CASE("a sensor on an unknown vehicle or body is refused", "[scene][vehicle]") {
  CHECK_THAT(refusal_of("vehicle=\"tram\""),
             Contains("\"tram\" is unknown; expected \"bogie\" [E-SENSOR-01]"));
  CHECK_THAT(refusal_of("vehicle=\"bogie\", body=\"boot\""),
             Contains("expected \"frame\", \"wheel_1\", \"wheel_2\" [E-SENSOR-01]"));
  CHECK_THAT(refusal_of("vehicle=\"bogie\", body=\"wheel_1\", x_m=0.1"),
             Contains("wheel_1 does not pitch; expected x_m = 0 [E-SENSOR-06]"));
  CHECK_THAT(refusal_of("vehicle=\"bogie\", position_m=1.0"),
             Contains("'position_m'") && Contains("E-KEY-02"));
  CHECK_THAT(refusal_of("body=\"frame\""), Contains("'vehicle'") && Contains("E-KEY-01"));
  CHECK_THAT(refusal_of("vehicle=\"bogie\", x_m=1e3"), Contains("x_m = 1000"));
  const Ran asked = railstep_program("receptance " + kBogieScene +
                                     " --set 'sensor=[{name=\"s\", on=\"vehicle\", "
                                     "vehicle=\"bogie\"}]' --at s --from 50 --to-hz 60");
  CHECK(asked.code == 2);
  CHECK_THAT(asked.err, Contains("E-RECEPTANCE-17"));
}
