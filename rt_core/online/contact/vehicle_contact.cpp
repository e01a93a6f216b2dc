#include "online/contact/vehicle_contact.h"

#include "online/math/dense.h"
#include "online/track/travel.h"

namespace railstep {

namespace {

/// Height of a vehicle's wheel k, m.
double wheel_height(const VehicleModel& vehicle, int k, const double* u) noexcept {
  return dot(vehicle.row + k * vehicle.size, u + vehicle.first, vehicle.size);
}

}  // namespace

double rail_height(const Model& model, const RailRow& row, const Configuration& at) noexcept {
  double sum = 0.;
  for (std::int32_t l = 0; l < model.lines; ++l) sum += motion(model.line[l], row, at);
  return sum;
}

double slope_under(const Model& model, const WheelContact& at,
                   const Configuration& located) noexcept {
  const double per_metre = 2. / model.element_length;
  const double slope[3] = {(at.xi - .5) * per_metre, -2. * at.xi * per_metre,
                           (at.xi + .5) * per_metre};
  RailRow along = at.row;
  set_height_row(model.cant[along.rail], at.y, at.z, slope, along);
  return rail_height(model, along, located);
}

void place_vehicle_wheels(const Model& model, const VehicleModel& vehicle, std::int64_t step,
                          double before, WheelContact* contact, double later) noexcept {
  const double way = way_at(model, vehicle.travel, step, before).distance;
  const double further = way_at(model, vehicle.travel, step, before - later).distance;
  const double behind = track_offset(model, step),
               rolled = (behind + model.endless.origin) + further;
  const double up[3] = {0., 0., 1.};
  for (std::int32_t k = 0; k < vehicle.wheels; ++k) {
    const VehicleWheel& wheel = model.vehicle_wheel[vehicle.first_wheel + k];
    WheelContact& found = contact[vehicle_contact(model, vehicle.first_wheel + k)];
    found = WheelContact{};
    found.x = vehicle.start + way + wheel.place;
    found.row.rail = wheel.rail;
    found.normal[2] = 1.;
    const Cant& cant = model.cant[wheel.rail];
    const CrownTop top = crown_top(cant, model.head_z[wheel.rail], model.crown_radius[wheel.rail]);
    found.y = top.y;
    found.z = top.z;
    const double scaled = found.x / model.element_length;
    found.on_rail = scaled >= 0. && scaled <= model.elements;
    found.on_ground = !found.on_rail;
    if (found.on_rail) {
      found.row.element = static_cast<std::int32_t>(scaled);
      if (found.row.element == model.elements) found.row.element = model.elements - 1;
      found.xi = 2. * (scaled - found.row.element) - 1.;
      double shape[3];
      shape_functions(found.xi, shape);
      set_height_row(cant, found.y, found.z, shape, found.row);
      const Irregularity off = irregularity(model, wheel.tread, wheel.rail, up,
                                            (found.x + behind) + (further - way), rolled);
      found.irregularity = off.depth;
      found.slope = off.slope;
    } else {
      const SignalValue tread = signal_at(wheel.tread, rolled);
      found.irregularity = tread.value;
      found.slope = tread.slope;
    }
  }
}

void find_vehicle_contacts(const Model& model, const VehicleModel& vehicle, std::int64_t step,
                           double before, const Configuration& at, WheelContact* contact) noexcept {
  place_vehicle_wheels(model, vehicle, step, before, contact);
  for (std::int32_t k = 0; k < vehicle.wheels; ++k) {
    WheelContact& found = contact[vehicle_contact(model, vehicle.first_wheel + k)];
    const double height = found.on_rail ? rail_height(model, found.row, at) : 0.;
    found.penetration = height + found.irregularity - wheel_height(vehicle, k, at.u);
  }
}

}  // namespace railstep
