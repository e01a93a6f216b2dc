#include "online/track/p_delta.h"

#include "online/math/table.h"

namespace railstep {

namespace {

/// Roll of a node's section, rad; if the rail is cut there, of the end behind.
/// @param s       index of the node's seat among those around the point
/// @param shared  `motions` holds those of the other rail
double node_roll(const Model& model, std::int32_t rail, std::int32_t node, const Configuration& at,
                 std::int32_t s, bool shared, SeatMotions& motions) noexcept {
  const ElementNode own = element_node(node);
  double roll = 0.;
  for (std::int32_t l = 0; l < model.lines; ++l) {
    const LineModel& line = model.line[l];
    if (line.rail_factor[rail] == 0.) continue;
    const bool alike = line.unknown_of[0] == line.unknown_of[1] && line.rail_factor[1 - rail] != 0.;
    double* const value = motions.value[l][s];
    if (!shared || !alike) {
      value[0] = nodal_value(line, rail, own, 5, at);
      value[1] = line.rigid_section != 0 ? value[0] : nodal_value(line, rail, own, 7, at);
    }
    roll += .5 * weight_of(line, rail, 5) * value[0];
    roll -= .5 * weight_of(line, rail, 7) * value[1];
  }
  return roll;
}

}  // namespace

double add_p_delta(const Model& model, const Configuration& at, double roll, double xi, double y,
                   double z, const double* normal, RailRow& row, SeatMotions& motions) noexcept {
  double shape[3];
  shape_functions(xi, shape);
  double along[3];
  to_rail(model.cant[row.rail], normal, along);
  const double down = roll * (z * along[2] + y * along[1]);
  for (int i = 0; i < 3; ++i) {
    row.coefficient[i][5] -= .5 * down * shape[i];
    row.coefficient[i][7] += .5 * down * shape[i];
  }
  return add_levers(model, at, xi, normal, row, motions);
}

double add_levers(const Model& model, const Configuration& at, double xi, const double* normal,
                  RailRow& row, SeatMotions& motions) noexcept {
  const SeatLevers around = seat_levers(model, row.rail, row.element, xi);
  const bool shared = motions.first == around.first;
  motions.first = around.first;
  take_levers(around, row);
  TwoMotions roll[kPDeltaSeats];
  for (std::int32_t i = 0; i < around.count; ++i)
    roll[i].first =
        node_roll(model, row.rail, around.node[i], at, around.number[i], shared, motions);
  return lean_on_seats(roll, normal[2], row);
}

void take_levers(const SeatLevers& around, RailRow& row) noexcept {
  row.seats = around.count;
  for (std::int32_t i = 0; i < around.count; ++i) {
    row.seat[i] = around.node[i];
    row.lever[i] = around.lever[i];
  }
}

double lean_on_seats(const TwoMotions* roll, double up, RailRow& row) noexcept {
  double rise = 0.;
  for (std::int32_t s = 0; s < row.seats; ++s) {
    row.lever[s] *= up * roll[s].first;
    rise += .5 * roll[s].first * row.lever[s];
  }
  return rise;
}

SeatLevers seat_levers(const Model& model, std::int32_t rail, std::int32_t element,
                       double xi) noexcept {
  const PDeltaModel& seats = model.p_delta;
  SeatLevers around{-kPDeltaSeats, 0, {}, {}, {}};
  const double* lever = seats.lever[rail];
  if (lever == nullptr) return around;
  const std::int32_t bays = model.elements / seats.elements_per_bay;
  around.first = element / seats.elements_per_bay - (kPDeltaSeats / 2 - 1);
  lever += static_cast<std::ptrdiff_t>(element) * kPDeltaSeats * (seats.points + 1);
  for (std::int32_t s = 0; s < kPDeltaSeats; ++s) {
    if (around.first + s < 0 || around.first + s > bays) continue;
    around.number[around.count] = s;
    around.node[around.count] = 2 * seats.elements_per_bay * (around.first + s);
    around.lever[around.count++] = interpolate(lever + s * (seats.points + 1), seats.points, xi);
  }
  return around;
}

}  // namespace railstep
