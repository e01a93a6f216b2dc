#include <catch2/catch.hpp>
#include <cmath>

#include "support/bricard.h"
#include "support/system_run.h"

using namespace railstep;
using Eigen::Vector3d;

namespace {

/// A rod on a hinge at the origin, released from the horizontal; its hinge is given `times` times.
System pendulum(bool planar, int times) {
  System s;
  s.planar = planar;
  s.bodies = {rod_body(Vector3d::Zero(), 1., 0., 1., .05)};
  for (int i = 0; i < times; ++i)
    s.joints.push_back(hinge(ground(), body(0), Vector3d::Zero(), planar));
  return s;
}

Vector3d end(const SystemRun& r) { return r.point_of_body(0, Vector3d::UnitX()); }

}  // namespace

TEST_CASE("a doubled hinge moves as a single one", "[system]") {
  // This is H20 of hard-cases.md.
  const bool planar = GENERATE(true, false);
  const Scheme scheme = GENERATE(generalised_alpha(1e-3, .9), energy_momentum(1e-3));
  SystemRun single(pendulum(planar, 1), sharp(scheme));
  SystemRun twice(pendulum(planar, 2), sharp(scheme)), thrice(pendulum(planar, 3), sharp(scheme));
  double apart = 0.;
  for (int i = 0; i < 2000; ++i) {
    for (SystemRun* r : {&single, &twice, &thrice}) r->frame();
    apart =
        std::max({apart, largest(end(single) - end(twice)), largest(end(single) - end(thrice))});
  }
  INFO("apart " << apart << " m");
  CHECK((single.seen | twice.seen | thrice.seen) == Status::ok);
  CHECK(apart < 1e-9);
  // Together they carry the load of the single hinge, in equal shares.
  const Vector3d one = single.joint_force(0), first = twice.joint_force(0),
                 second = twice.joint_force(1);
  // Joints hold to 1e-12 m, so forces to kg m = 4e6 N/m of that in each of 2000 steps.
  // Energy-momentum does not forget these errors, which add up as a random walk.
  const double known = std::sqrt(2000.) * 4e6 * 1e-12;
  CHECK((first + second - one).norm() < known);
  CHECK((first - second).norm() < known);
}

TEST_CASE("the direct solve names redundant joints", "[system]") {
  const bool planar = GENERATE(true, false);
  const SystemOptions direct = sharp(generalised_alpha(1e-3, .9), ConstraintMethod::direct);
  SystemRun single(pendulum(planar, 1), direct), twice(pendulum(planar, 2), direct);
  for (int i = 0; i < 1000; ++i) {
    single.frame();
    twice.frame();
  }
  CHECK(single.seen == Status::ok);
  CHECK(single.outputs.redundant_rows == 0);
  CHECK(twice.outputs.redundant_rows == (planar ? 2 : 5));
  // Either of two equal rows may be taken, but each must be one of a pair.
  for (int i = 0; i < twice.outputs.redundant_rows; ++i) {
    const int row = twice.outputs.redundant_row[i];
    CHECK((row >= 0 && row < 2 * twice.outputs.redundant_rows));
    for (int k = 0; k < i; ++k)
      CHECK(row % twice.outputs.redundant_rows !=
            twice.outputs.redundant_row[k] % twice.outputs.redundant_rows);
  }
  CHECK(twice.seen == Status::redundant_joint);
  CHECK(largest(end(single) - end(twice)) < 1e-9);
}

TEST_CASE("the direct solve names Bricard's redundant row and goes on", "[system]") {
  const Bricard m;
  const HighOrder known = high_order([&](double, const Eigen::VectorXd& y) { return m.slope(y); },
                                     Eigen::VectorXd::Zero(10), {0., 1.}, .05);
  REQUIRE(known.own_error < 1e-10);
  const Bricard::Chain5 right = m.chain(known.y[1]);
  const auto error = [&](double h) {
    SystemRun r(m.scene(), sharp(generalised_alpha(h, .9), ConstraintMethod::direct));
    double most = 0.;
    while (r.time() < 1. - .5 * h) {
      r.frame();
      CHECK(r.outputs.redundant_rows == 1);
    }
    CHECK(r.seen == Status::redundant_joint);
    for (std::size_t i = 0; i < 4; ++i) {
      const Vector3d at = r.point_of_body(static_cast<int>(i), m.point[i + 1]);
      most = std::max(most, largest(at - right.point[i + 1]));
    }
    return most;
  };
  const double coarse = error(2e-3), fine = error(1e-3);
  INFO("errors " << coarse << " " << fine << " m");
  CHECK(fine < 1e-3);  // a tenth of w h of a rod's length, w is some 10 rad/s
  CHECK_THAT(order(coarse, fine), Catch::WithinAbs(2., .15));
}
