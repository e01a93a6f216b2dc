#include "section/section_solve.h"

#include <ceres/ceres.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace railstep {
namespace {

/// 4 relative errors; head = head width, p = foot width, foot height, web width, head height (m).
struct PropertyResidual {
  FitTargets want;
  template <typename T>
  bool operator()(const T* head, const T* p, T* residual) const {
    const T web_height = want.height - p[1] - p[3];
    if (!(web_height > 0.0)) return false;  // Ceres retries with a shorter step
    const AreaProperties<T> got =
        properties(Rectangles<T>{{p[0], p[2], head[0]}, {p[1], web_height, p[3]}});
    residual[0] = got.area / want.area.area - 1.0;
    residual[1] = got.inertia_y / want.area.inertia_y - 1.0;
    residual[2] = got.inertia_z / want.area.inertia_z - 1.0;
    residual[3] = got.centroid_height / want.area.centroid_height - 1.0;
    return true;
  }
};

struct Unknowns {
  double head;
  std::array<double, 4> p;
};

Unknowns unknowns_of(const Rectangles<double>& r) {
  return {r.width[2], {r.width[0], r.height[0], r.width[1], r.height[2]}};
}

Rectangles<double> rectangles_of(const Unknowns& u, double height) {
  return {{u.p[0], u.p[2], u.head}, {u.p[1], height - u.p[1] - u.p[3], u.p[3]}};
}

/// To round-off: no tolerance stops early, only steps that no longer change anything.
ceres::Solver::Options to_round_off() {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 200;
  options.function_tolerance = 0.0;
  options.gradient_tolerance = 1e-30;
  options.parameter_tolerance = 1e-16;
  options.initial_trust_region_radius = 1e8;  // near Gauss-Newton at once
  options.logging_type = ceres::SILENT;
  return options;
}

void add_properties(ceres::Problem& problem, const FitTargets& targets, Unknowns& u) {
  problem.AddResidualBlock(
      new ceres::AutoDiffCostFunction<PropertyResidual, 4, 1, 4>(new PropertyResidual{targets}),
      nullptr, &u.head, u.p.data());
}

/// The minimum of the sum of squares that a start leads to.
Rectangles<double> least_squares(const FitTargets& targets, Unknowns u) {
  ceres::Problem problem;
  add_properties(problem, targets, u);
  const double least = kThinnest * targets.height;
  problem.SetParameterLowerBound(&u.head, 0, least);
  for (int i = 0; i < 4; ++i) problem.SetParameterLowerBound(u.p.data(), i, least);
  ceres::Solver::Summary summary;
  ceres::Solve(to_round_off(), &problem, &summary);
  return rectangles_of(u, targets.height);
}

double sum_of_squares(const RelativeErrors& e) {
  return e.area * e.area + e.inertia_y * e.inertia_y + e.inertia_z * e.inertia_z +
         e.centroid_height * e.centroid_height;
}

/// Derivatives of the four relative errors.
struct Derivatives {
  Eigen::Vector4d by_head;  // head width
  Eigen::Matrix4d by_rest;  // a column each: foot width, foot height, web width, head height
};

Derivatives derivatives(const FitTargets& targets, const Rectangles<double>& section) {
  using Jet = ceres::Jet<double, 5>;
  const Unknowns u = unknowns_of(section);
  const Jet head(u.head, 0);
  Jet p[4], residual[4];
  for (int i = 0; i < 4; ++i) p[i] = Jet(u.p[static_cast<std::size_t>(i)], i + 1);
  PropertyResidual{targets}(&head, p, residual);
  Derivatives d;
  for (int i = 0; i < 4; ++i) {
    d.by_head[i] = residual[i].v[0];
    d.by_rest.row(i) = residual[i].v.tail<4>();
  }
  return d;
}

/// d(foot width, foot height, web width, head height)/d(head width) at constant properties.
Eigen::Vector4d tangent(const FitTargets& targets, const Rectangles<double>& section) {
  const Derivatives d = derivatives(targets, section);
  return d.by_rest.partialPivLu().solve(-d.by_head);
}

/// Slope at a head width, the section found by continuation from a neighbour.
struct SlopeResidual {
  const FitTargets* targets;
  std::span<const Point> polygon;
  Rectangles<double> neighbour;
  bool operator()(const double* head, double* residual) const {
    Rectangles<double> section = neighbour;
    section.width[2] = *head;
    int iterations = 0;
    if (!solve_exact(*targets, true, section, iterations)) return false;
    *residual = slope(*targets, polygon, section);
    return true;
  }
};

/// Zero of the slope between two head widths that enclose it.
bool solve_slope(const FitTargets& targets, std::span<const Point> polygon, double low, double high,
                 Rectangles<double>& section, int& iterations) {
  const SlopeResidual residual{&targets, polygon, section};
  double head = 0.5 * (low + high), at_low = 0.0, value = 0.0;
  ceres::Problem problem;
  problem.AddResidualBlock(new ceres::NumericDiffCostFunction<SlopeResidual, ceres::CENTRAL, 1, 1>(
                               new SlopeResidual(residual)),
                           nullptr, &head);
  problem.SetParameterLowerBound(&head, 0, low);
  problem.SetParameterUpperBound(&head, 0, high);
  // Ceres takes differences between neighbours, and writes to stderr where a neighbour is missing.
  const double step = 2e-6 * head, below = head - step, above = head + step;
  if (residual(&below, &value) && residual(&above, &value) && residual(&head, &value)) {
    ceres::Solver::Summary summary;
    ceres::Solve(to_round_off(), &problem, &summary);
    iterations += static_cast<int>(summary.iterations.size());
  }
  if (!residual(&head, &value)) return false;
  if (std::abs(value) > 1e-10) {
    // The slope jumps over zero: a rectangle's side on a straight side of the outline. Halve on
    // signs.
    if (!residual(&low, &at_low)) return false;
    while (high - low > 1e-15) {
      const double middle = 0.5 * (low + high);
      if (middle <= low || middle >= high) break;
      if (!residual(&middle, &value)) return false;
      ((value < 0.0) == (at_low < 0.0) ? low : high) = middle;
    }
    head = 0.5 * (low + high);
  }
  section.width[2] = head;
  return solve_exact(targets, true, section, iterations);
}

}  // namespace

bool is_section(const Rectangles<double>& r) {
  const double height = r.height[0] + r.height[1] + r.height[2];
  return std::all_of(r.width.begin(), r.width.end(),
                     [](double w) { return w > 0.0 && std::isfinite(w); }) &&
         std::all_of(r.height.begin(), r.height.end(),
                     [height](double h) { return h >= kThinnest * height; });
}

RelativeErrors relative_errors(const FitTargets& targets, const Rectangles<double>& section) {
  const AreaProperties<double> got = properties(section);
  return {
      got.area / targets.area.area - 1.0, got.centroid_height / targets.area.centroid_height - 1.0,
      got.inertia_y / targets.area.inertia_y - 1.0, got.inertia_z / targets.area.inertia_z - 1.0};
}

bool solve_exact(const FitTargets& targets, bool head_width_fixed, Rectangles<double>& section,
                 int& iterations) {
  Unknowns u = unknowns_of(section);
  ceres::Problem problem;
  add_properties(problem, targets, u);
  if (head_width_fixed) problem.SetParameterBlockConstant(&u.head);
  ceres::Solver::Summary summary;
  ceres::Solve(to_round_off(), &problem, &summary);
  iterations += static_cast<int>(summary.iterations.size());
  const Rectangles<double> found = rectangles_of(u, targets.height);
  if (!is_section(found) || !(largest(relative_errors(targets, found)) < kExact)) return false;
  section = found;
  return true;
}

Rectangles<double> closest(const FitTargets& targets) {
  // Least squares has many minima here: of a circle, a rail's proportions lead to one that errs ten
  // times as much as the least.
  constexpr std::array<double, 4> kShares = {0.06, 0.17, 0.34, 0.55};  // of the height
  const double H = targets.height, mean = targets.area.area / H;
  Rectangles<double> best{};
  double least = std::numeric_limits<double>::infinity();
  for (const double foot : kShares)
    for (const double head : kShares)
      for (const double waist : {0.15, 1.0, 3.0}) {  // the web's width over the outer ones'
        if (foot + head > 0.95) continue;
        const double outer = mean / (foot + head + waist * (1.0 - foot - head));
        const Rectangles<double> found =
            least_squares(targets, {outer, {outer, foot * H, waist * outer, head * H}});
        const double error = sum_of_squares(relative_errors(targets, found));
        if (!is_section(found) || !(error < least)) continue;
        least = error;
        best = found;
      }
  return best;
}

double slope(const FitTargets& targets, std::span<const Point> polygon,
             const Rectangles<double>& section) {
  const auto& [w, h] = section;
  const std::array<double, 4> z = {0.0, h[0], targets.height - h[2], targets.height};
  // d(area inside)/d(width): half of both upright sides' lengths inside the outline.
  std::array<double, 3> by_width;
  for (std::size_t i = 0; i < 3; ++i)
    by_width[i] = 0.5 * (length_inside(polygon, 0, 0.5 * w[i], z[i], z[i + 1]) +
                         length_inside(polygon, 0, -0.5 * w[i], z[i], z[i + 1]));
  const auto level = [&](double at, double width) {
    return length_inside(polygon, 1, at, -0.5 * width, 0.5 * width);
  };
  const double by_foot_height = level(z[1], w[0]) - level(z[1], w[1]);
  const double by_head_height = level(z[2], w[2]) - level(z[2], w[1]);
  const Eigen::Vector4d along = tangent(targets, section);
  const double inside = by_width[2] + by_width[0] * along[0] + by_foot_height * along[1] +
                        by_width[1] * along[2] + by_head_height * along[3];
  return -2.0 * inside;  // both areas are constant along the family
}

bool descend(const FitTargets& targets, std::span<const Point> polygon, Rectangles<double>& section,
             int& iterations) {
  const double first = slope(targets, polygon, section);
  const double step = (first > 0.0 ? -2e-3 : 2e-3) * targets.height;
  for (int i = 0; i < 2000; ++i) {
    Rectangles<double> next = section;
    next.width[2] += step;
    if (!solve_exact(targets, true, next, iterations)) return false;
    const double here = section.width[2], there = next.width[2];
    section = next;
    if ((slope(targets, polygon, next) > 0.0) != (first > 0.0))
      return solve_slope(targets, polygon, std::min(here, there), std::max(here, there), section,
                         iterations);
  }
  return false;
}

std::array<double, 4> sensitivity(const FitTargets& targets, const Rectangles<double>& section) {
  // The covariance is inv(J) inv(J)', so its diagonal holds the squares of inv(J)'s row norms; not
  // by ceres::Covariance, which logs on stderr where J is singular.
  const Eigen::Matrix4d inverse = derivatives(targets, section).by_rest.fullPivLu().inverse();
  std::array<double, 4> result;
  for (std::size_t i = 0; i < 4; ++i) {
    const double norm = inverse.row(static_cast<Eigen::Index>(i)).norm();
    result[i] = std::isfinite(norm) ? norm : std::numeric_limits<double>::infinity();
  }
  return result;
}

}  // namespace railstep
