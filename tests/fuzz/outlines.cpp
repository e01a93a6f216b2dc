#include "outlines.h"

#include <cmath>

#include "oracle.h"
#include "report/fit_report.h"
#include "section/fit_profile.h"
#include "section/section_file.h"

namespace railstep::fuzz {
namespace {

constexpr std::size_t kMostSegments = 60;  // of an outline to be fitted
constexpr double kShortest = 1e-3;  // m, of its segments: slivers take seconds to triangulate

bool is_coarse(const Outline& outline) {
  for (const Segment& s : outline.segments)
    if (std::hypot(s.to[0] - s.from[0], s.to[1] - s.from[1]) < kShortest) return false;
  return outline.segments.size() <= kMostSegments;
}

bool are_finite(const AreaProperties<double>& a) {
  return std::isfinite(a.area) && std::isfinite(a.centroid_height) && std::isfinite(a.inertia_y) &&
         std::isfinite(a.inertia_z);
}

/// The section as `railstep fit --out` writes it and a scene reads it; 17 digits hold every bit.
void check_written(const FitResult& result) {
  const Section found = read_section(written("section.toml", to_toml(result)));
  const AreaProperties<double>&a = found.area, &b = result.section.area;
  check(a.area == b.area && a.centroid_height == b.centroid_height && a.inertia_y == b.inertia_y &&
            a.inertia_z == b.inertia_z && found.height == result.section.height,
        "a section is not read as it is written");
  check(!to_html(result).empty() && !to_table(result).empty(), "a fit without a report");
}

void fit(const Profile& profile) {
  const FitResult r = fit_profile(profile, "input");
  check(r.lopsided.share >= 0., "an asymmetry below 0");
  if (r.refusal) return;
  check(largest(r.fit.errors) < 1e-9, "a fit that misses the properties");
  check_written(r);
}

}  // namespace

void check_outline(const Profile& profile) {
  const Outline& outline = profile.outline;
  check(outline.segments.size() >= 3 && outline.height > 0. && outline.height <= 1.,
        "an outline without a height");
  const AreaProperties<double> own = properties(outline);
  check(are_finite(own) && own.area > 0., "an outline without an area");
  if (is_coarse(outline)) accepts([&] { fit(profile); });
}

}  // namespace railstep::fuzz
