#pragma once
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace railstep {

/// A table that other codes' programs compare with: remarks (#), a title, rows of numbers. A remark
/// `# own_error=...` gives their error.
struct ReferenceFile {
  double own_error = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::vector<double>> rows;

  /// Throws std::runtime_error if the file does not exist or has no row.
  explicit ReferenceFile(const std::string& path) {
    const std::string remark = "# own_error=";
    std::ifstream in(path);
    for (std::string line; std::getline(in, line);) {
      if (line.starts_with(remark)) own_error = std::stod(line.substr(remark.size()));
      if (line.empty() || line[0] == '#' || line[0] == 't') continue;  // time_s begins the title
      std::vector<double> row;
      std::istringstream numbers(line);
      for (std::string number; std::getline(numbers, number, ',');)
        row.push_back(std::stod(number));
      rows.push_back(row);
    }
    if (rows.empty()) throw std::runtime_error(path + ": no reference");
  }
};

}  // namespace railstep
