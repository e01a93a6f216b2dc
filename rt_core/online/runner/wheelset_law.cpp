#include "online/runner/wheelset_law.h"

#include <cmath>

#include "online/track/travel.h"

namespace railstep {

RunnerStage stage_of(const Model& model, const RunnerModel& runner, const Stage& stage) noexcept {
  return {model, runner, stage, held_fraction(model), law_rate(model)};
}

namespace {

/// Whether the law takes a motion in the middle of the step.
constexpr bool is_earlier(BodyMotion motion) noexcept {
  return motion == BodyMotion::y || motion == BodyMotion::yaw;
}

/// Both factors of the slopes of three forces at one contact, or of a patch.
/// @param placed  change of a motion that creep depends on with the law's own
/// @param seat  of its rail's y, z and roll among the n coordinates; 0: they are not among them
/// @param to    from these three scalars on; a row of `spread` has `rank` numbers
void fill_slopes(const ContactSlopes& w, double rate, double seat_rate, double placed, int n,
                 int seat, const LawSlopes& to, int rank) noexcept {
  for (int k = 0; k < 3; ++k) {
    double* const own = to.slope + k * n;
    for (int m = 0; m < n; ++m) own[m] = 0.;
    for (int m = 0; m < kMotions; ++m) own[m] = rate * w.by_rate[k][m];
    for (int m = 0; m < 4; ++m)
      own[index_of(kPlaced[m])] += (is_earlier(kPlaced[m]) ? placed : 1.) * w.by_motion[k][m];
    double* const spread = to.spread + k;
    for (int m = 0; m < n; ++m) spread[m * rank] = m < kMotions ? w.spread[m][k] : 0.;
    if (seat == 0) continue;
    // The wheel's place counts over the rail.
    own[seat] = (rate - seat_rate) * w.by_rate[k][1] - own[1];
    own[seat + 1] = (rate - seat_rate) * w.by_rate[k][2] - own[2];
    own[seat + 2] = w.by_section[k] + seat_rate * w.by_section_rate[k];
    spread[seat * rank] = -w.spread[1][k];
    spread[(seat + 1) * rank] = -w.spread[2][k];
    spread[(seat + 2) * rank] = w.section[k];
  }
}

constexpr int kOfContact = 3;  // scalars

/// Adds spread times slope of three scalars.
/// @param J  [n][n]
void add_product(const LawSlopes& of, int n, double* J) noexcept {
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < kOfContact; ++k)
        J[i * n + j] += of.spread[i * kOfContact + k] * of.slope[k * n + j];
}

double sign_of(int side) noexcept { return side == 0 ? 1. : -1.; }

}  // namespace

int WheelsetLaw::contacts(int side) const noexcept {
  return profile == nullptr || profile[side].patches == 0 ? 1 : profile[side].patches;
}
bool WheelsetLaw::is_folded() const noexcept {
  return kOfContact * (contacts(0) + contacts(1)) > size();
}
int WheelsetLaw::rank() const noexcept {
  return is_folded() ? size() : kOfContact * (contacts(0) + contacts(1));
}

void WheelsetLaw::find_fold(const double* Y, int n, int first) noexcept {
  double most = 0.;
  for (int i = 0; i < size(); ++i) {
    fold[i] = Y[std::ptrdiff_t{n} * (first + i) + (first + i)];
    most = fold[i] > most ? fold[i] : most;
  }
  for (int i = 0; i < size(); ++i)
    if (!(fold[i] > 1e-12 * most)) fold[i] = most > 0. ? most : 1.;
}

void WheelsetLaw::place(const double* z, Placed& at) const noexcept {
  for (int k = 0; k < kMotions; ++k) {
    at.v[k] = rate * z[k] + rate_at_zero[k];
    at.u[k] = is_earlier(BodyMotion{k}) ? z[k] - later * at.v[k] : z[k];
  }
  at.under = rails;
  add_frame_rates(rails, runner->wheelset[wheelset].radius, at.u, at.v);
  for (int side = 0; side < 2; ++side) {
    at.moving[side] = {0., uneven_rate[side], 0.};
    if (!seated) continue;
    const int seat = kMotions + 3 * side;
    const auto rate_along = [&](int k) noexcept {
      return seat_rate * z[seat + k] + rate_at_zero[seat + k];
    };
    at.moving[side] = {rate_along(0), uneven_rate[side] + rate_along(1), rate_along(2)};
    at.under.y[side] += z[seat] - later * at.moving[side].y;
    at.under.z[side] += z[seat + 1];
    at.under.roll[side] = z[seat + 2];
  }
}

template <typename Wanted>
bool WheelsetLaw::find_contacts_where(const double* z, const Wanted& wanted) noexcept {
  if (profile == nullptr) return false;
  Placed at;
  place(z, at);
  bool any = false;
  for (int side = 0; side < 2; ++side) {
    double over[kMotions];
    place_over_rail(at.under, side, at.u, over);
    const OverRail now{over, at.under.roll[side]};
    if (!wanted(profile[side], now)) continue;
    any = true;
    find_profile_wheel(runner->contact, runner->wheelset[wheelset].radius, sign_of(side), now,
                       profile[side]);
  }
  return any;
}

void WheelsetLaw::find_contacts(const double* z) noexcept {
  find_contacts_where(z, [](const ProfileWheel&, const OverRail&) noexcept { return true; });
}

bool WheelsetLaw::follow_contacts(const double* z) noexcept {
  constexpr double kFar = .005;  // rad
  return find_contacts_where(z, [](const ProfileWheel& wheel, const OverRail& now) noexcept {
    return turned_by(wheel, now) > kFar;
  });
}

WheelForce WheelsetLaw::on_cone(const Placed& at, int side, const LawSlopes* slopes,
                                double* steep) const noexcept {
  double over[kMotions];
  place_over_rail(at.under, side, at.u, over);
  const RollingContact& c = runner->contact;
  const double radius = runner->wheelset[wheelset].radius;
  ContactSlopes own;
  const WheelForce f =
      slopes == nullptr
          ? wheel_force(c, radius, sign_of(side), rolling[side], over, at.v, at.moving[side])
          : wheel_force(c, radius, sign_of(side), rolling[side], over, at.v, at.moving[side], own);
  *steep = f.depth > 0. ? std::sqrt(f.depth) : 0.;
  if (slopes != nullptr)
    fill_slopes(own, rate, seat_rate, 1. - later * rate, size(), seated ? kMotions + 3 * side : 0,
                *slopes, kWheelsetRank);
  return f;
}

WheelForce WheelsetLaw::on_profile(const Placed& at, int side, const LawSlopes* slopes,
                                   double* steep) const noexcept {
  double over[kMotions];
  place_over_rail(at.under, side, at.u, over);
  ProfileWheel& wheel = profile[side];
  ContactSlopes* const own = wheel.slopes;
  own[0] = {};
  double stiffness[kMostZones] = {};
  const WheelForce f =
      profile_force(runner->contact, wheel, runner->wheelset[wheelset].radius, sign_of(side),
                    rolling[side], {over, at.under.roll[side]}, at.v, at.moving[side], stiffness,
                    slopes == nullptr ? nullptr : own);
  const int n = size(), full = rank(), seat = seated ? kMotions + 3 * side : 0;
  const bool folded = is_folded();
  for (int i = 0; i < contacts(side); ++i) {
    if (!folded) steep[kOfContact * i] = stiffness[i];
    if (slopes == nullptr) continue;
    double spread[kMostLaw * kOfContact], slope[kMostLaw * kOfContact];
    const LawSlopes to =
        folded ? LawSlopes{spread, slope}
               : LawSlopes{slopes->spread + kOfContact * i, slopes->slope + kOfContact * i * n};
    fill_slopes(own[i], rate, seat_rate, 1. - later * rate, n, seat, to,
                folded ? kOfContact : full);
    if (folded) add_product(to, n, slopes->spread);
  }
  return f;
}

void WheelsetLaw::evaluate(const double* z, double* force, const LawSlopes* slopes,
                           double* steep) noexcept {
  const int n = size();
  Placed at;
  place(z, at);
  for (int k = 0; k < kMotions; ++k) force[k] = 0.;
  lost = slides = at_edge = false;
  const bool folded = is_folded();
  if (folded && slopes != nullptr)
    for (int i = 0; i < n * n; ++i) {
      slopes->spread[i] = 0.;
      slopes->slope[i] = i % (n + 1) == 0 ? 1. / fold[i / n] : 0.;
    }
  for (int side = 0; side < 2; ++side) {
    const int first = side == 0 || folded ? 0 : kOfContact * contacts(0);
    LawSlopes own{};
    if (slopes != nullptr) own = {slopes->spread + first, slopes->slope + first * n};
    const LawSlopes* const to = slopes == nullptr ? nullptr : &own;
    const WheelForce f = profile == nullptr ? on_cone(at, side, to, steep + first)
                                            : on_profile(at, side, to, steep + first);
    lost = lost || !(f.depth > 0.);
    slides = slides || f.slides;
    at_edge = at_edge || (profile != nullptr && profile[side].at_edge);
    for (int k = 0; k < kMotions; ++k) force[k] += f.generalised[k];
    keep_wheel_force(f, kept[side]);
    for (int k = 0; k < 3; ++k) creepage[side][k] = f.creepage[k];
    if (!seated) continue;
    const int seat = kMotions + 3 * side;
    force[seat] = -f.generalised[1];
    force[seat + 1] = -f.generalised[2];
    force[seat + 2] = f.on_section;
  }
  for (int i = 0; folded && slopes != nullptr && i < n * n; ++i) slopes->spread[i] *= fold[i % n];
}

WheelsetLaw law_of(const RunnerStage& at, int wheelset, bool seated, const State& s) noexcept {
  const double theta = at.model.scheme.theta;
  const bool banded = at.model.form == Form::banded;
  const RunnerModel& runner = at.runner;
  const double* const v = s.v + runner.first + runner.wheelset[wheelset].first;
  const double frame = travelled(runner.travel, at.time(theta)).speed;
  WheelsetLaw law{};
  law.runner = &runner;
  law.wheelset = wheelset;
  law.seated = seated;
  RailsUnder slope;
  law.rails = rails_under(at.model, runner, wheelset, at.along(theta, s), &slope);
  // find_motion() counts the way of a free runner from the stage's start.
  if (runner.rolls_freely != 0)
    law.rails.frame_x -= s.u[runner.first + runner.wheelset[wheelset].first];
  law.ahead = frame + ahead_of(runner, s.v + runner.first);
  law.rate = at.rate;
  law.seat_rate = banded ? 1. / at.stage.span : at.rate;
  law.later = banded ? 0. : (theta - .5) * at.model.scheme.dt;
  for (int side = 0; side < 2; ++side) {
    law.rolling[side] =
        rolling_of(runner, wheelset, frame, v,
                   creepage_of(s, runner.first_wheelset + wheelset, side), at.stage.span);
    law.rolling[side].grip = law.rails.grip[side];
    law.rails.y[side] -= law.later * (law.ahead * slope.y[side]);
    law.uneven_rate[side] = law.ahead * slope.z[side];
  }
  return law;
}

Status events_of(const WheelsetLaw& law) noexcept {
  return (law.lost ? Status::contact_lost : Status::ok) |
         (law.slides ? Status::full_slip : Status::ok) |
         (law.at_edge ? Status::beyond_profile : Status::ok);
}

}  // namespace railstep
