#include "online/step/load.h"

#include "online/step/table.h"

namespace railstep {

namespace {

double coefficient(const LineModel& line, const LoadModel& load, int k) noexcept {
  const double factor = line.rail_factor[load.rail] * load.row[k];
  return line.mirrored != 0 && load.rail == 1 && flips_in_mirror(k) ? -factor : factor;
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
  const double factor =
      load.table_points == 0 ? 1. : table_value(load.table, load.table_points, time);
  const bool taken_off = load.speed >= 0. ? at.x > load.stop : at.x < load.stop;
  at.force = taken_off ? 0. : load.force * factor;
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
