#include "offline/pack/step_compliance.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "online/track/rail_point.h"

namespace railstep {
namespace {

/// Row of a vertical force at a load point, at a place in an element.
RailRow row_of(const Model& model, const LoadPoint& load_point, std::int32_t element, double xi) {
  RailRow row{load_point.rail, element, {}, 0, {}, {}};
  double shape[3];
  shape_functions(xi, shape);
  set_point_row(model.cant[load_point.rail], load_point.y, load_point.z, shape, kUp, row);
  return row;
}

/// row S^-1 row' for a banded line.
double banded_compliance(const Line& own, const LineModel& line, const LocalInverse& inverse,
                         const RailRow& row) {
  Eigen::SparseVector<double> load(own.unknowns());
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 9; ++k) {
      const double value = row.coefficient[i][k] * weight_of(line, row.rail, k);
      const int unknown = own.element_unknown(row.rail, row.element, i, k);
      if (unknown >= 0 && value != 0.) load.coeffRef(unknown) += value;
    }
  if (load.nonZeros() == 0) return 0.;
  const int *const first = load.innerIndexPtr(), *const last = first + load.nonZeros() - 1;
  const Stretch moved = inverse.solve(load, *first, *last + 1);
  double sum = 0.;
  for (Eigen::SparseVector<double>::InnerIterator at(load); at; ++at)
    sum += at.value() * moved[at.index()];
  return sum;
}

/// Re row held_force row for a condensed line.
double condensed_compliance(const LineModel& line, const RailRow& row, std::vector<double>& re,
                            std::vector<double>& im) {
  std::fill(re.begin(), re.end(), 0.);
  std::fill(im.begin(), im.end(), 0.);
  spread_modes(line, row, 1., re.data(), im.data());
  double sum = 0.;
  for (std::int32_t k = 0; k < line.size; ++k) {
    const auto at = static_cast<std::size_t>(line.first) + static_cast<std::size_t>(k);
    const std::complex<double> c(re[at], im[at]);
    sum += (std::complex<double>(line.modal.held_force.re[k], line.modal.held_force.im[k]) * c * c)
               .real();
  }
  return sum;
}

}  // namespace

StepCompliance::StepCompliance(const Model& model, const std::vector<PackedLine>& lines)
    : model_(model), lines_(lines) {
  const Scheme& s = model.scheme;
  for (const PackedLine& own : lines)
    if (model.form == Form::banded)
      inverse_.emplace_back(own.line.stiffness + s.kv * own.line.damping + s.kg * own.line.mass);
}

std::vector<double> StepCompliance::table(const LoadPoint& load_point, int points,
                                          std::int32_t elements) const {
  const auto n = static_cast<std::size_t>(model_.unknowns);
  std::vector<double> re(n), im(n), table;
  // The tables cover one bay: the one in which the traffic on a ring stands.
  const Endless& e = model_.endless;
  const auto first =
      model_.form == Form::condensed && e.bays > 0
          ? static_cast<std::int32_t>(std::lround(e.origin / e.bay_length)) * e.bay_elements
          : 0;
  for (std::int32_t element = first; element < first + elements; ++element)
    for (int p = 0; p <= points; ++p) {
      const RailRow row = row_of(model_, load_point, element, 2. * p / points - 1.);
      double sum = 0.;
      for (std::size_t l = 0; l < lines_.size(); ++l)
        sum += model_.form == Form::condensed
                   ? condensed_compliance(model_.line[l], row, re, im)
                   : banded_compliance(lines_[l].line, model_.line[l], inverse_[l], row);
      table.push_back(model_.scheme.theta * sum);
    }
  return table;
}

}  // namespace railstep
