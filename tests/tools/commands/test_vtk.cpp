// Files for ParaView: their content, decoded here by a separate reader.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <vector>

#include "report/vtk_mesh.h"
#include "support/program.h"
#include "support/shipped.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

std::vector<unsigned char> decoded(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<unsigned char> bytes;
  unsigned word = 0, bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    word = word << 6U | static_cast<unsigned>(digits.find(c));
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes.push_back(static_cast<unsigned char>(word >> bits & 255U));
  }
  return bytes;
}

/// The n-th array of that name in a file.
template <typename T>
std::vector<T> array_of(const std::string& file, const std::string& name, int n = 0) {
  std::size_t at = 0;
  for (int i = 0; i <= n; ++i) at = file.find("Name=\"" + name + "\"", at) + 1;
  const std::size_t from = file.find('>', at) + 1, to = file.find('<', from);
  const std::vector<unsigned char> bytes = decoded(file.substr(from, to - from));
  std::uint32_t size = 0;
  REQUIRE(bytes.size() >= 4);
  std::memcpy(&size, bytes.data(), 4);
  REQUIRE(bytes.size() == size + 4);
  std::vector<T> values(size / sizeof(T));
  if (size > 0) std::memcpy(values.data(), bytes.data() + 4, size);
  return values;
}

/// The last value of a column of a trace.
double last_of(const std::string& trace, const std::string& column) {
  std::istringstream lines(trace);
  std::string names, line, row, cell;
  std::getline(lines, names);
  while (std::getline(lines, line)) row = line;
  std::istringstream heads(names), cells(row);
  while (std::getline(heads, line, ',')) {
    std::getline(cells, cell, ',');
    if (line == column) return std::stod(cell);
  }
  FAIL("no column " << column);
  return 0.;
}

}  // namespace

TEST_CASE("a mesh file holds in base64 the values put into it", "[vtk]") {
  VtkMesh mesh;
  mesh.add_force({9.F, 8.F, 7.F}, {0.F, 0.F, -1e-3F}, {0.F, 0.F, -5e4F});
  for (const float x : {0.F, 1.F})
    for (const auto& [y, z] : {std::pair{0.F, 0.F}, {1.F, 0.F}, {0.F, 1.F}})
      mesh.add_point({x, y, z}, {.1F, .2F, z});
  mesh.add_prism(VtkPart::sleeper, 1, 4, 3, true, true);
  const std::string file = mesh.polydata();
  CHECK(file.find("NumberOfPoints=\"7\" NumberOfVerts=\"1\" NumberOfPolys=\"5\"") !=
        std::string::npos);
  CHECK(array_of<float>(file, "rest_m") ==
        std::vector<float>{9, 8, 7, 0, 0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 0, 1, 1, 0, 1, 0, 1});
  CHECK(array_of<float>(file, "force_n")[2] == -5e4F);
  CHECK(array_of<std::int32_t>(file, "connectivity", 1) ==
        std::vector<std::int32_t>{1, 4, 5, 2, 2, 5, 6, 3, 3, 6, 4, 1, 1, 2, 3, 6, 5, 4});
  CHECK(array_of<std::int32_t>(file, "offsets", 1) == std::vector<std::int32_t>{4, 8, 12, 15, 18});
  CHECK(array_of<std::int32_t>(file, "part") == std::vector<std::int32_t>{3, 1, 1, 1, 1, 1});
}

TEST_CASE("a run's files for ParaView show the trace's deflection and forces", "[vtk]") {
  // The load stands on a node, where the lines alone are exact; single precision: 1e-6.
  const auto folder = fresh_folder("vtk");
  const std::string trace = (folder / "trace.csv").string(), out = (folder / "pictures").string();
  const Ran ran = railstep_program("run " + kScenes +
                                   "moving_load.toml --duration 0.25 --set 'load[0].start_m=4.8' "
                                   "--set 'load[0].speed_m_per_s=0.0' --trace " +
                                   trace + " --vtk " + out);
  CAPTURE(ran.err);
  REQUIRE(ran.code == 0);
  CHECK(entries(out) == 102);
  const std::string series = text_of(out + "/moving_load.pvd");
  CHECK(series.find("timestep=\"0\" file=\"moving_load_0000.vtp\"") != std::string::npos);
  CHECK(series.find("timestep=\"0.25\" file=\"moving_load_0100.vtp\"") != std::string::npos);

  const std::string last = text_of(out + "/moving_load_0100.vtp");
  const auto rest = array_of<float>(last, "rest_m"),
             moved = array_of<float>(last, "displacement_m"),
             force = array_of<float>(last, "force_n");
  REQUIRE(moved.size() == rest.size());
  const double deflection = last_of(text_of(trace), "load_left.deflection_z_m");
  CHECK(deflection < -1e-4);
  CHECK(force[2] == -50e3F);
  CHECK_THAT(static_cast<double>(moved[2]), WithinRel(deflection, 1e-6));
  // The whole section over the seat moves with the load, and the rail is as high as its section.
  float low = 1.F, high = -1.F;
  int found = 0;
  for (std::size_t i = 6; i < rest.size(); i += 3) {
    if (std::abs(rest[i] - 4.8F) > 1e-4F || rest[i + 1] < 0.F) continue;
    CHECK_THAT(static_cast<double>(moved[i + 2]), WithinRel(deflection, 1e-6));
    low = std::min(low, rest[i + 2]);
    high = std::max(high, rest[i + 2]);
    ++found;
  }
  CHECK(found == 4);  // a rectangle has 4 corners
  CHECK_THAT(static_cast<double>(high) - static_cast<double>(low), WithinAbs(.2319, 1e-6));
  const auto faces = array_of<std::int32_t>(last, "connectivity", 1);
  CHECK(*std::max_element(faces.begin(), faces.end()) < static_cast<std::int32_t>(rest.size() / 3));
}

TEST_CASE("the files show wheels on the rails with the forces that they carry", "[vtk]") {
  const auto folder = fresh_folder("vtk_wheels");
  const std::string trace = (folder / "trace.csv").string(), out = (folder / "pictures").string();
  const std::string model = GENERATE("full", "condensed");
  const Ran ran = railstep_program("run " + kScenes +
                                   "ballasted_track.toml --duration 0.01 "
                                   "--model " +
                                   model + " --trace " + trace + " --vtk " + out);
  CAPTURE(ran.err);
  REQUIRE(ran.code == 0);
  std::string name;
  for (const auto& entry : std::filesystem::directory_iterator(out))
    if (entry.path().extension() == ".vtp") name = std::max(name, entry.path().string());
  const std::string last = text_of(name);
  const auto force = array_of<float>(last, "force_n");
  const auto part = array_of<std::int32_t>(last, "part");
  for (const int wanted : {0, 1, 2, 3})
    CHECK(std::count(part.begin(), part.end(), wanted) > 0);  // rail, sleeper, wheel, force
  std::vector<double> shown;
  for (std::size_t i = 2; i < force.size(); i += 3)
    if (force[i] != 0.F) shown.push_back(-static_cast<double>(force[i]));
  REQUIRE(shown.size() == 2);
  CHECK_THAT(shown[0], WithinRel(last_of(text_of(trace), "wheel_left.force_z_n"), 1e-6));
  CHECK_THAT(shown[1], WithinRel(last_of(text_of(trace), "wheel_right.force_z_n"), 1e-6));
}

TEST_CASE("the files show vehicles with the forces of their wheels and the pitch of their frame",
          "[vtk]") {
  const auto folder = fresh_folder("vtk_vehicle");
  const std::string trace = (folder / "trace.csv").string(), out = (folder / "pictures").string();
  const Ran ran = railstep_program(
      "run " + kScenes +
      "bogie_at_speed.toml --duration 0.02 --set track.bays=40 --set 'sensor=[]' " +
      "--set 'vehicle[0].start_m=6.0' --set 'defect=[{kind=\"dipped_joint\", at_m=8.0, "
      "depth_m=2e-3, ramp_m=0.3}]' --trace " +
      trace + " --vtk " + out);
  CAPTURE(ran.err);
  REQUIRE(ran.code == 0);
  std::string name;
  for (const auto& entry : std::filesystem::directory_iterator(out))
    if (entry.path().extension() == ".vtp") name = std::max(name, entry.path().string());
  const std::string last = text_of(name), csv = text_of(trace);
  const auto force = array_of<float>(last, "force_n"), rest = array_of<float>(last, "rest_m"),
             moved = array_of<float>(last, "displacement_m");
  std::vector<double> shown;
  for (std::size_t i = 2; i < force.size(); i += 3)
    if (force[i] != 0.F) shown.push_back(-static_cast<double>(force[i]));
  REQUIRE(shown.size() == 2);
  for (const std::size_t wheel : {0u, 1u})
    CHECK_THAT(
        shown[wheel],
        WithinRel(last_of(csv, "bogie.wheel_" + std::to_string(wheel + 1) + ".force_z_n"), 1e-6));
  // Discs have 48 faces and two ends; the frame is a block whose eight points are the last ones.
  const auto part = array_of<std::int32_t>(last, "part");
  CHECK(std::count(part.begin(), part.end(), 2) == 2 * 50);
  REQUIRE(std::count(part.begin(), part.end(), 4) == 6);
  const std::size_t block = rest.size() - 24;
  const double length = 2.56 + 2. * .6, pitch = last_of(csv, "bogie.frame.pitch_rad");
  const auto of = [&](const std::vector<float>& values, std::size_t point, std::size_t d) {
    return static_cast<double>(values[block + 3 * point + d]);
  };
  CHECK_THAT(of(rest, 4, 0) - of(rest, 0, 0), WithinAbs(length, 1e-5));
  // At rest its two springs of 1.22 MN/m sag under frame and body. Bound: single precision of 5 mm.
  const double sag = 9307.5 * 9.81 / 2.44e6, height = last_of(csv, "bogie.frame.z_m") + sag;
  CHECK(std::abs(pitch) > 1e-4);
  CHECK_THAT(of(moved, 4, 2) - of(moved, 0, 2), WithinAbs(-length * pitch, 1e-8));
  CHECK_THAT(.5 * (of(moved, 4, 2) + of(moved, 0, 2)), WithinAbs(height, 1e-8));
  CHECK_THAT(of(moved, 2, 0) - of(moved, 0, 0), WithinAbs(.3 * pitch, 1e-8));
}

TEST_CASE("the option --vtk refuses a scene without rails and a path that is a file", "[vtk]") {
  const auto folder = fresh_folder("vtk_bad");
  const Ran bodies =
      railstep_program("run " + kScenes + "double_pendulum.toml --vtk " + (folder / "a").string());
  CHECK(bodies.code == 2);
  CHECK_THAT(bodies.err, Catch::Contains("E-RUN-05"));
  const std::string file = (folder / "file").string();
  std::ofstream(file) << "x";
  const Ran taken = railstep_program("run " + kScenes + "moving_load.toml --vtk " + file);
  CHECK(taken.code == 2);
  CHECK_THAT(taken.err, Catch::Contains("E-REPORT-06"));
  CHECK(text_of(file) == "x");
}
