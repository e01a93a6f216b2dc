// Wheels on rails by their profiles, in the geometry of one instant: work, frames, slopes.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "offline/runner/rolling_profiles.h"
#include "online/runner/runner_contact.h"
#include "support/wheel_pair.h"

using namespace railstep;

namespace {

constexpr double kWheel = .46, kRolling = 30.;
constexpr int y = 1, z = 2, roll = 3, yaw = 5;

/// S1002 on 60E1 at 1:40 under 55 kN, by a law of creep.
struct Pair {
  RollingProfiles profiles = rolling_profiles(s1002_on_60e1(), {}, .3, 55e3);
  RollingContact contact = profiles.contact;
  explicit Pair(CreepLaw law) { contact.creep = {law, 10, {{.3, .3}}, {1., 1., 80.8e9, 1., {}}}; }
};

/// Places of a wheelset with a wheel on its rail, from the tread to the flange, and rates.
struct Riding {
  double u[6], v[6], section;
  RailRate rail;
};
class Draws {
 public:
  explicit Draws(int seed) : engine_(static_cast<unsigned>(seed)) {}
  double operator()(double size) { return size * part_(engine_); }
  Riding state(double side) {
    Riding d{};
    auto& own = *this;
    d.u[y] = own(5.5e-3);
    d.u[roll] = own(2e-3);
    d.u[yaw] = own(5e-3);
    d.section = own(2e-3);
    // Roll lifts a wheel, and the section's roll moves its top away from it.
    d.u[z] = -side * .75 * d.u[roll] + own(2e-4);
    for (double& rate : d.v) rate = own(.05);
    d.rail = {own(.02), own(.02), own(.05)};
    return d;
  }

 private:
  std::mt19937_64 engine_;
  std::uniform_real_distribution<double> part_{-1., 1.};
};

struct Found {
  ProfileWheel wheel;
  WheelForce force;
};
Found found(const RollingContact& c, double side, const Riding& d) {
  Found f;
  find_profile_wheel(c, kWheel, side, {d.u, d.section}, f.wheel);
  double stiffness[kMostZones];
  f.force =
      profile_force(c, f.wheel, kWheel, side, kRolling, {d.u, d.section}, d.v, d.rail, stiffness);
  return f;
}

/// Depth of a wheel at a place in the geometry of another.
double depth_of(const RollingContact& c, ProfileWheel wheel, double side, const double* u,
                double section) {
  const double none[6] = {};
  double stiffness[kMostZones];
  return profile_force(c, wheel, kWheel, side, kRolling, {u, section}, none, {}, stiffness).depth;
}

}  // namespace

TEST_CASE("the power of a wheel's forces is that of its normal force and its creep",
          "[profile_contact]") {
  for (const CreepLaw law : {CreepLaw::linear, CreepLaw::she, CreepLaw::polach}) {
    const Pair pair(law);
    Draws draws(3);
    int touching = 0;
    for (int n = 0; n < 400; ++n) {
      const double side = n % 2 == 0 ? 1. : -1.;
      const Riding d = draws.state(side);
      const auto [wheel, f] = found(pair.contact, side, d);
      if (wheel.patches != 1 || !(f.normal > 0.)) continue;
      ++touching;
      double power = kRolling * f.generalised[0] + kRolling / kWheel * f.generalised[4], size = 0.;
      for (int k = 0; k < 6; ++k) power += d.v[k] * f.generalised[k];
      power -= f.generalised[1] * d.rail.y + f.generalised[2] * d.rail.z;
      power += f.on_section * d.rail.roll;
      constexpr double h = 1e-6;
      double later[6], sooner[6];
      for (int k = 0; k < 6; ++k) {
        // The wheelset moves over the rail.
        const double rate = d.v[k] - (k == y ? d.rail.y : k == z ? d.rail.z : 0.);
        later[k] = d.u[k] + h * rate;
        sooner[k] = d.u[k] - h * rate;
      }
      const double deeper =
          (depth_of(pair.contact, wheel, side, later, d.section + h * d.rail.roll) -
           depth_of(pair.contact, wheel, side, sooner, d.section - h * d.rail.roll)) /
          (2. * h);
      size = std::fabs(f.normal * deeper) + std::fabs(f.creep_power) + kRolling;
      INFO("law " << static_cast<int>(law) << ", case " << n);
      CHECK(power == Approx(f.creep_power - f.normal * deeper).margin(1e-7 * size));
      if (law != CreepLaw::polach) CHECK(f.creep_power <= 1e-9 * size);
    }
    CHECK(touching > 150);
  }
}

TEST_CASE("a rail that rolls under a wheelset is a wheelset that moves over the rail",
          "[profile_contact]") {
  // Without rates; forces turn with the rail.
  const Pair pair(CreepLaw::she);
  const ProfileContact& c = pair.contact.profiles;
  Draws draws(5);
  for (int n = 0; n < 200; ++n) {
    const double side = n % 2 == 0 ? 1. : -1.;
    Riding d = draws.state(side);
    std::fill_n(d.v, 6, 0.);
    d.u[yaw] = 0.;
    d.rail = {};
    Riding turned = d;
    turned.section = 0.;
    turned.u[roll] -= d.section;
    const double cosine = std::cos(d.section), sine = std::sin(d.section);
    const double from_y = d.u[y] - side * c.point_y, from_z = c.height + d.u[z] - c.point_z;
    turned.u[y] = side * c.point_y + cosine * from_y + sine * from_z;
    turned.u[z] = c.point_z - c.height + cosine * from_z - sine * from_y;
    const WheelForce a = found(pair.contact, side, d).force,
                     b = found(pair.contact, side, turned).force;
    INFO("case " << n);
    const double margin = 1e-6 * (1. + b.normal);
    CHECK(a.depth == Approx(b.depth).margin(1e-12));
    CHECK(a.generalised[1] ==
          Approx(cosine * b.generalised[1] - sine * b.generalised[2]).margin(margin));
    CHECK(a.generalised[2] ==
          Approx(cosine * b.generalised[2] + sine * b.generalised[1]).margin(margin));
    CHECK(a.generalised[3] == Approx(b.generalised[3]).margin(margin));
    CHECK(a.on_section == Approx(b.on_section).margin(margin));
  }
}

TEST_CASE("left and right wheels are mirror images", "[profile_contact]") {
  const Pair pair(CreepLaw::fastsim);
  Draws draws(7);
  for (int n = 0; n < 200; ++n) {
    const Riding d = draws.state(1.);
    Riding mirrored = d;
    for (const int k : {y, roll, yaw}) {
      mirrored.u[k] = -d.u[k];
      mirrored.v[k] = -d.v[k];
    }
    mirrored.section = -d.section;
    mirrored.rail = {-d.rail.y, d.rail.z, -d.rail.roll};
    const WheelForce a = found(pair.contact, 1., d).force,
                     b = found(pair.contact, -1., mirrored).force;
    constexpr double sign[6] = {1., -1., 1., -1., 1., -1.};
    const double margin = 1e-11 * (1. + a.normal);
    for (int k = 0; k < 6; ++k)
      CHECK(a.generalised[k] == Approx(sign[k] * b.generalised[k]).margin(margin));
    CHECK(a.on_section == Approx(-b.on_section).margin(margin));
  }
}

TEST_CASE("depths follow the rows of a wheel's patch", "[profile_contact]") {
  // Rows are those at the centre of pressure, depths those of the deepest point.
  const Pair pair(CreepLaw::she);
  Draws draws(9);
  double worst = 0.;
  for (int n = 0; n < 200; ++n) {
    const double side = n % 2 == 0 ? 1. : -1.;
    Riding d = draws.state(side);
    d.u[y] = -side * std::fabs(d.u[y]) * .6 - side * 2e-3;  // away from jumps of the contact
    if (d.u[y] * side < -4.4e-3) continue;
    const auto [wheel, f] = found(pair.contact, side, d);
    if (wheel.patches != 1 || f.depth < 2e-5) continue;
    const double step[5] = {2e-5, 2e-6, 2e-6, 2e-4, 2e-6};
    constexpr int moved[5] = {y, z, roll, yaw, -1};
    for (int m = 0; m < 5; ++m) {
      Riding more = d, less = d;
      (moved[m] < 0 ? more.section : more.u[moved[m]]) += step[m];
      (moved[m] < 0 ? less.section : less.u[moved[m]]) -= step[m];
      const double truly = found(pair.contact, side, more).wheel.patch[0].rows.depth -
                           found(pair.contact, side, less).wheel.patch[0].rows.depth;
      const double by_rows = depth_of(pair.contact, wheel, side, more.u, more.section) -
                             depth_of(pair.contact, wheel, side, less.u, less.section);
      INFO("case " << n << ", motion " << m);
      constexpr double kLever[5] = {.05, 1., .75, .02, .02};
      worst = std::max(worst, std::fabs(by_rows - truly) / (2. * step[m] * kLever[m]));
    }
  }
  CHECK(worst < .15);
}

TEST_CASE("planes of contact turn as the bodies move", "[profile_contact]") {
  // A wheel under 60 kN from its tread to the throat on the gauge corner, without creep.
  Pair pair(CreepLaw::linear);
  pair.contact.creep.patch = {1., 1., 1., 0., {}};
  const auto slope_of = [](const WheelForce& f) {
    return std::atan2(f.generalised[1], f.generalised[2]);
  };
  const auto press = [&](Riding& d, const auto& force) {
    double low = d.u[z] - 2e-3, high = d.u[z] + 2e-3;
    for (int i = 0; i < 45; ++i) {
      d.u[z] = .5 * (low + high);
      (force(d).normal > 60e3 ? low : high) = d.u[z];
    }
    return slope_of(force(d));
  };
  const auto by_profiles = [&](const Riding& d) { return found(pair.contact, -1., d).force; };
  // Motions, and what they shift the wheel across and tilt it by.
  constexpr int moved[3] = {y, roll, -1};
  constexpr double lever[3] = {1., .46, .03};
  int on_throat = 0;
  for (double shift = 0.; shift < 6.55e-3; shift += 5e-5) {
    Riding d{};
    d.u[y] = -shift;
    d.u[yaw] = -4e-3;
    press(d, by_profiles);
    ProfileWheel wheel = found(pair.contact, -1., d).wheel;
    if (wheel.patches != 1) continue;
    const bool throat = shift > 5.5e-3;
    on_throat += throat ? 1 : 0;
    const auto by_law = [&](const Riding& at) {
      double stiffness[kMostZones];
      return profile_force(pair.contact, wheel, kWheel, -1., kRolling, {at.u, at.section}, at.v,
                           at.rail, stiffness);
    };
    for (int m = 0; m < 3; ++m) {
      Riding more = d, less = d;
      const double step = 4e-6 / lever[m];
      (moved[m] < 0 ? more.section : more.u[moved[m]]) += step;
      (moved[m] < 0 ? less.section : less.u[moved[m]]) -= step;
      Riding more_by_law = more, less_by_law = less;
      const double truly = press(more, by_profiles) - press(less, by_profiles),
                   turned = press(more_by_law, by_law) - press(less_by_law, by_law);
      CAPTURE(shift, m, truly / 8e-6, turned / 8e-6);
      if (found(pair.contact, -1., more).wheel.patches != 1 ||
          found(pair.contact, -1., less).wheel.patches != 1)
        continue;
      // Patches on the tread reach over several radii of the rail.
      CHECK(turned == Approx(truly).epsilon(throat ? .21 : .75));
    }
  }
  CHECK(on_throat > 10);
}

TEST_CASE("a wheel that leaves its gauge corner has no force", "[profile_contact]") {
  // Beyond the shift at which throat and corner are most alike.
  const Pair pair(CreepLaw::she);
  for (const double shift : {6.3e-3, 6.5e-3, 6.6e-3, 6.65e-3, 6.7e-3})
    for (const double load : {20e3, 60e3}) {
      Riding d{};
      d.u[y] = -shift;
      double low = -1e-3, high = 3e-3;
      for (int i = 0; i < 45; ++i) {
        d.u[z] = .5 * (low + high);
        (found(pair.contact, -1., d).force.normal > load ? low : high) = d.u[z];
      }
      const ProfileWheel wheel = found(pair.contact, -1., d).wheel;
      for (const double lift : {3e-4, 5e-4, 1e-3}) {
        double u[6];
        std::copy_n(d.u, 6, u);
        u[z] += lift;
        CAPTURE(shift, load, lift);
        CHECK(depth_of(pair.contact, wheel, -1., u, 0.) < 0.);
      }
    }
}

TEST_CASE("slopes of a patch are those of its forces", "[profile_contact]") {
  for (const CreepLaw law : {CreepLaw::linear, CreepLaw::she, CreepLaw::polach}) {
    const Pair pair(law);
    Draws draws(11);
    for (int n = 0; n < 200; ++n) {
      const double side = n % 2 == 0 ? 1. : -1.;
      const Riding d = draws.state(side);
      Found at_once = found(pair.contact, side, d);
      ProfileWheel& wheel = at_once.wheel;
      const WheelForce& f = at_once.force;
      if (wheel.patches != 1 || f.depth < 1e-5 || f.slides) continue;
      double stiffness[kMostZones];
      ContactSlopes slopes[kMostZones];
      const auto force = [&](const Riding& at, ContactSlopes* to) {
        return profile_force(pair.contact, wheel, kWheel, side, kRolling, {at.u, at.section}, at.v,
                             at.rail, stiffness, to);
      };
      static_cast<void>(force(d, slopes));
      const double n_y = wheel.patch[0].rows.n_y, n_z = wheel.patch[0].rows.n_z;
      // The three scalars of a patch, in directions that do not turn.
      const auto scalar = [&](const WheelForce& w, int k) {
        return k == 0   ? n_y * w.generalised[1] + n_z * w.generalised[2]
               : k == 1 ? w.generalised[0]
                        : n_z * w.generalised[1] - n_y * w.generalised[2];
      };
      const auto check = [&](double* place, Riding& moved, double step, int k, double slope) {
        const double kept = *place;
        *place = kept + step;
        const WheelForce more = force(moved, nullptr);
        *place = kept - step;
        const WheelForce less = force(moved, nullptr);
        *place = kept;
        if (more.slides || less.slides) return;
        const double difference = (scalar(more, k) - scalar(less, k)) / (2. * step);
        CHECK(slope == Approx(difference).epsilon(2e-3).margin(2e-4 * f.normal));
      };
      for (int k = 0; k < 3; ++k) {
        Riding moved = d;
        INFO("law " << static_cast<int>(law) << ", case " << n << ", scalar " << k);
        for (int m = 0; m < 4; ++m)
          check(moved.u + index_of(kPlaced[m]), moved, 1e-9, k, slopes[0].by_motion[k][m]);
        for (int m = 0; m < 6; ++m) check(moved.v + m, moved, 1e-6, k, slopes[0].by_rate[k][m]);
        check(&moved.section, moved, 1e-9, k, slopes[0].by_section[k]);
        check(&moved.rail.roll, moved, 1e-6, k, slopes[0].by_section_rate[k]);
      }
    }
  }
}

TEST_CASE("the height of a loaded wheel does not leap as it shifts", "[profile_contact]") {
  // Throat and tread become one patch, or two, at shifts of 5 to 6 mm.
  const Pair pair(CreepLaw::she);
  const auto height = [&](double shift, double load) {
    double low = -2e-3, high = 4e-3;
    for (int i = 0; i < 45; ++i) {
      const double sunk = .5 * (low + high), at[6] = {0., shift, -sunk, 0., 0., 0.};
      ProfileWheel wheel;
      find_profile_wheel(pair.contact, kWheel, -1., {at, 0.}, wheel);
      double sum = 0.;
      for (int i_patch = 0; i_patch < wheel.patches; ++i_patch) {
        const ProfilePatch& patch = wheel.patch[i_patch];
        sum += patch.zone.share * patch.rows.n_z *
               patch_force(patch_of(patch.zone), patch.rows.depth).normal;
      }
      (sum > load ? high : low) = sunk;
    }
    return .5 * (low + high);
  };
  for (const auto& [load, most] : {std::pair{55e3, 5e-8}, std::pair{100e3, 5e-7}}) {
    double before = 0., last = 0., worst = 0.;
    for (int i = 0; i < 900; ++i) {
      const double own = height(-6.2e-3 + 2e-6 * i, load);
      if (i > 1) worst = std::max(worst, std::fabs(own - 2. * last + before));
      before = last;
      last = own;
    }
    INFO(1e-3 * load << " kN");
    CHECK(worst < most);
  }
}

TEST_CASE("coefficients that are given are divided among the patches of a wheel",
          "[profile_contact]") {
  Pair pair(CreepLaw::linear);
  pair.contact.creep.patch = {1., 1., 1., 0., {9e6, 8.5e6, 0., 0.}};
  int two = 0;
  for (double shift = 0.; shift < 6.6e-3; shift += 2e-5) {
    double u[6] = {0., -shift, 2e-3, 0., 0., 0.};
    ProfileWheel wheel;
    for (int turn = 0; turn < 4; ++turn) {  // until 60 um are pressed
      find_profile_wheel(pair.contact, kWheel, -1., {u, 0.}, wheel);
      double deepest = -2e-4;
      for (int i = 0; i < wheel.patches; ++i)
        deepest = std::max(deepest, wheel.patch[i].rows.depth / wheel.patch[i].rows.n_z);
      while (wheel.patches == 0 && u[z] > -2e-3) {
        u[z] -= 1e-4;
        find_profile_wheel(pair.contact, kWheel, -1., {u, 0.}, wheel);
      }
      if (wheel.patches > 0 && turn < 3 && deepest > -2e-4) u[z] -= 6e-5 - deepest;
    }
    REQUIRE(wheel.patches > 0);
    double shares = 0.;
    for (int i = 0; i < wheel.patches; ++i)
      shares += wheel.patch[i].zone.share * wheel.patch[i].creep.shear;
    CHECK(shares == Approx(1.).epsilon(1e-12));
    two += wheel.patches == 2 ? 1 : 0;
    double deepest = -1.;
    for (int i = 0; i < wheel.patches; ++i) deepest = std::max(deepest, wheel.patch[i].rows.depth);
    for (int i = 0; i < wheel.patches; ++i)
      if (deepest > 0. && !(wheel.patch[i].rows.depth > 0.))
        CHECK(wheel.patch[i].creep.shear == 0.);
  }
  CHECK(two > 20);
}

TEST_CASE("a wheel beside its rail has no patch and says so", "[profile_contact]") {
  const Pair pair(CreepLaw::she);
  const double beside[6] = {0., .2, 0., 0., 0., 0.}, nan[6] = {0., std::nan(""), 0., 0., 0., 0.};
  for (const double* u : {beside, nan}) {
    ProfileWheel wheel;
    find_profile_wheel(pair.contact, kWheel, -1., {u, 0.}, wheel);
    CHECK(wheel.patches == 0);
    CHECK(wheel.at_edge);
    const double rest[6] = {};
    double stiffness[kMostZones];
    const WheelForce f =
        profile_force(pair.contact, wheel, kWheel, -1., kRolling, {u, 0.}, rest, {}, stiffness);
    CHECK(f.normal == 0.);
    CHECK(f.depth < 0.);
  }
}
