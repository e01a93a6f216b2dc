#include "online/patch/wheel_zones.h"

#include "online/math/scalar.h"

namespace railstep {

namespace {

constexpr double kBeside = 1.;      // m, gap beside the rail
constexpr double kReach = 1e-3;     // m: higher minima are not near contact
constexpr double kAllowance = 1.3;  // of a depth, to which a step may press a zone
constexpr int kMostMinima = 8;
constexpr int kHalvings = 3;  // of the distance of two strips, at the edge of a zone
constexpr int kTurns = 6;     // of the search for a minimum

struct TableValue {
  double value, slope;
};

/// Beyond its ends a table goes on straight.
TableValue value_at(const ProfileTable& t, double place) noexcept {
  const double at = (place - t.first) / t.step;
  std::int32_t i = 0;
  if (at > 0.) i = at < t.points - 1 ? static_cast<std::int32_t>(at) : t.points - 2;
  const double *const a = t.value + 2 * i, *const b = a + 2;
  double x = at - i, beyond = 0.;
  if (x < 0.) beyond = x, x = 0.;
  if (x > 1.) beyond = x - 1., x = 1.;
  // Hermite's cubic: a + x (a' + x (c + x d)).
  const double rise = b[0] - a[0];
  const double c = 3. * rise - 2. * a[1] - b[1], d = a[1] + b[1] - 2. * rise;
  const double slope = a[1] + x * (2. * c + 3. * d * x);
  return {a[0] + x * (a[1] + x * (c + d * x)) + beyond * slope, slope / t.step};
}

bool is_within(const ProfileTable& t, double place) noexcept {
  return place >= t.first && place <= t.first + (t.points - 1) * t.step;
}

/// The lowest line of a wheel in the rail's frame.
struct LowestLine {
  const WheelOnRail& pair;
  const WheelsetPlace& at;
  double roll_cosine, roll_sine, yaw_cosine;

  LowestLine(const WheelOnRail& own, const WheelsetPlace& place) noexcept
      : pair(own),
        at(place),
        roll_cosine(1. - .5 * place.roll * place.roll),
        roll_sine(place.roll * (1. - place.roll * place.roll / 6.)),
        yaw_cosine(1. - .5 * place.yaw * place.yaw) {}

  struct Point {
    double x, y, z;
  };
  Point point(double s, const TableValue& wheel) const noexcept {
    const double radius = pair.radius + wheel.value, along = pair.half_distance + s;
    const double angle = -wheel.slope * at.yaw;  // about the axle, ahead of the lowest point
    const double ahead = radius * angle, down = radius * (1. - .5 * angle * angle);
    const double level = along * roll_cosine + down * roll_sine;
    return {ahead - level * at.yaw, at.outwards + level * yaw_cosine + ahead * at.yaw,
            at.up + along * roll_sine - down * roll_cosine};
  }
  double gap(const Point& p) const noexcept {
    return is_within(pair.rail, p.y) ? p.z - value_at(pair.rail, p.y).value : kBeside;
  }
  double gap(double s) const noexcept { return gap(point(s, value_at(pair.wheel, s))); }
  /// Derivative of the gap over s, as without yaw, over what makes that of a steep rail large.
  double rise(double s) const noexcept {
    const TableValue wheel = value_at(pair.wheel, s);
    const double rail = value_at(pair.rail, point(s, wheel).y).slope;
    return ((roll_sine - wheel.slope * roll_cosine) -
            rail * (roll_cosine + wheel.slope * roll_sine)) /
           square_root(1. + rail * rail);
  }
};

/// Gaps at the search's strips.
struct Search {
  double first, step;
  double gap[kSearchStrips];
  double place(int i) const noexcept { return first + step * i; }
};

void look(const LowestLine& line, Search& search) noexcept {
  const ProfileTable& wheel = line.pair.wheel;
  search.first = wheel.first;
  search.step = (wheel.points - 1) * wheel.step / (kSearchStrips - 1);
  for (int i = 0; i < kSearchStrips; ++i) {
    const double s = search.place(i);
    search.gap[i] = line.gap(line.point(s, value_at(wheel, s)));
  }
}

/// A minimum of the gap, and the strips up to which its zone goes.
struct Minimum {
  int at, first, last;
  double place, gap;  // m, between strips too
};

/// The minimum about a strip, by regula falsi for the derivative of the gap, whose kept end counts
/// half (Illinois).
Minimum minimum_at(const LowestLine& line, const Search& search, int i) noexcept {
  Minimum found{i, 0, kSearchStrips - 1, search.place(i), search.gap[i]};
  double low = search.place(i > 0 ? i - 1 : i),
         high = search.place(i + 1 < kSearchStrips ? i + 1 : i);
  double at_low = line.rise(low), at_high = line.rise(high);
  int kept = 0;
  for (int turn = 0; turn < kTurns && at_low < 0. && at_high > 0.; ++turn) {
    const double middle = low + (high - low) * (at_low / (at_low - at_high));
    const double own = line.rise(middle);
    if (own < 0.) {
      low = middle, at_low = own;
      if (kept == 1) at_high *= .5;
      kept = 1;
    } else {
      high = middle, at_high = own;
      if (kept == -1) at_low *= .5;
      kept = -1;
    }
    const double gap = line.gap(middle);
    if (gap < found.gap) found.place = middle, found.gap = gap;
  }
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
  if (gap[lowest] >= kBeside) return 0;
  for (int i = 1; i + 1 < kSearchStrips; ++i) {
    const bool is_least = gap[i] <= gap[i - 1] && gap[i] < gap[i + 1];
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
  if (count == 0) found[count++] = minimum_at(line, search, lowest);
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

/// A place with a gap above a level, near one below it. @param inner, outer  of both kinds
double edge_of(const LowestLine& line, double inner, double outer, double level) noexcept {
  for (int turn = 0; turn < kHalvings; ++turn) {
    const double middle = .5 * (inner + outer);
    (line.gap(middle) < level ? inner : outer) = middle;
  }
  return outer;
}

void fill_zone(const LowestLine& line, const Search& search, const Minimum& own, double least_depth,
               WheelZone& zone) noexcept {
  const double level = own.gap + kAllowance * (level_of(own.gap, least_depth) - own.gap);
  int a = own.at > own.first ? own.at - 1 : own.at, b = own.at < own.last ? own.at + 1 : own.at;
  while (a > own.first && search.gap[a] < level) --a;
  while (b < own.last && search.gap[b] < level) ++b;
  const double from = edge_of(line, search.place(a + 1), search.place(a), level),
               width = (edge_of(line, search.place(b - 1), search.place(b), level) - from) /
                       (kZoneStrips - 1);
  const int deepest = static_cast<int>((own.place - from) / width + .5);
  const double first = own.place - deepest * width;
  double gap[kZoneStrips];
  for (int k = 0; k < kZoneStrips; ++k) gap[k] = line.gap(first + k * width);
  const TableValue own_wheel = value_at(line.pair.wheel, own.place);
  const LowestLine::Point point = line.point(own.place, own_wheel);
  const double along = 1. / square_root(1. + own_wheel.slope * own_wheel.slope);
  // The wheel's surface falls as its radius grows, and turns with the roll.
  zone.slope = (line.roll_sine - own_wheel.slope * line.roll_cosine) /
               (line.roll_cosine + own_wheel.slope * line.roll_sine);
  const double normal = 1. / square_root(1. + zone.slope * zone.slope);
  zone.depth = -normal * own.gap;
  zone.s = own.place;
  zone.ahead = point.x;
  zone.y = point.y;
  zone.z = point.z;
  zone.cosine_of_wheel = along;
  const double overlap = kVirtualPart * zone.depth;
  for (int k = 0; k < kZoneStrips; ++k) {
    const double above = normal * (gap[k] - own.gap);
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
  const LowestLine line(pair, at);
  Search search;
  look(line, search);
  Minimum found[kMostMinima];
  const int count = leave_deepest(found, find_minima(line, search, least_depth, found));
  for (int i = 0; i < count; ++i) fill_zone(line, search, found[i], least_depth, zone[i]);
  return count;
}

}  // namespace railstep
