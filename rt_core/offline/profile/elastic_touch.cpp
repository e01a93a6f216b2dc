#include "offline/profile/elastic_touch.h"

#include <algorithm>
#include <cmath>

#include "offline/math/refuse.h"
#include "offline/math/root.h"

namespace railstep {

namespace {

constexpr int kStrips = 64;               // of a patch
constexpr double kMostApproach = 3e-3;    // m
constexpr double kMostRollBeyond = 2e-3;  // rad, beyond that of rigid contact

/// Carries approaches of one wheel over its rail to patches.
class Loading {
 public:
  Loading(const WheelRail& pair, const Elastic& bodies, double outwards, double roll)
      : wheel_(pair, outwards, roll),
        radius_(pair.radius),
        modulus_(bodies.young / (1. - bodies.poisson * bodies.poisson)),
        samples_(wheel_.samples()),
        least_(wheel_.distance(wheel_.nearest())) {
    const std::vector<double>& at = samples_.distance;
    for (std::size_t i = 1; i + 1 < at.size(); ++i)
      if (at[i] <= at[i - 1] && at[i] < at[i + 1] && at[i] < least_ + kMostApproach)
        minima_.push_back(i);
  }

  [[nodiscard]] std::vector<WheelPatch> under(double approach) const {
    std::vector<WheelPatch> patches;
    double covered = samples_.first;
    for (const std::size_t i : minima_) {
      if (samples_.place(i) < covered) continue;  // in the patch before
      const std::size_t deepest = deepest_near(i, approach);
      const double above = samples_.distance[deepest] - least_;
      if (!(approach > above)) continue;
      const auto [from, to] = edges(deepest, least_ + above + kVirtualPart * (approach - above));
      patches.push_back(patch(samples_.place(deepest), from, to, approach - above));
      covered = to;
    }
    return patches;
  }
  [[nodiscard]] double upright(double approach) const {
    double sum = 0.;
    for (const WheelPatch& p : under(approach)) sum += p.force.normal * std::cos(p.deepest.angle);
    return sum;
  }
  [[nodiscard]] WheelLoaded carrying(double force) const {
    if (!(upright(kMostApproach) > force))
      refuse("E-TOUCH-02",
             "the rails do not carry " + std::to_string(force) + " N with an approach of 3 mm");
    const double approach =
        bracketed_root([&](double d) { return upright(d) - force; }, 0., kMostApproach, 1e-12);
    return {-least_ - approach, approach, under(approach)};
  }

 private:
  /// Among the minima that one patch about minimum i would cover, the deepest.
  [[nodiscard]] std::size_t deepest_near(std::size_t i, double approach) const {
    std::size_t best = i;
    for (const std::size_t other : minima_) {
      if (other <= i) continue;
      const double above = samples_.distance[best] - least_;
      const double level = least_ + above + kVirtualPart * (approach - above);
      if (samples_.place(other) < edges(best, level).second &&
          samples_.distance[other] < samples_.distance[best])
        best = other;
    }
    return best;
  }
  /// Ends of the stretch about sample i that lies below a distance.
  [[nodiscard]] std::pair<double, double> edges(std::size_t i, double level) const {
    const std::vector<double>& at = samples_.distance;
    const auto crossing = [&](std::size_t inner, std::size_t outer) {
      const double part = (level - at[inner]) / (at[outer] - at[inner]);
      return samples_.place(inner) + part * (samples_.place(outer) - samples_.place(inner));
    };
    std::size_t a = i, b = i;
    while (a > 0 && at[a - 1] < level) --a;
    while (b + 1 < at.size() && at[b + 1] < level) ++b;
    return {a > 0 ? crossing(a, a - 1) : samples_.first,
            b + 1 < at.size() ? crossing(b, b + 1) : samples_.place(at.size() - 1)};
  }
  [[nodiscard]] WheelPatch patch(double deepest, double from, double to, double upwards) const {
    const WheelTouch touch = wheel_.touch_at(deepest);
    const double cosine = std::cos(touch.angle), lowest = wheel_.distance(deepest);
    // Strips to both sides of the deepest point, of a width that covers the overlap.
    const double step = (to - from) / (kStrips - 2);
    const int before = static_cast<int>((deepest - from) / step) + 1;
    double gap[kStrips];
    for (int i = 0; i < kStrips; ++i)
      gap[i] = std::max(cosine * (wheel_.distance(deepest + (i - before) * step) - lowest), 0.);
    const double approach = cosine * upwards;
    const StripPatch strips{
        gap, kStrips, before, step / cosine, (radius_ + touch.growth) / cosine, modulus_};
    const PatchForce force = patch_force(strips, approach);
    return {touch, approach, force, wheel_.touch_at(deepest + cosine * force.centre)};
  }

  WheelOverRail wheel_;
  double radius_, modulus_;
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
  const double roll =
      bracketed_root(uneven, rigid - kMostRollBeyond, rigid + kMostRollBeyond, 1e-9);
  return {shift, roll, right(roll), left(roll)};
}

}  // namespace railstep
