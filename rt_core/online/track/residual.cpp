#include "online/track/residual.h"

#include <cmath>

namespace railstep {

namespace {

/// Value of a table [load_points][elements][points + 1] under a force.
double look_up(const Model& model, const double* table, std::int32_t elements,
               const RailForce& at) noexcept {
  if (table == nullptr || at.load_point == kNoLoadPoint) return 0.;
  const std::int32_t points = model.residual.points;
  const std::ptrdiff_t row =
      static_cast<std::ptrdiff_t>(at.load_point) * elements + at.element % elements;
  return interpolate(table + row * (points + 1), points, at.xi);
}

/// Whether two places are less than an element's length apart.
bool close(const RailForce& a, const RailForce& b) noexcept {
  const double distance = (b.element - a.element) + .5 * (b.xi - a.xi);
  return distance * distance < 1.;
}

/// At most the geometric mean of the flexibilities under both forces. Otherwise two opposite forces
/// would have a negative flexibility, and their wheels would diverge. Interpolation between places
/// smooths the kink at the force, by some percent of the flexibility under it.
double at_most_mean(const Model& model, const RailForce& a, const RailForce& b,
                    double between) noexcept {
  const double own = residual_under(model, a), other = residual_under(model, b);
  const bool over = own > 0. && other > 0. && between > 0. && between * between > own * other;
  return over ? std::sqrt(own * other) : between;
}

}  // namespace

RailForce rail_force(const Model& model, std::int32_t load_point, double x, double force) noexcept {
  const double scaled = x / model.element_length;
  std::int32_t element = 0;
  if (scaled >= model.elements) element = model.elements - 1;
  if (scaled > 0. && scaled < model.elements) element = static_cast<std::int32_t>(scaled);
  double xi = 2. * (scaled - element) - 1.;
  if (!(xi > -1.)) xi = -1.;
  if (xi > 1.) xi = 1.;
  return {model, load_point, element, xi, force};
}

int rail_forces(const Model& model, const Outputs& outputs, RailForce* forces) noexcept {
  int count = 0;
  for (std::int32_t i = 0; i < model.loads; ++i)
    forces[count++] =
        rail_force(model, model.load[i].load_point, outputs.load_place[i], outputs.load_force[i]);
  for (const ContactId i : wheels(model))
    forces[count++] = rail_force(model, model.contact[i].load_point, outputs.contact_place[i],
                                 outputs.contact_on_rail[i] ? -outputs.contact_force[i] : 0.);
  for (std::int32_t i = 0; i < model.external_wheels; ++i)
    forces[count++] =
        rail_force(model, model.external_wheel[i].load_point, outputs.external_place[i],
                   outputs.external_on_rail[i] ? outputs.external_force[i] : 0.);
  for (std::int32_t n = 0; n < model.runners; ++n) {
    const RunnerModel& runner = model.runner[n];
    const std::int32_t first = WheelId{runner.first_wheelset, 0}.number();
    for (std::int32_t i = first; i < first + 2 * runner.wheelsets; ++i)
      if (outputs.wheel_on_rail[i])
        forces[count++] = rail_force(model, runner.load_point[wheel_of(i).side],
                                     outputs.wheel_place[i], -outputs.wheel_q[i]);
  }
  return count;
}

double residual_under(const Model& model, const RailForce& at) noexcept {
  return look_up(model, model.residual.under, model.residual.elements, at);
}

double residual_axis(const Model& model, const RailForce& at) noexcept {
  return look_up(model, model.residual.axis, model.residual.elements, at);
}

double residual_between(const Model& model, const RailForce& force, const RailForce& at) noexcept {
  if (force.load_point == kNoLoadPoint || at.load_point == kNoLoadPoint) return 0.;
  const PairModel& pair = model.residual.pair[force.load_point][at.load_point];
  const std::int32_t shift = at.element - force.element;
  if (pair.value == nullptr || shift > pair.range || shift < -pair.range) return 0.;
  const std::int32_t points = model.residual.pair_points;
  const double* block =
      pair.value +
      (static_cast<std::ptrdiff_t>(force.element % model.residual.elements) * (2 * pair.range + 1) +
       (shift + pair.range)) *
          static_cast<std::ptrdiff_t>((points + 1) * (points + 1));
  const Cubic& along = force.between;
  double sum = 0.;
  for (int i = 0; i < 4; ++i)
    sum += along.weight[i] * interpolate(block + (along.first + i) * (points + 1), at.between);
  return close(force, at) ? at_most_mean(model, force, at, sum) : sum;
}

double residual_displacement(const Model& model, const RailForce* forces, int count,
                             int at) noexcept {
  double sum = 0.;
  for (int i = 0; i < count; ++i)
    sum += forces[i].force * (i == at ? residual_under(model, forces[i])
                                      : residual_between(model, forces[i], forces[at]));
  return sum;
}

void residual_displacements(const Model& model, const RailForce* forces, int count, int points,
                            double* moved) noexcept {
  for (int i = 0; i < points; ++i) moved[i] = forces[i].force * residual_under(model, forces[i]);
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < i && j < points; ++j) {  // the same both ways (Maxwell)
      const double between = residual_between(model, forces[j], forces[i]);
      moved[j] += forces[i].force * between;
      if (i < points) moved[i] += forces[j].force * between;
    }
}

double residual_of_track_sensor(const Model& model, std::int32_t track_sensor,
                                const RailForce* forces, int count) noexcept {
  const TrackSensorModel& p = model.track_sensor;
  const std::int32_t table = p.table[track_sensor];
  if (p.residual == nullptr || table < 0) return 0.;
  const std::int32_t points = model.residual.points, elements = p.ends[table + 1] - p.ends[table];
  const double* values = p.residual + static_cast<std::ptrdiff_t>(p.ends[table]) *
                                          model.residual.load_points * (points + 1);
  double sum = 0.;
  for (int i = 0; i < count; ++i) {
    const std::int32_t at = forces[i].element - p.first[table];
    if (forces[i].load_point == kNoLoadPoint || at < 0 || at >= elements) continue;
    const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(forces[i].load_point) * elements + at;
    sum += forces[i].force * interpolate(values + row * (points + 1), points, forces[i].xi);
  }
  return sum;
}

}  // namespace railstep
