#include "online/step/vehicle_contact.h"

#include "online/step/travel.h"

namespace railstep {

namespace {

/// The row of the rail's vertical displacement in the contact, or of its slope along x.
void fill_row(const Model& model, WheelContact& at, const double* shape) noexcept {
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 9; ++k)
      at.row.coefficient[i][k] = k == 2   ? shape[i]
                                 : k == 8 ? model.head_z[at.row.rail] * shape[i]
                                          : 0.;
}

/// Height of a vehicle's wheel k, m.
double wheel_height(const VehicleModel& vehicle, int k, const double* u) noexcept {
  double sum = 0.;
  for (int i = 0; i < vehicle.size; ++i)
    sum += vehicle.row[k * vehicle.size + i] * u[vehicle.first + i];
  return sum;
}

}  // namespace

double rail_height(const Model& model, const RailRow& row, const Configuration& at) noexcept {
  double sum = 0.;
  for (std::int32_t l = 0; l < model.lines; ++l) sum += motion(model.line[l], row, at);
  return sum;
}

double slope_under(const Model& model, const WheelContact& at, const Configuration& seen) noexcept {
  const double per_metre = 2. / model.element_length;
  const double slope[3] = {(at.xi - .5) * per_metre, -2. * at.xi * per_metre,
                           (at.xi + .5) * per_metre};
  WheelContact along = at;
  fill_row(model, along, slope);
  return rail_height(model, along.row, seen);
}

void find_vehicle_contacts(const Model& model, const VehicleModel& vehicle, double time,
                           const Configuration& at, WheelContact* contact, double later) noexcept {
  const double gone = travelled(vehicle.travel, time).distance;
  const double rolled = travelled(vehicle.travel, time + later).distance;
  const double up[3] = {0., 0., 1.};
  for (std::int32_t k = 0; k < vehicle.wheels; ++k) {
    const VehicleWheel& wheel = model.vehicle_wheel[vehicle.first_wheel + k];
    WheelContact& found = contact[2 * model.wheelsets + vehicle.first_wheel + k];
    found = WheelContact{};
    found.x = vehicle.start + gone + wheel.place;
    found.row.rail = wheel.rail;
    found.normal[2] = 1.;
    found.z = model.head_z[wheel.rail];
    const double scaled = found.x / model.element_length;
    found.on_rail = scaled >= 0. && scaled <= model.elements;
    found.on_ground = !found.on_rail;
    double height = 0.;
    if (found.on_rail) {
      found.row.element = static_cast<std::int32_t>(scaled);
      if (found.row.element == model.elements) found.row.element = model.elements - 1;
      found.xi = 2. * (scaled - found.row.element) - 1.;
      double shape[3];
      shape_functions(found.xi, shape);
      fill_row(model, found, shape);
      height = rail_height(model, found.row, at);
      const Irregularity off =
          irregularity(model, wheel.tread, wheel.rail, up, found.x + (rolled - gone), rolled);
      found.irregular = off.depth;
      found.rise = off.rise;
    } else {
      const SignalValue tread = signal_at(wheel.tread, rolled);
      found.irregular = tread.value;
      found.rise = tread.slope;
    }
    found.penetration = height + found.irregular - wheel_height(vehicle, k, at.u);
  }
}

}  // namespace railstep
