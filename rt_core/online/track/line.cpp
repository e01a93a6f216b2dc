#include "online/track/line.h"

namespace railstep {

namespace {

Complex shape_of(const Modal& modal, std::int32_t row) noexcept {
  const double* re = modal.shape + 2 * static_cast<std::ptrdiff_t>(row) * modal.count;
  return {re, re + modal.count};
}

/// Calls visit(unknown, weight) for those unknowns of a row that a line has.
template <typename Visit>
void for_carried(const LineModel& line, const RailRow& row, Visit visit) noexcept {
  if (line.rail_factor[row.rail] == 0.) return;
  const std::int32_t* const table = line.unknown_of[row.rail];
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 9; ++k) {
      const std::int32_t unknown = table[table_place({row.element, i}, k)];
      if (unknown < 0 || row.coefficient[i][k] == 0.) continue;
      visit(unknown, weight_of(line, row.rail, k) * row.coefficient[i][k]);
    }
  for (std::int32_t s = 0; s < row.seats; ++s)
    for (int k = 5; k <= 7; k += 2) {
      const std::int32_t unknown = table[table_place(row.seat[s], k)];
      if (unknown >= 0)
        visit(unknown, (k == 5 ? .5 : -.5) * weight_of(line, row.rail, k) * row.lever[s]);
    }
}

}  // namespace

double unknown_value(const LineModel& line, std::int32_t unknown,
                     const Configuration& at) noexcept {
  if (line.modal.count == 0) return at.u[line.first + unknown];
  return modes_dot(shape_of(line.modal, unknown),
                   {at.modes.re + line.first, at.modes.im + line.first}, line.modal.count);
}

double nodal_value(const LineModel& line, std::int32_t rail, ElementNode node, int k,
                   const Configuration& at) noexcept {
  const std::int32_t unknown = line.unknown_of[rail][table_place(node, k)];
  return unknown < 0 ? 0. : unknown_value(line, unknown, at);
}

double axis_height(const Model& model, std::int32_t rail, std::int32_t element, double xi,
                   const Configuration& at) noexcept {
  double shape[3], sum = 0.;
  shape_functions(xi, shape);
  const Cant& cant = model.cant[rail];
  for (std::int32_t l = 0; l < model.lines; ++l)
    for (int i = 0; i < 3; ++i) {
      sum += shape[i] * (cant.cosine * weight_of(model.line[l], rail, 2)) *
             nodal_value(model.line[l], rail, {element, i}, 2, at);
      if (cant.sine == 0.) continue;
      sum += shape[i] * (cant.sine * weight_of(model.line[l], rail, 1)) *
             nodal_value(model.line[l], rail, {element, i}, 1, at);
    }
  return sum;
}

bool carries(const LineModel& line, const RailRow& row) noexcept {
  if (line.rail_factor[row.rail] == 0.) return false;
  // Most rows carry an unknown of the first node.
  const std::int32_t* const table = line.unknown_of[row.rail];
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 9; ++k)
      if (row.coefficient[i][k] != 0. && table[table_place({row.element, i}, k)] >= 0) return true;
  for (std::int32_t s = 0; s < row.seats; ++s)
    for (int k = 5; k <= 7; k += 2)
      if (table[table_place(row.seat[s], k)] >= 0) return true;
  return false;
}

double motion(const LineModel& line, const RailRow& row, const Configuration& at) noexcept {
  double sum = 0.;
  for_carried(line, row, [&](std::int32_t unknown, double weight) noexcept {
    sum += weight * unknown_value(line, unknown, at);
  });
  return sum;
}

void spread(const LineModel& line, const RailRow& row, double force, double* rhs) noexcept {
  for_carried(line, row, [&](std::int32_t unknown, double weight) noexcept {
    rhs[line.first + unknown] += force * weight;
  });
}

void carry(const LineModel& line, const RailRow& row, CarriedRow& carried) noexcept {
  carried.count = 0;
  for_carried(line, row, [&](std::int32_t unknown, double weight) noexcept {
    // The roll of a section that does not strain is its a_z and its b_y.
    const int last = carried.count - 1;
    if (last >= 0 && carried.unknown[last] == unknown) {
      carried.weight[last] += weight;
      return;
    }
    carried.unknown[carried.count] = unknown;
    carried.weight[carried.count++] = weight;
  });
}

double between(const Modal& modal, const CarriedRow& a, const CarriedRow& b) noexcept {
  const auto row_of = [&](std::int32_t unknown) noexcept {
    return modal.between + std::ptrdiff_t{unknown} * (unknown + 1) / 2;
  };
  const double* of_b[kMostCarried];
  for (int k = 0; k < b.count; ++k) of_b[k] = row_of(b.unknown[k]);
  double sum = 0.;
  for (int i = 0; i < a.count; ++i) {
    const std::int32_t own = a.unknown[i];
    const double* const of_a = row_of(own);
    double along = 0.;
    for (int k = 0; k < b.count; ++k) {
      const std::int32_t other = b.unknown[k];
      along += b.weight[k] * (own > other ? of_a[other] : of_b[k][own]);
    }
    sum += a.weight[i] * along;
  }
  return sum;
}

Panels panels_of(const LineModel& line, const RailRow& row) noexcept {
  std::int32_t first = line.size, last = -1;
  for_carried(line, row, [&](std::int32_t unknown, double) noexcept {
    if (unknown < first) first = unknown;
    if (unknown > last) last = unknown;
  });
  return last < 0 ? Panels{0, 0} : Panels{first / kLanes, last / kLanes + 1};
}

void shape_row(const LineModel& line, const RailRow& row, double* re, double* im) noexcept {
  CarriedRow carried;
  carry(line, row, carried);
  const double *shape[kMostCarried], *imaginary[kMostCarried];
  const double* const weight = carried.weight;
  const int count = carried.count;
  for (int i = 0; i < count; ++i) {
    const Complex own = shape_of(line.modal, carried.unknown[i]);
    shape[i] = own.re;
    imaginary[i] = own.im;
  }
  for (std::int32_t k = 0; k < line.size; k += kLanes) {
    double sum_re[kLanes] = {}, sum_im[kLanes] = {};
    for (int i = 0; i < count; ++i) {
#pragma omp simd
      for (int l = 0; l < kLanes; ++l) {
        sum_re[l] += weight[i] * shape[i][k + l];
        sum_im[l] += weight[i] * imaginary[i][k + l];
      }
    }
    for (int l = 0; l < kLanes; ++l) re[line.first + k + l] = sum_re[l];
    for (int l = 0; l < kLanes; ++l) im[line.first + k + l] = sum_im[l];
  }
}

void spread_modes(const LineModel& line, const RailRow& row, double force, double* re,
                  double* im) noexcept {
  for_carried(line, row, [&](std::int32_t unknown, double weight) noexcept {
    modes_add(force * weight, shape_of(line.modal, unknown), re + line.first, im + line.first,
              line.modal.count);
  });
}

}  // namespace railstep
