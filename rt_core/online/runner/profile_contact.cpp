#include "online/runner/profile_contact.h"

namespace railstep {

namespace {

constexpr double kLeastDepth = kLeastPatchDepth;  // up to which strips of a patch reach at least
constexpr double kFarOff = 2e-4;                  // m
constexpr double kMostTurn = .2;                  // rad, of a plane of contact within a solve
constexpr double kMostDepth = 3e-3;  // m: a wheel that is deeper is not on the rail but in it

struct SectionVector {
  double y, z;
};

/// The wheelset's middle in the frame of the rail's profile, y outwards.
struct Middle {
  double y, z;          // m
  double cosine, sine;  // of the section's roll, positive outwards
};

Middle middle_of(const ProfileContact& c, double radius, double side, const OverRail& at) noexcept {
  const tread_contact::CosineSine<double> roll = tread_contact::turned(side * at.section);
  const double height = c.height + (radius - c.pair.radius);
  const double y = side * at.motion[index_of(BodyMotion::y)] - c.point_y,
               z = (height + at.motion[index_of(BodyMotion::z)]) - c.point_z;
  return {c.point_y + (y * roll.cosine + z * roll.sine),
          c.point_z + (z * roll.cosine - y * roll.sine), roll.cosine, roll.sine};
}

ProfilePair pair_of(const ProfileContact& c, double radius) noexcept {
  ProfilePair pair = c.pair;
  pair.radius = radius;
  return pair;
}

/// Rows of a patch that is pressed at a point.
void fill_patch_rows(const ProfileContact& c, const Middle& middle, double side,
                     const tread_contact::Axle<double>& axle, const PressedPoint& point,
                     ProfilePatch& patch) noexcept {
  const double size = 1. / std::sqrt(1. + point.slope * point.slope);
  const auto to_track = [&](double y, double z) noexcept -> SectionVector {
    return {side * (y * middle.cosine - z * middle.sine), y * middle.sine + z * middle.cosine};
  };
  WheelRows<double>& rows = patch.rows;
  const SectionVector normal = to_track(-size * point.slope, size),
                      arm = to_track(point.y - middle.y, point.z - middle.z),
                      of_rail = to_track(point.y - c.point_y, point.z - c.point_z);
  rows.depth = patch.zone.depth;
  rows.n_y = normal.y;
  rows.n_z = normal.z;
  fill_rows(axle, {point.ahead, arm.y, arm.z}, rows);
  rows.normal_section = normal.z * of_rail.y - normal.y * of_rail.z;
  rows.across_section = normal.y * of_rail.y + normal.z * of_rail.z;
  // The contact goes ahead with the yaw as the plane of contact slopes.
  patch.across_turned = arm.z / normal.z;
}

PatchTurn turn_of(double curvature, double shift) noexcept {
  const double of_rail = curvature * shift - 1.;  // r / k
  return {-curvature * of_rail, of_rail, -curvature * shift};
}

/// Whether the scene gives coefficients of creep, which hold for a wheel.
bool has_coefficients(const RollingContact& c) noexcept { return c.creep.patch.exponent == 0.; }

/// Size and shape of a patch as creep sees it. It has a force from a little depth on, and grows as
/// the root of what is beyond that.
/// @param force, depth  of the patch pressed so deep
void fill_creep_patch(const RollingContact& c, const PatchForce& force, double depth,
                      ProfilePatch& patch) noexcept {
  const double per_root = 1. / std::sqrt(depth - patch.zone.patch.collocation.gap);
  patch.creep = {per_root * force.half_length, per_root * force.half_width, c.creep.patch.shear, 1.,
                 kalker(force.half_length / force.half_width, c.profiles.poisson)};
}

/// Divides the coefficients of a wheel among its patches by their normal forces.
/// @param normal  [patches] N, those that the wheel has
void share_coefficients(const RollingContact& c, const double* normal,
                        ProfileWheel& wheel) noexcept {
  double all = 0., shares = 0.;
  for (int i = 0; i < wheel.patches; ++i) {
    all += normal[i];
    shares += wheel.patch[i].zone.share;
  }
  for (int i = 0; i < wheel.patches; ++i) {
    const double share = wheel.patch[i].zone.share;
    wheel.patch[i].creep = c.creep.patch;
    wheel.patch[i].creep.shear *= all > 0. ? normal[i] / (share * all) : 1. / shares;
  }
}

}  // namespace

ProfileWheel* profile_wheels(const Workspace& w, std::int32_t wheelset) noexcept {
  static_assert(sizeof(ProfileWheel) <= kProfileWheelDoubles * sizeof(double));
  return reinterpret_cast<ProfileWheel*>(w.profile) + 2 * std::ptrdiff_t{wheelset};
}

void find_profile_wheel(const RollingContact& c, double radius, double side, const OverRail& at,
                        ProfileWheel& wheel) noexcept {
  const Middle middle = middle_of(c.profiles, radius, side, at);
  const double roll = at.motion[index_of(BodyMotion::roll)],
               yaw = at.motion[index_of(BodyMotion::yaw)];
  const ProfilePair pair = pair_of(c.profiles, radius);
  const WheelsetPlace place{middle.y, middle.z, side * (roll - at.section), side * yaw};
  const tread_contact::Axle<double> axle(roll, yaw);
  for (int m = 0; m < 4; ++m) wheel.placed[m] = at.motion[index_of(kPlaced[m])];
  wheel.section = at.section;
  wheel.patches = 0;
  WheelZone zone[kMostZones];
  int zones = find_zones(pair, place, kLeastDepth, zone);
  for (int i = 0; i < zones; ++i)
    if (zone[i].depth > kMostDepth) zones = 0;
  wheel.at_edge = zones == 0;
  double normal[kMostZones];
  for (int i = 0; i < zones; ++i) {
    if (zone[i].depth < -kFarOff) continue;
    ProfilePatch& patch = wheel.patch[wheel.patches];
    patch.zone = zone[i];
    wheel.at_edge = wheel.at_edge || (zone[i].at_edge && zone[i].depth > 0.);
    const double part = zone[i].depth / kLeastDepth;
    const double depth = part > 1. ? zone[i].depth : kLeastDepth;
    const PatchForce own = patch_force(patch_of(patch.zone), depth);
    normal[wheel.patches++] = zone[i].share * (part > 1.   ? own.normal
                                               : part > 0. ? own.normal * part
                                                           : 0.);
    patch.last = {depth, own.normal, own.stiffness};
    fill_creep_patch(c, own, depth, patch);
    const double per = zone[i].cosine_of_wheel;
    const PressedPoint point =
        pressed_point(pair, place, zone[i].s + per * own.centre, per * own.half_width);
    patch.turn = turn_of(point.curvature, shift_by_tilt(patch_of(patch.zone), depth));
    fill_patch_rows(c.profiles, middle, side, axle, point, patch);
  }
  if (has_coefficients(c)) share_coefficients(c, normal, wheel);
}

namespace {

/// How much the plane of contact turns at a place near that at which a wheel was found, rad, and
/// the derivatives over kPlaced and over the section's roll.
struct Turned {
  double angle, by_motion[4], by_section;
};

/// Moves depth and rows of a patch to a place near that at which the wheel was found.
Turned move_rows(const ProfileWheel& wheel, const PatchTurn& turn, const OverRail& at,
                 WheelRows<double>& r) noexcept {
  const WheelRows<double> found = r;
  const double across[4] = {r.n_z, -r.n_y, r.across_roll, r.across_yaw};
  const double normal[4] = {r.n_y, r.n_z, r.normal_roll, r.normal_yaw};
  const double section = at.section - wheel.section;
  const double roll = at.motion[index_of(BodyMotion::roll)] - wheel.placed[2];
  double shift = r.across_section * section;
  r.depth += r.normal_section * section;
  Turned turned;
  for (int m = 0; m < 4; ++m) {
    const double moved = at.motion[index_of(kPlaced[m])] - wheel.placed[m];
    r.depth -= normal[m] * moved;
    shift += across[m] * moved;
    turned.by_motion[m] = turn.by_shift * across[m];
  }
  turned.by_motion[2] += turn.by_roll;
  turned.by_section = turn.by_shift * r.across_section + turn.by_section;
  const double by_rolls = turn.by_roll * roll + turn.by_section * section;
  double angle = turned.angle = turn.by_shift * shift + by_rolls;
  const double part = std::fabs(angle) > kMostTurn ? kMostTurn / std::fabs(angle) : 1.;
  r.depth -= .5 * shift * (angle + by_rolls) * (part * (2. - part));
  angle *= part;
  if (part < 1.) {
    for (double& by : turned.by_motion) by = 0.;
    turned.by_section = 0.;
  }
  r.n_y += angle * found.n_z;
  r.n_z -= angle * found.n_y;
  r.normal_roll += angle * found.across_roll;
  r.normal_yaw += angle * found.across_yaw;
  r.normal_section -= angle * found.across_section;
  r.across_roll -= angle * found.normal_roll;
  r.across_yaw -= angle * found.normal_yaw;
  r.across_section += angle * found.normal_section;
  return turned;
}

/// Rate at which a wheel leaves its rail at a contact, m/s.
double leaving(const WheelRows<double>& r, const double* v, const RailRate& rail) noexcept {
  return (r.n_y * (v[1] - rail.y) + r.n_z * (v[2] - rail.z)) +
         ((r.normal_roll * v[3] + r.normal_yaw * v[5]) - r.normal_section * rail.roll);
}

/// The normal force of a patch at a depth above 0.
PatchNormal patch_normal_force(ProfilePatch& patch, double depth) noexcept {
  constexpr double kNear = 1e-6;
  PatchNormal& last = patch.last;
  const double held = last.depth - patch.zone.patch.collocation.gap;
  const double part = (depth - last.depth) / held;
  if (last.normal > 0. && std::fabs(part) < kNear) {
    const double less = last.stiffness * held / last.normal - 1.;
    return {depth, last.normal * (1. + part * (1. + less) * (1. + .5 * less * part)),
            last.stiffness * (1. + less * part)};
  }
  const PatchForce found = patch_force(patch_of(patch.zone), depth);
  return last = {depth, found.normal, found.stiffness};
}

/// @param by_yaw    slip across by the yaw, m/s
/// @param by_angle  the same by the plane's turn
void find_slopes(const WheelRows<double>& r, const Turned& turned, const PatchNormal& force,
                 double by_yaw, double by_angle, const ContactCreep& creep,
                 ContactSlopes& slopes) noexcept {
  fill_rates_and_spread(r, creep, slopes);
  const double deeper[4] = {-r.n_y, -r.n_z, -r.normal_roll, -r.normal_yaw};
  for (int k = 0; k < 3; ++k) {
    const double by_depth = force.stiffness * (k == 0 ? 1. : creep.by_normal[k - 1]);
    for (int m = 0; m < 4; ++m) slopes.by_motion[k][m] = by_depth * deeper[m];
    slopes.by_section[k] = by_depth * r.normal_section;
    const double by_slip = k == 0 ? 0. : creep.by_slip[k - 1][1];
    slopes.by_motion[k][3] += by_slip * by_yaw;
    // Forces turn with the plane.
    const double turning = (k == 0   ? -creep.force[1]
                            : k == 2 ? force.normal
                                     : 0.) +
                           by_slip * by_angle;
    for (int m = 0; m < 4; ++m) slopes.by_motion[k][m] += turning * turned.by_motion[m];
    slopes.by_section[k] += turning * turned.by_section;
  }
}

void take_share(double share, ContactSlopes& slopes) noexcept {
  for (int k = 0; k < 3; ++k) {
    for (double& by : slopes.by_motion[k]) by *= share;
    for (double& by : slopes.by_rate[k]) by *= share;
    slopes.by_section[k] *= share;
    slopes.by_section_rate[k] *= share;
  }
}

void add(double share, const WheelForce& own, WheelForce& sum) noexcept {
  if (own.depth > sum.depth) sum.depth = own.depth;
  sum.normal += share * own.normal;
  sum.on_section += share * own.on_section;
  sum.creep_power += share * own.creep_power;
  sum.rail_y += share * own.normal * own.rail_y;
  for (int k = 0; k < 6; ++k) sum.generalised[k] += share * own.generalised[k];
  for (int k = 0; k < 3; ++k) sum.creepage[k] += share * own.normal * own.creepage[k];
}

}  // namespace

double turned_by(const ProfileWheel& wheel, const OverRail& at) noexcept {
  double most = 0.;
  for (int i = 0; i < wheel.patches; ++i) {
    WheelRows<double> rows = wheel.patch[i].rows;
    const double angle = std::fabs(move_rows(wheel, wheel.patch[i].turn, at, rows).angle);
    if (rows.depth > 0. && angle > most) most = angle;
  }
  return most;
}

WheelForce profile_force(const RollingContact& c, ProfileWheel& wheel, double radius, double side,
                         const Rolling& rolling, const OverRail& at, const double* v,
                         const RailRate& rail, double* stiffness, ContactSlopes* slopes) noexcept {
  WheelForce sum{-1., 0., 0., {}, 0., false, {}};
  int touching = 0, sliding = 0;
  const double spin = rolling.frame / radius + v[index_of(BodyMotion::pitch)];
  const double yawed = at.motion[index_of(BodyMotion::yaw)] - wheel.placed[3];
  for (int i = 0; i < wheel.patches; ++i) {
    ProfilePatch& patch = wheel.patch[i];
    WheelRows<double> rows = patch.rows;
    const Turned turned = move_rows(wheel, patch.turn, at, rows);
    stiffness[i] = 0.;
    if (slopes != nullptr) slopes[i] = {};
    if (!(rows.depth > 0.)) {
      if (rows.depth > sum.depth) sum.depth = rows.depth;
      continue;
    }
    rows.across_spin += patch.across_turned * yawed;
    const Slip<double> slip = slip_of(rows, v, rolling.frame, radius, rail);
    const PatchNormal force = patch_normal_force(patch, rows.depth);
    const double share = patch.zone.share;
    const double beyond = rows.depth - patch.zone.patch.collocation.gap;
    RollingPatch grown = patch.creep;
    if (grown.exponent > 0. && force.normal > 0.)
      grown.exponent = .5 * force.normal / (force.stiffness * beyond);
    const ContactCreep creep =
        creep_on_rail(c.creep, grown, side, {beyond, force.normal}, slip, rolling,
                      slopes == nullptr ? CreepWanted::force : CreepWanted::slopes);
    stiffness[i] = share * force.stiffness;
    if (slopes != nullptr) {
      find_slopes(rows, turned, force, patch.across_turned * spin, -leaving(rows, v, rail), creep,
                  slopes[i]);
      take_share(share, slopes[i]);
    }
    add(share, wheel_force(rows, force.normal, slip, rolling, creep), sum);
    ++touching;
    sliding += creep.slides() ? 1 : 0;
  }
  sum.slides = touching > 0 && sliding == touching;
  // Patches of a wheel keep one mean.
  const double per_normal = sum.normal > 0. ? 1. / sum.normal : 0.;
  for (double& own : sum.creepage) own *= per_normal;
  sum.rail_y *= per_normal;
  return sum;
}

}  // namespace railstep
