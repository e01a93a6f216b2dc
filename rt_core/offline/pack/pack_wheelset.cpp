#include <cmath>
#include <string>

#include "offline/contact/hertz.h"
#include "offline/math/refuse.h"
#include "offline/pack/pack.h"
#include "online/contact/wheel_seat.h"

namespace railstep {

namespace {

SuspendedMatrices matrices_of(const Wheelset& w, const Scheme& scheme) {
  SuspendedMatrices m{Eigen::VectorXd::Constant(kMotions, w.mass),
                      Eigen::VectorXd::Zero(kMotions),
                      Eigen::MatrixXd::Zero(kMotions, kMotions),
                      Eigen::MatrixXd::Zero(kMotions, kMotions),
                      Eigen::MatrixXd(kMotions, 0),
                      Eigen::VectorXd::Zero(kMotions)};
  m.mass.tail(3) << w.inertia_roll, w.inertia_spin, w.inertia_yaw;
  m.rest[index_of(BodyMotion::z)] = -w.weight;
  if (w.guide != Guide::augmented_lagrangian) m.held = Eigen::MatrixXd::Zero(kMotions, kGuideRows);
  for (int i = 0; i < kGuideRows; ++i)
    if (w.guide == Guide::augmented_lagrangian)
      m.penalty[kGuided[i]] = kGuidePenalty * scheme.kg * m.mass[kGuided[i]];
    else
      m.held(kGuided[i], i) = 1.;
  return m;
}

}  // namespace

void PackedModel::add_wheelset(const Track& track, const Wheelset& wheelset,
                               const std::array<Railhead, 2>& heads) {
  if (track.rails != 2)
    refuse("E-PACK-10",
           "a wheelset stands on two rails, but the track has one; expected track.rails = 2");
  if (model_.wheelsets == kMaxWheelsets)
    refuse("E-PACK-11", "there are more wheelsets than a model takes; expected at most " +
                            std::to_string(kMaxWheelsets));
  for (const double inertia : {wheelset.mass, wheelset.inertia_roll, wheelset.inertia_spin,
                               wheelset.inertia_yaw, wheelset.radius})
    if (!(inertia > 0.))
      refuse("E-PACK-12",
             "the mass, an inertia or the radius of a wheelset is not above 0; expected numbers "
             "above 0");
  const std::int32_t number = model_.wheelsets;
  WheelsetModel& packed = model_.wheelset[number];
  add_suspended(matrices_of(wheelset, model_.scheme), wheelset.forces, packed, "wheelset");
  packed.radius = wheelset.radius;
  packed.tread_half_width = wheelset.tread_half_width;
  packed.start = model_.endless.origin + wheelset.start;
  packed.travel = keep_travel(wheelset.speed, wheelset.speeds);
  packed.rest_z =
      crown_top(model_.cant[0], heads[0].top_z, heads[0].crown_radius).height + wheelset.radius;
  for (const int rail : {0, 1}) {
    const auto side = static_cast<std::size_t>(rail);
    const Material material = track.bar(rail).material;
    ContactModel& tread = insert_contact(tread_of(number, rail));
    tread = {ContactKind::tread,         number, rail,    {},     load_point_of_wheel(rail),
             keep(wheelset.tread[side]), 0.,     nullptr, nullptr};
    tread.law.hertz =
        hertz_constant(wheelset.radius, heads[side].crown_radius, material.young, material.poisson);
  }
  ++model_.wheelsets;
  packed.guide = wheelset.guide;
  packed.cap = wheelset.cap;
  packed.tolerance = wheelset.tolerance;
  packed.alpha = wheelset.alpha;
  packed.beta = wheelset.beta;
  if (wheelset.flange) add_flange(track, wheelset, heads);
}

namespace {

/// The point on a head's side, y across its section, that lies kGaugeDepth below the head's top as
/// the rail leans.
SectionPoint gauge_face(const Cant& cant, const Railhead& head, double y) {
  const double height = crown_top(cant, head.top_z, head.crown_radius).height - kGaugeDepth;
  return {y, (height - cant.sine * y) / cant.cosine};
}

}  // namespace

/// Adds flanges to the last wheelset. `clearance` further in, each face would touch the gauge face.
void PackedModel::add_flange(const Track& track, const Wheelset& wheelset,
                             const std::array<Railhead, 2>& heads) {
  const Flange& flange = *wheelset.flange;
  FlangeModel& packed = model_.flange[model_.flanges];
  packed.wheelset = model_.wheelsets - 1;
  packed.normal[0] = -std::sin(flange.angle);
  packed.normal[1] = std::cos(flange.angle);
  packed.tip = -(wheelset.radius + flange.height);
  ContactLaw law{0., flange.stiffness, flange.damping};
  const Material material = track.bar(0).material;
  const double around = (wheelset.radius + kGaugeDepth) / std::cos(flange.angle);
  if (flange.corner_radius > 0.)
    law = {hertz_constant(around, flange.corner_radius, material.young, material.poisson), 0., 0.};
  for (const int rail : {0, 1}) {
    const Railhead& head = heads[static_cast<std::size_t>(rail)];
    const double inward = rail == 0 ? -1. : 1.;
    const SectionPoint gauge = gauge_face(model_.cant[rail], head, inward * head.gauge_half_width);
    insert_contact(flange_contact(model_, flange_number(model_.flanges, rail))) = {
        ContactKind::flange, packed.wheelset, rail, law, kNoLoadPoint, {}, 0., nullptr, nullptr};
    packed.gauge[rail][0] = gauge.y;
    packed.gauge[rail][1] = gauge.z;
    const double own[3] = {0., gauge.y, gauge.z};
    double in_track[3];
    to_track(model_.cant[rail], own, in_track);
    packed.point[rail][0] = model_.rail_y[rail] + in_track[1] + inward * flange.clearance;
    packed.point[rail][1] = -(wheelset.radius + kGaugeDepth);
  }
  ++model_.flanges;
}

}  // namespace railstep
