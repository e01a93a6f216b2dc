#include "answer/track_sections.h"

#include <algorithm>
#include <cmath>

#include "online/track/along_line.h"

namespace railstep {
namespace {

constexpr double kBase = 10.;        // m, over which a change counts
constexpr double kCurvature = 1e-5;  // 1/m
constexpr double kCant = 1e-3;       // rad, 1.5 mm

/// Where a table of the line has a row, between two places, and these themselves.
std::vector<double> borders_of(const LineShape& line, double from, double to) {
  std::vector<double> borders = {from, to};
  for (const std::vector<double>* table : {&line.curvature, &line.cant})
    for (std::size_t i = 0; i < table->size(); i += 2)
      if ((*table)[i] > from && (*table)[i] < to) borders.push_back((*table)[i]);
  std::sort(borders.begin(), borders.end());
  return borders;
}

TrackSection section_between(const DesignLine& line, double from, double to) {
  const double middle = .5 * (from + to),
               half =
                   .5 * std::max(kBase, (1. - 1e-6) * (to - from));  // a table may jump at a border
  const auto change = [&](const LineTable& table) {
    return std::fabs(value_at(table, line.transition, middle + half).value -
                     value_at(table, line.transition, middle - half).value);
  };
  const double curvature = value_at(line.curvature, line.transition, middle).value;
  const double radius = std::fabs(curvature) > kCurvature ? 1. / curvature : 0.;
  const bool changes = change(line.curvature) > kCurvature || change(line.cant) > kCant;
  return {changes        ? SectionKind::transition
          : radius == 0. ? SectionKind::straight
                         : SectionKind::curve,
          from, to, radius};
}

bool goes_on(const TrackSection& before, const TrackSection& after) {
  return before.kind == after.kind &&
         (before.kind != SectionKind::curve ||
          std::fabs(before.radius - after.radius) < .02 * std::fabs(before.radius));
}

/// Adds a part behind others. One that is short belongs to the part before it.
void append(const TrackSection& part, std::vector<TrackSection>& parts) {
  if (!parts.empty() && goes_on(parts.back(), part)) {
    parts.back().to = part.to;
    return;
  }
  if (parts.size() > 1 && parts.back().to - parts.back().from < kBase) {
    const TrackSection last = parts.back();
    parts.pop_back();
    parts.back().to = last.to;
    return append(part, parts);
  }
  parts.push_back(part);
}

}  // namespace

double nominal_length(const TrackSection& part) {
  const double radius = std::fabs(part.radius);
  if (part.kind == SectionKind::transition) return 0.;
  return radius == 0. || radius >= 600. ? 250. : radius >= 400. ? 100. : 70.;
}

std::vector<TrackSection> sections_between(const LineShape& line, double from, double to) {
  const DesignLine view = design_line(line, to - from);
  const std::vector<double> borders = borders_of(line, from, to);
  std::vector<TrackSection> parts, sections;
  for (std::size_t i = 0; i + 1 < borders.size(); ++i) {
    if (!(borders[i + 1] > borders[i])) continue;
    append(section_between(view, borders[i], borders[i + 1]), parts);
  }
  for (const TrackSection& part : parts) {
    const double length = part.to - part.from;
    const int count =
        part.kind == SectionKind::transition
            ? 1
            : std::max(1, static_cast<int>(std::lround(length / nominal_length(part))));
    for (int k = 0; k < count; ++k) {
      TrackSection own = part;
      own.from = part.from + length * k / count;
      own.to = part.from + length * (k + 1) / count;
      sections.push_back(own);
    }
  }
  return sections;
}

}  // namespace railstep
