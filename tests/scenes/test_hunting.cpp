// Wheels that are cones hunt in runs as closed linear theory has it: Klingel's wavelength, and the
// critical speed over steps and schemes.
#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "answer/scene_running.h"
#include "online/math/pi.h"
#include "support/coned_wheelset.h"
#include "support/scene_run.h"

using namespace railstep;

namespace {

constexpr double kAxleMass = 1250., kAxleInertia = 700.;   // kg, kg m2 about x and z
constexpr double kCreepAlong = 9e6, kCreepAcross = 8.5e6;  // of creep per wheel, N
constexpr double kGuideLateral = .5e6, kGuideYaw = .5e6, kHalfDistance = .75;  // N/m, N m, m

/// Linear theory knows the ratio of conicity and radius only, but for the roll by the cones, which
/// goes with the radius: small wheels have the lateral motion and yaw of the test problem alone.
ConedWheelset problem(double radius) { return coned(radius, .1 * radius / .46, kHalfDistance); }

struct HuntingGuide {
  double lateral, yaw;             // N/m, N m
  double spin_force, spin_moment;  // of creep, N m, N m2
  double inertia;                  // about the axle, kg m2
};

constexpr HuntingGuide kSprung{kGuideLateral, kGuideYaw, 0., 0., .1},
    kFreeGuide{0., 0., 0., 0., .1};

Scene coned_scene(const ConedWheelset& w, const HuntingGuide& g, double speed,
                  const std::string& step) {
  return railstep::scene_of(
      fmt::format("schema = 1\n"
                  "[track]\nform = \"rigid\"\n"
                  "[contact]\nwheel = \"cone\"\nrail = \"crown\"\nnormal = \"hertz\"\n"
                  "slope = {}\ndistance_m = 1.5\nhertz_n_per_m15 = 1e14\ncreep = \"linear\"\n"
                  "kalker = [9.0e6, 8.5e6, {}, {}]\n"
                  "[[vehicle]]\nname = \"set\"\ntype = \"rail_vehicle\"\nspeed_m_per_s = {}\n"
                  "[[vehicle.wheelset]]\nname = \"axle\"\nmass_kg = 1250.0\nplace_m = 0.0\n"
                  "inertia_kg_m2 = [700.0, {}, 700.0]\nradius_m = {}\n"
                  "[[vehicle.element]]\nname = \"guide\"\ntype = \"bushing\"\n"
                  "between = [\"axle\", \"ground\"]\npoint_m = [0.0, 0.0, {}]\n"
                  "stiffness_n_per_m = [0.0, {}, 0.0]\nstiffness_n_m_per_rad = [0.0, 0.0, {}]\n"
                  "[step]\nduration_s = 100.0\n{}",
                  w.slope, g.spin_force, g.spin_moment, speed, g.inertia, w.radius, w.radius,
                  g.lateral, g.yaw, step));
}

double found_speed(const ConedWheelset& w, const HuntingGuide& g) {
  const auto found = critical_speed_between(coned_scene(w, g, 30., "dt_s = 1e-3\n"), 30., 60.);
  return found ? found->speed : 0.;
}

/// Lateral motion y and yaw, M q'' + C q' + K q = 0, with roll(y) and the height of the weight.
struct LateralMotion {
  Eigen::Matrix2d mass, damping, stiffness;
};
LateralMotion lateral_motion(const ConedWheelset& w, const HuntingGuide& g, double v) {
  const double roll = w.roll(), a = w.across(), by_yaw = w.across_by_yaw(), t = w.slope;
  const double upright = std::cos(w.angle()), weight = kAxleMass * 9.81;
  const double momentum = g.inertia * v / w.radius,
               spun = t / w.radius;                   // spin of the cones over v
  const double ahead = kHalfDistance - w.radius * t;  // along x and over yaw, of the contacts
  LateralMotion m;
  m.mass << kAxleMass + kAxleInertia * roll * roll, 0., 0., kAxleInertia;
  const double spin = 2. * g.spin_force * a * upright / v - momentum * roll;
  m.damping << 2. * kCreepAcross * a * a / v, spin, -spin,
      2. * (kCreepAlong * kHalfDistance * kHalfDistance + g.spin_moment * upright * upright) / v;
  // The forces of spin of both wheels, against each other, turn with the yaw and with the roll.
  m.stiffness << kGuideLateral + weight * w.height_bend() -
                     2. * g.spin_force * spun * w.half_chord() * roll * roll,
      -2. * kCreepAcross * a * by_yaw, 2. * kCreepAlong * kHalfDistance * w.conicity() / w.radius,
      kGuideYaw - weight * t * ahead + 2. * g.spin_force * (1. + spun * ahead);
  return m;
}

/// The least speed at which a motion grows.
template <class Grows>
double least_speed(const Grows& grows) {
  double low = 20., high = 80.;
  while (high - low > 1e-9) {
    const double v = .5 * (low + high);
    (grows(v) ? high : low) = v;
  }
  return low;
}

double closed_speed(const ConedWheelset& w, const HuntingGuide& g) {
  return least_speed([&](double v) {
    const LateralMotion m = lateral_motion(w, g, v);
    const Eigen::Matrix2d per_mass = m.mass.inverse();
    Eigen::Matrix4d rate = Eigen::Matrix4d::Zero();
    rate.topRightCorner<2, 2>().setIdentity();
    rate.bottomLeftCorner<2, 2>() = -per_mass * m.stiffness;
    rate.bottomRightCorner<2, 2>() = -per_mass * m.damping;
    return rate.eigenvalues().real().maxCoeff() > 0.;
  });
}

/// The same in steps of the generalised-alpha method: of q, q' dt and q'' dt^2 from one step to the
/// next.
double stepped_speed(const ConedWheelset& w, const HuntingGuide& g, double rho, double dt) {
  const double m = (2. * rho - 1.) / (rho + 1.), f = rho / (rho + 1.), gamma = .5 - m + f,
               beta = .25 * (1. - m + f) * (1. - m + f);
  return least_speed([&](double v) {
    const LateralMotion own = lateral_motion(w, g, v);
    const Eigen::Matrix2d C = dt * own.damping, K = dt * dt * own.stiffness;
    const Eigen::Matrix2d by_new = (1. - m) * own.mass + (1. - f) * (gamma * C + beta * K);
    const Eigen::Matrix2d solved = by_new.inverse();
    Eigen::Matrix<double, 2, 6> acceleration;
    acceleration << solved * -K, solved * -(C + (1. - f) * K),
        solved * -(m * own.mass + (1. - f) * ((1. - gamma) * C + (.5 - beta) * K));
    Eigen::Matrix<double, 6, 6> step = Eigen::Matrix<double, 6, 6>::Zero();
    step.topRows<2>() = beta * acceleration;
    step.middleRows<2>(2) = gamma * acceleration;
    step.bottomRows<2>() = acceleration;
    const Eigen::Matrix2d one = Eigen::Matrix2d::Identity();
    step.block<2, 2>(0, 0) += one;
    step.block<2, 2>(0, 2) += one;
    step.block<2, 2>(0, 4) += (.5 - beta) * one;
    step.block<2, 2>(2, 2) += one;
    step.block<2, 2>(2, 4) += (1. - gamma) * one;
    return step.eigenvalues().cwiseAbs().maxCoeff() > 1. + 1e-13;
  });
}

/// A motion e^(growth t) cos(frequency t + phase).
struct Swing {
  double growth, frequency;  // 1/s, rad/s
};

/// From a small lateral displacement: the recurrence of three values that lie `apart`, in s, from
/// `from` to `to`, when nothing else swings any more.
Swing swing(const Scene& scene, double from, double to, double apart) {
  Simulation run(scene);
  const Model& model = run.model();
  const RunnerModel& runner = model.runner[0];
  run.state.u[runner.first + runner.wheelset[0].first + index_of(BodyMotion::y)] = 1e-6;
  Outputs outputs{};
  publish_start(model, run.state, outputs);
  std::vector<double> y;
  const double dt = model.scheme.dt;
  for (int n = 0; n < static_cast<int>(to / dt); ++n) {
    static_cast<void>(advance_frame(model, run.state, run.workspace, outputs));
    if (n * dt >= from) y.push_back(outputs.wheelset_y[0]);
  }
  const auto lag = static_cast<Eigen::Index>(std::lround(apart / dt));
  const auto count = static_cast<Eigen::Index>(y.size()) - 2 * lag;
  const Eigen::Map<const Eigen::VectorXd> all(y.data(), count + 2 * lag);
  Eigen::MatrixXd before(count, 2);
  before << all.segment(lag, count), all.head(count);
  const Eigen::Vector2d p = before.colPivHouseholderQr().solve(all.tail(count));
  const double size = std::sqrt(-p[1]), time = static_cast<double>(lag) * dt;
  return {std::log(size) / time, std::acos(.5 * p[0] / size) / time};
}

}  // namespace

TEST_CASE("the critical speed of cones is that of closed theory", "[hunting]") {
  // Roll included, all of it: 3.6 % and, of a wheel's momentum, 4 %.
  for (const double radius : {.46, .2, .05}) {
    for (const double inertia : {.1, 500. * radius * radius}) {
      for (const auto& [force, moment] : {std::pair{0., 0.}, {12e3, 20.}}) {
        const HuntingGuide guide{kGuideLateral, kGuideYaw, force, moment, inertia};
        INFO(radius << " m, " << inertia << " kg m2, " << force << " N m");
        CHECK(found_speed(problem(radius), guide) ==
              Approx(closed_speed(problem(radius), guide)).epsilon(2e-5));
      }
    }
  }
  // The test problem knows no roll: without spin 43.6609 m/s. With spin it is printed as 42.8838
  // m/s, from a yaw equation that leaves out the moment of creep by yaw, 2 f23 psi.
  CHECK(closed_speed(problem(1e-4), {kGuideLateral, kGuideYaw, 0., 0., 0.}) ==
        Approx(43.6609).epsilon(2e-6));
  CHECK(found_speed(problem(.03), kSprung) == Approx(43.6609).epsilon(5e-4));
}

TEST_CASE("a free wheelset follows Klingel's wave", "[hunting]") {
  for (const double radius : {.46, .03}) {
    const ConedWheelset w = problem(radius);
    const double wavelength =
        2. * kPi *
        std::sqrt(radius * kHalfDistance * w.across() / (w.conicity() * w.across_by_yaw()));
    for (const double v : {1., 5.}) {
      INFO("radius of " << radius << " m at " << v << " m/s: " << wavelength << " m");
      const Swing s =
          swing(coned_scene(w, kFreeGuide, v, "dt_s = 1e-3\n"), 4., 40., wavelength / (4. * v));
      CHECK(2. * kPi * v / s.frequency == Approx(wavelength).epsilon(1e-4));
    }
  }
  CHECK(2. * kPi * std::sqrt(.46 * kHalfDistance / .1) == Approx(11.6704987).epsilon(1e-8));
}

TEST_CASE("runs hunt from a critical speed that errs as the scheme does", "[hunting]") {
  // A conicity that is one step late makes 5 % at 1 ms, at which these make 0.005 % at most.
  const ConedWheelset w = problem(.03);
  const double linear = found_speed(w, kSprung), closed = closed_speed(w, kSprung);
  for (const double rho : {.6, 0., 1.}) {
    for (const double dt : {2e-4, 5e-4, 1e-3, 2e-3}) {
      const auto growth_at = [&](double part) {
        const std::string step = fmt::format("dt_s = {0}\nframe_s = {0}\nrho_inf = {1}\n", dt, rho);
        return swing(coned_scene(w, kSprung, part * linear, step), 4., 10., .068).growth;
      };
      const double low = growth_at(.999), high = growth_at(1.001);
      const double error = 100. * (-.001 + .002 * low / (low - high)),
                   known = 100. * (stepped_speed(w, kSprung, rho, dt) / closed - 1.);
      INFO("rho_inf " << rho << ", step of " << dt << " s: " << error << " and " << known << " %");
      CHECK(std::fabs(error - known) < 2e-4);
    }
  }
}
