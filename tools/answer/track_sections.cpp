#include "answer/track_sections.h"

#include <algorithm>
#include <cmath>

#include "online/track/along_line.h"

namespace railstep {
namespace {

constexpr double kStraight = 1e-6;  // 1/m: less curved track is straight

double nominal_length(const TrackSection& part) {
  const double radius = std::fabs(part.radius);
  return radius == 0. || radius >= 600. ? 250. : radius >= 400. ? 100. : 70.;
}

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
  const double inside = 1e-6 * (to - from);  // a table may jump at a border
  const auto at = [&](const LineTable& table, double place) {
    return value_at(table, line.transition, place).value;
  };
  const double first = at(line.curvature, from + inside), last = at(line.curvature, to - inside),
               middle = at(line.curvature, .5 * (from + to));
  const double cant_change = at(line.cant, to - inside) - at(line.cant, from + inside);
  const bool changes = std::fabs(last - first) > kStraight || std::fabs(cant_change) > 1e-4;
  const double radius = std::fabs(middle) > kStraight ? 1. / middle : 0.;
  return {changes        ? SectionKind::transition
          : radius == 0. ? SectionKind::straight
                         : SectionKind::curve,
          from, to, radius};
}

bool goes_on(const TrackSection& before, const TrackSection& after) {
  return before.kind == after.kind &&
         (before.kind != SectionKind::curve ||
          std::fabs(before.radius - after.radius) < 1e-3 * std::fabs(before.radius));
}

}  // namespace

std::vector<TrackSection> sections_between(const LineShape& line, double from, double to) {
  const DesignLine view = design_line(line, to - from);
  const std::vector<double> borders = borders_of(line, from, to);
  std::vector<TrackSection> parts, sections;
  for (std::size_t i = 0; i + 1 < borders.size(); ++i) {
    if (!(borders[i + 1] > borders[i])) continue;
    const TrackSection part = section_between(view, borders[i], borders[i + 1]);
    if (!parts.empty() && goes_on(parts.back(), part))
      parts.back().to = part.to;
    else
      parts.push_back(part);
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
