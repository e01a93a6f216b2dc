// Railheads by tangent arcs, placed by inclination and gauge.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "offline/profile/rail_head.h"
#include "section/profile.h"
#include "section/running_profile.h"

using namespace railstep;

namespace {

std::string shipped_profile(const std::string& name) {
  return std::string(RAILSTEP_SOURCE) + "/config/profiles/" + name;
}
RailHead head_of(const std::string& name) {
  return tangent_head(read_profile(shipped_profile(name)).outline);
}

}  // namespace

TEST_CASE("the head of 60E1 has the arcs of its drawing, tangent", "[profile]") {
  const RailHead head = head_of("60e1.toml");
  REQUIRE(head.arcs.size() == 5);
  // Centres from the top in mm, by exact tangency.
  const double known[][3] = {
      {0., -300., 300.}, {7.500533, -80.127896, 80.}, {23.016220, -14.949192, 13.}};
  for (std::size_t i = 0; i < 3; ++i)
    for (const double side : {-1., 1.}) {
      const HeadArc& arc = head.arcs[side < 0. ? 2 - i : 2 + i];
      CAPTURE(i, side);
      CHECK(1e3 * arc.centre[0] == Approx(side * known[i][0]).margin(1e-6));
      CHECK(1e3 * (arc.centre[1] - .172) == Approx(known[i][1]).margin(1e-6));
      CHECK(1e3 * arc.radius == Approx(known[i][2]).epsilon(1e-12));
    }
  const HeadArc& last = head.arcs.back();
  CHECK(1e3 * (last.centre[0] + last.radius * std::sin(last.from)) ==
        Approx(26.026727).margin(1e-6));
  CHECK(1e3 * (last.centre[0] + last.radius * std::sin(last.to)) == Approx(36.).margin(1e-6));
}

TEST_CASE("all shipped rails have heads of tangent arcs, at gauge in the track", "[profile]") {
  for (const char* name :
       {"49e1.toml", "54e1.toml", "56e1.toml", "60e1.toml", "115re.toml", "136re.toml"})
    for (const double inclination : {0., 1. / 40., 1. / 20.}) {
      CAPTURE(name, inclination);
      const RunningSurface rail = placed(head_of(name), {inclination, 1.435});
      double top = -1., inner = 1.;
      for (double y = rail.first(); y < rail.last(); y += 1e-6) {
        const double z = rail.at(y).height;
        top = std::max(top, z);
        if (z >= -.014) inner = std::min(inner, y);
      }
      CHECK(top == Approx(0.).margin(1e-9));
      // A face within 0.5 degrees of upright is cut off.
      CHECK(inner == Approx(.7175).margin(inclination > .03 ? 6e-5 : 2e-6));
    }
}

TEST_CASE("the top of 60E1 lies where its inclination puts it", "[profile]") {
  for (const auto& [inclination, known] : {std::pair(1. / 40., 760.531), {1. / 20., 764.004}}) {
    const RunningSurface rail = placed(head_of("60e1.toml"), {inclination, 1.435});
    double at = 0., top = -1.;
    for (double y = .75; y < .775; y += 1e-7)
      if (rail.at(y).height > top) {
        top = rail.at(y).height;
        at = y;
      }
    CHECK(1e3 * at == Approx(known).margin(2e-3));
  }
}

TEST_CASE("a measured head is placed as the drawing it was measured from", "[profile]") {
  // Points of 60E1, some 0.3 mm apart, with noise of 0.01 mm in both directions.
  const RailHead head = head_of("60e1.toml");
  std::mt19937 engine(5);
  std::normal_distribution<double> noise(0., 1e-5);
  for (const double sigma : {0., 1.}) {
    std::vector<Point> points;
    for (double z = -.02; z < 0.; z += 3e-4)
      if (z < -.014) points.push_back({-(.036 + (-.0143 - z) / 20.), .172 + z});
    for (const HeadArc& arc : head.arcs)
      for (double angle = arc.from + 2e-4 / arc.radius; angle < arc.to; angle += 3e-4 / arc.radius)
        points.push_back({arc.centre[0] + arc.radius * std::sin(angle) + sigma * noise(engine),
                          arc.centre[1] + arc.radius * std::cos(angle) + sigma * noise(engine)});
    const SmoothedPoints made = smoothed(points, sigma * 1.2e-5);
    const RunningSurface measured = placed(made.points, {1. / 40., 1.435});
    const RunningSurface drawn = placed(head, {1. / 40., 1.435});
    for (double y = .722; y < .780; y += 1e-3) {
      CAPTURE(sigma, y);
      CHECK(measured.at(y).height == Approx(drawn.at(y).height).margin(sigma > 0. ? 4e-5 : 2e-6));
      if (y > .728)
        CHECK(measured.at(y).slope == Approx(drawn.at(y).slope).margin(sigma > 0. ? .025 : 2e-3));
    }
    CHECK(made.rms == Approx(sigma * 1.2e-5).epsilon(1e-3).margin(1e-12));
  }
}
