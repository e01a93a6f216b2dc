// Forces and travels of linear elements in the trace.
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "support/bad_input.h"
#include "support/own_element.h"
#include "support/scene_run.h"

using namespace railstep;

namespace {

const std::vector<std::string> kIntoCurve = {
    "line.transition=\"bloss\"", "line.curvature_table=[[0.0,0.0],[20.0,0.0],[60.0,0.0016]]",
    "line.cant_table=[[0.0,0.0],[20.0,0.0],[60.0,0.1]]", "step.duration_s=3.0",
    "step.frame_s=1e-3"};

/// A shipped scene with the linear elements of manchester_1 in the trace.
Scene all_traced(const std::string& scene, std::vector<std::string> words) {
  const std::filesystem::path folder = fresh_folder("traced_element");
  std::filesystem::create_directories(folder);
  std::string text =
      text_of(std::filesystem::path(RAILSTEP_SOURCE) / "config" / "vehicles" / "manchester_1.toml");
  const std::string mirror = "mirror = true\n";
  for (std::size_t at = 0; (at = text.find(mirror, at)) != std::string::npos; at += mirror.size())
    text.insert(at, "trace = true\n"), at += 13;
  std::ofstream(folder / "vehicle.toml") << text;
  words.push_back("vehicle[0].file=\"" + (folder / "vehicle.toml").string() + "\"");
  return read_scene(shipped(scene), words);
}

}  // namespace

TEST_CASE("a linear element moves as one beside it that is not linear, in a curve too",
          "[traced_elements]") {
  const std::string point = "point_m = [9.5, 0.0, 0.7]\n",
                    points = "points_m = [[8.5, 1.2, 0.6], [9.5, 1.2, 0.6]]\n";
  const std::string elements =
      element_on_bogie("stop", "type = \"bump_stop\"\naxis = \"y\"\n" + point +
                                   "table = [[0.0, 0.0], [0.1, 1e4]]\n") +
      element_on_bogie("bush", "type = \"bushing\"\ntrace = true\n" + point +
                                   "stiffness_n_per_m = [0.0, 2e4, 0.0]\n"
                                   "damping_n_s_per_m = [0.0, 5e3, 0.0]\n") +
      element_on_bogie("yaw", "type = \"nonlinear_damper\"\n" + points +
                                  "table = [[0.0, 0.0], [0.01, 5e3], [1.0, 6e3]]\n") +
      element_on_bogie("line", "type = \"spring_damper\"\ntrace = true\n" + points +
                                   "stiffness_n_per_m = 3e5\ndamping_n_s_per_m = 2e4\n") +
      element_on_bogie("maxwell", "type = \"maxwell\"\ntrace = true\n" + points +
                                      "series_stiffness_n_per_m = 2e6\ndamping_n_s_per_m = 1e5\n");
  const Traced run(scene_with_elements(elements, "manchester_curve", kIntoCurve));
  const std::vector<double> stop = run["car.stop.travel_m"], bush = run["car.bush.travel_y_m"],
                            on_bush = run["car.bush.force_y_n"], yaw = run["car.yaw.travel_m"],
                            line = run["car.line.travel_m"], tension = run["car.line.force_n"],
                            behind = run["car.maxwell.travel_m"], slow = run["car.maxwell.force_n"];
  constexpr double kFrame = 1e-3;
  CHECK(largest_of(stop) > 1.5e-3);
  CHECK(largest_of(yaw) > 1e-3);
  for (std::size_t i = 1; i + 1 < stop.size(); ++i) {
    CHECK(bush[i] == Approx(stop[i]).margin(1e-14));
    CHECK(line[i] == Approx(yaw[i]).margin(1e-14));
    CHECK(behind[i] == Approx(yaw[i]).margin(1e-14));
    const double rate = (bush[i + 1] - bush[i - 1]) / (2. * kFrame),
                 way = (line[i + 1] - line[i - 1]) / (2. * kFrame);
    CHECK(on_bush[i] == Approx(-2e4 * bush[i] - 5e3 * rate).margin(1.));
    CHECK(tension[i] == Approx(3e5 * line[i] + 2e4 * way).margin(5.));
    // F' = s (z' - F / c).
    const double rises = (slow[i + 1] - slow[i - 1]) / (2. * kFrame);
    CHECK(rises == Approx(2e6 * (way - slow[i] / 1e5)).margin(1e-3 * 2e6 * .05));
  }
  CHECK(largest_of(on_bush) > 50.);
  CHECK(largest_of(slow) > 200.);
}

TEST_CASE("the forces of a suspension carry its bodies through a curve", "[traced_elements]") {
  const double speed = 28., curvature = 1. / 600., roll = std::asin(.1 / 1.5);
  const Traced run(all_traced("manchester_curve", {"step.duration_s=0.1"}));
  const auto sum = [&](const std::vector<std::string>& elements, const char* of) {
    double all = 0.;
    for (const std::string& element : elements)
      for (const char* side : {"_left", "_right"})
        all += run["car." + element + side + "." + of].back();
    return all;
  };
  const double inwards = speed * speed * curvature * std::cos(roll) - 9.81 * std::sin(roll),
               upwards = speed * speed * curvature * std::sin(roll) + 9.81 * std::cos(roll);
  CHECK(sum({"secondary_1", "secondary_2"}, "force_z_n") == Approx(32000. * upwards).epsilon(1e-3));
  double most = 0.;
  for (const char* set : {"leading_1", "trailing_1", "leading_2", "trailing_2"})
    most = std::max(most, std::fabs(run["car." + std::string(set) + ".sum_y_n"].back()));
  for (const char* set : {"leading_1", "trailing_1", "leading_2", "trailing_2"}) {
    // On the bogie. The axes of both bodies differ by the wheelset's roll.
    const double on_bogie = sum({"primary_" + std::string(set)}, "force_y_n"),
                 on_track = run["car." + std::string(set) + ".sum_y_n"].back();
    CAPTURE(set, on_bogie, on_track);
    CHECK(on_bogie == Approx(-on_track - 1813. * inwards).margin(.01 * most));
  }
}

TEST_CASE("a traced bushing turns as its bodies and the frames between them do",
          "[traced_elements]") {
  const double curvature = 1. / 600., roll = -std::asin(.1 / 1.5), apart = 9.5;
  const Traced run(scene_with_elements(
      element_on_bogie("bush",
                       "type = \"bushing\"\ntrace = true\npoint_m = [9.5, 0.0, 0.7]\n"
                       "stiffness_n_per_m = [0.0, 0.0, 0.0]\n"
                       "stiffness_n_m_per_rad = [1e3, 2e3, 3e3]\n"),
      "manchester_curve", {"step.duration_s=0.1"}));
  const auto last = [&](const std::string& column) { return run["car." + column].back(); };
  const auto beside = [&](const std::string& angle) {
    return last("car." + angle) - last("bogie_1." + angle);
  };
  // The frame of the car, behind that of the bogie, is turned back about the vertical.
  CHECK(last("bush.roll_rad") == Approx(beside("roll_rad")).margin(1e-12));
  CHECK(last("bush.pitch_rad") ==
        Approx(beside("pitch_rad") - curvature * apart * std::sin(roll)).margin(1e-6));
  CHECK(last("bush.yaw_rad") ==
        Approx(beside("yaw_rad") - curvature * apart * std::cos(roll)).margin(1e-5));
  CHECK(last("bush.moment_x_n_m") == Approx(-1e3 * last("bush.roll_rad")));
  CHECK(last("bush.moment_y_n_m") == Approx(-2e3 * last("bush.pitch_rad")));
  CHECK(last("bush.moment_z_n_m") == Approx(-3e3 * last("bush.yaw_rad")));
}

TEST_CASE("vehicles of a train and couplers have their own traced elements", "[traced_elements]") {
  const std::string at = "point_m = [9.5, 0.0, 0.7]\n";
  const std::string file =
      vehicle_with_elements(element_on_bogie("stop", "type = \"bump_stop\"\naxis = \"y\"\n" + at +
                                                         "table = [[0.0, 0.0], [0.1, 1e4]]\n") +
                            element_on_bogie("bush", "type = \"bushing\"\ntrace = true\n" + at +
                                                         "stiffness_n_per_m = [0.0, 2e4, 0.0]\n"));
  const auto vehicle = [&](const std::string& name, const std::string& start) {
    return "{name=\"" + name + "\",start_m=" + start + ",speed_m_per_s=20.0,file=\"" + file + "\"}";
  };
  const auto coupler = [](const std::string& name, const std::string& y, const std::string& keys) {
    return "{name=\"" + name + "\",between=[\"last.car\",\"first.car\"],points_m=[[12.0," + y +
           ",1.0],[-12.0," + y + ",1.0]]," + keys + "}";
  };
  const std::string draw = "type=\"spring_damper\",stiffness_n_per_m=1e6,damping_n_s_per_m=2e4",
                    damper = "type=\"nonlinear_damper\",table=[[0.0,0.0],[1.0,1e3]]";
  std::vector<std::string> words = kIntoCurve;
  words.insert(
      words.end(),
      {"vehicle=[" + vehicle("last", "0.0") + "," + vehicle("first", "25.0") + "]",
       "coupler=[" + coupler("draw_a", "0.5", draw) + "," + coupler("damp_a", "0.5", damper) + "," +
           coupler("draw_b", "-0.6", draw) + "," + coupler("damp_b", "-0.6", damper) + "]"});
  const Traced run(read_scene(shipped("manchester_curve"), words));
  for (const std::string name : {"last", "first"}) {
    const std::vector<double> stop = run[name + ".stop.travel_m"],
                              bush = run[name + ".bush.travel_y_m"];
    CHECK(largest_of(stop) > 1e-3);
    for (std::size_t i = 0; i < stop.size(); i += 50)
      CHECK(bush[i] == Approx(stop[i]).margin(1e-13));
  }
  for (const std::string name : {"a", "b"}) {
    const std::vector<double> z = run["draw_" + name + ".travel_m"],
                              beside = run["damp_" + name + ".travel_m"],
                              force = run["draw_" + name + ".force_n"];
    CHECK(largest_of(z) > 1e-4);
    for (std::size_t i = 50; i + 1 < z.size(); i += 50) {
      CHECK(z[i] == Approx(beside[i]).margin(1e-12));
      CHECK(force[i] ==
            Approx(1e6 * z[i] + 2e4 * (z[i + 1] - z[i - 1]) / 2e-3).epsilon(.01).margin(5.));
    }
  }
}

TEST_CASE("elements in the trace have a limit and a place in the file", "[traced_elements]") {
  std::string many;
  for (int i = 0; i < 22; ++i)
    many += element_on_bogie("bush_" + std::to_string(i),
                             "type = \"bushing\"\ntrace = true\npoint_m = [9.5, 0.0, 0.7]\n"
                             "stiffness_n_per_m = [1.0, 1.0, 1.0]\n");
  const Scene scene = scene_with_elements(many, "manchester_curve", {});
  CHECK_THROWS_WITH(Simulation(scene), Catch::Contains("E-PACK-63"));
  CHECK_THROWS_WITH(
      scene_with_elements(element_on_bogie("stop",
                                           "type = \"bump_stop\"\ntrace = true\naxis = \"y\"\n"
                                           "point_m = [9.5, 0.0, 0.7]\nclearance_m = 0.01\n"
                                           "stiffness_n_per_m = 1e5\n"),
                          "manchester_curve", {}),
      Catch::Contains("E-KEY-02"));
}
