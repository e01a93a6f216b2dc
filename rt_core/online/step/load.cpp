#include "online/step/load.h"

namespace railstep {

namespace {

/// Factor of the load's table at a time; at most table_points turns of the loop.
double table_factor(const LoadModel& load, double time) noexcept {
  if (load.table_points == 0) return 1.;
  const double* point = load.table;
  if (time <= point[0]) return point[1];
  for (std::int32_t i = 1; i < load.table_points; ++i) {
    const double* next = load.table + 2 * i;
    if (time < next[0]) {
      const double share = (time - point[0]) / (next[0] - point[0]);
      return point[1] + share * (next[1] - point[1]);
    }
    point = next;
  }
  return point[1];
}

/// Cubic Lagrange interpolation of equally spaced values, four points around xi in [-1, 1].
double interpolate(const double* value, std::int32_t intervals, double xi) noexcept {
  const double at = .5 * (xi + 1.) * intervals;
  std::int32_t first = static_cast<std::int32_t>(at) - 1;
  if (first < 0) first = 0;
  if (first > intervals - 3) first = intervals - 3;
  const double t = at - first;  // 0..3
  const double* f = value + first;
  return -f[0] * (t - 1.) * (t - 2.) * (t - 3.) / 6. + f[1] * t * (t - 2.) * (t - 3.) / 2. -
         f[2] * t * (t - 1.) * (t - 3.) / 2. + f[3] * t * (t - 1.) * (t - 2.) / 6.;
}

/// y components of the mirrored right rail change sign: r_y, a_x, a_z, b_y.
constexpr bool flips(int k) noexcept { return k == 1 || k == 3 || k == 5 || k == 7; }

double coefficient(const LineModel& line, const LoadModel& load, int k) noexcept {
  const double factor = line.rail_factor[load.rail] * load.row[k];
  return line.mirrored != 0 && load.rail == 1 && flips(k) ? -factor : factor;
}

}  // namespace

PlacedLoad place(const Model& model, const LoadModel& load, std::int64_t step) noexcept {
  const double time = static_cast<double>(step) * model.scheme.dt;
  PlacedLoad at{};
  at.x = load.start + load.speed * time;
  const double scaled = at.x / model.element_length;
  at.on_rail = scaled >= 0. && scaled <= model.elements;
  if (!at.on_rail) return at;
  at.element = static_cast<std::int32_t>(scaled);
  if (at.element == model.elements) at.element = model.elements - 1;
  at.xi = 2. * (scaled - at.element) - 1.;
  at.shape[0] = -.5 * at.xi * (1. - at.xi);
  at.shape[1] = 1. - at.xi * at.xi;
  at.shape[2] = .5 * at.xi * (1. + at.xi);
  const bool taken_off = load.speed >= 0. ? at.x > load.stop : at.x < load.stop;
  at.force = taken_off ? 0. : load.force * table_factor(load, time);
  return at;
}

void spread(const LineModel& line, const LoadModel& load, const PlacedLoad& at,
            double* rhs) noexcept {
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 9; ++k) {
      const std::int32_t unknown = line.unknown_of[9 * (2 * at.element + i) + k];
      if (unknown >= 0) rhs[unknown] += at.force * (at.shape[i] * coefficient(line, load, k));
    }
}

double deflection(const Model& model, const LoadModel& load, const PlacedLoad& at,
                  const double* u) noexcept {
  double sum = 0.;
  for (std::int32_t l = 0; l < model.lines; ++l) {
    const LineModel& line = model.line[l];
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 9; ++k) {
        const std::int32_t unknown = line.unknown_of[9 * (2 * at.element + i) + k];
        if (unknown >= 0) sum += at.shape[i] * coefficient(line, load, k) * u[line.first + unknown];
      }
  }
  if (load.residual == nullptr) return sum;
  const double* table =
      load.residual + static_cast<std::ptrdiff_t>(at.element) * (model.residual_points + 1);
  return sum + at.force * interpolate(table, model.residual_points, at.xi);
}

}  // namespace railstep
