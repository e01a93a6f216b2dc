// A vehicle in space on straight, rigid rails: modes at a speed, critical speed and static wheel
// loads, against a model with finite rotations, exact contact geometry and derivatives by the
// complex step (Manchester passenger vehicle 1, set V1a).
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/program.h"
#include "support/shipped.h"

using namespace railstep;

namespace {

nlohmann::json answer(const std::string& words) {
  const Ran ran = railstep_program(words + " --json");
  INFO(words << ": " << ran.err);
  REQUIRE(ran.code == 0);
  return nlohmann::json::parse(ran.out);
}

struct Mode {
  double hz, ratio;
};

void check_hz(const std::string& words, double hz) {
  const auto found = answer("modes " + words).at("modes");
  CHECK(std::any_of(found.begin(), found.end(), [&](const auto& m) {
    return std::fabs(m.at("frequency_hz").template get<double>() / hz - 1.) < 1e-4;
  }));
}

/// Each wanted mode is among those found: its frequency and its damping ratio within 1e-4.
void check_modes(const std::string& words, const std::vector<Mode>& wanted) {
  const auto found = answer("modes " + words).at("modes");
  for (const Mode& mode : wanted) {
    INFO(mode.hz << " Hz, damping " << mode.ratio);
    bool met = false;
    for (const auto& m : found)
      met = met || (std::fabs(m.at("frequency_hz").get<double>() / mode.hz - 1.) < 1e-4 &&
                    std::fabs(m.at("damping_ratio").get<double>() - mode.ratio) <
                        1e-4 * std::max(mode.ratio, .1));
    CHECK(met);
  }
}

const std::string kScene = shipped("manchester_straight");

}  // namespace

TEST_CASE("a vehicle in space has the modes of the reference", "[critical]") {
  check_modes(kScene + " --speed 20 --set contact.slope=0.091105769", {{1.080073, .13451},
                                                                       {1.312592, .15112},
                                                                       {7.408145, .24054},
                                                                       {7.423822, .23665},
                                                                       {11.586396, .11874},
                                                                       {.564851, .22999},
                                                                       {.871949, .55113},
                                                                       {1.212274, .34415},
                                                                       {.922152, .29331},
                                                                       {.969411, .33288},
                                                                       {9.607219, .32070},
                                                                       {12.898293, .19757},
                                                                       {38.470309, .27238}});
  // Their damping is printed with two digits. The bounce on the contact is that of a slope of 0.1.
  check_hz(kScene + " --speed 20 --set contact.slope=0.1", 26.054);
  check_hz(kScene + " --speed 20 --set contact.slope=0.1", 180.47);
  check_modes(kScene + " --speed 60", {{.564734, .23427},
                                       {.864779, .52232},
                                       {1.267574, .34718},
                                       {4.402020, .23177},
                                       {4.419875, .23258},
                                       {9.644225, .30980},
                                       {14.105287, .23092}});
  check_modes(kScene + " --speed 40 --set contact.slope=0.294479742", {{.863931, .52248},
                                                                       {5.360066, .32141},
                                                                       {5.374032, .32042},
                                                                       {9.568428, .31577},
                                                                       {13.381472, .21774}});
}

TEST_CASE("a vehicle in space hunts at the speed of the reference", "[critical]") {
  struct Known {
    const char* slope;
    double speed, hz;
  };
  for (const Known& known : {Known{"0.047632739", 96.48737, 2.78422},
                             {"0.091105769", 97.04367, 4.03845},
                             {"0.168206167", 93.51622, 5.86640},
                             {"0.294479742", 73.50241, 7.88745},
                             {"0.4", 58.84453, 0.}}) {
    const auto found =
        answer("critical " + kScene + " --from 10 --to 150 --set contact.slope=" + known.slope);
    CHECK(found.at("critical_speed_m_per_s").get<double>() == Approx(known.speed).epsilon(1e-4));
    if (known.hz > 0.)
      CHECK(found.at("frequency_hz").get<double>() == Approx(known.hz).epsilon(1e-4));
  }
  const auto none = answer("critical " + kScene + " --from 10 --to 50");
  CHECK(none.at("critical_speed_m_per_s").is_null());
}

TEST_CASE("static wheel loads of a vehicle in space are those of the reference", "[critical]") {
  const auto found =
      answer("static " + kScene + " --set contact.slope=0.1 --set vehicle[0].speed_m_per_s=20.0");
  const double q[4] = {54547.60, 54545.16, 54546.95, 54544.51};
  REQUIRE(found.at("wheels").size() == 8);
  double sum = 0.;
  for (std::size_t i = 0; i < 8; ++i) {
    const auto& wheel = found.at("wheels")[i];
    sum += wheel.at("q_n").get<double>();
    CHECK(wheel.at("q_n").get<double>() == Approx(q[i / 2]).epsilon(1e-5));
    CHECK(wheel.at("y_n").get<double>() == Approx(1215.).epsilon(1e-3));
  }
  CHECK(sum == Approx(9.81 * 44482.).epsilon(1e-9));
  for (const auto& set : found.at("wheelsets")) {
    CHECK(std::fabs(set.at("y_m").get<double>()) < 1e-9);
    CHECK(std::fabs(set.at("sum_y_n").get<double>()) < 1e-4);
  }
}

namespace {

/// The ring with rails and supports 1e4 times as stiff.
const std::string kStiffRing =
    shipped("manchester_ring") +
    " --set rail.young_pa=2.1e15 --set support.stiffness_x_n_per_m=5e11"
    " --set support.stiffness_y_n_per_m=5e11 --set support.stiffness_z_n_per_m=2e12"
    " --set support.stiffness_roll_n_m_per_rad=3e9 --set ballast.stiffness_z_n_per_m=5e11";

}  // namespace

TEST_CASE("on a stiff track a vehicle in space has the figures of rigid rails", "[critical]") {
  const std::pair<const char*, double> known[] = {
      {"0.091105769", 97.0437}, {"0.168206167", 93.5162}, {"0.294479742", 73.5024}};
  for (const auto& [slope, speed] : known) {
    INFO("slope " << slope);
    const auto found =
        answer("critical " + kStiffRing + " --from 60 --to 110 --set contact.slope=" + slope);
    CHECK(found.at("critical_speed_m_per_s").get<double>() == Approx(speed).epsilon(1e-3));
  }
  const auto rigid = answer("modes " + kScene + " --speed 60").at("modes");
  const auto stiff = answer("modes " + kStiffRing + " --speed 60").at("modes");
  for (const auto& wanted : rigid) {
    const double hz = wanted.at("frequency_hz").get<double>(),
                 ratio = wanted.at("damping_ratio").get<double>();
    INFO(hz << " Hz, damping " << ratio);
    CHECK(std::any_of(stiff.begin(), stiff.end(), [&](const auto& m) {
      return std::fabs(m.at("frequency_hz").template get<double>() / hz - 1.) < 1e-3 &&
             std::fabs(m.at("damping_ratio").template get<double>() - ratio) < 1e-3;
    }));
  }
}

TEST_CASE("wheel loads on a track that gives way are those at which a run starts", "[critical]") {
  const auto found = answer("static " + shipped("manchester_ring") +
                            " --set irregularity.geometries='[\"gauge\"]'");
  double sum = 0.;
  for (const auto& wheel : found.at("wheels")) sum += wheel.at("q_n").get<double>();
  CHECK(sum == Approx(9.81 * 44482.).epsilon(1e-8));
  CHECK(found.at("wheelsets").size() == 4);
}

TEST_CASE("the motor car has the weights and the vertical modes of its source", "[critical]") {
  const std::string car = kScene + " --set 'vehicle[0].file=\"../vehicles/gz18.toml\"'";
  const auto loads = answer("static " + car);
  for (const auto& wheel : loads.at("wheels"))
    CHECK(wheel.at("q_n").get<double>() ==
          Approx(9.81 * (30551. + 2. * 8900. + 4. * 1834. + 8.) / 8.).epsilon(1e-4));
  // Car and frames that bounce on held wheelsets. The arms of the boxes also push the wheelsets
  // along, as they end 13.5 mm above the axles: frames bounce by 2 % slower.
  const double car_kg = 30551., frames_kg = 2. * 8900., air = 4. * 230e3, primary = 8. * 1.4e6,
               air_damping = 4. * 20e3, primary_damping = 8. * 10e3;
  Eigen::Matrix4d A = Eigen::Matrix4d::Zero();
  A(0, 2) = A(1, 3) = 1.;
  A.row(2) << -air / car_kg, air / car_kg, -air_damping / car_kg, air_damping / car_kg;
  A.row(3) << air / frames_kg, -(air + primary) / frames_kg, air_damping / frames_kg,
      -(air_damping + primary_damping) / frames_kg;
  const auto modes = answer("modes " + car + " --speed 16.667").at("modes");
  for (const std::complex<double>& s : A.eigenvalues()) {
    const double hz = std::abs(s) / (2. * 3.14159265358979), ratio = -s.real() / std::abs(s);
    INFO(hz << " Hz, damping " << ratio);
    CHECK(std::any_of(modes.begin(), modes.end(), [&](const auto& m) {
      return std::fabs(m.at("frequency_hz").template get<double>() / hz - 1.) < .025 &&
             std::fabs(m.at("damping_ratio").template get<double>() / ratio - 1.) < .025;
    }));
  }
}

TEST_CASE("what a vehicle in space cannot be asked is refused", "[critical]") {
  const auto refused = [](const std::string& words, const std::string& id) {
    const Ran ran = railstep_program(words);
    INFO(words << ": " << ran.err);
    CHECK(ran.code == 2);
    CHECK_THAT(ran.err, Catch::Contains(id));
  };
  refused("critical " + kScene + " --from 50 --to 10", "E-CLI-15");
  const Ran lost = railstep_program("run " + kScene + " --set 'vehicle[0].file=\"no.toml\"'");
  CHECK(lost.code == 2);
  CHECK(std::count(lost.err.begin(), lost.err.end(), '\n') == 1);  // one error, told once
  refused("critical " + shipped("bogie_at_speed"), "E-VEHICLE-27");
  refused("modes --speed 20 " + kScene + " --set track.rails=1", "E-VEHICLE-26");
  const std::string creep = "modes --speed 20 " + kScene + " --set 'contact.creep=\"";
  refused(creep + "fastsim\"' --set contact.friction=0.3", "E-CONTACT-07");
  refused(creep + "polach\"' --set contact.friction=0.3", "E-CONTACT-07");
  refused(creep + "she\"'", "E-KEY-01");
  refused(creep + "she\"' --set contact.friction=-0.3", "E-KEY-05");
  refused(creep + "linear\"' --set contact.friction=0.3", "E-KEY-02");
}

namespace {

/// The shipped scene with a line added behind another one, wherever it stands in the vehicle's
/// file.
struct Added {
  const char *behind, *line;
};
std::string scene_with(const std::filesystem::path& folder, const std::vector<Added>& added) {
  std::filesystem::create_directories(folder / "scenes");
  std::filesystem::create_directories(folder / "vehicles");
  const std::filesystem::path config = std::filesystem::path(RAILSTEP_SOURCE) / "config";
  std::string vehicle = text_of(config / "vehicles" / "manchester_1.toml");
  for (const auto& [behind, line] : added) {
    const std::string text = std::string(behind) + "\n" + line;
    REQUIRE(vehicle.find(behind) != std::string::npos);
    for (std::size_t at = vehicle.find(behind); at != std::string::npos;
         at = vehicle.find(behind, at + text.size()))
      vehicle.replace(at, std::string(behind).size(), text);
  }
  std::ofstream(folder / "vehicles" / "manchester_1.toml") << vehicle;
  const auto scene = folder / "scenes" / "straight.toml";
  std::ofstream(scene) << text_of(config / "scenes" / "manchester_straight.toml");
  return scene.string();
}

}  // namespace

TEST_CASE("dampers in series with springs have the critical speeds of the reference",
          "[critical]") {
  const auto folder = fresh_folder("series");
  const std::string scene =
      scene_with(folder, {{"damping_n_s_per_m = [15.0e3, 2.0e3, 4.0e3]",
                           "series_stiffness_n_per_m = [60.0e6, 7.5e6, 1.0e6]"},
                          {"damping_n_s_per_m = [0.0, 32.0e3, 20.0e3]",
                           "series_stiffness_n_per_m = [0.0, 6.0e6, 6.0e6]"}});
  struct Known {
    const char* slope;
    double speed;
  };
  for (const Known& known : {Known{"0.091105769", 99.2747}, {"0.168206167", 95.1044}}) {
    const auto found =
        answer("critical " + scene + " --from 10 --to 150 --set contact.slope=" + known.slope);
    CHECK(found.at("critical_speed_m_per_s").get<double>() == Approx(known.speed).epsilon(1e-4));
  }
  check_hz(scene + " --speed 20", 7.742);
  std::filesystem::remove_all(folder);
}

TEST_CASE("the bodies of a vehicle's file are checked", "[critical]") {
  const auto folder = fresh_folder("bodies");
  const auto refused = [&](const Added& added, const std::string& id) {
    const Ran ran = railstep_program("modes --speed 20 " + scene_with(folder, {added}));
    INFO(added.line << ": " << ran.err);
    CHECK(ran.code == 2);
    CHECK_THAT(ran.err, Catch::Contains(id));
  };
  const char* const bar = "type = \"anti_roll_bar\"";
  refused({bar, "mirror = true"}, "E-VEHICLE-22");
  refused({"stiffness_n_m_per_rad = 940.0e3               # B",
           "[[bogie.element]]\nname = \"rod\"\ntype = \"spring\"\nbetween = [\"car\", \"no\"]\n"
           "points_m = [[0, 0, 1], [1, 0, 1]]\nstiffness_n_per_m = 1.0"},
          "E-VEHICLE-20");
  refused({"stiffness_n_m_per_rad = 940.0e3               # B",
           "[[bogie.element]]\nname = \"rod\"\ntype = \"spring\"\nbetween = [\"car\", "
           "\"bogie\"]\npoints_m = [[0, 0, 1]]\nstiffness_n_per_m = 1.0"},
          "E-VEHICLE-21");
  refused({"type = \"rail_vehicle\"",
           "\n[[body]]\nname = \"loose\"\nmass_kg = 1.0\n"
           "inertia_kg_m2 = [1, 1, 1]\ncentre_m = [0, 0, 1]"},
          "E-SUSPENSION-05");
  refused({"type = \"rail_vehicle\"",
           "\n[[body]]\nname = \"car\"\nmass_kg = 1.0\n"
           "inertia_kg_m2 = [1, 1, 1]\ncentre_m = [0, 0, 1]"},
          "E-VEHICLE-24");
  std::filesystem::remove_all(folder);
}

TEST_CASE("the root locus is drawn with the answer in words", "[critical][cli]") {
  const auto page = fresh_folder("critical") / "critical.html";
  const std::string scene =
      std::string(RAILSTEP_SOURCE) + "/config/scenes/manchester_straight.toml";
  const Ran ran =
      railstep_program("critical " + scene + " --from 80 --to 100 --report " + page.string());
  REQUIRE(ran.code == 0);
  const std::string text = text_of(page);
  CHECK_THAT(text, Catch::Contains("hunts from 93.52 m/s") && Catch::Contains("</html>"));
  std::size_t drawings = 0;
  for (std::size_t at = text.find("<svg"); at != std::string::npos; at = text.find("<svg", at + 1))
    ++drawings;
  CHECK(drawings == 2);
  const Ran none =
      railstep_program("critical " + scene + " --from 40 --to 60 --report " + page.string());
  REQUIRE(none.code == 0);
  CHECK_THAT(text_of(page), Catch::Contains("No mode loses its damping"));
}
