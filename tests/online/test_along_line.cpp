// The design line at a place: tables, their integrals, and frames that follow it.
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "online/track/along_line.h"

using namespace railstep;

namespace {

constexpr double kCurved[] = {-20., 0., 10., 2e-3, 35., 2e-3, 60., -1e-3, 61., 0.};
constexpr LineTable kCurvature{5, kCurved};

/// Integral of the table and of that integral by Simpson's rule in many parts.
LineIntegral by_quadrature(Transition transition, double from, double to) {
  constexpr int kParts = 20000;
  const double h = (to - from) / kParts;
  LineIntegral sum{0., 0.};
  for (int i = 0; i < kParts; ++i) {
    const double a = from + i * h;
    double value[3];
    for (int k = 0; k < 3; ++k) value[k] = value_at(kCurvature, transition, a + .5 * k * h).value;
    const double once = h / 6. * (value[0] + 4. * value[1] + value[2]);
    sum.twice += sum.once * h + h * h / 6. * (value[0] + 2. * value[1]);
    sum.once += once;
  }
  return sum;
}

DesignLine circle(double curvature, double sine, std::vector<double>& rows) {
  rows = {0., curvature, 0., sine};
  return {Transition::linear, {1, rows.data()}, {1, rows.data() + 2}, {0, nullptr}, 1};
}

}  // namespace

TEST_CASE("integrals of a design line are exact over any of its pieces, both ways", "[line]") {
  for (const Transition transition : {Transition::linear, Transition::bloss, Transition::cosine})
    for (const double from : {-60., -20., -3., 10., 47.5, 60.2, 90.})
      for (const double to : {-70., -20., 5., 35., 59., 61., 200.}) {
        CAPTURE(static_cast<int>(transition), from, to);
        const LineIntegral exact = integral(kCurvature, transition, 6, from, to),
                           other = by_quadrature(transition, from, to);
        CHECK(exact.once == Approx(other.once).margin(2e-10));
        CHECK(exact.twice == Approx(other.twice).margin(2e-8));
      }
}

TEST_CASE("transitions by Bloss and by a cosine begin and end without a corner", "[line]") {
  for (const Transition transition : {Transition::bloss, Transition::cosine})
    for (const double corner : {-20., 10.}) {
      CHECK(value_at(kCurvature, transition, corner - 1e-9).slope == Approx(0.).margin(1e-12));
      CHECK(value_at(kCurvature, transition, corner + 1e-9).slope == Approx(0.).margin(1e-12));
    }
  // Slopes are derivatives of the values.
  for (const Transition transition : {Transition::linear, Transition::bloss, Transition::cosine})
    for (const double place : {-13., 1., 48., 60.4}) {
      const double h = 1e-4, ahead = value_at(kCurvature, transition, place + h).value,
                   behind = value_at(kCurvature, transition, place - h).value;
      CHECK(value_at(kCurvature, transition, place).slope ==
            Approx((ahead - behind) / (2. * h)).epsilon(1e-6));
    }
}

TEST_CASE("frames on a canted circle stand as on the circle", "[line]") {
  std::vector<double> rows;
  for (const double way : {-10., 1.3, 12.}) {
    const double curvature = 1. / 200., sine = -.08, angle = curvature * way;
    const FramePose pose = pose_between(circle(curvature, sine, rows), 500., 500. + way);
    const double cosine = std::sqrt(1. - sine * sine), aside = (1. - std::cos(angle)) / curvature;
    CHECK(pose.pose[0] == Approx(std::sin(angle) / curvature - way).epsilon(1e-3));
    CHECK(pose.pose[1] == Approx(cosine * aside).epsilon(1e-6));
    CHECK(pose.pose[2] == Approx(-sine * aside).epsilon(1e-6));
    CHECK(pose.pose[4] == Approx(sine * angle).epsilon(1e-12));
    CHECK(pose.pose[5] == Approx(cosine * angle).epsilon(1e-12));
    for (const double rate : pose.per_way) CHECK(rate == 0.);
  }
}

TEST_CASE("poses of frames change as their rates say", "[line]") {
  static constexpr double kCant[] = {-30., 0., 20., -.06, 70., .03},
                          kGradient[] = {-40., .01, 0., -.02, 90., .03};
  for (const Transition transition : {Transition::linear, Transition::bloss, Transition::cosine}) {
    const DesignLine line{transition, kCurvature, {3, kCant}, {3, kGradient}, 4};
    for (const double from : {-12., 4.7, 40.}) {
      const double h = 1e-4, way = 9.5;
      const FramePose pose = pose_between(line, from, from + way),
                      ahead = pose_between(line, from + h, from + h + way),
                      behind = pose_between(line, from - h, from - h + way);
      for (int k = 1; k < 6; ++k) {
        CAPTURE(from, k, static_cast<int>(transition));
        CHECK(pose.per_way[k] == Approx((ahead.pose[k] - behind.pose[k]) / (2. * h)).margin(2e-7));
      }
    }
  }
}

TEST_CASE("a climbing curve rolls as a helix does", "[line]") {
  // The vertical has a part along a way that climbs, and a curve turns about it.
  static constexpr double kLevel[] = {0., 1. / 250.}, kRise[] = {0., .08};
  const DesignLine line{Transition::linear, {1, kLevel}, {0, nullptr}, {1, kRise}, 1};
  CHECK(rotation_at(line, 100.).x == Approx(.08 / 250.).epsilon(1e-12));
  CHECK(pose_between(line, 100., 110.).pose[3] == Approx(10. * .08 / 250.).epsilon(1e-12));
}

TEST_CASE("a frame feels its weight and its way", "[line]") {
  std::vector<double> rows;
  const double curvature = 1. / 400., sine = -.05, cosine = std::sqrt(1. - sine * sine);
  const FrameMotion m = frame_motion(circle(curvature, sine, rows), 10., 20., 0., 1e-3, 9.81);
  const double inwards = 20. * 20. * curvature;
  CHECK(m.acceleration[1] == Approx(inwards * cosine + 9.81 * sine).epsilon(1e-12));
  CHECK(m.acceleration[2] == Approx(9.81 * (cosine - 1.) - inwards * sine).epsilon(1e-10));
  CHECK(m.rate[2] == Approx(20. * curvature * cosine).epsilon(1e-12));
  CHECK(m.rate[1] == Approx(20. * curvature * sine).epsilon(1e-12));
  CHECK(m.angular[2] == 0.);
  // The impulse of a corner: a ramp of cant begins within the step.
  static constexpr double kRamp[] = {0., 0., 20., -.06};
  const DesignLine ramp{Transition::linear, {0, nullptr}, {2, kRamp}, {0, nullptr}, 2};
  double impulse = 0.;
  for (int i = -5; i <= 5; ++i)
    impulse += 1e-3 * frame_motion(ramp, (i + .2) * 25e-3, 25., 0., 1e-3, 9.81).angular[0];
  CHECK(impulse == Approx(25. * -.06 / 20.).epsilon(1e-3));
}
