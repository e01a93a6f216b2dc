#include "online/patch/wheel_zones.h"

#include "online/math/scalar.h"

namespace railstep {

namespace {

constexpr double kBeside = 1.;        // m, gap beside the rail
constexpr double kReach = 1e-3;       // m: higher minima are not near contact
constexpr double kAllowance = 1.3;    // of a depth, to which a step may press a zone
constexpr double kLeastOverlap = .1;  // of the least depth: some strips overlap
constexpr int kMostMinima = 8;
constexpr int kFineStrips = 17;  // over the strips to both sides of a minimum

struct TableValue {
  double value, slope;
};

/// A table at a place, the slope over the distance of two points. Places beyond the ends are taken
/// there.
inline TableValue cubic_at(const ProfileTable& t, double last, double place) noexcept {
  const double at = (place - t.first) * t.per_step;
  const std::int32_t k = !(at > 0.) ? 0 : static_cast<std::int32_t>(at < last ? at : last);
  const double* const c = t.coefficient + 4 * k;
  const double x = at - k;
  return {c[0] + x * (c[1] + x * (c[2] + x * c[3])), c[1] + x * (2. * c[2] + 3. * c[3] * x)};
}

TableValue value_at(const ProfileTable& table, double place) noexcept {
  const TableValue own = cubic_at(table, table.points - 2, place);
  return {own.value, table.per_step * own.slope};
}

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
  /// The wheel's surface falls as its radius grows, and turns with the roll.
  double slope_in_frame(double growth_slope) const noexcept {
    return (roll_sine - growth_slope * roll_cosine) / (roll_cosine + growth_slope * roll_sine);
  }
};

Lowest lowest(const ProfilePair& pair, const WheelsetPlace& at) noexcept {
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
  static constexpr int kMost = kZoneStrips + 1;
  const ProfilePair& pair;
  Lowest wheel;

  /// Gaps at places on the wheel. @param n  at most kMost
  void gaps(const double* s, int n, double* gap) const noexcept {
    const ProfileTable own = pair.wheel,
                       rail = pair.rail;  // by themselves: loops need not look again
    const Lowest at = wheel;
    const double per_step = own.per_step, last = own.points - 2, rail_last = rail.points - 2;
    const double begin = rail.first, end = begin + (rail.points - 1) / rail.per_step;
    double growth[kMost], slope[kMost], y[kMost], z[kMost], under[kMost];
    for (int i = 0; i < n; ++i) {
      const TableValue found = cubic_at(own, last, s[i]);
      growth[i] = found.value;
      slope[i] = found.slope;
    }
#pragma omp simd
    for (int i = 0; i < n; ++i) {
      const FramePoint p = at.point(s[i], growth[i], per_step * slope[i]);
      y[i] = p.y;
      z[i] = p.z;
    }
    for (int i = 0; i < n; ++i) under[i] = cubic_at(rail, rail_last, y[i]).value;
#pragma omp simd
    for (int i = 0; i < n; ++i) gap[i] = y[i] >= begin && y[i] <= end ? z[i] - under[i] : kBeside;
  }
  TableValue wheel_at(double s) const noexcept { return value_at(pair.wheel, s); }
};

/// Gaps at the search's strips.
struct Search {
  const double* place;
  double gap[kSearchStrips];
  int first, last;  // strips over the rail
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
  search.first = kSearchStrips;
  search.last = -1;
  for (int i = 0; i < kSearchStrips; ++i) {
    search.gap[i] = kBeside;
    if (!(y[i] >= 0.) || !(y[i] < last)) continue;
    if (search.last < 0) search.first = i;
    search.last = i;
    const auto k = static_cast<std::int32_t>(y[i]);
    const double* const own = rail.coefficient + 4 * k;
    search.gap[i] = z[i] - (own[0] + (y[i] - k) * (own[4] - own[0]));
  }
}

/// A point of the gap between the search's strips: the strip next to it, its place and the gap, m.
struct GapPoint {
  int at;
  double place, gap;
};

/// A minimum of the gap, and the ends up to which its zone goes: ridges, or ends of the search.
struct Minimum {
  int at;
  double place, gap;  // m, between strips too
  GapPoint from, to;
  double apart;  // 1: a zone by itself; 0: one with the minimum before
};

GapPoint end_of(const Search& search, int strip) noexcept {
  return {strip, search.place[strip], search.gap[strip]};
}

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
  Minimum found{i, s[least], gap[least], end_of(search, 0), end_of(search, kSearchStrips - 1), 1.};
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

/// The same between strips, by the parabola through the highest one and those beside it.
GapPoint ridge_point(const Search& search, int from, int to) noexcept {
  const int at = ridge_between(search, from, to);
  GapPoint ridge = end_of(search, at);
  if (at == from || at == to) return ridge;
  const double *const s = search.place + at, *const g = search.gap + at;
  const double before = (g[0] - g[-1]) / (s[0] - s[-1]), after = (g[1] - g[0]) / (s[1] - s[0]);
  const double bend = (after - before) / (s[1] - s[-1]);
  if (!(bend < 0.)) return ridge;
  const double slope = before + bend * (s[0] - s[-1]), way = -.5 * slope / bend;
  ridge.place += way;
  ridge.gap += way * (slope + bend * way);
  return ridge;
}

double apart(const Search& search, const Minimum& a, const Minimum& b,
             double least_depth) noexcept {
  const Minimum &deeper = a.gap < b.gap ? a : b, &higher = a.gap < b.gap ? b : a;
  const double ridge = search.gap[ridge_between(search, a.at, b.at)];
  return patches_apart(deeper.gap, search.gap[higher.at], ridge, least_depth);
}

int find_minima(const LowestLine& line, const Search& search, double least_depth,
                Minimum* found) noexcept {
  int count = 0, candidates = 0, lowest = 0, candidate[kSearchStrips];
  const double* const gap = search.gap;
  double before = kBeside;
  for (int i = search.first; i <= search.last; ++i) {
    const double after = i < search.last ? gap[i + 1] : kBeside;
    candidate[candidates] = i;
    candidates += gap[i] <= before && gap[i] < after ? 1 : 0;
    before = gap[i];
  }
  for (int n = 1; n < candidates; ++n)
    if (gap[candidate[n]] < gap[candidate[lowest]]) lowest = n;
  for (int n = 0; n < candidates; ++n) {
    const int i = candidate[n];
    if (gap[i] > kReach && n != lowest) continue;
    const Minimum own = minimum_at(line, search, i);
    if (count > 0) {
      Minimum& last = found[count - 1];
      if (!(apart(search, last, own, least_depth) > 0.) || count == kMostMinima) {
        if (own.gap < last.gap) last = {i, own.place, own.gap, last.from, last.to, 1.};
        continue;
      }
      last.to = ridge_point(search, last.at, i);
    }
    found[count] = own;
    if (count > 0) found[count].from = found[count - 1].to;
    ++count;
  }
  return count;
}

/// Leaves the deepest minima, in their order.
int leave_deepest(Minimum* found, int count, int most) noexcept {
  while (count > most) {
    int highest = 0;
    for (int i = 1; i < count; ++i)
      if (found[i].gap > found[highest].gap) highest = i;
    for (int i = highest; i + 1 < count; ++i) found[i] = found[i + 1];
    --count;
  }
  return count;
}

/// Minima from one to another as one.
Minimum as_one(const Minimum* from, const Minimum* to) noexcept {
  Minimum one = *from;
  for (const Minimum* own = from + 1; own <= to; ++own)
    if (own->gap < one.gap) one = *own;
  one.from = from->from;
  one.to = to->to;
  return one;
}

/// Places to both sides of a minimum at which the gap meets a level: between the strips of the
/// search a and a + 1, and b - 1 and b. The root of the gap above the minimum is straight where the
/// gap is a parabola: one step along it from where it would be by the strips, by the gap there. At
/// the end of a profile, or of the zone, it is that end.
struct Edges {
  double from, to;
};
Edges edges_of(const LowestLine& line, const Search& search, const Minimum& own, int a, int b,
               double level) noexcept {
  const auto root = [&](double gap) noexcept -> double {
    return gap > own.gap ? square_root(gap - own.gap) : 0.;
  };
  const GapPoint outer[2] = {a == own.from.at ? own.from : end_of(search, a),
                             b == own.to.at ? own.to : end_of(search, b)};
  const int inner[2] = {a + 1, b - 1};
  const double wanted = root(level);
  double place[2], gap[2], per_root[2], most[2];
  for (int side = 0; side < 2; ++side) {
    const double from = outer[side].place, far = outer[side].gap;
    const bool is_beyond =
        side == 0 ? search.place[inner[side]] > own.place : search.place[inner[side]] < own.place;
    most[side] = is_beyond ? own.place : search.place[inner[side]];
    const double high = root(far), low = is_beyond ? 0. : root(search.gap[inner[side]]);
    const bool is_end = !(far > level) || far >= kBeside || !(high > low);
    per_root[side] = is_end ? 0. : (most[side] - from) / (low - high);
    place[side] = from + (wanted - high) * per_root[side];
  }
  line.gaps(place, 2, gap);
  for (int side = 0; side < 2; ++side) {
    const double from = outer[side].place,
                 found = place[side] + (wanted - root(gap[side])) * per_root[side];
    const double low = side == 0 ? from : most[side], high = side == 0 ? most[side] : from;
    place[side] = found < low ? low : found < high ? found : high;
  }
  return {place[0] < own.place ? place[0] : search.place[a],
          place[1] > own.place ? place[1] : search.place[b]};
}

/// Turns a zone whose gaps are upright to the plane in which it is pressed, that of the mean place
/// of its collocation: the deepest point leaps where the bodies are alike, as throat and gauge
/// corner are.
void take_plane(const LowestLine& line, double place, WheelZone& zone) noexcept {
  const TableValue wheel = line.wheel_at(place);
  const double slope = line.wheel.slope_in_frame(wheel.slope);
  zone.cosine = 1. / square_root(1. + slope * slope);
  zone.cosine_of_wheel = 1. / square_root(1. + wheel.slope * wheel.slope);
  for (double& gap : zone.gap) gap *= zone.cosine;
  zone.patch.collocation.gap *= zone.cosine;
  zone.patch.width /= zone.cosine_of_wheel;
  zone.patch.radius = (line.pair.radius + wheel.value) / zone.cosine_of_wheel;
}

/// A strip that has neighbours.
int within(int strip) noexcept {
  return strip < 1 ? 1 : strip < kSearchStrips - 1 ? strip : kSearchStrips - 2;
}

/// Fills a zone about minima. All that overlap are in it, whatever the ridges between them.
void fill_zone(const LowestLine& line, const Search& search, const Minimum* from_minimum,
               const Minimum* to_minimum, double least_depth, WheelZone& zone) noexcept {
  const Minimum own = as_one(from_minimum, to_minimum);
  const double level = own.gap + kAllowance * (level_of(own.gap, least_depth) - own.gap);
  int first = own.at, last_overlaps = own.at;
  for (const Minimum* each = from_minimum; each <= to_minimum; ++each) {
    if (!(search.gap[each->at] < level)) continue;
    if (each->at < first) first = each->at;
    if (each->at > last_overlaps) last_overlaps = each->at;
  }
  int a = within(first) - 1, b = within(last_overlaps) + 1;
  while (a > own.from.at && search.gap[a] < level) --a;
  while (b < own.to.at && search.gap[b] < level) ++b;
  const auto [from, to] = edges_of(line, search, own, a, b, level);
  const double width = (to - from) / (kZoneStrips - 1);
  double s[kZoneStrips + 1], gap[kZoneStrips + 1];
  for (int k = 0; k < kZoneStrips; ++k) s[k] = from + k * width;
  s[kZoneStrips] = own.place;
  line.gaps(s, kZoneStrips + 1, gap);
  const double least = gap[kZoneStrips];
  for (int k = 0; k < kZoneStrips; ++k) zone.gap[k] = gap[k] > least ? gap[k] - least : 0.;
  const double deepest = (own.place - from) / width, last = kZoneStrips - 1;
  zone.patch = {zone.gap, kZoneStrips,      deepest < last ? deepest : last, {}, width,
                0.,       line.pair.modulus};
  const double least_overlap = kLeastOverlap * least_depth;
  zone.patch.collocation =
      collocation_of(zone.patch, -least > least_overlap ? -least : least_overlap);
  const Collocation& pressed = zone.patch.collocation;
  take_plane(line, from + .5 * width * (pressed.first + pressed.second), zone);
  zone.depth = -zone.cosine * least;
  zone.s = own.place;
  const double overlap = kVirtualPart * zone.depth;
  zone.at_edge = (a == 0 && zone.gap[0] < overlap) ||
                 (b == kSearchStrips - 1 && zone.gap[kZoneStrips - 1] < overlap);
  for (int k = 1; k < kZoneStrips; ++k) {
    const bool beside = gap[k - 1] >= kBeside, next = gap[k] >= kBeside;
    if (beside != next && zone.gap[beside ? k : k - 1] < overlap) zone.at_edge = true;
  }
  zone.patch.gap = nullptr;
}

}  // namespace

int find_zones(const ProfilePair& pair, const WheelsetPlace& at, double least_depth,
               WheelZone* zone) noexcept {
  const LowestLine line{pair, lowest(pair, at)};
  Search search;
  look(line, search);
  Minimum found[kMostMinima];
  const int count =
      leave_deepest(found, find_minima(line, search, least_depth, found), pair.patches);
  for (int i = 1; i < count; ++i)
    found[i].apart = apart(search, found[i - 1], found[i], least_depth);
  int zones = 0;
  for_each_share(
      count, [&](int i) noexcept { return found[i].apart; },
      [&](int first, int last, double share) noexcept {
        fill_zone(line, search, found + first, found + last, least_depth, zone[zones]);
        zone[zones++].share = share;
      });
  return zones;
}

PressedPoint pressed_point(const ProfilePair& pair, const WheelsetPlace& at, double s,
                           double half) noexcept {
  const Lowest wheel = lowest(pair, at);
  const TableValue own = value_at(pair.wheel, s);
  const FramePoint point = wheel.point(s, own.value, own.slope);
  const double of_rail = value_at(pair.rail, point.y).slope;
  const double steeper =
      value_at(pair.wheel, s + half).slope - value_at(pair.wheel, s - half).slope;
  const double cosine = 1. / square_root(1. + own.slope * own.slope);
  return {point.x, point.y, point.z, .5 * (wheel.slope_in_frame(own.slope) + of_rail),
          -steeper / (2. * half) * (cosine * cosine * cosine)};
}

}  // namespace railstep
