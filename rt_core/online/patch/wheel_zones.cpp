#include "online/patch/wheel_zones.h"

#include "online/math/scalar.h"

namespace railstep {

namespace {

constexpr double kBeside = 1.;      // m, gap beside the rail
constexpr double kReach = 1e-3;     // m: higher minima are not near contact
constexpr double kAllowance = 1.3;  // of a depth, to which a step may press a zone
constexpr int kMostMinima = 8;
constexpr int kFineStrips = 17;  // over the strips to both sides of a minimum
constexpr int kEdgeStrips = 8;   // between two strips at the edge of a zone

struct TableValue {
  double value, slope;
};

/// Intervals of a table and places in them, side by side. Places beyond the ends are taken there.
struct Cubics {
  double c0[kZoneStrips], c1[kZoneStrips], c2[kZoneStrips], c3[kZoneStrips], x[kZoneStrips];

  void find(const ProfileTable& t, const double* place, int n) noexcept {
    const double last = t.points - 2;
    for (int i = 0; i < n; ++i) {
      const double at = (place[i] - t.first) * t.per_step;
      const std::int32_t k = !(at > 0.) ? 0 : static_cast<std::int32_t>(at < last ? at : last);
      const double* const c = t.coefficient + 4 * k;
      c0[i] = c[0], c1[i] = c[1], c2[i] = c[2], c3[i] = c[3];
      x[i] = at - k;
    }
  }
  double value(int i) const noexcept {
    return c0[i] + x[i] * (c1[i] + x[i] * (c2[i] + x[i] * c3[i]));
  }
  /// Over the distance of two points.
  double slope(int i) const noexcept { return c1[i] + x[i] * (2. * c2[i] + 3. * c3[i] * x[i]); }
};

/// A point in the rail's frame.
struct FramePoint {
  double x, y, z;
};

/// The points of a wheel's circles at which its normal has no part along the rail.
struct Lowest {
  double half_distance, radius;
  double outwards, up, roll_cosine, roll_sine, yaw, yaw_cosine;

  /// @param growth, slope  of the wheel's radius at s
  FramePoint point(double s, double growth, double slope) const noexcept {
    const double r = radius + growth, along = half_distance + s;
    // About the axle, ahead of the lowest point.
    const double angle = (roll_sine - slope * roll_cosine) * yaw;
    const double ahead = r * angle, down = r * (1. - .5 * angle * angle);
    const double level = along * roll_cosine + down * roll_sine;
    return {ahead - level * yaw, outwards + level * yaw_cosine + ahead * yaw,
            up + along * roll_sine - down * roll_cosine};
  }
};

Lowest lowest(const WheelOnRail& pair, const WheelsetPlace& at) noexcept {
  return {pair.half_distance,
          pair.radius,
          at.outwards,
          at.up,
          1. - .5 * at.roll * at.roll,
          at.roll * (1. - at.roll * at.roll / 6.),
          at.yaw,
          1. - .5 * at.yaw * at.yaw};
}

/// The line of these points over the rail.
struct LowestLine {
  const WheelOnRail& pair;
  Lowest wheel;

  /// Gaps at places on the wheel. @param n  at most kZoneStrips
  void gaps(const double* s, int n, double* gap) const noexcept {
    const ProfileTable& rail = pair.rail;
    const Lowest own = wheel;  // by itself, so that loops need not look at it again
    const double per_step = pair.wheel.per_step, rail_per_step = rail.per_step;
    const double begin = rail.first, end = begin + (rail.points - 1) / rail_per_step;
    Cubics cubics;
    double y[kZoneStrips], z[kZoneStrips];
    cubics.find(pair.wheel, s, n);
#pragma omp simd
    for (int i = 0; i < n; ++i) {
      const FramePoint p = own.point(s[i], cubics.value(i), per_step * cubics.slope(i));
      y[i] = p.y;
      z[i] = p.z;
    }
    cubics.find(rail, y, n);
#pragma omp simd
    for (int i = 0; i < n; ++i) {
      const bool over = y[i] >= begin && y[i] <= end;
      gap[i] = over ? z[i] - cubics.value(i) : kBeside;
    }
  }
  TableValue wheel_at(double s) const noexcept {
    Cubics cubics;
    cubics.find(pair.wheel, &s, 1);
    return {cubics.value(0), pair.wheel.per_step * cubics.slope(0)};
  }
};

/// Gaps at the search's strips.
struct Search {
  const double* place;
  double gap[kSearchStrips];
};

/// Gaps to the rail's table as if it were straight between its points.
void look(const LowestLine& line, Search& search) noexcept {
  const ProfileTable& rail = line.pair.rail;
  const Lowest wheel = line.wheel;
  const double rail_first = rail.first, rail_per_step = rail.per_step;
  const double *const place = line.pair.search_place, *const growth = line.pair.search_growth,
                      *const slope = line.pair.search_slope;
  search.place = place;
  double y[kSearchStrips], z[kSearchStrips];
#pragma omp simd
  for (int i = 0; i < kSearchStrips; ++i) {
    const FramePoint p = wheel.point(place[i], growth[i], slope[i]);
    y[i] = (p.y - rail_first) * rail_per_step;
    z[i] = p.z;
  }
  const double last = rail.points - 1;
  for (int i = 0; i < kSearchStrips; ++i) {
    search.gap[i] = kBeside;
    if (!(y[i] >= 0.) || !(y[i] < last)) continue;
    const auto k = static_cast<std::int32_t>(y[i]);
    const double* const own = rail.coefficient + 4 * k;
    search.gap[i] = z[i] - (own[0] + (y[i] - k) * (own[4] - own[0]));
  }
}

/// A minimum of the gap, and the strips up to which its zone goes.
struct Minimum {
  int at, first, last;
  double place, gap;  // m, between strips too
};

/// The minimum about a strip of the search, by the parabola through three finer ones.
Minimum minimum_at(const LowestLine& line, const Search& search, int i) noexcept {
  const int from = i > 0 ? i - 1 : i, to = i + 1 < kSearchStrips ? i + 1 : i;
  const double first = search.place[from], step = (search.place[to] - first) / (kFineStrips - 1);
  double s[kFineStrips], gap[kFineStrips];
  for (int k = 0; k < kFineStrips; ++k) s[k] = first + k * step;
  line.gaps(s, kFineStrips, gap);
  int least = 0;
  for (int k = 1; k < kFineStrips; ++k)
    if (gap[k] < gap[least]) least = k;
  Minimum found{i, 0, kSearchStrips - 1, s[least], gap[least]};
  if (least == 0 || least == kFineStrips - 1) return found;
  const double half = .5 * (gap[least + 1] - gap[least - 1]),
               bend = gap[least + 1] - 2. * gap[least] + gap[least - 1];
  if (!(bend > 0.) || gap[least - 1] >= kBeside || gap[least + 1] >= kBeside) return found;
  found.place -= step * half / bend;
  found.gap -= .5 * half * half / bend;
  return found;
}

/// Gap up to which bodies overlap about a point, by the law of patches.
double level_of(double gap, double least_depth) noexcept {
  return gap + kVirtualPart * (-gap > least_depth ? -gap : least_depth);
}

int ridge_between(const Search& search, int from, int to) noexcept {
  int highest = from;
  for (int i = from + 1; i <= to; ++i)
    if (search.gap[i] > search.gap[highest]) highest = i;
  return highest;
}

int find_minima(const LowestLine& line, const Search& search, double least_depth,
                Minimum* found) noexcept {
  int count = 0, lowest = 0;
  const double* const gap = search.gap;
  for (int i = 1; i < kSearchStrips; ++i)
    if (gap[i] < gap[lowest]) lowest = i;
  if (!(gap[lowest] < kBeside)) return 0;
  for (int i = 0; i < kSearchStrips; ++i) {
    const double before = i > 0 ? gap[i - 1] : kBeside,
                 after = i + 1 < kSearchStrips ? gap[i + 1] : kBeside;
    const bool is_least = gap[i] <= before && gap[i] < after;
    if (!is_least || (gap[i] > kReach && i != lowest)) continue;
    const Minimum own = minimum_at(line, search, i);
    if (count > 0) {
      Minimum& last = found[count - 1];
      const double deeper = own.gap < last.gap ? own.gap : last.gap;
      const int ridge = ridge_between(search, last.at, i);
      if (gap[ridge] < level_of(deeper, least_depth) || count == kMostMinima) {
        if (own.gap < last.gap) last = {i, last.first, last.last, own.place, own.gap};
        continue;
      }
      last.last = ridge;
    }
    found[count] = own;
    if (count > 0) found[count].first = found[count - 1].last;
    ++count;
  }
  return count;
}

/// Leaves the deepest minima, in their order.
int leave_deepest(Minimum* found, int count) noexcept {
  while (count > kMostZones) {
    int highest = 0;
    for (int i = 1; i < count; ++i)
      if (found[i].gap > found[highest].gap) highest = i;
    for (int i = highest; i + 1 < count; ++i) found[i] = found[i + 1];
    --count;
  }
  return count;
}

/// Places to both sides of another with gaps above a level, next to some below it: between the
/// strips of the search a and a + 1, and b - 1 and b.
struct Edges {
  double from, to;
};
Edges edges_of(const LowestLine& line, const Search& search, int a, int b, double level,
               double place) noexcept {
  constexpr int n = kEdgeStrips;
  const double left_step = (search.place[a + 1] - search.place[a]) / n,
               right_step = (search.place[b] - search.place[b - 1]) / n;
  double s[2 * n], gap[2 * n];
  for (int k = 0; k < n; ++k) {
    s[k] = search.place[a] + k * left_step;
    s[n + k] = search.place[b] - k * right_step;
  }
  line.gaps(s, 2 * n, gap);
  int left = 0, right = 0;
  while (left + 1 < n && !(gap[left + 1] < level) && s[left + 1] < place) ++left;
  while (right + 1 < n && !(gap[n + right + 1] < level) && s[n + right + 1] > place) ++right;
  return {s[left], s[n + right]};
}

void fill_zone(const LowestLine& line, const Search& search, const Minimum& own, double least_depth,
               WheelZone& zone) noexcept {
  const double level = own.gap + kAllowance * (level_of(own.gap, least_depth) - own.gap);
  const int inner = own.at > 0 ? own.at < kSearchStrips - 1 ? own.at : kSearchStrips - 2 : 1;
  int a = inner - 1, b = inner + 1;
  while (a > own.first && search.gap[a] < level) --a;
  while (b < own.last && search.gap[b] < level) ++b;
  const Edges edges = edges_of(line, search, a, b, level, own.place);
  const double width = (edges.to - edges.from) / (kZoneStrips - 1);
  const double strips_before = (own.place - edges.from) / width;
  int deepest = static_cast<int>(strips_before);
  if (strips_before - deepest > .5) ++deepest;
  double s[kZoneStrips], gap[kZoneStrips];
  for (int k = 0; k < kZoneStrips; ++k) s[k] = own.place + (k - deepest) * width;
  line.gaps(s, kZoneStrips, gap);
  const double least = gap[deepest];
  const TableValue own_wheel = line.wheel_at(own.place);
  const FramePoint point = line.wheel.point(own.place, own_wheel.value, own_wheel.slope);
  const double along = 1. / square_root(1. + own_wheel.slope * own_wheel.slope);
  // The wheel's surface falls as its radius grows, and turns with the roll.
  zone.slope = (line.wheel.roll_sine - own_wheel.slope * line.wheel.roll_cosine) /
               (line.wheel.roll_cosine + own_wheel.slope * line.wheel.roll_sine);
  const double normal = 1. / square_root(1. + zone.slope * zone.slope);
  zone.depth = -normal * least;
  zone.s = own.place;
  zone.ahead = point.x;
  zone.y = point.y;
  zone.z = point.z;
  zone.cosine_of_wheel = along;
  const double overlap = kVirtualPart * zone.depth;
  for (int k = 0; k < kZoneStrips; ++k) {
    const double above = normal * (gap[k] - least);
    zone.gap[k] = above > 0. ? above : 0.;
  }
  zone.at_edge = (a == 0 && zone.gap[0] < overlap) ||
                 (b == kSearchStrips - 1 && zone.gap[kZoneStrips - 1] < overlap);
  for (int k = 1; k < kZoneStrips; ++k) {
    const bool beside = gap[k - 1] >= kBeside, next = gap[k] >= kBeside;
    if (beside != next && zone.gap[beside ? k : k - 1] < overlap) zone.at_edge = true;
  }
  zone.patch = {nullptr,
                kZoneStrips,
                deepest,
                width / along,
                (line.pair.radius + own_wheel.value) / along,
                line.pair.modulus};
}

}  // namespace

int find_zones(const WheelOnRail& pair, const WheelsetPlace& at, double least_depth,
               WheelZone* zone) noexcept {
  const LowestLine line{pair, lowest(pair, at)};
  Search search;
  look(line, search);
  Minimum found[kMostMinima];
  const int count = leave_deepest(found, find_minima(line, search, least_depth, found));
  for (int i = 0; i < count; ++i) fill_zone(line, search, found[i], least_depth, zone[i]);
  return count;
}

}  // namespace railstep
