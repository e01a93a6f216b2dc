#include "online/contact/runner_coupling.h"

#include "online/contact/damper.h"
#include "online/contact/mean_contact.h"
#include "online/contact/track_response.h"
#include "online/track/travel.h"

namespace railstep {

namespace {

constexpr int kOfWheelset = kMotions + 2 * kWheelSeatRows;

/// Visits all wheelsets: their runner, their number in it, and that among all.
template <typename Visit>
void for_each_wheelset(const Model& model, Visit visit) noexcept {
  for (std::int32_t n = 0; n < model.runners; ++n)
    for (std::int32_t i = 0; i < model.runner[n].wheelsets; ++i)
      visit(model.runner[n], i, model.runner[n].first_wheelset + i);
}

/// Slopes along x of the displacements of all rows of seats but those along z, as contacts are
/// located: means over an element to either side, in which a seat's own deflection cancels; 0 in
/// the last elements. On a rail that rises the contact moves ahead on the wheel, so that the rise
/// does not count.
void find_slopes(const Model& model, const State& s, const Workspace& w, const Coupling& c,
                 double* slopes) noexcept {
  const Configuration at = located_on(model, s, w);
  const auto slope = [&](int base, std::int32_t, const LineModel& line) noexcept -> double {
    if (base < c.contacts) return 0.;
    RailRow row = base_row(c, base);
    if (row.element == 0 || row.element + 1 >= model.elements) return 0.;
    row.seats = 0;
    ++row.element;
    const double ahead = motion(line, row, at);
    row.element -= 2;
    return (ahead - motion(line, row, at)) / (2. * model.element_length);
  };
  sum_rows(model, c, slope, slopes);
  for (int i = c.contacts + 1; i < c.rows; i += kWheelSeatRows) slopes[i] = 0.;
}

/// Part of the residual flexibility between two rows of a seat that follows the force of this step;
/// the rest follows that of the last one. Forces act at theta of a step, in which the displacements
/// along y and the roll must be, too: their rate is theirs less that at its start over theta dt.
double at_once(const Model& model, int i, int j) noexcept {
  return i == 1 && j == 1 ? 1. : model.scheme.theta;
}

/// Displacement of a seat's row by the last step's forces on all seats.
double moved_before(const Model& model, const State& s, const Coupling& c, int row) noexcept {
  double sum = 0.;
  for (std::int32_t wheel = 0; wheel < 2 * model.runner_wheelsets; ++wheel)
    sum += moved_by_wheel(c.W + row * c.ports + c.contacts + kWheelSeatRows * wheel,
                          s.wheel_force + std::ptrdiff_t{kWheelForces} * wheel);
  return sum;
}

/// The first displacement of force elements among the coordinates of Newton's method, behind all
/// wheelsets.
int first_of_elements(const Model& model, int scalars) noexcept {
  return scalars + kOfWheelset * model.runner_wheelsets;
}

/// The row of the track of a coordinate of Newton's method that is one, or the port of a scalar.
/// -1: a motion of a wheelset, or of a force element.
int port_of_coordinate(const Model& model, const Coupling& c, int scalars, int at) noexcept {
  if (at < scalars) return port_of(c, at);
  if (at >= first_of_elements(model, scalars)) return -1;
  const int set = (at - scalars) / kOfWheelset, k = (at - scalars) % kOfWheelset;
  return k < kMotions ? -1 : c.contacts + 2 * kWheelSeatRows * set + (k - kMotions);
}

/// The runner of a force element by its number among those of all runners.
const RunnerModel& runner_of_element(const Model& model, int element) noexcept {
  std::int32_t r = 0;
  while (r + 1 < model.runners && element >= model.runner[r + 1].first_force_element) ++r;
  return model.runner[r];
}
const ForceElement& element_of(const Model& model, int element) noexcept {
  const RunnerModel& runner = runner_of_element(model, element);
  return runner.force_element[element - runner.first_force_element];
}

void fill_compliance(const Model& model, const Coupling& c, int scalars, double* Y) noexcept {
  const int n = newton_size(model);
  int port[kMostNewton];
  for (int i = 0; i < n; ++i) port[i] = port_of_coordinate(model, c, scalars, i);
  for (int i = 0; i < n; ++i) {
    double* const row = Y + i * n;
    for (int j = 0; j < n; ++j) row[j] = 0.;
    if (port[i] < 0) continue;
    const double* const own = c.W + port[i] * c.ports;
    for (int j = 0; j < n; ++j)
      if (port[j] >= 0) row[j] = own[port[j]];
  }
  for (std::int32_t r = 0; r < model.runners; ++r) {
    const RunnerModel& runner = model.runner[r];
    const int motions = kMotions * runner.wheelsets, meets = interface_size(runner);
    int at[kMostInterfaces];
    for (int k = 0; k < meets; ++k)
      at[k] =
          k < motions
              ? scalars + kOfWheelset * (runner.first_wheelset + k / kMotions) + k % kMotions
              : first_of_elements(model, scalars) + runner.first_element_coordinate + (k - motions);
    for (int i = 0; i < meets; ++i)
      for (int j = 0; j < meets; ++j) Y[at[i] * n + at[j]] = runner.compliance[i * meets + j];
  }
}

/// Displacements of the seats under a wheelset without forces of this step, and their rates at
/// zero. On condensed lines seats are in the wheel's place in the middle of the step, and rates are
/// those there. On banded lines they are in its place at the end, where rates jump as the wheel
/// passes: they are those of the moving seat, less those of its going along.
/// @param slope   [track rows] of banded lines
/// @param enters  the wheelset was off the rails when the stage began
void couple_seats(const Model& model, const State& s, const Coupling& c, const RunnerModel& runner,
                  std::int32_t set, const double* slope, bool enters,
                  CoupledRunners& all) noexcept {
  const bool banded = model.form == Form::banded;
  const int first = all.scalars + kOfWheelset * set;
  WheelsetLaw& law = all.law[set];
  for (int side = 0; side < 2; ++side) {
    const int seat = wheel_seat_row(model, set, side), to = kMotions + kWheelSeatRows * side;
    const SeatFlexibility own = seat_flexibility(model, runner, side, c.place[seat + 1]);
    const double* const last = wheel_force_of(s, set, side);
    for (int k = 0; k < kWheelSeatRows; ++k) {
      const int row = seat + k;
      double later[kWheelSeatRows];
      for (int j = 0; j < kWheelSeatRows; ++j)
        later[j] = (1. - at_once(model, k, j)) * own.along[k][j];
      const double free = c.track_free[row] + moved_by_wheel(later, last);
      all.z_free[first + to + k] = free;
      all.motion[first + to + k] = free + moved_before(model, s, c, row);
      double before = 0.;
      if (banded)
        before = enters ? all.motion[first + to + k] : seat_motion_of(s, set, side)[k];
      else if (is_on_rail(c, row))
        before = (c.located[row] + residual_before(model, s, c, row)) +
                 (moved_by_wheel(own.along[k], last) + c.seat[row - c.contacts].rise);
      law.rate_at_zero[to + k] = -law.seat_rate * before;
      if (banded) law.rate_at_zero[to + k] -= law.ahead * slope[row];
    }
  }
}

}  // namespace

void locate_wheel_seats(const Model& model, const Stage& stage, const State& s, const Workspace& w,
                        Coupling& c) noexcept {
  const double held = held_fraction(model);
  const Configuration at = located_on(model, s, w);
  for_each_wheelset(model, [&](const RunnerModel& runner, int i, std::int32_t set) noexcept {
    const double x = element_place(model, runner, i, stage_of(model, runner, stage).along(held, s));
    if (c.mirrored) {
      const std::int32_t row = wheel_seat_row(model, set, 0);
      return locate_mirrored_seats(model, at, runner, x, c.seat + (row - c.contacts),
                                   c.place + row);
    }
    SeatMotions seats;
    for (int side = 0; side < 2; ++side) {
      const std::int32_t row = wheel_seat_row(model, set, side);
      locate_wheel_seat(model, at, runner, x, side, seats, c.seat + (row - c.contacts),
                        c.place + row);
    }
  });
}

void lean_wheel_seats(const Model& model, Coupling& c) noexcept {
  for_each_wheelset(model, [&](const RunnerModel& runner, int, std::int32_t set) noexcept {
    for (int side = 0; side < 2; ++side) {
      const std::int32_t first = wheel_seat_row(model, set, side);
      const SeatLean own = seat_lean(model, runner.contact, side, c.located[first + 2]);
      WheelSeatRow& along_z = c.seat[first + 1 - c.contacts];
      along_z.lean += own.lean;
      along_z.rise += own.rise;
      c.located[first + 1] -= own.lean * c.located[first + 2];
      if (model.form == Form::condensed) c.moved[first + 1] -= own.lean * c.moved[first + 2];
    }
  });
}

void add_seat_flexibility(const Model& model, Coupling& c) noexcept {
  for_each_wheelset(model, [&](const RunnerModel& runner, int, std::int32_t set) noexcept {
    for (int side = 0; side < 2; ++side) {
      const int seat = wheel_seat_row(model, set, side);
      if (!is_on_rail(c, seat)) continue;
      const SeatFlexibility own = seat_flexibility(model, runner, side, c.place[seat + 1]);
      for (int i = 0; i < kWheelSeatRows; ++i)
        for (int j = 0; j < kWheelSeatRows; ++j)
          c.W[(seat + i) * c.ports + seat + j] += at_once(model, i, j) * own.along[i][j];
    }
  });
}

void couple_runners(const Model& model, const Stage& stage, State& s, Workspace& w,
                    const Coupling& c, CoupledRunners& all) noexcept {
  all.scalars = c.contacts + model.fixed.count;
  const bool banded = model.form == Form::banded;
  double slope[kMaxTrackRows];
  if (banded) find_slopes(model, s, w, c, slope);
  fill_compliance(model, c, all.scalars, w.newton);
  for (std::int32_t r = 0; r < model.runners; ++r) {
    const RunnerModel& runner = model.runner[r];
    const RunnerStage at = stage_of(model, runner, stage);
    double* const u = w.solved + runner.first;
    move_freely(at, s, w, u);
    const int own = first_of_elements(model, all.scalars) + runner.first_element_coordinate;
    find_elements(at, s, w, u, all.z_free + own, all.motion + own);
  }
  for_each_wheelset(model, [&](const RunnerModel& runner, int i, std::int32_t set) noexcept {
    const RunnerStage at = stage_of(model, runner, stage);
    WheelsetMotion motion;
    find_motion(at, i, s, w, w.solved + runner.first, motion);
    WheelsetLaw& law = all.law[set] = law_of(at, i, true, s);
    const int first = all.scalars + kOfWheelset * set;
    for (int k = 0; k < kMotions; ++k) {
      all.z_free[first + k] = motion.free[k];
      all.motion[first + k] = motion.start[k];
      law.rate_at_zero[k] = motion.rate_at_zero[k];
    }
    const double place = element_place(model, runner, i, at.along(0., s));
    const bool enters = !(place >= 0. && place <= model.elements * model.element_length);
    couple_seats(model, s, c, runner, set, slope, enters, all);
    if (has_profiles(runner.contact)) law.profile = profile_wheels(w, set);
    law.find_contacts(all.motion + first);
    law.find_fold(w.newton, newton_size(model), first);
  });
}

void move_seat(const Coupling& c, int row, double by, CoupledRunners& all) noexcept {
  const int seat = row - c.contacts, of_set = 2 * kWheelSeatRows;
  const int at = all.scalars + kOfWheelset * (seat / of_set) + kMotions + seat % of_set;
  all.z_free[at] += by;
  all.motion[at] += by;
}

NewtonResult solve_coupled_runners(const Model& model, const Workspace& w, Coupling& c,
                                   CoupledRunners& all) noexcept {
  LawBlock block[kMostNewton];
  double* const z = all.motion;
  const int n = newton_size(model), sets = model.runner_wheelsets;
  for (int i = 0; i < all.scalars; ++i) {
    const int port = port_of(c, i);
    const PortLaw& law = c.law[i];
    block[i] = {i, 1, 1};
    z[i] = all.z_free[i];
    if (c.force[port] > 0. || law.bilateral) z[i] = port_depth(law, c.force[port]);
  }
  for (int i = 0; i < model.runner_force_elements; ++i)
    block[all.scalars + sets + i] = element_block(
        element_of(model, i), first_of_elements(model, all.scalars) +
                                  runner_of_element(model, i).first_element_coordinate);
  double diagonal[kMostNewton];
  for (int i = 0; i < n; ++i) diagonal[i] = w.newton[std::ptrdiff_t{n} * i + i];
  for (std::int32_t r = 0; r < model.runners; ++r) {
    const RunnerModel& runner = model.runner[r];
    double* const own =
        diagonal + first_of_elements(model, all.scalars) + runner.first_element_coordinate;
    for (std::int32_t i = 0; i < runner.element_coordinates; ++i)
      own[i] += runner.element_compliance[i];
  }
  const auto law = [&](int b, const double* at, double* force, const LawSlopes* slopes,
                       double* steep) noexcept {
    const int element = b - all.scalars - sets;
    if (element >= 0) {
      const RunnerModel& runner = runner_of_element(model, element);
      return evaluate_element(runner, element - runner.first_force_element, w, at, force, slopes);
    }
    if (b >= all.scalars) return all.law[b - all.scalars].evaluate(at, force, slopes, steep);
    const PortForce own = port_force(c.law[b], *at);
    *force = -own.force;
    if (slopes == nullptr) return;
    *slopes->spread = 1.;
    *slopes->slope = -own.slope;
  };
  const NewtonResult met = solve_and_follow(all.law, sets, z + all.scalars, [&]() noexcept {
    for (int i = 0; i < sets; ++i)
      block[all.scalars + i] = {all.scalars + kOfWheelset * i, kOfWheelset, all.law[i].rank()};
    return solve_laws({n, all.scalars + sets + model.runner_force_elements, w.newton, block,
                       all.z_free, w.newton + std::ptrdiff_t{n} * n, kRunnerTolerance,
                       model.runner_force_elements > 0 ? diagonal : nullptr},
                      law, all.force, z);
  });
  // The last point that was tried need not be the best one.
  double steep[kMostLaw];
  for (int i = 0; i < sets && met.status != NewtonStatus::converged; ++i) {
    const int first = all.scalars + kOfWheelset * i;
    all.law[i].evaluate(z + first, all.force + first, nullptr, steep);
  }
  for (int i = 0; i < n; ++i) {
    const int port = port_of_coordinate(model, c, all.scalars, i);
    if (port < 0) continue;
    c.force[port] = -all.force[i];
    if (i < all.scalars) c.penetration[port] = z[i];
  }
  return met;
}

namespace {

/// Stores the motions of the seats under a wheelset.
void keep_seats(const Coupling& c, const CoupledRunners& all, std::int32_t set, State& s,
                int first_row) noexcept {
  const WheelsetLaw& law = all.law[set];
  for (int side = 0; side < 2; ++side) {
    double* const kept = seat_motion_of(s, set, side);
    const bool on_rail = is_on_rail(c, first_row + kWheelSeatRows * side);
    for (int k = 0; k < kWheelSeatRows; ++k) {
      const int own = kMotions + kWheelSeatRows * side + k;
      const double z = on_rail ? all.motion[all.scalars + kOfWheelset * set + own] : 0.;
      kept[k] = z;
      kept[kWheelSeatRows + k] = on_rail ? law.seat_rate * z + law.rate_at_zero[own] : 0.;
    }
  }
}

}  // namespace

Status move_coupled_runners(const Model& model, const Coupling& c, const CoupledRunners& all,
                            State& s, Workspace& w) noexcept {
  Status met = Status::ok;
  for (std::int32_t r = 0; r < model.runners; ++r) {
    const RunnerModel& runner = model.runner[r];
    double force[kMostInterfaces];
    for (int i = 0; i < runner.wheelsets; ++i) {
      const std::int32_t set = runner.first_wheelset + i;
      for (int k = 0; k < kMotions; ++k)
        force[kMotions * i + k] = all.force[all.scalars + kOfWheelset * set + k];
      keep_wheel_forces(runner, i, all.law[set], s);
      if (keeps_seats(model)) keep_seats(c, all, set, s, wheel_seat_row(model, set, 0));
      met = met | events_of(all.law[set]);
      if (!is_on_rail(c, wheel_seat_row(model, set, 0))) met = met | Status::off_rail;
    }
    const int elements = first_of_elements(model, all.scalars) + runner.first_element_coordinate;
    for (int j = 0; j < runner.element_coordinates; ++j)
      force[kMotions * runner.wheelsets + j] = all.force[elements + j];
    move_by(runner, force, w.solved + runner.first, reactions_of(model, s, runner));
    keep_elements(runner, all.motion + elements, all.force + elements, w, s);
  }
  return met;
}

}  // namespace railstep
