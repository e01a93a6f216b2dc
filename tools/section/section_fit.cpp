#include "section/section_fit.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "section/section_family.h"
#include "section/section_solve.h"

namespace railstep {
namespace {

constexpr int kHeadHeights = 400;   // levels of the search over the family
constexpr double kFitChord = 1e-8;  // m; the difference's area errs by under 1e-8 m2
constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

/// Fewest and most of a family's head widths, m.
std::array<double, 2> head_widths(const std::vector<Rectangles<double>>& family) {
  const auto [least, most] =
      std::minmax_element(family.begin(), family.end(),
                          [](const auto& a, const auto& b) { return a.width[2] < b.width[2]; });
  return {least->width[2], most->width[2]};
}

void refuse_empty(const std::vector<Rectangles<double>>& family, const FitTargets& t) {
  if (!family.empty()) return;
  const RelativeErrors e = relative_errors(t, closest(t));
  throw NoSection(
      "E-FIT-14",
      fmt::format("no three rectangles {:.6g} m high have the area {:.6g} m2, the inertias {:.6g} "
                  "and {:.6g} m4 and the centroid height {:.6g} m; the nearest that were found "
                  "differ by {:+.2e}, {:+.2e}, {:+.2e} and {:+.2e} of these values",
                  t.height, t.area.area, t.area.inertia_y, t.area.inertia_z, t.area.centroid_height,
                  e.area, e.inertia_y, e.inertia_z, e.centroid_height));
}

/// The least difference among the sections that lie within a level of the search, by the golden
/// section of the head height: where the family turns back in its head width, which descend()
/// follows, it goes on in this.
template <typename Difference>
Rectangles<double> lowest_beside(const FitTargets& targets, const Difference& difference,
                                 const Rectangles<double>& section) {
  const double level = targets.height / kHeadHeights, golden = 0.5 * (std::sqrt(5.0) - 1.0);
  Rectangles<double> best = section;
  const auto at = [&](double head) {
    const auto found = section_beside(targets, section, head);
    if (!found) return std::numeric_limits<double>::infinity();
    const double here = difference(*found);
    if (here < difference(best)) best = *found;
    return here;
  };
  double low = section.height[2] - level, high = section.height[2] + level;
  double left = high - golden * (high - low), right = low + golden * (high - low);
  double at_left = at(left), at_right = at(right);
  for (int i = 0; i < 60; ++i) {
    const bool to_left = at_left < at_right;
    (to_left ? high : low) = to_left ? right : left;
    (to_left ? right : left) = to_left ? left : right;
    (to_left ? at_right : at_left) = to_left ? at_left : at_right;
    double& fresh = to_left ? left : right;
    fresh = to_left ? high - golden * (high - low) : low + golden * (high - low);
    (to_left ? at_left : at_right) = at(fresh);
  }
  return best;
}

SectionFit describe(const FitTargets& targets, const Rectangles<double>& section,
                    std::size_t family_points, int iterations) {
  return {.section = section,
          .errors = relative_errors(targets, section),
          .symmetric_difference = kNotKnown,
          .stationarity = kNotKnown,
          .family_points = static_cast<int>(family_points),
          .iterations = iterations,
          .from_start = false,
          .sensitivity = sensitivity(targets, section)};
}

}  // namespace

double largest(const RelativeErrors& e) {
  return std::max({std::abs(e.area), std::abs(e.centroid_height), std::abs(e.inertia_y),
                   std::abs(e.inertia_z)});
}

double symmetric_difference(std::span<const Point> polygon, double area,
                            const Rectangles<double>& section) {
  double own = 0.0, shared = 0.0, z = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double half = 0.5 * section.width[i], top = z + section.height[i];
    own += section.width[i] * section.height[i];
    shared += area_inside(polygon, -half, half, z, top);
    z = top;
  }
  return area + own - 2.0 * shared;
}

SectionFit fit_section(const Outline& outline, const std::optional<Rectangles<double>>& start) {
  const FitTargets targets{properties(outline), outline.height};
  const std::vector<Point> points = polygon(outline, kFitChord);
  const auto difference = [&](const Rectangles<double>& section) {
    return symmetric_difference(points, targets.area.area, section);
  };
  const std::vector<Rectangles<double>> family = section_family(targets, kHeadHeights);
  refuse_empty(family, targets);
  Rectangles<double> best = *std::min_element(
      family.begin(), family.end(),
      [&](const auto& a, const auto& b) { return difference(a) < difference(b); });
  int iterations = 0;
  bool from_start = false;
  if (!solve_exact(targets, true, best, iterations))
    throw NoSection("E-FIT-15",
                    "the search for three rectangles did not bring the four errors to round-off; "
                    "expected the area, inertias and centroid height of a rail");
  // Downhill may lead past the end of a valley, or along a family that is all but a plain
  // rectangle's: then what it started from stands.
  Rectangles<double> lower = best;
  bool flat = descend(targets, points, lower, iterations);
  if (difference(lower) <= difference(best))
    best = lower;
  else
    flat = false;
  if (!flat) {
    best = lowest_beside(targets, difference, best);
    solve_exact(targets, true, best, iterations);  // halving leaves 1e-12 of the properties
  }
  if (start) {
    Rectangles<double> other = *start;
    // A start may lead to the end of the family or to a lesser minimum: then the search's stands.
    if (solve_exact(targets, false, other, iterations) &&
        descend(targets, points, other, iterations) &&
        difference(other) <= difference(best) + 1e-12 * targets.area.area) {
      best = other;
      flat = from_start = true;
    }
  }
  SectionFit fit = describe(targets, best, family.size(), iterations);
  fit.from_start = from_start;
  fit.symmetric_difference = difference(best);
  fit.stationarity = flat ? slope(targets, points, best) : kNotKnown;
  return fit;
}

SectionFit fit_targets(const FitTargets& targets, double head_width) {
  std::vector<Rectangles<double>> family = section_family(targets, kHeadHeights);
  refuse_empty(family, targets);
  const auto [least, most] = head_widths(family);
  const std::size_t points = family.size();
  std::sort(family.begin(), family.end(), [head_width](const auto& a, const auto& b) {
    return std::abs(a.width[2] - head_width) < std::abs(b.width[2] - head_width);
  });
  // Near the family's fold two sections share a head width; the one with the wider foot is a rail.
  std::optional<Rectangles<double>> best;
  int iterations = 0;
  for (std::size_t i = 0; i < std::min<std::size_t>(points, 16); ++i) {
    Rectangles<double> section = family[i];
    section.width[2] = head_width;
    if (solve_exact(targets, true, section, iterations) &&
        (!best || section.width[0] > best->width[0] + 1e-9))
      best = section;
  }
  if (!best)
    throw NoSection("E-FIT-16",
                    fmt::format("no three rectangles have these properties with a head {:.6g} m "
                                "wide; expected a head width of {:.6g} to {:.6g} m",
                                head_width, least, most));
  return describe(targets, *best, points, iterations);
}

}  // namespace railstep
