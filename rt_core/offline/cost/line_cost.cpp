#include "offline/cost/line_cost.h"

#include <algorithm>
#include <set>

#include "online/contact/wheel_seat.h"
#include "online/model/contact_id.h"

namespace railstep {

namespace {

/// Panels that the unknowns of elements [from, end) span.
std::int64_t panels_of_elements(const LineModel& line, std::int64_t from, std::int64_t end) {
  std::int64_t first = line.size, last = -1;
  for (const std::int32_t* table : line.unknown_of)
    for (std::int64_t k = 27 * from; k < 27 * end; ++k)
      if (table[k] >= 0) {
        first = std::min<std::int64_t>(first, table[k]);
        last = std::max<std::int64_t>(last, table[k]);
      }
  return last < 0 ? 0 : last / kLanes - first / kLanes + 1;
}

/// Most panels of a banded line that the response to a wheel fills. The row of a wheelset has the
/// rolls over the seats around it.
std::int64_t response_panels(const Model& model, const LineModel& line) {
  const std::int64_t around =
      has_levers(model) ? kPDeltaSeats / 2 * std::int64_t{model.p_delta.elements_per_bay} + 1 : 0;
  std::int64_t most = 0;
  for (std::int64_t e = 0; e < model.elements; ++e)
    most =
        std::max(most, panels_of_elements(line, std::max<std::int64_t>(e - around, 0),
                                          std::min<std::int64_t>(e + around + 1, model.elements)));
  return std::min<std::int64_t>(most + line.reach, line.step.panels);
}

/// Solve of banded lines halfway in some panels, into two copies.
Cost half_solve_cost(const Band& band, std::int64_t panels) {
  const std::int64_t flops = 2 * kLanes * (std::int64_t{band.left} + 1) + 128;
  return panels * work(flops, kLanes * std::int64_t{band.left} + 64 + 6 * kLanes);
}

}  // namespace

std::int64_t carried_by(const Model& model, const LineModel& line) {
  std::size_t most = 0;
  for (const std::int32_t* table : line.unknown_of)
    for (std::int32_t e = 0; e < model.elements; ++e) {
      std::set<std::int32_t> along, across;  // rows are along x, or in the plane of a section
      for (std::int32_t i = 27 * e; i < 27 * (e + 1); ++i)
        if (table[i] >= 0) (i % 3 == 0 ? along : across).insert(table[i]);
      most = std::max({most, along.size(), across.size()});
    }
  return static_cast<std::int64_t>(most);
}

Cost solve_cost(const Band& band) {
  const std::int64_t panels = band.panels, left = band.left;
  std::int64_t columns = 0;  // left of all panels, those before the first unknown left out
  for (std::int64_t p = 0; p < panels; ++p) columns += std::min<std::int64_t>(kLanes * p, left);
  // Forth and back a product and two sums over the even and the odd columns, then a block.
  const std::int64_t flops = 2 * (2 * kLanes * columns + 2 * kLanes * panels) + 128 * panels;
  return work(flops, 2 * kLanes * columns + 64 * panels + 6 * kLanes * panels);
}

LineCost line_cost(const Model& model, const LineModel& line) {
  const std::int64_t n = line.size, points = carried_by(model, line);
  const bool modal = model.form == Form::condensed, tabled = line.modal.between != nullptr;
  const std::int64_t seats = has_levers(model) ? 2 * kPDeltaSeats : 0;
  LineCost c{};
  c.value = modal ? work(4 * n + 7, 4 * n) : work(0, 1);
  c.row = points * (work(3, 2) + (modal ? work(4 * n + 7, 6 * n) : Cost{}));
  c.wheel_row = c.row + seats * (work(4, 3) + (modal ? work(4 * n + 7, 6 * n) : Cost{}));
  c.shape = work((points + seats) * (2 + 4 * n), (points + seats) * (2 + 2 * n) + 2 * n);
  const std::int64_t filled = modal ? n : kLanes * response_panels(model, line);
  c.unit = modal ? c.shape + (tabled ? Cost{} : work(6 * n, 6 * n))
                 : 2 * c.wheel_row + half_solve_cost(line.step, filled / kLanes);
  c.read = modal ? work(4 * n + 8, 4 * n) : work(2 * filled + 8, 2 * filled);
  c.located = modal ? c.read : c.wheel_row;
  const std::int64_t pairs = (points + seats) * (points + seats);
  c.pair = tabled ? work(2 * pairs + 2 * (points + seats) + 1, 2 * pairs + 2) : c.read;
  c.add = modal ? work(4 * n, 6 * n) : work(2 * filled, 3 * filled);
  c.node_roll = 2 * (work(3, 2) + c.value);
  return c;
}

Cost advance_cost(const Model& model, const LineModel& line) {
  const std::int64_t n = line.size;
  // The traffic passes a bay border in one step at most: u, v, a, g of the line one bay on.
  const Cost shift = model.endless.bays > 0 ? 4 * work(4 * n, 7 * n) : Cost{};
  // Three complex products and two sums.
  if (model.form == Form::condensed) return shift + work(22 * n, 18 * n);
  const std::int64_t diagonals = line.mass.count + line.damping.count;
  const Cost predicted = work(10 * n, 6 * n), corrected = work(9 * n, 9 * n);
  const Cost inertia = work(3 * n + 2 * n * diagonals, n * (2 * diagonals + 9));
  return shift + predicted + inertia + solve_cost(line.step) + corrected;
}

Cost loads_cost(const Model& model) {
  Cost sum = model.loads * kPlace;
  for (std::int32_t i = 0; i < model.loads; ++i)
    sum = sum + table_cost(model.load[i].table_points) + table_cost(model.load[i].travel.rows);
  return sum;
}

std::int64_t bases_on(const Model& model, const LineModel& line) {
  std::int64_t count = 0;
  for (const ContactId i : contacts(model))
    if (line.rail_factor[model.contact[i].rail] != 0.) ++count;
  const std::int64_t seats = wheel_seat_row_count(model) / 2;  // of a rail
  if (seats > 0 && seats_mirror(model))
    return count + seats + (has_levers(model) ? 2 * std::int64_t{model.runner_wheelsets} : 0);
  for (const double factor : line.rail_factor)
    if (factor != 0.) count += seats;
  return count;
}

}  // namespace railstep
