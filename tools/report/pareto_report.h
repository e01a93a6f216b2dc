#pragma once
#include <string>

#include "study/pareto.h"

namespace railstep {

/// One self-contained HTML page: which setting to take, error over cost in time and in flops with
/// the front, the receptances' errors over frequency, and all settings in a table that sorts by any
/// column. Throws Failed where gnuplot fails.
std::string pareto_report(const std::string& title, const ParetoResult& result);

/// One line a setting, 17 digits; the columns of the JSON's rows, errors of each kind of output
/// beside.
std::string pareto_csv(const ParetoResult& result);

}  // namespace railstep
