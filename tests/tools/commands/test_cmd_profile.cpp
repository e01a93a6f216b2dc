// `railstep profile`: what it prints and writes, and what it refuses.
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "support/program.h"
#include "support/shipped.h"

using namespace railstep;
using Catch::Matchers::Contains;

namespace {

const std::string kProfiles = std::string(RAILSTEP_SOURCE) + "/config/profiles/";
const std::string kPair = "profile " + kProfiles + "s1002.toml " + kProfiles + "60e1.toml";

nlohmann::json profile(const std::string& words) {
  const Ran ran = railstep_program(kPair + " --json " + words);
  INFO(words << ": " << ran.err);
  REQUIRE(ran.code == 0);
  return nlohmann::json::parse(ran.out);
}

double conicity(const nlohmann::json& answer, double amplitude, const char* key) {
  for (const auto& row : answer.at("conicity"))
    if (std::fabs(row.at("amplitude_m").get<double>() - amplitude) < 1e-9)
      return row.at(key).get<double>();
  FAIL("no such amplitude");
  return 0.;
}

const nlohmann::json& at_shift(const nlohmann::json& rows, double shift) {
  for (const auto& row : rows)
    if (std::fabs(row.at("shift_m").get<double>() - shift) < 1e-9) return row;
  FAIL("no such shift");
  return rows;
}

void refused(const std::string& words, const std::string& message) {
  const Ran ran = railstep_program(words);
  INFO(words);
  CHECK(ran.code == 2);
  CHECK_THAT(ran.err, Contains(message));
  CHECK(ran.out.empty());
}

/// A wheel file with one text of S1002 replaced by another.
std::string changed(const std::filesystem::path& folder, const std::string& from,
                    const std::string& to) {
  std::string text = text_of(kProfiles + "s1002.toml");
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  text.replace(at, from.size(), to);
  const auto file = folder / "wheel.toml";
  std::ofstream(file) << text;
  return file.string();
}

}  // namespace

TEST_CASE("a pair of profiles has rows, jumps and conicities", "[profile]") {
  const nlohmann::json answer = profile("");
  const auto& row = at_shift(answer.at("rows"), 3e-3);
  CHECK(row.at("radius_difference_m").get<double>() == Approx(.95865e-3).margin(1e-6));
  CHECK(row.at("roll_rad").get<double>() == Approx(.17967e-3).margin(1e-6));
  CHECK(row.at("wheel_right_m").get<double>() == Approx(-12.718e-3).margin(5e-6));
  CHECK(row.at("wheel_left_m").get<double>() == Approx(10.437e-3).margin(5e-6));
  CHECK(row.at("angle_right_rad").get<double>() == Approx(5.135 * M_PI / 180.).margin(1e-4));
  CHECK(row.at("angle_left_rad").get<double>() == Approx(.617 * M_PI / 180.).margin(1e-4));
  CHECK(answer.at("jumps").size() == 3);
  CHECK(conicity(answer, 3e-3, "value") == Approx(.1771).margin(1e-3));
  CHECK(conicity(answer, 3e-3, "without_roll") == Approx(.1742).margin(1e-3));
  CHECK(answer.at("conicity")[0].at("at_load").is_null());
  CHECK_FALSE(answer.contains("loaded_rows"));
}

TEST_CASE("without roll the rows are those of a level wheelset", "[profile]") {
  const nlohmann::json answer = profile("--no-roll --inclination 1:20");
  for (const auto& row : answer.at("rows")) CHECK(row.at("roll_rad").get<double>() == 0.);
  CHECK(conicity(answer, 3e-3, "value") == conicity(answer, 3e-3, "without_roll"));
}

TEST_CASE("inclination and gauge move the contact", "[profile]") {
  CHECK(conicity(profile("--inclination 1:20"), 3e-3, "value") == Approx(.0095).margin(3e-4));
  CHECK(conicity(profile("--inclination 0.05"), 3e-3, "value") == Approx(.0095).margin(3e-4));
  CHECK(conicity(profile("--gauge 1.445"), 3e-3, "value") <
        .5 * conicity(profile(""), 3e-3, "value"));
}

TEST_CASE("a load adds patches that carry it, and smooths the conicity", "[profile]") {
  const nlohmann::json answer = profile("--load 60000");
  const auto& row = at_shift(answer.at("loaded_rows"), 2e-3);
  CHECK(row.at("radius_difference_m").get<double>() == Approx(.748e-3).epsilon(.08));
  for (const char* side : {"right", "left"}) {
    double upright = 0.;
    for (const auto& patch : row.at(side))
      upright += patch.at("normal_n").get<double>() * std::cos(patch.at("angle_rad").get<double>());
    CHECK(upright == Approx(60e3).epsilon(1e-3));
  }
  // CONTACT on a measured rail: .211 and .174.
  CHECK(conicity(answer, .5e-3, "at_load") == Approx(.211).epsilon(.08));
  CHECK(conicity(answer, 3e-3, "at_load") == Approx(.174).epsilon(.04));
}

TEST_CASE("the table and the CSV have what the JSON has", "[profile]") {
  const auto folder = fresh_folder("profile");
  std::filesystem::create_directories(folder);
  const auto file = folder / "rows.csv";
  const Ran ran = railstep_program(kPair + " --csv " + file.string());
  REQUIRE(ran.code == 0);
  CHECK_THAT(ran.out, Contains("S1002 on 60E1 (UIC 60), inclination 1:40, gauge 1435 mm"));
  CHECK_THAT(ran.out, Contains("0.1771"));
  std::istringstream lines(text_of(file));
  std::string line;
  std::getline(lines, line);
  CHECK(line.rfind("shift_m,radius_difference_m,roll_rad,", 0) == 0);
  int count = 0;
  while (std::getline(lines, line)) ++count;
  CHECK(count == 321);
}

TEST_CASE("measured wheels are smoothed and say by how much", "[profile]") {
  const auto folder = fresh_folder("profile_points");
  std::filesystem::create_directories(folder);
  const auto file = folder / "worn.toml";
  std::ofstream out(file);
  out << "schema = 1\nkind = \"wheel\"\nname = \"worn\"\nsource = \"here\"\nflange_back_mm = "
         "-70.0\n"
         "tolerance_mm = 0.002\npoints_mm = [\n";
  for (int i = 0; i <= 300; ++i) {
    const double s = -20. + .25 * i;
    out << "[" << s << ", " << -s / 40. + 1e-3 * std::sin(40. * i) << "],\n";
  }
  out << "]\n";
  out.close();
  const Ran ran = railstep_program("profile " + file.string() + " " + kProfiles + "60e1.toml" +
                                   " --range 0.005");
  INFO(ran.err);
  REQUIRE(ran.code == 0);
  CHECK_THAT(ran.out, Contains("wheel: smoothed points"));
  CHECK_THAT(ran.out, Contains("tolerance 0.002 mm"));
}

TEST_CASE("profiles that cannot be used are refused with file and place", "[profile]") {
  const auto folder = fresh_folder("bad_profile");
  std::filesystem::create_directories(folder);
  const std::string rail = " " + kProfiles + "60e1.toml";
  refused("profile " + changed(folder, "16.446,", "16.5,") + rail, "E-SURFACE-06");
  refused("profile " + changed(folder, "to_mm = -35.0", "to_mm = -39.0") + rail, "E-SURFACE-02");
  refused("profile " + changed(folder, "-2.747477419]", "-2.9]") + rail, "E-SURFACE-0");
  refused(
      "profile " + changed(folder, "arc_mm = [-26", "polynomial_mm = [1.0]\narc_mm = [-26") + rail,
      "E-WHEEL-01");
  refused("profile " + changed(folder, "-13.0]", "0.0]") + rail, "E-WHEEL-02");
  refused("profile " + changed(folder, "kind = \"wheel\"", "kind = \"rail\"") + rail, "kind");
  refused("profile " + changed(folder, "name =", "colour = 1\nname =") + rail, "colour");
  refused("profile" + rail + rail, "60e1.toml");
  refused(kPair + " --inclination 1:0", "E-CLI-16");
  refused(kPair + " --inclination steep", "E-CLI-16");
  refused(kPair + " --gauge 1435", "out of range");
  refused(kPair + " --gauge 1.7", "E-TOUCH-01");
}
