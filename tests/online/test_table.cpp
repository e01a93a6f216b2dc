#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <vector>

#include "online/math/table.h"
#include "online/track/travel.h"

using namespace railstep;

namespace {

double at(const std::vector<double>& table, std::int32_t row, std::int32_t width) {
  return table[static_cast<std::size_t>(row) * static_cast<std::size_t>(width)];
}

/// Expected result of the search, found by going through all rows.
std::int32_t last_not_above(const std::vector<double>& table, std::int32_t width, double value) {
  const auto rows = static_cast<std::int32_t>(table.size()) / width;
  std::int32_t found = 0;
  for (std::int32_t i = 0; i < rows; ++i)
    if (at(table, i, width) <= value) found = i;
  return found;
}

std::vector<double> rising(std::int32_t rows, std::int32_t width, std::mt19937_64& random) {
  std::uniform_real_distribution<double> between(0., 1.);
  std::vector<double> table;
  double time = -3.;
  for (std::int32_t i = 0; i < rows; ++i) {
    time += between(random) + 1e-3;
    table.push_back(time);
    for (std::int32_t k = 1; k < width; ++k) table.push_back(between(random));
  }
  return table;
}

}  // namespace

TEST_CASE("the search finds the row that going through all rows finds", "[table]") {
  std::mt19937_64 random(7);
  for (const std::int32_t width : {1, 2, 3})
    for (const std::int32_t rows : {1, 2, 3, 4, 5, 7, 8, 9, 31, 64, 1000}) {
      const std::vector<double> table = rising(rows, width, random);
      std::uniform_real_distribution<double> time(-4., table[table.size() - 1] + 600.);
      const auto check = [&](double value) {
        CAPTURE(width, rows, value);
        CHECK(row_at(table.data(), width, rows, value) == last_not_above(table, width, value));
      };
      for (int i = 0; i < 50; ++i) check(time(random));
      for (std::int32_t i = 0; i < std::min(rows, 10); ++i)  // on a row itself, and beside it
        for (const double off : {0., -1e-9, 1e-9}) check(at(table, i, width) + off);
    }
}

TEST_CASE("a table's value is linear between its rows and constant outside them", "[table]") {
  const double table[] = {0., 1., .5, 3., 2., -3.};
  const double times[] = {-1., 0., .25, .5, 1.25, 2., 9.};
  const double values[] = {1., 1., 2., 3., 0., -3., -3.};
  for (int i = 0; i < 7; ++i) {
    CAPTURE(times[i]);
    CHECK(table_value(table, 3, times[i]) == values[i]);
  }
  CHECK(table_value(table, 1, -1.) == 1.);
  CHECK(table_value(table, 1, 7.) == 1.);
}

TEST_CASE("the distance by a table of speeds is a parabola between its rows", "[table]") {
  // From 10 to 20 m/s in 2 s, then 20 m/s until 4 s, at rest from 5 s on.
  const double rows[] = {0., 10., 0., 2., 20., 30., 4., 20., 70., 5., 0., 80.};
  const TravelModel travel{20., 4, rows};
  const double times[] = {-1., 0., 1., 2., 3., 4.5, 5., 8.};
  const double distances[] = {-10., 0., 12.5, 30., 50., 77.5, 80., 80.};
  const double speeds[] = {10., 10., 15., 20., 20., 10., 0., 0.};
  for (int i = 0; i < 8; ++i) {
    CAPTURE(times[i]);
    const Travelled at = travelled(travel, times[i]);
    CHECK(at.distance == distances[i]);
    CHECK(at.speed == speeds[i]);
  }
}
