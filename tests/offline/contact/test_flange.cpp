// Flanges on rigid rails: the geometry of the contact, and its motion against closed forms and a
// separate integration.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "online/contact/wheel.h"
#include "support/flanged.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

/// Steps without residual flexibility: that of a rigid rail is only the mesh's own.
PackOptions rigid(double dt) {
  PackOptions o = full_order(dt);
  o.residual_flexibility = false;
  return o;
}

/// A run on rigid rails, at y in the equilibrium of the treads, with that lateral speed.
ModelRun rolling(const Wheelset& w, double dt, double y, double speed) {
  ModelRun run(rigid_track(), {.wheelsets = {w}, .head = kFlangedHead}, rigid(dt));
  const WheelsetModel& own = run.model().wheelset[0];
  run.state.u[own.first + 1] = y;
  run.state.v[own.first + 1] = speed;
  double depth[2];  // the treads are half a metre from the middle, the weight is at y
  for (const int i : {0, 1}) {
    run.state.contact_force[i] = w.weight * (.5 + (i == 0 ? y : -y));
    depth[i] = std::pow(run.state.contact_force[i] / run.model().contact[i].law.hertz, 2. / 3.);
  }
  run.state.u[own.first + 2] = -.5 * (depth[0] + depth[1]);
  run.state.u[own.first + 3] = depth[1] - depth[0];
  return run;
}

PlaneWheelset plane_of(const ModelRun& run) {
  PlaneWheelset plane;
  plane.hertz = run.model().contact[0].law.hertz;
  const ContactLaw& face = run.model().contact[2].law;
  plane.stiffness = face.stiffness;
  plane.damping = face.damping;
  plane.face_hertz = face.hertz;
  return plane;
}

/// Flange contacts of a run in its present state, left and right.
std::array<WheelContact, 2> flanges_of(const ModelRun& run) {
  std::array<WheelContact, 2> sides;
  find_flanges(run.model(), run.model().flange[0], {run.state.u, {}}, sides.data());
  return sides;
}

/// Motion of wheelset and rails as one rigid body: a shift, then a rotation about the axes' origin.
struct RigidMotion {
  double shift[3], roll, yaw;
};

/// Closure of a contact by it: that of the rail's row less that of the wheelset's.
double closed_by(const Model& model, const WheelContact& at, const RigidMotion& m,
                 const double* centre) {
  const double L = model.element_length;
  double sum = 0.;
  for (int i = 0; i < 3; ++i) {
    const double x = (at.row.element + .5 * i) * L, y = model.rail_y[at.row.rail], z = 0.;
    const double dq[9] = {m.shift[0] - m.yaw * y,
                          m.shift[1] + m.yaw * x - m.roll * z,
                          m.shift[2] + m.roll * y,
                          -m.yaw,
                          0.,
                          m.roll,  // e_y
                          0.,
                          -m.roll,
                          0.};  // e_z
    for (int k = 0; k < 9; ++k) sum += at.row.coefficient[i][k] * dq[k];
  }
  const double dp[6] = {m.shift[0] - m.yaw * centre[1],
                        m.shift[1] + m.yaw * centre[0] - m.roll * centre[2],
                        m.shift[2] + m.roll * centre[1],
                        m.roll,
                        0.,
                        m.yaw};
  for (int k = 0; k < 6; ++k) sum -= at.body_row[k] * dp[k];
  return sum;
}

}  // namespace

TEST_CASE("the gap of a flange is that between a straight face and a point", "[flange]") {
  ModelRun run = rolling(flanged_wheelset(1e6, 0.), 1e-4, 0., 0.);
  double* p = run.state.u + run.model().wheelset[0].first;
  const PlaneWheelset plane = plane_of(run);
  p[2] = 0.;
  // A face of 70 degrees, 7 mm aside, is 7 mm sin 70 away along its normal, to rounding of 1 m.
  for (const WheelContact& side : flanges_of(run))
    CHECK_THAT(side.penetration, WithinAbs(-7e-3 * std::sin(kFaceAngle), 1e-15));
  for (const auto& pose : {std::array{7e-3, 0., 0.}, std::array{9e-3, 1e-3, 0.},
                           std::array{-8e-3, -2e-4, 3e-3}, std::array{6e-3, 4e-3, -8e-3}}) {
    for (std::size_t k = 0; k < 3; ++k) p[k + 1] = pose[k];
    const auto sides = flanges_of(run);
    for (const int i : {0, 1}) {
      const auto want = plane.flange({pose[0], pose[1], pose[2]}, i == 0 ? 1. : -1.);
      const WheelContact& got = sides[static_cast<std::size_t>(i)];
      CAPTURE(pose, i);
      CHECK_THAT(got.penetration, WithinAbs(want.depth, 1e-15));
      CHECK_THAT(got.body_row[1], WithinAbs(want.y, 1e-15));
      CHECK_THAT(got.body_row[2], WithinAbs(want.z, 1e-15));
      CHECK_THAT(got.body_row[3], WithinAbs(want.moment, 1e-15));
      CHECK(got.body_row[4] == 0.);
    }
  }
}

TEST_CASE("the force of a flange acts on wheelset and rail at one point", "[flange]") {
  ModelRun run = rolling(flanged_wheelset(1e6, 0.), 1e-4, 0., 0.);
  double* p = run.state.u + run.model().wheelset[0].first;
  p[1] = 8e-3;
  p[2] = 1e-3;
  p[3] = 5e-3;
  const double centre[3] = {3.2 + p[0], p[1], run.model().wheelset[0].rest_z + p[2]};
  for (const WheelContact& at : flanges_of(run)) {
    CHECK(at.penetration != 0.);
    // Moved as one body they do not close: f times the closure is the work of the force and its
    // opposite. The origin is 3.2 m away, so rounding is some 1e-16 of that.
    const auto closed = [&](const RigidMotion& m) { return closed_by(run.model(), at, m, centre); };
    CHECK_THAT(closed({{0., 1., 0.}, 0., 0.}), WithinAbs(0., 1e-14));
    CHECK_THAT(closed({{0., 0., 1.}, 0., 0.}), WithinAbs(0., 1e-14));
    CHECK_THAT(closed({{1., 0., 0.}, 0., 0.}), WithinAbs(0., 1e-14));
    CHECK_THAT(closed({{0., 0., 0.}, 1., 0.}), WithinAbs(0., 1e-14));
    CHECK_THAT(closed({{0., 0., 0.}, 0., 1.}), WithinAbs(0., 1e-14));
    CHECK(std::abs(at.body_row[3]) > 1e-4);  // there is a moment to balance
  }
}

TEST_CASE("a wheelset that runs into its flange moves as in a separate integration", "[flange]") {
  // Lateral displacement and heights of the axle over both rails, each over its largest, are of
  // second order where the force has only a kink. A damper's force jumps within a step, which
  // leaves up to c sin^2 v dt / m of the speed. Each run meets the flange just before the end of a
  // step, so that steps compare. The impact of Hertz's law lifts the tread.
  struct Law {
    double stiffness, damping, corner;
    double coarse, end;  // s
    double error;        // at a quarter of `coarse`
  };
  const Law law = GENERATE(Law{1e7, 0., 0., 1e-5, .02, 3e-5}, Law{1e7, 1.35e4, 0., 1e-5, .02, 2e-3},
                           Law{0., 0., .013, 8e-6, .008, 3e-5});
  Wheelset w = flanged_wheelset(law.stiffness, law.damping);
  w.flange->corner_radius = law.corner;
  constexpr double kSpeed = .0374;
  const double start = 7e-3 + 1e-11 - kSpeed * 64. * law.coarse, fine = law.coarse / 40.;
  std::vector<double> error;
  for (const int part : {1, 2, 4}) {
    ModelRun run = rolling(w, law.coarse / part, start, kSpeed);
    const PlaneWheelset plane = plane_of(run);
    const double rest = run.body()[2];
    PlaneWheelset::State q{start, rest, run.body()[3], kSpeed, 0., 0.};
    double most[3] = {}, miss[3] = {};
    const auto moved = [&](double y, double z, double roll) {
      return std::array{y - 7e-3, z - rest + .5 * roll, z - rest - .5 * roll};
    };
    while (run.time() < law.end - 1e-9) {
      run.step();
      for (int i = 0; i < 40 / part; ++i) q = plane.step(q, fine);
      const auto want = moved(q[0], q[1], q[2]),
                 got = moved(run.body()[1], run.body()[2], run.body()[3]);
      for (std::size_t k = 0; k < 3; ++k) {
        most[k] = std::max(most[k], std::abs(want[k]));
        miss[k] = std::max(miss[k], std::abs(got[k] - want[k]));
      }
    }
    error.push_back(std::max({miss[0] / most[0], miss[1] / most[1], miss[2] / most[2]}));
    CHECK(q[3] < -.01);  // it came back
    const double sine = std::sin(kFaceAngle), dt = law.coarse / part;
    if (law.damping > 0.) CHECK(miss[0] < law.damping * sine * sine * kSpeed * dt / 100. * law.end);
  }
  CAPTURE(law.stiffness, law.damping, law.corner, error);
  CHECK(error[2] < law.error);
  if (law.damping > 0.) return;
  CHECK_THAT(std::log2(error[0] / error[1]), WithinAbs(2., .3));
  CHECK_THAT(std::log2(error[1] / error[2]), WithinAbs(2., .3));
}

TEST_CASE("a damped flange rebounds as in the closed form", "[flange]") {
  // m / sin^2 on k and c, which let go when they would pull: e = exp(-(pi - 2 asin zeta) zeta /
  // sqrt(1 - zeta^2)) (Schwager and Poschel, 2007). The treads yield by k cos^2 / (2 k_tread) = 1e5
  // * .117 / 4e8 of it.
  constexpr double kStiffness = 1e5, kSpeed = .0374;
  const double effective = 100. / std::pow(std::sin(kFaceAngle), 2);
  for (const double zeta : {0., .2, .5}) {
    const double damping = 2. * zeta * std::sqrt(kStiffness * effective);
    ModelRun run = rolling(flanged_wheelset(kStiffness, damping), 2e-5, 7e-3 - 1e-5, kSpeed);
    double peak = 0.;
    while (run.time() < .15) {
      run.step();
      peak = std::max(peak, run.outputs.contact_force[flange_contact(run.model(), 0)]);
    }
    const double want =
        std::exp(-(M_PI - 2. * std::asin(zeta)) * zeta / std::sqrt(1. - zeta * zeta));
    const double got = -run.state.v[run.model().wheelset[0].first + 1] / kSpeed;
    CAPTURE(zeta, got, want, got / want - 1.);
    CHECK_THAT(got, WithinRel(want, 1e-3));
    if (zeta == 0.)
      CHECK_THAT(
          peak, WithinRel(kSpeed * std::sin(kFaceAngle) * std::sqrt(kStiffness * effective), 1e-3));
  }
}

TEST_CASE("a mirrored run into the right flange is the mirror image", "[flange]") {
  const auto run_into = [](double side) {
    ModelRun run = rolling(flanged_wheelset(1e7, 1.35e4), 5e-5, side * 6.9e-3, side * .0374);
    run.until(.02);
    return run;
  };
  const ModelRun left = run_into(1.), right = run_into(-1.);
  CHECK(left.state.v[left.model().wheelset[0].first + 1] < -.01);
  // Sums over both rails go in one order, so mirror images differ by rounding: in steps that press
  // with 1e3 N on 1e7 N/m, by 1e-16 1e-4 m each.
  CHECK_THAT(left.body()[1], WithinAbs(-right.body()[1], 1e-12));
  CHECK_THAT(left.body()[2], WithinAbs(right.body()[2], 1e-12));
  CHECK_THAT(left.body()[3], WithinAbs(-right.body()[3], 1e-12));
}

TEST_CASE("a flange holds up to Nadal's limit without friction, then climbs and runs off",
          "[flange]") {
  // A wheel on its flange alone has tan 70 as lateral over vertical force. The left tread lets go
  // at a push given by the wheelset's balance: 2 N_left = V + M / half gauge, V = Q - f cos, with
  // the moments M of flange and treads about the centre, 7 mm aside.
  const double c = std::cos(kFaceAngle), s = std::sin(kFaceAngle), Q = 981., y = 7e-3;
  const auto left = [&](double f) {
    const double V = Q - f * c, arm = .5 - kHalfHead - y;
    return .5 * (V + (V * y - f * c * arm + .162 * f * s) / .5);
  };
  const double f = left(0.) / (left(0.) - left(1.)), limit = f * s;
  CHECK_THAT(limit / (f * c), WithinRel(std::tan(kFaceAngle), 1e-12));
  const auto pushed = [&](double force) {
    Wheelset w = flanged_wheelset(1e7, 1.35e5);
    w.forces = {{1, {0., 0., .5, force}}};
    return rolling(w, 5e-5, 7e-3, 0.);
  };
  // The face yields by 0.3 mm and turns with the resulting roll: 1 % of the push, below 3 %.
  ModelRun held = pushed(.97 * limit);
  held.until(.6);
  CHECK(held.seen == Status::ok);
  CHECK(held.outputs.contact_force[0] > 0.);
  CHECK(held.outputs.contact_force[0] < .1 * Q);
  ModelRun climbs = pushed(1.03 * limit);
  while (!has(climbs.seen, Status::off_rail) && climbs.time() < 2.) climbs.step();
  CHECK(has(climbs.seen, Status::contact_lost));
  REQUIRE(has(climbs.seen, Status::off_rail));
  CHECK(climbs.outputs.contact_force[0] == 0.);
  // The tip, 28 mm below the tread, has come up to the point 14 mm below the head's top. It is over
  // that point by the motion in a step of 50 us at up to 2 m/s.
  const double *p = climbs.body(), arm_y = .5 - kHalfHead - p[1], arm_z = -.162 - p[2];
  const double over = -.176 - (arm_z * std::cos(p[3]) - arm_y * std::sin(p[3]));
  CHECK_THAT(over, WithinAbs(0., 1e-4));
}

TEST_CASE("a flange reports an impact that is too fast for the step", "[flange]") {
  // Half an oscillation of the mass m / sin^2, with its share of roll, on 1e8 N/m takes 3.3 ms: 33
  // steps of 0.1 ms, or 7 of 0.5 ms.
  const auto met = [](double dt) {
    ModelRun run = rolling(flanged_wheelset(1e8, 0.), dt, 6.9e-3, .0374);
    run.until(.01);
    return has(run.seen, Status::contact_unresolved);
  };
  CHECK_FALSE(met(1e-4));
  CHECK(met(5e-4));
}
