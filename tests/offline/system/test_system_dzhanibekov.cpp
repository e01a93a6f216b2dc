#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "support/high_order.h"
#include "support/system_run.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// Jacobi's sn, cn, dn at u for the modulus k, by descending Landen steps of the arithmetic and
/// geometric mean (Abramowitz and Stegun 16.4); given is 1 - k^2, which k itself has lost.
struct Jacobi {
  double sn, cn, dn;
};
Jacobi jacobi(double u, double k2, double one_less_k2) {
  double a[16], c[16], b = std::sqrt(one_less_k2);
  a[0] = 1.;
  c[0] = std::sqrt(k2);
  int n = 0;
  while (std::abs(c[n]) > 1e-17 && n < 15) {
    a[n + 1] = .5 * (a[n] + b);
    c[n + 1] = .5 * (a[n] - b);
    b = std::sqrt(a[n] * b);
    ++n;
  }
  double phi = std::ldexp(a[n] * u, n);
  for (; n > 0; --n) phi = .5 * (phi + std::asin(c[n] / a[n] * std::sin(phi)));
  return {std::sin(phi), std::cos(phi), std::sqrt(1. - k2 * std::sin(phi) * std::sin(phi))};
}

/// A complete elliptic integral K(k) by the same mean.
double quarter_period(double one_less_k2) {
  double a = 1., b = std::sqrt(one_less_k2);
  for (int i = 0; i < 40; ++i) {
    const double mean = .5 * (a + b);
    b = std::sqrt(a * b);
    a = mean;
  }
  return std::acos(-1.) / (2. * a);
}

/// A free body with I1 < I2 < I3 that starts with the spin (a, 0, c). By Euler's equations w = (a
/// cn, B sn, c dn)(p t). If 1 - k^2 is small, it stays near its second axis and flips twice in each
/// period.
struct FreeBody {
  Vector3d inertia{1., 2., 3.};
  double c = 2., one_less_k2 = 1e-4;

  double rate() const {
    return c * std::sqrt((inertia[2] - inertia[0]) * (inertia[2] - inertia[1]) /
                         (inertia[0] * inertia[1]));
  }
  double a() const {
    return c * std::sqrt((1. - one_less_k2) * inertia[2] * (inertia[2] - inertia[1]) /
                         (inertia[0] * (inertia[1] - inertia[0])));
  }
  double period() const { return 4. * quarter_period(one_less_k2) / rate(); }
  Vector3d spin(double t) const {
    const Jacobi j = jacobi(rate() * t, 1. - one_less_k2, one_less_k2);
    const double B = (inertia[2] - inertia[0]) * a() * c / (inertia[1] * rate());
    return {a() * j.cn, B * j.sn, c * j.dn};
  }
  System scene() const {
    System s;
    s.gravity.setZero();
    RigidBody b;
    b.mass = 1.;
    b.inertia = inertia.asDiagonal();
    b.velocity = {.3, -.2, .1};
    b.angular_velocity = {a(), 0., c};
    s.bodies = {b};
    return s;
  }
};

/// Largest error of the spin in body axes, rad/s.
double spin_error(const FreeBody& body, double duration, const Scheme& scheme) {
  SystemRun r(body.scene(), sharp(scheme));
  double most = 0.;
  while (r.time() < duration) {
    r.frame();
    most = std::max(most, largest(r.body_spin(0) - body.spin(r.time())));
  }
  CHECK(r.seen == Status::ok);
  return most;
}

}  // namespace

TEST_CASE("a book flips as Jacobi's functions say", "[system]") {
  const FreeBody book;
  // First the closed form is compared with Euler's equations.
  const auto euler = [&](double, const Eigen::VectorXd& w) -> Eigen::VectorXd {
    const Vector3d own = w, momentum = book.inertia.cwiseProduct(own);
    return momentum.cross(own).cwiseQuotient(book.inertia);
  };
  const double T = book.period();
  // Near the second axis an error grows by 4 / (1 - k^2)^.5 in each quarter: from 1e-15 of 7 rad/s
  // to 1e-9.
  const HighOrder solution = high_order(euler, book.spin(0.), {0., .25 * T, .45 * T}, .05);
  REQUIRE(solution.own_error < 1e-8);
  REQUIRE(largest(solution.y[1] - book.spin(.25 * T)) < 1e-8);
  REQUIRE(largest(solution.y[2] - book.spin(.45 * T)) < 1e-8);

  CHECK(book.spin(.25 * T)[1] * book.spin(.75 * T)[1] < -5.);  // it does flip
  for (const SchemeOrder& c : std::span(kSchemeOrders).first(2)) {
    // Half a period contains one flip, in which the error of a step grows as above.
    const double coarse = spin_error(book, .5 * T, c.scheme(1e-3));
    const double fine = spin_error(book, .5 * T, c.scheme(5e-4));
    INFO("spin errors " << coarse << " " << fine << " rad/s of " << book.spin(.25 * T)[1]);
    CHECK_THAT(order(coarse, fine), WithinAbs(c.order, .1));
  }
}

TEST_CASE("energy-momentum keeps a book's momentum and energy over 1e5 steps", "[system]") {
  const FreeBody book;
  SystemRun r(book.scene(), sharp(energy_momentum(1e-3)));
  const Eigen::Matrix<double, 6, 1> before = r.momentum();
  const double energy = r.energy();
  double lost = 0., drift = 0., turned = 0.;
  for (int i = 0; i < 100000; ++i) {
    r.frame();
    if (i % 10 != 0) continue;
    const Eigen::Matrix<double, 6, 1> now = r.momentum();
    drift = std::max(drift, largest(now.head<3>() - before.head<3>()));
    turned = std::max(turned, largest(now.tail<3>() - before.tail<3>()));
    lost = std::max(lost, std::abs(r.energy() / energy - 1.));
  }
  CHECK(r.seen == Status::ok);
  INFO("linear " << drift << ", angular " << turned << " of " << before.tail<3>().norm()
                 << ", energy " << lost);
  // Each step rounds a few times by 1e-16, all to one side: 1e5 * 10 * 1e-16.
  CHECK(drift < 1e-10);
  CHECK(turned < 1e-10 * before.tail<3>().norm());
  CHECK(lost < 1e-10);
}
