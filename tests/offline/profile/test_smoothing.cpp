// Splines through measured points.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "offline/profile/smoothing.h"

using namespace railstep;
using Catch::Matchers::Contains;

namespace {

/// Heights of a circle's top, R 80 mm, 40 mm wide, with noise.
std::vector<Point> circle(double noise, int half = 40) {
  std::mt19937 engine(11);
  std::normal_distribution<double> error(0., 1.);
  std::vector<Point> points;
  for (int i = -half; i <= half; ++i) {
    const double y = .02 * i / half;
    points.push_back({y, std::sqrt(.08 * .08 - y * y) + noise * error(engine)});
  }
  return points;
}

double curvature_error(const RunningSurface& surface) {
  double most = 0.;
  for (double y = -.015; y < .015; y += 1e-4) {
    const double exact = -.08 * .08 / std::pow(.08 * .08 - y * y, 1.5);
    most = std::max(most, std::abs(surface.at(y).curvature / exact - 1.));
  }
  return most;
}

}  // namespace

TEST_CASE("a spline without tolerance goes through its points", "[profile]") {
  const std::vector<Point> points = circle(0.);
  const SmoothedPoints made = smoothed(points, 0.);
  for (const Point& p : points)
    CHECK(through(made.points).at(p[0]).height == Approx(p[1]).epsilon(1e-12));
  CHECK(curvature_error(through(made.points)) < 1e-3);
  CHECK(made.largest < 1e-12);
}

TEST_CASE("smoothing takes the noise out of the curvature", "[profile]") {
  // 5 um of noise, 0.5 mm apart: the second difference is noise alone.
  const std::vector<Point> points = circle(5e-6);
  CHECK(curvature_error(through(points)) > 2.);
  const SmoothedPoints made = smoothed(points, 5e-6);
  CHECK(curvature_error(through(made.points)) < .3);
  CHECK(made.rms == Approx(5e-6).epsilon(1e-6));
  CHECK(made.largest < 3e-5);
}

TEST_CASE("a tolerance beyond a straight line gives that line", "[profile]") {
  const SmoothedPoints made = smoothed(circle(0.), .01);
  CHECK(std::abs(through(made.points).at(0.).curvature) < 1e-5);
  CHECK(made.rms < .01);
}

TEST_CASE("points of no running surface are refused with their place", "[profile]") {
  const auto refused = [](std::vector<Point> points, double tolerance, const char* id,
                          const char* number) {
    CHECK_THROWS_WITH(through(smoothed(points, tolerance).points),
                      Contains(number) && Contains(id));
  };
  refused({{0., 0.}, {1e-3, 0.}, {2e-3, 0.}}, 0., "E-POINTS-01", " 3 ");
  CHECK_THROWS_WITH(through(std::vector<Point>{{0., 0.}}),
                    Contains(" 1 ") && Contains("E-POINTS-01"));
  std::vector<Point> points = circle(0.);
  points[7][1] = std::nan("");
  refused(points, 0., "E-POINTS-02", " 8 ");
  points = circle(0.);
  points[9][0] = points[8][0];
  refused(points, 0., "E-POINTS-03", " 10 ");
  points = circle(0.);
  points.erase(points.begin() + 20, points.begin() + 40);
  refused(points, 0., "E-POINTS-04", " -10.5");
  points = circle(0.);
  for (std::size_t i = 50; i < points.size(); ++i)
    points[i][1] -= .8 * (points[i][0] - points[49][0]);
  refused(points, 0., "E-POINTS-05", " 4.5");
  points = circle(2e-6, 100);
  points[75][1] += 1e-4;
  refused(points, 5e-6, "E-POINTS-06", " -5.0");
  points = circle(0.);
  for (std::size_t i = 50; i < points.size(); ++i) points[i][1] -= 2e-3;
  refused(points, 0., "E-POINTS-08", " 4.0");
}
