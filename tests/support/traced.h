#pragma once
#include <catch2/catch.hpp>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "support/program.h"

namespace railstep {

struct Rows {
  std::string header;
  std::vector<std::vector<double>> row;

  /// Number of the column with that name.
  std::size_t column(const std::string& name) const {
    std::istringstream names(header);
    std::string own;
    for (std::size_t c = 0; std::getline(names, own, ','); ++c)
      if (own == name) return c;
    FAIL("no column " + name);
    return 0;
  }
};

inline Rows rows_of(const std::string& csv) {
  Rows rows;
  std::istringstream lines(csv);
  std::string line, cell;
  std::getline(lines, rows.header);
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    rows.row.emplace_back();
    while (std::getline(cells, cell, ','))
      rows.row.back().push_back(std::strtod(cell.c_str(), nullptr));
  }
  return rows;
}

/// The trace of a run of the real program.
inline Rows traced(const std::string& words) {
  const auto file = fresh_folder("traced") / "t.csv";
  const Ran ran = railstep_program("run " + words + " --trace " + file.string());
  CAPTURE(words, ran.err);
  REQUIRE(ran.code == 0);
  return rows_of(text_of(file));
}

inline nlohmann::json told(const std::string& words) {
  const Ran ran = railstep_program("run " + words + " --json");
  CAPTURE(words, ran.err);
  REQUIRE(ran.code == 0);
  return nlohmann::json::parse(ran.out);
}

}  // namespace railstep
