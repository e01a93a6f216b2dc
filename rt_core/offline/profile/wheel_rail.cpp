#include "offline/profile/wheel_rail.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "offline/math/golden_section.h"
#include "offline/math/refuse.h"
#include "offline/math/root.h"

namespace railstep {

namespace {

constexpr double kSample = 1e-4;        // m, between places where distances are looked at
constexpr double kNearlyLeast = 20e-6;  // m: minima that far above the least one are refined
constexpr double kFine = 1e-8;          // m, of a place of contact
constexpr double kMostRoll = .03;       // rad
constexpr double kBeside = .5;          // m: distances beside the rail are larger
constexpr double kTouches = 1e-8;       // m
constexpr double kLargeJump = .5e-3;    // m, on the wheel
constexpr double kJumpWidth = 1e-6;     // m, of a shift

}  // namespace

WheelOverRail::WheelOverRail(const WheelRail& pair, double outwards, double roll)
    : pair_(pair), shift_(outwards), cosine_(std::cos(roll)), sine_(std::sin(roll)) {}

double WheelOverRail::place(double s, double growth) const {
  return shift_ + (pair_.half_distance + s) * cosine_ + (pair_.radius + growth) * sine_;
}

double WheelOverRail::distance(double s) const {
  const double growth = pair_.wheel.at(s).height, y = place(s, growth);
  if (y < pair_.rail.first() || y > pair_.rail.last()) return 1.;
  return (pair_.half_distance + s) * sine_ - (pair_.radius + growth) * cosine_ -
         pair_.rail.at(y).height;
}

WheelTouch WheelOverRail::touch_at(double s) const {
  const SurfacePoint p = pair_.wheel.at(s);
  return {s, place(s, p.height), p.height, -std::atan(p.slope)};
}

WheelOverRail::Samples WheelOverRail::samples() const {
  const double first = pair_.wheel.first(), length = pair_.wheel.last() - first;
  const int count = static_cast<int>(length / kSample);
  Samples all{first, length / count, {}};
  for (int i = 0; i <= count; ++i) all.distance.push_back(distance(first + all.step * i));
  return all;
}

WheelOverRail::Nearest WheelOverRail::nearest() const {
  const Samples all = samples();
  const std::vector<double>& at = all.distance;
  const auto lowest = std::min_element(at.begin(), at.end());
  if (!(*lowest < kBeside))
    refuse("E-TOUCH-01",
           "the wheel is beside its rail; expected a gauge, a distance of wheels and "
           "a shift that go together");
  Nearest found{all.place(static_cast<std::size_t>(lowest - at.begin())), true};
  double least = *lowest;
  for (std::size_t i = 1; i + 1 < at.size(); ++i) {
    if (at[i] > at[i - 1] || at[i] > at[i + 1] || at[i] > *lowest + kNearlyLeast) continue;
    if (at[i - 1] > kBeside || at[i + 1] > kBeside) continue;  // the rail's edge
    const auto [place, depth] = golden_section([this](double s) { return -distance(s); },
                                               all.place(i - 1), all.place(i + 1), kFine);
    if (-depth > least) continue;
    found = {place, false};
    least = -depth;
  }
  return found;
}

WheelsetTouch touch(const WheelRail& pair, double shift, bool with_roll) {
  double roll = 0.;
  if (with_roll) {
    const auto uneven = [&](double angle) {
      const WheelOverRail right(pair, shift, angle), left(pair, -shift, -angle);
      return right.distance(right.nearest().s) - left.distance(left.nearest().s);
    };
    roll = bracketed_root(uneven, -kMostRoll, kMostRoll, 1e-13);
  }
  const WheelOverRail right(pair, shift, roll), left(pair, -shift, -roll);
  const WheelOverRail::Nearest r = right.nearest(), l = left.nearest();
  if (r.at_edge || l.at_edge)
    refuse("E-TOUCH-04", "at a shift of " + std::to_string(1e3 * shift) +
                             " mm a wheel touches at the edge of a profile; expected profiles that "
                             "reach beyond their contacts");
  const double right_distance = right.distance(r.s), left_distance = left.distance(l.s);
  if (with_roll && !(std::abs(right_distance - left_distance) < kTouches))
    refuse("E-TOUCH-03", "no roll of up to 0.03 rad brings both wheels onto their rails");
  return {shift, roll, -std::min(right_distance, left_distance), right.touch_at(r.s),
          left.touch_at(l.s)};
}

std::vector<WheelsetTouch> touches(const WheelRail& pair, double range, double spacing,
                                   bool with_roll) {
  const auto half = static_cast<int>(std::lround(range / spacing));
  std::vector<WheelsetTouch> rows;
  for (int i = -half; i <= half; ++i) rows.push_back(touch(pair, i * spacing, with_roll));
  return rows;
}

std::vector<ContactJump> jumps_of(const WheelRail& pair, const std::vector<WheelsetTouch>& rows,
                                  bool with_roll) {
  std::vector<ContactJump> jumps;
  // The larger part of a jump is followed: two jumps between neighbours become two entries.
  const auto divide = [&](const auto& self, const WheelsetTouch& a,
                          const WheelsetTouch& b) -> void {
    if (std::abs(b.right.on_wheel - a.right.on_wheel) < kLargeJump) return;
    if (b.shift - a.shift < kJumpWidth) {
      if (!jumps.empty() && .5 * (a.shift + b.shift) - jumps.back().shift < 10. * kJumpWidth)
        jumps.back().to = b.right.on_wheel;  // the same jump, seen in two parts
      else
        jumps.push_back({.5 * (a.shift + b.shift), a.right.on_wheel, b.right.on_wheel});
      return;
    }
    const WheelsetTouch middle = touch(pair, .5 * (a.shift + b.shift), with_roll);
    self(self, a, middle);
    self(self, middle, b);
  };
  for (std::size_t i = 1; i < rows.size(); ++i) divide(divide, rows[i - 1], rows[i]);
  return jumps;
}

namespace {

/// V = int difference dy from the first shift on, exact for what is straight between points.
class Potential {
 public:
  explicit Potential(const RadiusDifference& of) : of_(of), at_{0.} {
    for (std::size_t i = 1; i < of.shift.size(); ++i)
      at_.push_back(at_.back() + .5 * (of.difference[i] + of.difference[i - 1]) *
                                     (of.shift[i] - of.shift[i - 1]));
  }
  double operator()(double y) const {
    const auto next = std::upper_bound(of_.shift.begin() + 1, of_.shift.end() - 1, y);
    const auto i = static_cast<std::size_t>(next - of_.shift.begin()) - 1;
    const double into = y - of_.shift[i];
    const double slope =
        (of_.difference[i + 1] - of_.difference[i]) / (of_.shift[i + 1] - of_.shift[i]);
    return at_[i] + into * (of_.difference[i] + .5 * slope * into);
  }

 private:
  const RadiusDifference& of_;
  std::vector<double> at_;
};

}  // namespace

std::optional<double> equivalent_conicity(const RadiusDifference& of, double amplitude,
                                          double distance, double radius) {
  constexpr int kPlaces = 4000;
  constexpr double kLevel = 1e-12;  // m2: the wheelset has no wave where V rises by less
  const Potential potential(of);
  const double low = of.shift.front(), high = of.shift.back() - 2. * amplitude;
  const auto rise = [&](double from) { return potential(from + 2. * amplitude) - potential(from); };
  if (!(low < high) || !(rise(low) <= 0.) || !(rise(high) >= 0.)) return std::nullopt;
  const double from = bracketed_root(rise, low, high, 1e-12);
  const double end = potential(from);
  double length = 0., deepest = 0.;
  for (int i = 0; i < kPlaces; ++i) {
    const double angle = M_PI * (i + .5) / kPlaces;
    const double y = from + amplitude * (1. - std::cos(angle));
    const double above = end - potential(y);
    if (above < -kLevel) return std::nullopt;  // the wheelset turns back before
    deepest = std::max(deepest, above);
    length += amplitude * std::sin(angle) / std::sqrt(std::max(2. * above, 1e-300));
  }
  if (deepest < kLevel) return 0.;
  length *= 2. * M_PI / kPlaces * std::sqrt(distance * radius);
  return 2. * M_PI * M_PI * distance * radius / (length * length);
}

}  // namespace railstep
