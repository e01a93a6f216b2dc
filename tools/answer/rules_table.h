#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "answer/rules.h"

namespace railstep {

/// Keys in the order of columns; NaN becomes null.
nlohmann::ordered_json to_json(const StudyRow& row);

/// One line per row, 17 significant digits, nothing where JSON has null.
std::string to_csv(const std::vector<StudyRow>& rows);

/// One line per rule, for reading: errors of chosen meshes and Poisson's ratios.
std::string to_table(const std::vector<StudyRow>& rows);

}  // namespace railstep
