#include "online/track/line.h"

#include <bit>

namespace railstep {

namespace {

Complex shape_of(const Modal& modal, std::int32_t row) noexcept {
  const double* re = modal.shape + 2 * static_cast<std::ptrdiff_t>(row) * modal.count;
  return {re, re + modal.count};
}

/// Calls visit(unknown, weight) for those unknowns of the roll over a node that a line has. The
/// roll of a section that does not strain is one unknown, its a_z and its b_y.
template <typename Visit>
void for_roll(const LineModel& line, std::int32_t rail, std::int32_t node, Visit visit) noexcept {
  const std::int32_t* const table = line.unknown_of[rail];
  const std::int32_t a = table[table_place(node, 5)], b = table[table_place(node, 7)];
  const double of_a = .5 * weight_of(line, rail, 5), of_b = -.5 * weight_of(line, rail, 7);
  if (a >= 0) visit(a, a == b ? of_a + of_b : of_a);
  if (b >= 0 && b != a) visit(b, of_b);
}

/// Calls visit(unknown, weight) for those unknowns of a row that a line has.
template <typename Visit>
void for_carried(const LineModel& line, const RailRow& row, Visit visit) noexcept {
  if (line.rail_factor[row.rail] == 0.) return;
  const std::int32_t* const table = line.unknown_of[row.rail];
  for (int i = 0; i < 3; ++i)
    for (auto left = static_cast<std::uint32_t>(line.components); left != 0; left &= left - 1) {
      const int k = std::countr_zero(left);
      const std::int32_t unknown = table[table_place({row.element, i}, k)];
      if (unknown < 0 || row.coefficient[i][k] == 0.) continue;
      visit(unknown, weight_of(line, row.rail, k) * row.coefficient[i][k]);
    }
  for (std::int32_t s = 0; s < row.seats; ++s)
    for_roll(line, row.rail, row.seat[s], [&](std::int32_t unknown, double weight) noexcept {
      visit(unknown, weight * row.lever[s]);
    });
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

bool carries(const LineModel& line, const RailRow& row) noexcept {
  if (line.rail_factor[row.rail] == 0.) return false;
  // Most rows carry an unknown of the first node.
  const std::int32_t* const table = line.unknown_of[row.rail];
  for (int i = 0; i < 3; ++i)
    for (auto left = static_cast<std::uint32_t>(line.components); left != 0; left &= left - 1) {
      const int k = std::countr_zero(left);
      if (row.coefficient[i][k] != 0. && table[table_place({row.element, i}, k)] >= 0) return true;
    }
  for (std::int32_t s = 0; s < row.seats; ++s)
    for (int k = 5; k <= 7; k += 2)
      if (table[table_place(row.seat[s], k)] >= 0) return true;
  return false;
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

namespace {

/// Displacement by three unknowns of a condensed line; its modes are read once for all of them.
double motion_of_three(const LineModel& line, const CarriedRow& carried, Complex at) noexcept {
  Complex shape[3];
  for (int i = 0; i < 3; ++i) shape[i] = shape_of(line.modal, carried.unknown[i]);
  const double *const weight = carried.weight, *const re = at.re + line.first,
                      *const im = at.im + line.first;
  double sum[kLanes] = {};
  for (std::int32_t k = 0; k < line.size; k += kLanes) {
#pragma omp simd
    for (int l = 0; l < kLanes; ++l) {
      const double own_re = (weight[0] * shape[0].re[k + l] + weight[1] * shape[1].re[k + l]) +
                            weight[2] * shape[2].re[k + l];
      const double own_im = (weight[0] * shape[0].im[k + l] + weight[1] * shape[1].im[k + l]) +
                            weight[2] * shape[2].im[k + l];
      sum[l] += own_re * re[k + l] - own_im * im[k + l];
    }
  }
  return lane_sum(sum);
}

}  // namespace

double motion(const LineModel& line, const RailRow& row, const Configuration& at) noexcept {
  CarriedRow carried;
  carry(line, row, carried);
  if (line.modal.count > 0 && carried.count == 3) return motion_of_three(line, carried, at.modes);
  double sum = 0.;
  for (int i = 0; i < carried.count; ++i)
    sum += carried.weight[i] * unknown_value(line, carried.unknown[i], at);
  return sum;
}

double axis_height(const Model& model, std::int32_t rail, std::int32_t element, double xi,
                   const Configuration& at) noexcept {
  const Cant& cant = model.cant[rail];
  RailRow row{};
  row.rail = rail;
  row.element = element;
  double shape[3];
  shape_functions(xi, shape);
  for (int i = 0; i < 3; ++i) {
    row.coefficient[i][1] = shape[i] * cant.sine;
    row.coefficient[i][2] = shape[i] * cant.cosine;
  }
  return motion(model, row, at);
}

namespace {

/// Numbers of three rows of the table, with their weights. @param adds  to y; else y is overwritten
template <bool adds>
void read_three(const double* const* row, const double* weight, const std::int32_t* unknown,
                int count, double* y) noexcept {
  const double *a = row[0], *b = row[1], *c = row[2];
  for (int k = 0; k < count; ++k) {
    const std::int32_t at = unknown[k];
    const double sum = (weight[0] * a[at] + weight[1] * b[at]) + weight[2] * c[at];
    y[k] = adds ? y[k] + sum : sum;
  }
}

}  // namespace

void read_table(const Modal& modal, const CarriedPart& own, const std::int32_t* unknown, int count,
                double* y) noexcept {
  for (int i = 0; i < own.count; i += 3) {
    const double* row[3];
    double weight[3] = {};
    for (int m = 0; m < 3; ++m) {
      const int at = i + m < own.count ? i + m : i;  // else its weight is 0
      row[m] = modal.between + std::ptrdiff_t{own.unknown[at]} * modal.rows;
      if (i + m < own.count) weight[m] = own.weight[at];
    }
    if (i == 0)
      read_three<false>(row, weight, unknown, count, y);
    else
      read_three<true>(row, weight, unknown, count, y);
  }
}

Panels panels_of(const LineModel& line, const RailRow& row) noexcept {
  std::int32_t first = line.size, last = -1;
  for_carried(line, row, [&](std::int32_t unknown, double) noexcept {
    if (unknown < first) first = unknown;
    if (unknown > last) last = unknown;
  });
  return last < 0 ? Panels{0, 0} : Panels{first / kLanes, last / kLanes + 1};
}

namespace {

/// re, im  of the line
void shape_carried(const LineModel& line, const CarriedRow& carried, double* re,
                   double* im) noexcept {
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
    for (int l = 0; l < kLanes; ++l) re[k + l] = sum_re[l];
    for (int l = 0; l < kLanes; ++l) im[k + l] = sum_im[l];
  }
}

/// The shape of a row that carries `count` unknowns, and its motions as modes_dot() takes them, all
/// of the line.
template <int count>
TwoMotions shape_and_move(const LineModel& line, const CarriedRow& carried, Complex first,
                          Complex second, double* __restrict re, double* __restrict im) noexcept {
  Complex shape[count];
  double weight[count];
  for (int i = 0; i < count; ++i) {
    shape[i] = shape_of(line.modal, carried.unknown[i]);
    weight[i] = carried.weight[i];
  }
  double sum[kLanes] = {}, other[kLanes] = {};
  for (std::int32_t k = 0; k < line.size; k += kLanes) {
#pragma omp simd
    for (int l = 0; l < kLanes; ++l) {
      double own_re = weight[0] * shape[0].re[k + l], own_im = weight[0] * shape[0].im[k + l];
      for (int i = 1; i < count; ++i) {
        own_re += weight[i] * shape[i].re[k + l];
        own_im += weight[i] * shape[i].im[k + l];
      }
      sum[l] += own_re * first.re[k + l] - own_im * first.im[k + l];
      other[l] += own_re * second.re[k + l] - own_im * second.im[k + l];
      re[k + l] = own_re;
      im[k + l] = own_im;
    }
  }
  return {lane_sum(sum), lane_sum(other)};
}

}  // namespace

void shape_row(const LineModel& line, const RailRow& row, double* re, double* im) noexcept {
  CarriedRow carried;
  carry(line, row, carried);
  shape_carried(line, carried, re + line.first, im + line.first);
}

TwoMotions shape_moving_row(const LineModel& line, const RailRow& row, Complex first,
                            Complex second, double* re, double* im) noexcept {
  const std::int32_t at = line.first;
  const Complex own = {re + at, im + at}, one = {first.re + at, first.im + at},
                other = {second.re + at, second.im + at};
  CarriedRow carried;
  carry(line, row, carried);
  switch (carried.count) {
    case 3:  // one motion of an element's nodes
      return shape_and_move<3>(line, carried, one, other, re + at, im + at);
    default:
      shape_carried(line, carried, re + at, im + at);
      return {modes_dot(own, one, line.size), modes_dot(own, other, line.size)};
  }
}

int roll_parts(const LineModel& line, const RailRow& row, RollPart* part) noexcept {
  int count = 0;
  for (std::int32_t s = 0; s < row.seats; ++s)
    for_roll(line, row.rail, row.seat[s], [&](std::int32_t unknown, double weight) noexcept {
      part[count++] = {s, weight, shape_of(line.modal, unknown)};
    });
  return count;
}

namespace {

/// Adds the motions of `count` parts: each mode is read once for all of them.
template <int count>
void add_moved(const RollPart* part, Complex first, Complex second, int size,
               TwoMotions* motion) noexcept {
  constexpr int kSums = kLanes / 2;
  double one[count][kSums] = {}, other[count][kSums] = {};
  for (int k = 0; k < size; k += kSums)
    for (int i = 0; i < count; ++i) {
      const Complex own = part[i].shape;
#pragma omp simd
      for (int l = 0; l < kSums; ++l) {
        one[i][l] += own.re[k + l] * first.re[k + l] - own.im[k + l] * first.im[k + l];
        other[i][l] += own.re[k + l] * second.re[k + l] - own.im[k + l] * second.im[k + l];
      }
    }
  const auto sum = [](const double* s) noexcept { return (s[0] + s[2]) + (s[1] + s[3]); };
  for (int i = 0; i < count; ++i) {
    motion[part[i].seat].first += part[i].weight * sum(one[i]);
    motion[part[i].seat].second += part[i].weight * sum(other[i]);
  }
}

}  // namespace

void move_rolls(const LineModel& line, const RailRow& row, Complex first, Complex second,
                TwoMotions* motion) noexcept {
  const std::int32_t at = line.first;
  const Complex one = {first.re + at, first.im + at}, other = {second.re + at, second.im + at};
  for (std::int32_t s = 0; s < row.seats; ++s) motion[s] = {0., 0.};
  RollPart part[kMostRollParts];
  const int count = roll_parts(line, row, part);
  int i = 0;
  for (; i + 3 <= count; i += 3) add_moved<3>(part + i, one, other, line.size, motion);
  for (; i < count; ++i) add_moved<1>(part + i, one, other, line.size, motion);
}

void spread_modes(const LineModel& line, const RailRow& row, double force, double* re,
                  double* im) noexcept {
  for_carried(line, row, [&](std::int32_t unknown, double weight) noexcept {
    modes_add(force * weight, shape_of(line.modal, unknown), re + line.first, im + line.first,
              line.modal.count);
  });
}

}  // namespace railstep
