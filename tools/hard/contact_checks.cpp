#include "hard/contact_checks.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace railstep {

void check_energy(HardResult& result, const HardRun& run, const std::string& at, double made,
                  double left) {
  const EnergyBalance energy = run.energy().value();
  result.checks.push_back(
      {at + "energy that the scheme makes", std::max(0., -energy.numerical_loss), made});
  result.checks.push_back(apart_by(at + "balance of energy but for the scheme's loss", energy.error,
                                   std::abs(energy.numerical_loss), left));
}

double largest_gap(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> gap;
  gap.reserve(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) gap.push_back(a[i] - b.at(i));
  return largest_size(gap);
}

double largest_size(const std::vector<double>& values) {
  double largest = 0.;
  for (const double value : values) {
    if (std::isnan(value)) return value;  // that no check passes
    largest = std::max(largest, std::abs(value));
  }
  return largest;
}

bool all_finite(const HardRun& run) {
  const std::vector<double>& rows = run.record().rows;
  return std::all_of(rows.begin(), rows.end(), [](double value) { return std::isfinite(value); });
}

double first_over(const HardRun& run, const std::string& column, double value) {
  const std::vector<double> values = run.column(column), time = run.time();
  for (std::size_t i = 0; i < values.size(); ++i)
    if (values[i] > value) return time[i];
  return time.back();
}

}  // namespace railstep
