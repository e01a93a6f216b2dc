#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "support/bricard.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Eigen::Vector3d;

namespace {

/// Positions of the four moving corners.
using Corners = Eigen::Matrix<double, 3, 4>;

Corners corners(const SystemRun& r, const Bricard& m) {
  Corners c;
  for (int i = 0; i < 4; ++i)
    c.col(i) = r.point_of_body(i, m.point[static_cast<std::size_t>(i) + 1]);
  return c;
}

HighOrder known(const Bricard& m, const std::vector<double>& times) {
  return high_order([&](double, const Eigen::VectorXd& y) { return m.slope(y); },
                    Eigen::VectorXd::Zero(10), times, .05);
}

Corners corners(const Bricard& m, const Eigen::VectorXd& y) {
  const Bricard::Chain5 c = m.chain(y);
  Corners result;
  for (int i = 0; i < 4; ++i) result.col(i) = c.point[static_cast<std::size_t>(i) + 1];
  return result;
}

}  // namespace

TEST_CASE("Bricard's loop stays closed while five hinges move", "[system]") {
  const Bricard m;
  const HighOrder solution = known(m, {0., .5, 1., 1.5});
  REQUIRE(solution.own_error < 1e-10);
  for (const Eigen::VectorXd& y : solution.y) {
    const Bricard::Chain5 c = m.chain(y);
    CHECK((c.point[5] - m.point[5]).norm() < 1e-10);
    CHECK((c.axis[5] - m.axis[5]).norm() < 1e-10);
  }
  // It falls: a corner moves by more than half a rod.
  CHECK(largest(corners(m, solution.y[2]) - corners(m, solution.y[0])) > .5);
}

TEST_CASE("Bricard's mechanism moves right with one redundant row", "[system]") {
  const Bricard m;
  const HighOrder solution = known(m, {0., 1.5});
  REQUIRE(solution.own_error < 1e-10);
  const Corners right = corners(m, solution.y[1]);
  for (const SchemeOrder& c : std::span(kSchemeOrders).first(2)) {
    const auto error = [&](double h) {
      SystemRun r(m.scene(), sharp(c.scheme(h)));
      r.until(1.5);
      CHECK(r.seen == Status::ok);
      return largest(corners(r, m) - right);
    };
    const double coarse = error(2e-3), fine = error(1e-3);
    INFO("errors " << coarse << " " << fine << " m");
    CHECK(fine < 1e-3);  // a tenth of w h of a rod's length, w is some 10 rad/s
    CHECK_THAT(order(coarse, fine), WithinAbs(c.order, .15));
  }
}

TEST_CASE("Bricard's mechanism keeps its energy for 10 s", "[system]") {
  const Bricard m;
  SystemRun r(m.scene(), sharp(energy_momentum(1e-3)));
  const double energy = r.energy();
  double lost = 0.;
  for (int i = 0; i < 10000; ++i) {
    r.frame();
    lost = std::max(lost, std::abs(r.energy() - energy));
  }
  INFO("energy " << lost << " J, violation " << r.violation << ", iterations " << r.iterations);
  CHECK(r.seen == Status::ok);
  CHECK(lost < 1e-3);  // bound of H21
  CHECK(r.violation < 1e-9);
}
