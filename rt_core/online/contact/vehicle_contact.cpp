#include "online/contact/vehicle_contact.h"

#include "online/math/dense.h"
#include "online/track/rail_point.h"
#include "online/track/travel.h"

namespace railstep {

double slope_under(const Model& model, const WheelContact& at,
                   const Configuration& located) noexcept {
  const double per_metre = 2. / model.element_length;
  const double slope[3] = {(at.xi - .5) * per_metre, -2. * at.xi * per_metre,
                           (at.xi + .5) * per_metre};
  RailRow along = at.row;
  set_point_row(model.cant[along.rail], at.y, at.z, slope, kUp, along);
  return motion(model, along, located);
}

void place_vehicle_wheels(const Model& model, std::int64_t step, double before,
                          WheelContact* contact, double later) noexcept {
  const double behind = track_offset(model, step);
  const SuspendedModel* last = nullptr;
  double way = 0., further = 0.;
  for (const ContactId i : upright_wheels(model)) {
    const ContactModel& wheel = model.contact[i];
    const SuspendedModel& vehicle = bodies_of(model, i);
    if (&vehicle != last) {
      last = &vehicle;
      way = way_at(model, vehicle.travel, step, before).distance;
      further = way_at(model, vehicle.travel, step, before - later).distance;
    }
    const double rolled = (behind + model.endless.origin) + further;
    WheelContact& found = contact[i];
    found = WheelContact{};
    found.x = vehicle.start + way + wheel.place;
    found.row.rail = wheel.rail;
    found.normal[2] = 1.;
    const Cant& cant = model.cant[wheel.rail];
    const CrownTop top = crown_top(cant, model.head_z[wheel.rail], model.crown_radius[wheel.rail]);
    found.y = top.y;
    found.z = top.z;
    const PlaceOnRails at = place_on_rails(model, found.x);
    found.on_rail = at.on_rail;
    found.on_ground = !found.on_rail;
    if (found.on_rail) {
      found.row.element = at.element;
      found.xi = at.xi;
      double shape[3];
      shape_functions(found.xi, shape);
      set_point_row(cant, found.y, found.z, shape, kUp, found.row);
      const Irregularity off = irregularity(model, wheel.tread, wheel.rail, kUp,
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

void find_vehicle_contacts(const Model& model, std::int64_t step, double before,
                           const Configuration& at, WheelContact* contact) noexcept {
  place_vehicle_wheels(model, step, before, contact);
  for (const ContactId i : upright_wheels(model)) {
    WheelContact& found = contact[i];
    const SuspendedModel& vehicle = bodies_of(model, i);
    const double height = found.on_rail ? motion(model, found.row, at) : 0.;
    found.penetration = (height + found.irregularity) -
                        dot(model.contact[i].row, at.u + vehicle.first, vehicle.size);
  }
}

}  // namespace railstep
