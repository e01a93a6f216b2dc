#include "offline/condense/line_flexibility.h"

#include <algorithm>

#include "offline/math/refuse.h"
#include "offline/track/pad.h"
#include "offline/track/squeeze.h"

namespace railstep {

void load_row(const Track& track, const LoadPoint& load_point, double* row) {
  const double lever[3] = {1., load_point.y, load_point.z};
  const double along[3] = {0., load_point.direction == 1 ? 1. : 0.,
                           load_point.direction == 2 ? 1. : 0.};
  double own[3];
  to_rail(track.lean(load_point.rail), along, own);
  for (int k = 0; k < 9; ++k) row[k] = lever[k / 3] * own[k % 3];
}

int tabled_elements(const Track& track) {
  return track.ring ? track.elements_per_bay : track.elements();
}

int shifted(const Track& track, int element, int shift) {
  const int elements = track.elements(), e2 = element + shift;
  if (track.ring) return (e2 % elements + elements) % elements;
  return e2 >= 0 && e2 < elements ? e2 : -1;
}

std::vector<int> carried_unknowns(const Line& line, int rail) {
  std::vector<int> found;
  for (int k = 0; k < 9; ++k)
    if (line.unknown(rail, 1, k) >= 0 && !(line.rigid_section && k == 7)) found.push_back(k);
  return found;
}

Line matching(const Track& other, const Line& line) {
  const auto carries_all = [&](const Line& there, int rail) {
    const std::vector<int> more = carried_unknowns(there, rail),
                           some = carried_unknowns(line, rail);
    return std::includes(more.begin(), more.end(), some.begin(), some.end());
  };
  for (Line& there : assemble(other))
    if (there.rail_factor == line.rail_factor && carries_all(there, 0) && carries_all(there, 1))
      return std::move(there);
  refuse("E-CONDENSE-14", "a line does not belong to its track");
}

namespace {

/// A divided line of the track with the section's strain; it owns that track. If the track's
/// unknowns do not carry a rail along x, readings along x count from its axis, and sleepers stay.
class StrainedLine : public LineFlexibility {
 public:
  StrainedLine(const Track& track, const Line& line, int parts)
      : track_(with_strain(track)),
        line_(matching(track_, line)),
        carries_along_(carries_along(line)),
        divided_(exact_line(track_, line_, parts)) {}

  Eigen::VectorXd under(const LoadPoint& load_point, const LoadPoint& other,
                        int points) const override {
    return divided_->under(load_point, other, points);
  }
  Strip between(const LoadPoint& a, const LoadPoint& b, int points, int range) const override {
    return divided_->between(a, b, points, range);
  }
  Eigen::VectorXd from(const LoadPoint& load_point, const Functional& functional, int points,
                       Elements at) const override {
    return divided_->from(load_point, counted_from_axis(functional), points, at);
  }
  Eigen::VectorXd flexibility(const std::vector<Functional>& reads,
                              const Functional& force) const override {
    std::vector<Functional> those;
    those.reserve(reads.size());
    for (const Functional& one : reads) those.push_back(counted_from_axis(one));
    return divided_->flexibility(those, counted_from_axis(force));
  }
  bool held() const override { return divided_->held(); }

 private:
  static bool carries_along(const Line& line) {
    const std::vector<int> own = carried_unknowns(line, line.first_rail());
    return std::find(own.begin(), own.end(), 0) != own.end();
  }
  Functional counted_from_axis(Functional functional) const {
    if (carries_along_) return functional;
    const std::vector<Functional::OnRail> whole = functional.rail;
    for (const Functional::OnRail& one : whole)
      if (one.at.direction == 0)
        functional.rail.push_back({{one.at.rail, one.at.x, 0., 0., 0}, -one.factor});
    std::erase_if(functional.sleeper,
                  [](const Functional::OnSleeper& one) { return one.direction == 0; });
    return functional;
  }

  Track track_;
  Line line_;
  bool carries_along_;
  std::unique_ptr<LineFlexibility> divided_;
};

}  // namespace

std::unique_ptr<LineFlexibility> exact_line(const Track& track, const Line& line, int parts) {
  if (parts > 1 && !strains_section(track.unknowns))
    return std::make_unique<StrainedLine>(track, line, parts);
  if (has_long_pads(track)) return std::make_unique<RefinedLine>(track, line, parts);
  return std::make_unique<DividedLine>(track, line, parts);
}

bool same_rail(const Line& line, int a, int b) { return a == b || line.mirrored; }

int element_at(const Track& track, double x) { return place_on(track, x).element; }

Eigen::VectorXd sleeper_load(const Track& track, const Line& line, const Functional& functional) {
  Eigen::VectorXd load = Eigen::VectorXd::Zero(line.unknowns());
  for (const Functional::OnSleeper& at : functional.sleeper)
    load += at.factor * sleeper_row(track, line, at.rail, at.seat, at.direction);
  return part_in(track, functional) * load;
}

}  // namespace railstep
