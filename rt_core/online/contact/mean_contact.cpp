#include "online/contact/mean_contact.h"

#include "online/contact/track_response.h"

namespace railstep {

double residual_before(const Model& model, const State& s, const Coupling& c, int i) noexcept {
  double sum = c.by_loads[i];
  if (c.place[i].load_point == kNoLoadPoint) return sum;
  for (int j = 0; j < c.rows; ++j) {
    const bool own_seat = i == j && j >= c.contacts;
    if (!is_on_rail(c, j) || own_seat) continue;
    // Vertical forces alone have residual displacements: of the rows of a seat the one along z.
    const int seat = j - c.contacts;
    const double force = seat < 0 ? s.contact_force[j]
                         : seat % kWheelSeatRows == 1
                             ? s.wheel_force[kWheelForces * (seat / kWheelSeatRows) + 2]
                             : 0.;
    sum -= force * (i != j ? residual_between(model, c.place[j], c.place[i])
                           : residual_under(model, c.place[i]));
  }
  return sum;
}

void find_means(const Model& model, const State& s, Coupling& c) noexcept {
  for (const ContactId i : contacts(c)) {
    const WheelContact& at = c.contact[i];
    if (!(c.law[i].hertz > 0.) || !(at.on_rail || at.on_ground)) continue;
    // track_free has the track and the loads at the step's end, and no position of the body that
    // carries the wheel.
    double from = c.track_free[i] - lift_by(model, c, i, s.u);
    if (at.on_rail) from += (residual_before(model, s, c, i) - c.by_loads[i]) - c.moved[i];
    c.law[i].mean = true;
    c.law[i].from = from;
  }
}

}  // namespace railstep
