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
        minima_.push_back(
            {i, golden_section([this](double s) { return -wheel_.distance(s); },
                               samples_.place(i - 1), samples_.place(i + 1), kFinePlace)
                    .first});
  }

  /// A patch under some approach: its deepest sample and point, and the ridges to its neighbours.
  struct Valley {
    std::size_t deepest, first, last;
    double place;  // on the wheel, m
    double share;  // WheelPatch::share
  };
  /// Which minima share a patch under an approach, and how far.
  [[nodiscard]] std::vector<Valley> valleys(double approach) const {
    std::vector<Valley> found;
    for (const auto& [at, place] : minima_) {
      if (!found.empty() && !(apart(found.back().deepest, at, approach) > 0.)) {
        Valley& last = found.back();
        if (samples_.distance[at] < samples_.distance[last.deepest])
          last = {at, last.first, last.last, place, 1.};
        continue;
      }
      found.push_back({at, 0, samples_.distance.size() - 1, place, 1.});
    }
    for (std::size_t k = 1; k < found.size(); ++k)
      found[k - 1].last = found[k].first = ridge(found[k - 1].deepest, found[k].deepest);
    return with_shares(found, approach);
  }
  [[nodiscard]] std::vector<WheelPatch> under(double approach) const {
    std::vector<WheelPatch> patches;
    for (const Valley& valley : valleys(approach)) {
      const double above = std::max(wheel_.distance(valley.place) - least_, 0.);
      if (!(approach > above)) continue;
      const auto [from, to] = edges(valley, level(above, approach));
      if (from < valley.place && valley.place < to)
        patches.push_back(patch(valley.place, from, to, approach - above, valley.share));
    }
    return patches;
  }
  [[nodiscard]] double upright(double approach) const {
    double sum = 0.;
    for (const WheelPatch& p : under(approach)) sum += p.upright;
    return sum;
  }
  [[nodiscard]] WheelLoaded carrying(double force) const {
    if (!(force > 0.) || !(upright(kMostApproach) > force))
      refuse("E-TOUCH-02",
             "the rails do not carry " + std::to_string(force) + " N with an approach of 3 mm");
    const double approach =
        bracketed_root([&](double d) { return upright(d) - force; }, 0., kMostApproach, 1e-12);
    return {-least_ - approach, approach, under(approach)};
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
  /// patches_apart() of two minima under an approach.
  [[nodiscard]] double apart(std::size_t left, std::size_t right, double approach) const {
    const auto gap = [&](std::size_t i) { return samples_.distance[i] - least_ - approach; };
    const double a = gap(left), b = gap(right);
    return patches_apart(std::min(a, b), std::max(a, b), gap(ridge(left, right)), kLeastPatchDepth);
  }
  /// Valleys, and those that are next to each other as one, with the shares that they have.
  [[nodiscard]] std::vector<Valley> with_shares(const std::vector<Valley>& found,
                                                double approach) const {
    const std::vector<double>& at = samples_.distance;
    const auto from_next = [&](int k) {
      const auto own = static_cast<std::size_t>(k);
      return apart(found[own - 1].deepest, found[own].deepest, approach);
    };
    std::vector<Valley> all;
    for_each_share(
        static_cast<int>(found.size()), from_next, [&](int first, int last, double share) {
          const auto from = found.begin() + first, to = found.begin() + last;
          Valley one = *std::min_element(from, to + 1, [&](const Valley& a, const Valley& b) {
            return at[a.deepest] < at[b.deepest];
          });
          one.first = from->first;
          one.last = to->last;
          one.share = share;
          all.push_back(one);
        });
    return all;
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
  [[nodiscard]] WheelPatch patch(double deepest, double from, double to, double upwards,
                                 double share) const {
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
    strips.collocation = collocation_of(strips, upwards);
    const WheelTouch mean = wheel_.touch_at(
        deepest + step * (.5 * (strips.collocation.first + strips.collocation.second) - before));
    const double cosine = std::cos(mean.angle);          // along the wheel's profile
    const double normal = std::cos(mean.angle + roll_);  // of the normal to the upright
    for (double& own : gap) own *= normal;
    strips.collocation.gap *= normal;
    strips.width /= cosine;
    strips.radius = (radius_ + mean.growth) / cosine;
    const double approach = normal * upwards;
    PatchForce force = patch_force(strips, approach);
    force.normal *= share;
    force.stiffness *= share;
    return {touch,
            approach,
            normal * force.normal,
            force,
            wheel_.touch_at(deepest + cosine * force.centre),
            share};
  }

  WheelOverRail wheel_;
  double roll_, radius_, modulus_;
  WheelOverRail::Samples samples_;
  double least_;
  struct Least {
    std::size_t sample;
    double place;  // on the wheel, m
  };
  std::vector<Least> minima_;
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
