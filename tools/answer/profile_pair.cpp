#include "answer/profile_pair.h"

#include <cmath>
#include <utility>

#include "text/message.h"

namespace railstep {
namespace {

constexpr double kFineShift = 5e-5, kShift = 1e-4, kAmplitude = 2.5e-4;  // m

template <class Row>
RadiusDifference difference_of(const std::vector<Row>& rows) {
  RadiusDifference of;
  for (const Row& row : rows) {
    of.shift.push_back(row.shift);
    of.difference.push_back(row.radius_difference());
  }
  return of;
}

std::vector<ConicityRow> conicities(const ProfileAnswer& a) {
  const RadiusDifference rigid = difference_of(a.rolled), level = difference_of(a.level),
                         loaded = difference_of(a.loaded);
  std::vector<ConicityRow> rows;
  const auto count = static_cast<int>(a.request.range / kAmplitude + 1e-6);
  for (int i = 1; i <= count; ++i) {
    const double amplitude = kAmplitude * i;
    const auto of = [&](const RadiusDifference& d) {
      return equivalent_conicity(d, amplitude, a.request.contact_distance, a.request.radius);
    };
    rows.push_back({amplitude, of(rigid), of(level), a.loaded.empty() ? std::nullopt : of(loaded)});
  }
  return rows;
}

void solve(const WheelRail& pair, ProfileAnswer& a) {
  const ProfileRequest& r = a.request;
  a.rolled = touches(pair, r.range, kFineShift, true);
  a.level = touches(pair, r.range, kFineShift, false);
  a.jumps = jumps_of(pair, a.rows(), r.roll);
  const auto half = static_cast<int>(std::lround(r.range / kShift));
  for (int i = -half; i <= half && r.load > 0.; ++i)
    a.loaded.push_back(loaded(pair, {}, kShift * i, r.load));
  a.conicity = conicities(a);
}

}  // namespace

ProfileAnswer solve_profile(const ProfileRequest& r) {
  ProfileAnswer a{r,
                  read_wheel_profile(r.wheel),
                  read_placed_rail(r.rail, {r.inclination, r.gauge}),
                  {},
                  {},
                  {},
                  {},
                  {}};
  const WheelRail pair{a.wheel.growth, a.rail.surface, .5 * r.back_to_back - a.wheel.flange_back,
                       r.radius};
  try {
    solve(pair, a);
  } catch (const Refused& error) {
    throw InputError(r.wheel.string() + " on " + r.rail.string(), error);
  }
  return a;
}

}  // namespace railstep
