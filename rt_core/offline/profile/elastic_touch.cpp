#include "offline/profile/elastic_touch.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "offline/math/golden_section.h"
#include "offline/math/refuse.h"
#include "offline/math/root.h"

namespace railstep {

namespace {

constexpr int kStrips = 64;               // of a patch
constexpr double kBesideRail = .5;        // m: distances beside the rail are larger
constexpr double kFinePlace = 1e-8;       // m
constexpr double kFirstApproach = 5e-5;   // m
constexpr double kMostApproach = 3e-3;    // m
constexpr double kMostRollBeyond = 1e-2;  // rad, beyond that of rigid contact

/// Carries approaches of one wheel over its rail to patches.
class Loading {
 public:
  Loading(const WheelRail& pair, const Elastic& bodies, double outwards, double roll)
      : wheel_(pair, outwards, roll),
        roll_(roll),
        radius_(pair.radius),
        modulus_(bodies.young / (1. - bodies.poisson * bodies.poisson)),
        samples_(wheel_.samples()),
        least_(wheel_.distance(wheel_.nearest().s)) {
    const std::vector<double>& at = samples_.distance;
    for (std::size_t i = 1; i + 1 < at.size(); ++i)
      if (at[i] <= at[i - 1] && at[i] < at[i + 1] && at[i] < least_ + kMostApproach &&
          at[i - 1] < kBesideRail && at[i + 1] < kBesideRail)
        minima_.push_back(i);
  }

  /// A patch under some approach: its deepest sample and point, and the ridges to its neighbours.
  struct Valley {
    std::size_t deepest, first, last;
    double place;  // on the wheel, m
  };
  /// Which minima share a patch under an approach.
  [[nodiscard]] std::vector<Valley> valleys(double approach) const {
    std::vector<Valley> found;
    for (const std::size_t i : minima_) {
      if (!found.empty() && share(found.back().deepest, i, approach)) {
        if (samples_.distance[i] < samples_.distance[found.back().deepest])
          found.back().deepest = i;
        continue;
      }
      found.push_back({i, 0, samples_.distance.size() - 1, 0.});
    }
    for (std::size_t k = 1; k < found.size(); ++k)
      found[k - 1].last = found[k].first = ridge(found[k - 1].deepest, found[k].deepest);
    for (Valley& valley : found)
      valley.place = golden_section([this](double s) { return -wheel_.distance(s); },
                                    samples_.place(valley.deepest - 1),
                                    samples_.place(valley.deepest + 1), kFinePlace)
                         .first;
    return found;
  }
  [[nodiscard]] std::vector<WheelPatch> under(double approach,
                                              const std::vector<Valley>& all) const {
    std::vector<WheelPatch> patches;
    for (const Valley& valley : all) {
      const double above = std::max(wheel_.distance(valley.place) - least_, 0.);
      if (!(approach > above)) continue;
      const auto [from, to] = edges(valley, level(above, approach));
      if (from < valley.place && valley.place < to)
        patches.push_back(patch(valley.place, from, to, approach - above));
    }
    return patches;
  }
  [[nodiscard]] double upright(double approach, const std::vector<Valley>& all) const {
    double sum = 0.;
    for (const WheelPatch& p : under(approach, all)) sum += p.upright;
    return sum;
  }
  [[nodiscard]] WheelLoaded carrying(double force) const {
    // Which minima share a patch is decided at the approach before, and kept in the search.
    double approach = kFirstApproach;
    std::vector<Valley> all;
    for (int turn = 0; turn < 4; ++turn) {
      all = valleys(approach);
      if (!(force > 0.) || !(upright(kMostApproach, all) > force))
        refuse("E-TOUCH-02",
               "the rails do not carry " + std::to_string(force) + " N with an approach of 3 mm");
      approach = bracketed_root([&](double d) { return upright(d, all) - force; }, 0.,
                                kMostApproach, 1e-12);
    }
    return {-least_ - approach, approach, under(approach, all)};
  }

 private:
  /// Distance up to which the bodies overlap, by the law, about a point.
  [[nodiscard]] double level(double above, double approach) const {
    return least_ + above + kVirtualPart * (approach - above);
  }
  [[nodiscard]] std::size_t ridge(std::size_t left, std::size_t right) const {
    const auto first = samples_.distance.begin();
    return static_cast<std::size_t>(
        std::max_element(first + static_cast<std::ptrdiff_t>(left),
                         first + static_cast<std::ptrdiff_t>(right) + 1) -
        first);
  }
  /// The overlap about the deeper of two minima goes beyond the ridge between them.
  [[nodiscard]] bool share(std::size_t left, std::size_t right, double approach) const {
    const double above = std::min(samples_.distance[left], samples_.distance[right]) - least_;
    return samples_.distance[ridge(left, right)] < level(above, approach);
  }
  /// First and last place of a valley that lies below a distance.
  [[nodiscard]] std::pair<double, double> edges(const Valley& valley, double below) const {
    const std::vector<double>& at = samples_.distance;
    const auto crossing = [&](std::size_t inner, std::size_t outer) {
      const double part = (below - at[inner]) / (at[outer] - at[inner]);
      return samples_.place(inner) + part * (samples_.place(outer) - samples_.place(inner));
    };
    std::size_t a = valley.first, b = valley.last;
    while (a < valley.deepest && !(at[a] < below)) ++a;
    while (b > valley.deepest && !(at[b] < below)) --b;
    return {a > valley.first ? crossing(a, a - 1) : samples_.place(a),
            b < valley.last ? crossing(b, b + 1) : samples_.place(b)};
  }
  [[nodiscard]] WheelPatch patch(double deepest, double from, double to, double upwards) const {
    const WheelTouch touch = wheel_.touch_at(deepest);
    const double lowest = wheel_.distance(deepest);
    // Strips to both sides of the deepest point, of a width that covers the overlap.
    const double step = (to - from) / (kStrips - 2);
    const int before = static_cast<int>((deepest - from) / step) + 1;
    double gap[kStrips];
    for (int i = 0; i < kStrips; ++i) {
      const double place = deepest + (i - before) * step;
      gap[i] = place < from || place > to ? 1.  // beyond the overlap, or in the next patch
                                          : std::max(wheel_.distance(place) - lowest, 0.);
    }
    StripPatch strips{gap, kStrips, 1. * before, {}, step, 1., modulus_};
    strips.hold = hold_of(strips, upwards);
    const WheelTouch mean =
        wheel_.touch_at(deepest + step * (.5 * (strips.hold.first + strips.hold.second) - before));
    const double cosine = std::cos(mean.angle);          // along the wheel's profile
    const double normal = std::cos(mean.angle + roll_);  // of the normal to the upright
    for (double& own : gap) own *= normal;
    strips.hold.gap *= normal;
    strips.width /= cosine;
    strips.radius = (radius_ + mean.growth) / cosine;
    const double approach = normal * upwards;
    const PatchForce force = patch_force(strips, approach);
    return {touch, approach, normal * force.normal, force,
            wheel_.touch_at(deepest + cosine * force.centre)};
  }

  WheelOverRail wheel_;
  double roll_, radius_, modulus_;
  WheelOverRail::Samples samples_;
  double least_;
  std::vector<std::size_t> minima_;
};

}  // namespace

double WheelLoaded::growth() const {
  double sum = 0., forces = 0.;
  for (const WheelPatch& p : patches) {
    sum += p.force.normal * p.centre.growth;
    forces += p.force.normal;
  }
  return sum / forces;
}

WheelsetLoaded loaded(const WheelRail& pair, const Elastic& bodies, double shift, double force) {
  const auto right = [&](double roll) {
    return Loading(pair, bodies, shift, roll).carrying(force);
  };
  const auto left = [&](double roll) {
    return Loading(pair, bodies, -shift, -roll).carrying(force);
  };
  const auto uneven = [&](double roll) { return left(roll).height - right(roll).height; };
  const double rigid = touch(pair, shift, true).roll;
  const double low = rigid - kMostRollBeyond, high = rigid + kMostRollBeyond;
  if (!(uneven(low) < 0.) || !(uneven(high) > 0.))
    refuse("E-TOUCH-05", "at a shift of " + std::to_string(1e3 * shift) +
                             " mm no roll lets both wheels carry " + std::to_string(force) + " N");
  const double roll = bracketed_root(uneven, low, high, 1e-9);
  return {shift, roll, right(roll), left(roll)};
}

}  // namespace railstep
