#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "section/fit_profile.h"
#include "section/section_solve.h"
#include "support/profiles.h"
#include "support/random_outlines.h"

using namespace railstep;
using Catch::WithinRel;

namespace {

FitResult fit(const Outline& outline) { return fit_profile({"o", "o", outline, {}}, "o"); }

FitTargets targets_of(const Outline& outline) { return {properties(outline), outline.height}; }

double determinant(const std::array<std::array<double, 3>, 3>& m) {
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
         m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

/// Rectangles of these two heights with A, A z_c and Iy + A z_c2, by Cramer's rule.
Rectangles<double> of_heights(const FitTargets& t, double foot, double head) {
  const std::array<double, 4> z = {0, foot / t.height, 1 - head / t.height, 1};
  const double H = t.height, c = t.area.centroid_height, A = t.area.area;
  const std::array<double, 3> want = {A / H, A * c / (H * H),
                                      (t.area.inertia_y + A * c * c) / (H * H * H)};
  std::array<std::array<double, 3>, 3> rows{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t power = 0; power < 3; ++power) {
      const double n = static_cast<double>(power) + 1;
      rows[power][i] = (std::pow(z[i + 1], n) - std::pow(z[i], n)) / n;
    }
  Rectangles<double> r{{}, {foot, H - foot - head, head}};
  const double all = determinant(rows);
  for (std::size_t i = 0; i < 3; ++i) {
    auto one = rows;
    for (std::size_t power = 0; power < 3; ++power) one[power][i] = want[power];
    r.width[i] = determinant(one) / all;
  }
  return r;
}

double lateral_error(const FitTargets& t, const Rectangles<double>& r) {
  return properties(r).inertia_z / t.area.inertia_z - 1;
}

/// Least symmetric difference of all exact sections, by brute force. Unlike the fit, it goes along
/// lines of one foot height and follows lines of one head height, without Ceres.
double least_difference(const Outline& outline) {
  const FitTargets t = targets_of(outline);
  const auto points = polygon(outline, 1e-7);
  constexpr int kFeet = 400, kHeads = 600;
  double least = 1.0;  // m2
  for (int j = 1; j < kFeet; ++j) {
    const double foot = t.height * j / kFeet, room = t.height - foot;
    double last = lateral_error(t, of_heights(t, foot, room / kHeads));
    for (int i = 2; i < kHeads; ++i) {
      double low = room * (i - 1) / kHeads, high = room * i / kHeads;
      const double at_low = last, next = lateral_error(t, of_heights(t, foot, high));
      last = next;
      if ((at_low < 0) == (next < 0)) continue;
      for (int k = 0; k < 50; ++k) {
        const double middle = .5 * (low + high);
        const bool below = lateral_error(t, of_heights(t, foot, middle)) < 0;
        (below == (at_low < 0) ? low : high) = middle;
      }
      const Rectangles<double> r = of_heights(t, foot, low);
      if (!is_section(r) || std::abs(lateral_error(t, r)) > 1e-6) continue;
      least = std::min(least, symmetric_difference(points, t.area.area, r));
    }
  }
  return least;
}

using Five = std::array<double, 5>;  // widths, heights of foot and head, over the whole height

double sum_of_squares(const FitTargets& t, const Five& x) {
  const double H = t.height;
  const Rectangles<double> r{{x[0] * H, x[1] * H, x[2] * H},
                             {x[3] * H, (1 - x[3] - x[4]) * H, x[4] * H}};
  if (!is_section(r)) return 1e9;
  const RelativeErrors e = relative_errors(t, r);
  return e.area * e.area + e.inertia_y * e.inertia_y + e.inertia_z * e.inertia_z +
         e.centroid_height * e.centroid_height;
}

/// The simplex of Nelder and Mead (1965), which compares only values.
Five downhill(const FitTargets& t, const Five& start, int steps) {
  std::vector<std::pair<double, Five>> s = {{sum_of_squares(t, start), start}};
  for (std::size_t i = 0; i < 5; ++i) {
    Five x = start;
    x[i] *= .9;
    s.emplace_back(sum_of_squares(t, x), x);
  }
  for (int k = 0; k < steps; ++k) {
    std::sort(s.begin(), s.end());
    const auto moved = [&](double by) {
      Five x{};
      for (std::size_t j = 0; j < 5; ++j) {
        double centre = 0;
        for (std::size_t i = 0; i < 5; ++i) centre += s[i].second[j] / 5;
        x[j] = centre + by * (s[5].second[j] - centre);
      }
      return std::make_pair(sum_of_squares(t, x), x);
    };
    const auto mirrored = moved(-1);
    if (mirrored.first < s[0].first) {
      s[5] = std::min(mirrored, moved(-2));
    } else if (mirrored.first < s[4].first) {
      s[5] = mirrored;
    } else if (const auto inner = moved(mirrored.first < s[5].first ? -.5 : .5);
               inner.first < std::min(mirrored.first, s[5].first)) {
      s[5] = inner;
    } else {
      for (std::size_t i = 1; i < 6; ++i) {
        for (std::size_t j = 0; j < 5; ++j) s[i].second[j] = .5 * (s[i].second[j] + s[0].second[j]);
        s[i].first = sum_of_squares(t, s[i].second);
      }
    }
  }
  return std::min_element(s.begin(), s.end())->second;
}

/// Least error by simplices from many starts: root of the sum of squares.
double least_error(const FitTargets& t, RandomOutlines& random) {
  Five best{1, 1, 1, .3, .3};
  for (int start = 0; start < 100; ++start) {
    const Five x = downhill(t,
                            {random.between(.05, 2), random.between(.02, 2), random.between(.05, 2),
                             random.between(.02, .5), random.between(.02, .45)},
                            500);
    if (sum_of_squares(t, x) < sum_of_squares(t, best)) best = x;
  }
  for (int again = 0; again < 5; ++again) best = downhill(t, best, 2000);
  return std::sqrt(sum_of_squares(t, best));
}

/// The id of the refusal; empty where rectangles were found.
std::string refused(const FitResult& r) { return r.refusal ? r.refusal->id : ""; }

/// Fitted: no section may be closer by 1 %. Refused: none may be exact or closer by 1 %.
void check_closest(const Outline& outline, RandomOutlines& random) {
  const FitResult r = fit(outline);
  CAPTURE(refused(r), outline.height);
  if (r.fit.family_points > 0) {
    CHECK(largest(r.fit.errors) < kExact);
    CHECK(r.fit.symmetric_difference <=
          1.01 * least_difference(outline) + 1e-12 * r.outline.area.area);
    return;
  }
  CHECK(refused(r) == "E-FIT-14");
  const FitTargets t = targets_of(outline);
  const RelativeErrors e = relative_errors(t, closest(t));
  const double own =
      std::hypot(std::hypot(e.area, e.inertia_y), std::hypot(e.inertia_z, e.centroid_height));
  const double least = least_error(t, random);
  CHECK(least > kExact);
  CHECK(own < 1.01 * least);
}

}  // namespace

TEST_CASE("every plain rectangle is three rectangles of its width", "[fit]") {
  RandomOutlines random(1);
  for (int i = 0; i < 200; ++i) {
    const Outline outline = random.rectangle();
    const FitResult r = fit(outline);
    CAPTURE(outline.height, r.outline.area.area / outline.height, refused(r));
    REQUIRE_FALSE(r.refusal.has_value());
    CHECK(r.warnings.empty());
    CHECK(largest(r.fit.errors) < 1e-14);
    for (const double width : r.fit.section.width)
      CHECK_THAT(width, WithinRel(r.outline.area.area / outline.height, 1e-9));
    CHECK_THAT(r.section.shear.torsion, WithinRel(r.outline.shear.torsion, 1e-4));  // bounds' gap
  }
}

TEST_CASE("a fit is the closest section to outlines of every kind", "[fit]") {
  RandomOutlines random(2);
  for (const char* name : kProfiles) {
    INFO(name);
    check_closest(read_profile(profile_file(name)).outline, random);
  }
  for (int i = 0; i < 2; ++i) {
    INFO(i);
    check_closest(random.i_shape(), random);
    check_closest(random.l_shape(), random);
    check_closest(random.trapezium(), random);
    check_closest(random.ellipse(), random);
    check_closest(RandomOutlines::circle(random.between(.01, .1)), random);
    check_closest(RandomOutlines::grooved(random.between(-.01, .01)), random);
  }
}

TEST_CASE("the fit of an I-shape returns its dimensions", "[fit]") {
  RandomOutlines random(3);
  for (int i = 0; i < 16; ++i) {
    const FitResult r = fit(random.i_shape());
    CAPTURE(i, refused(r));
    CHECK(r.fit.symmetric_difference < 1e-9 * r.outline.area.area);
  }
}
