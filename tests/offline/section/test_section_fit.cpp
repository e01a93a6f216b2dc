#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "section/section_family.h"
#include "section/section_fit.h"
#include "section/section_solve.h"
#include "support/profiles.h"

using namespace railstep;
using Catch::Contains;
using Catch::WithinAbs;

namespace {

/// Targets and height of section F (reference numbers).
const FitTargets kSectionF{{8700e-6, 85e-3, 39.0e-6, 6.0e-6}, 185.7375e-3};

std::array<double, 6> dimensions(const Rectangles<double>& r) {
  return {r.width[0], r.height[0], r.width[1], r.height[1], r.width[2], r.height[2]};
}

double farthest(const Rectangles<double>& a, const Rectangles<double>& b) {
  double most = 0;
  for (std::size_t i = 0; i < 6; ++i)
    most = std::max(most, std::abs(dimensions(a)[i] - dimensions(b)[i]));
  return most;
}

std::string refusal(const FitTargets& targets, double head_width) {
  try {
    fit_targets(targets, head_width);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "found";
}

}  // namespace

TEST_CASE("positive dimensions meet every profile to round-off", "[fit]") {
  for (const char* name : kProfiles) {
    INFO(name);
    const Outline outline = read_profile(profile_file(name)).outline;
    const SectionFit fit = fit_section(outline);
    // The demand is 1e-9. A double has 1.1e-16; ten operations on a property stay under 1e-14.
    CHECK(largest(fit.errors) < 1e-14);
    for (const double d : dimensions(fit.section)) CHECK(d > 0.0);
    const auto& h = fit.section.height;
    CHECK_THAT(h[0] + h[1] + h[2], WithinAbs(outline.height, 1e-15));
  }
}

TEST_CASE("the fit has the least symmetric difference of the whole family", "[fit]") {
  for (const char* name : kProfiles) {
    INFO(name);
    const Outline outline = read_profile(profile_file(name)).outline;
    const FitTargets targets{properties(outline), outline.height};
    const auto points = polygon(outline, 1e-7);
    const SectionFit fit = fit_section(outline);
    // The twin is ten times finer than the fit's own search, and compares only areas.
    const auto family = section_family(targets, 4000);
    REQUIRE(family.size() > 1000);
    double least = 1.0;
    Rectangles<double> nearest{};
    for (const auto& section : family) {
      const double here = symmetric_difference(points, targets.area.area, section);
      if (here < least) {
        least = here;
        nearest = section;
      }
    }
    const double own = symmetric_difference(points, targets.area.area, fit.section);
    CHECK(own <= least + 1e-16);  // areas of 1e-2 m2 in doubles
    // The grid's step in head height is H/4000, and no dimension changes more than twice as fast.
    CHECK(farthest(nearest, fit.section) < 2.0 * outline.height / 4000);
    // The slope is a sum of lengths of 0.1 m times a tangent of size 1, in doubles: 1e-14.
    CHECK_THAT(fit.stationarity, WithinAbs(0.0, 1e-13));
  }
}

TEST_CASE("the slope along the family is the difference quotient of the area", "[fit]") {
  const Outline outline = read_profile(profile_file("60e1")).outline;
  const FitTargets targets{properties(outline), outline.height};
  const auto points = polygon(outline, 1e-8);
  const Rectangles<double> best = fit_section(outline).section;
  const auto section = [&](double head) { return fit_targets(targets, head).section; };
  for (const double off : {-5e-3, -2e-3, 0.0, 2e-3, 5e-3}) {
    const double head = best.width[2] + off, step = 2.5e-7;
    const double up = symmetric_difference(points, targets.area.area, section(head + step));
    const double down = symmetric_difference(points, targets.area.area, section(head - step));
    const double along = slope(targets, points, section(head));
    // Areas of 1e-2 m2 err by some 1e-17 m2, over 5e-7 m: 2e-11 m. The third-order term is at the
    // foot's 40 mm arc: where it slopes 1:14 a level side has d2(length)/dz2 = 14^3/0.04 m = 7e4/m,
    // times step2/6: 7e-10 m. Both sides of the foot and the curvature of their height make 2.5
    // times that.
    CHECK_THAT(along, WithinAbs((up - down) / (2 * step), 2e-9));
    if (off != 0.0) CHECK(along * off > 0.0);  // uphill on both sides
  }
}

TEST_CASE("any start ends at the same dimensions", "[fit]") {
  std::mt19937 random(20260);
  const auto between = [&random](double a, double b) {
    return a + (b - a) * (static_cast<double>(random()) / 4294967296.0);
  };
  for (const char* name : kProfiles) {
    INFO(name);
    const Outline outline = read_profile(profile_file(name)).outline;
    const SectionFit fit = fit_section(outline);
    const double height = outline.height;
    int alone = 0;
    for (int i = 0; i < 12; ++i) {
      const double foot = between(0.05, 0.4) * height, head = between(0.05, 0.5) * height;
      const Rectangles<double> start{
          {between(0.2, 1.5) * height, between(0.02, 0.5) * height, between(0.1, 1.0) * height},
          {foot, height - foot - head, head}};
      const SectionFit other = fit_section(outline, start);
      if (other.from_start) ++alone;
      // A slope good to 1e-14 over its own slope of 1 to 10 per metre and head width gives 1e-14 m;
      // the contract asks for 1e-9.
      CHECK(farthest(other.section, fit.section) < 1e-12);
    }
    // The other starts end in a rectangle without width or on the family's far branch, where the
    // search over the family decides. If all did, this would compare the search with itself.
    CHECK(alone >= 3);
  }
}

TEST_CASE("given targets and head width give the reference family", "[fit]") {
  struct Known {
    double head, foot_width, foot_height, web_width, web_height, head_height;  // mm
  };
  const Known table[] = {{65.00, 133.2587, 24.2379, 19.8499, 111.3484, 50.1512},
                         {74.61, 137.8995, 21.2834, 24.6354, 130.1641, 34.2900},
                         {90.00, 136.3126, 20.7072, 26.7685, 141.9447, 23.0857}};
  for (const Known& known : table) {
    const SectionFit fit = fit_targets(kSectionF, 1e-3 * known.head);
    INFO(known.head);
    CHECK(largest(fit.errors) < 1e-14);
    CHECK(fit.section.width[2] == 1e-3 * known.head);
    // The figures are printed to 1e-4 mm; half of the last digit is 5e-8 m.
    CHECK_THAT(fit.section.width[0], WithinAbs(1e-3 * known.foot_width, 5.01e-8));
    CHECK_THAT(fit.section.height[0], WithinAbs(1e-3 * known.foot_height, 5.01e-8));
    CHECK_THAT(fit.section.width[1], WithinAbs(1e-3 * known.web_width, 5.01e-8));
    CHECK_THAT(fit.section.height[1], WithinAbs(1e-3 * known.web_height, 5.01e-8));
    CHECK_THAT(fit.section.height[2], WithinAbs(1e-3 * known.head_height, 5.01e-8));
  }
  // Section F is printed to eight digits after the point in mm, two to seven; half is 5e-11 m.
  const Rectangles<double> f = fit_targets(kSectionF, 77.20505094e-3).section;
  CHECK_THAT(f.width[0], WithinAbs(138.0985536e-3, 1e-10));
  CHECK_THAT(f.height[0], WithinAbs(20.996636e-3, 1e-9));
  CHECK_THAT(f.width[1], WithinAbs(25.22171327e-3, 1e-10));
  CHECK_THAT(f.height[1], WithinAbs(133.08941227e-3, 1e-10));
  CHECK_THAT(f.height[2], WithinAbs(31.65145173e-3, 1e-10));
}

TEST_CASE("the sensitivity is the change of dimensions that a property's change causes", "[fit]") {
  const double head = 74.61e-3, change = 1e-7;
  const SectionFit fit = fit_targets(kSectionF, head);
  // J^-1 column by column from differences; the root of the sum of squares is the covariance's.
  std::array<double, 4> squares{};
  for (int property = 0; property < 4; ++property) {
    FitTargets moved = kSectionF;
    double* place[] = {&moved.area.area, &moved.area.inertia_y, &moved.area.inertia_z,
                       &moved.area.centroid_height};
    *place[property] *= 1.0 + change;
    const Rectangles<double> to = fit_targets(moved, head).section;
    const std::array<double, 4> move = {
        to.width[0] - fit.section.width[0], to.height[0] - fit.section.height[0],
        to.width[1] - fit.section.width[1], to.height[2] - fit.section.height[2]};
    for (std::size_t i = 0; i < 4; ++i) squares[i] += move[i] * move[i] / (change * change);
  }
  // One-sided differences err by the order of the change, times 100 for curvature.
  for (std::size_t i = 0; i < 4; ++i)
    CHECK_THAT(fit.sensitivity[i] / std::sqrt(squares[i]), WithinAbs(1.0, 100 * change));
}

TEST_CASE("targets that three rectangles cannot have are refused with their errors",
          "[fit][bad_input]") {
  CHECK_THAT(refusal(kSectionF, 0.2), Contains("head 0.2 m wide") && Contains("E-FIT-16"));
  FitTargets impossible = kSectionF;
  impossible.area.inertia_y = 90e-6;  // over A H2/4 = 75e-6, which even two flanges do not reach
  CHECK_THAT(refusal(impossible, 0.075), Contains("E-FIT-14"));
}
