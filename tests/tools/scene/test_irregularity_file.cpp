#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <string>

#include "scene/irregularity_file.h"
#include "text/read.h"

using namespace railstep;
using Catch::Matchers::Contains;

namespace {

std::filesystem::path written(const std::string& text) {
  std::filesystem::path path = std::filesystem::temp_directory_path() /
                               ("railstep_rail_" + std::to_string(getpid()) + ".csv");
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

std::string file_refusal(const std::string& text) {
  try {
    read_irregularities(written(text));
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

double at(const Signal& signal, double place) { return signal_at(signal.model(), place).value; }

}  // namespace

TEST_CASE("a track's geometry is read in its units") {
  const RailSignals rails = read_irregularities(
      written("\xEF\xBB\xBF# a car's record\r\ndistance_m,vertical_mm,cross_level_m,gauge_mm\r\n"
              "100.0,1,0.002,4\r\n100.25,-1,0,0\r\n100.5,2,0,0\r\n100.75,3,0.001,2\r\n"));
  CHECK(at(rails.z[0], 100.) == Approx(2e-3));
  CHECK(at(rails.z[1], 100.) == Approx(0.).margin(1e-16));
  CHECK(at(rails.z[0], 100.25) == Approx(-1e-3));
  CHECK(at(rails.z[1], 100.75) == Approx(2.5e-3));
  CHECK(at(rails.y[0], 100.) == Approx(2e-3));
  CHECK(at(rails.y[1], 100.) == Approx(-2e-3));
  CHECK(at(rails.z[0], 90.) == Approx(2e-3));  // constant beyond the record's ends
}

TEST_CASE("irregularities of each rail are read separately") {
  const RailSignals rails = read_irregularities(
      written("left_z_mm;distance_m;right_y_m\n1;0;.01\n2;.5;.02\n3;1;.03\n4;1.5;.04\n"));
  CHECK(at(rails.z[0], .5) == Approx(2e-3));
  CHECK(at(rails.y[1], 1.) == Approx(.03));
  CHECK(rails.z[1].coefficient.empty());
  CHECK(rails.y[0].coefficient.empty());
}

TEST_CASE("a file that is not a record of irregularities is refused with its line") {
  const std::string rows = "0,1\n.5,2\n1,3\n1.5,4\n";
  CHECK_THAT(file_refusal(""), Contains("E-FILE-07"));
  CHECK_THAT(file_refusal("\n"), Contains("E-IRREGULARITY-21"));
  CHECK_THAT(file_refusal(rows), Contains(":1:") && Contains("'0'") && Contains("distance_m"));
  CHECK_THAT(file_refusal("distance_m,vertical\n" + rows), Contains("'vertical'"));
  CHECK_THAT(file_refusal("distance_m,vertical_um\n" + rows), Contains("'vertical_um'"));
  CHECK_THAT(file_refusal("vertical_mm,gauge_mm\n" + rows),
             Contains("lacks the column distance_m") && Contains("E-IRREGULARITY-14"));
  CHECK_THAT(file_refusal("distance_m\n0\n1\n2\n3\n"),
             Contains("lacks a column") && Contains("E-IRREGULARITY-14"));
  CHECK_THAT(file_refusal("distance_m,gauge_mm,gauge_m\n"), Contains("E-IRREGULARITY-13"));
  CHECK_THAT(file_refusal("distance_m,gauge_mm,left_z_mm\n"), Contains("E-IRREGULARITY-15"));
  CHECK_THAT(file_refusal("distance_m,gauge_mm\n0,1\n.5,2\n1,3\n"),
             Contains("3 rows") && Contains("E-IRREGULARITY-18"));
  CHECK_THAT(file_refusal("distance_m,gauge_mm\n0,1\n.5,2\n1,3\n1.7,3\n"),
             Contains(":5:") && Contains("1.7 m follows 1 m") && Contains("E-IRREGULARITY-19"));
  CHECK_THAT(
      file_refusal("distance_m,gauge_mm\n0,1\n.5,2\n1,3\n2,3\n2.5,3\n3,3\n"),  // 1.5 is missing
      Contains(":5:") && Contains("2 m follows 1 m"));
  CHECK_THAT(file_refusal("distance_m,gauge_mm\n3,1\n2,2\n1,3\n0,3\n"), Contains(":3:"));
  CHECK_THAT(file_refusal("distance_m,gauge_mm\n0,1\n.5,2\n1,x\n1.5,3\n"),
             Contains(":4:") && Contains("'x'"));
  CHECK_THAT(file_refusal("distance_m,gauge_mm\n0,1\n.5,nan\n1,1\n1.5,3\n"), Contains(":3:"));
  CHECK_THAT(file_refusal("distance_m,gauge_mm\n0,1\n0.5;2,5\n1,1\n1.5,3\n"), Contains("E-CSV-03"));
  CHECK_THAT(file_refusal("distance_m,gauge_mm\n0,1\n.5\n1,1\n1.5,3\n"),
             Contains("E-IRREGULARITY-17"));
  // A spline through these numbers would overflow.
  CHECK_THAT(file_refusal("distance_m,vertical_m\n-8e307,0\n-2.7e307,0\n2.7e307,0\n8e307,0\n"),
             Contains(":2:") && Contains("at least -1000000000, at most 1000000000 m"));
  CHECK_THAT(file_refusal("distance_m,left_z_m\n0,0\n1,1e308\n2,0\n3,0\n"),
             Contains(":3:") && Contains("left_z = 1e+308 m"));
  CHECK_THAT(file_refusal("distance_m,left_z_m\n0,0\n1e-9,0\n2e-9,0\n3e-9,0\n"),
             Contains("E-IRREGULARITY-20"));
}
