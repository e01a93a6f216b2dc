#include "offline/math/band_search.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "offline/math/golden_section.h"
#include "offline/math/rational_fit.h"

namespace railstep {

namespace {

constexpr int kBetween = 24;      // places looked at between two samples
constexpr double kWidth = 4e-11;  // of a gap's part, to which a top is narrowed
constexpr int kAtOnce = 16;       // samples taken before the fits are made again
constexpr double kNoise = 1e-9;   // error of a solve, over the largest response

double size_of(const Eigen::VectorXcd& functions) { return functions.cwiseAbs().maxCoeff(); }

/// The top of a fit between two places. A peak may be far narrower than their distance.
Largest narrowed(const RationalFit& fit, double low, double high) {
  const auto [hz, size] = golden_section([&](double at) { return size_of(fit.at(at)); }, low, high,
                                         kWidth * (high - low));
  return {hz, size};
}

/// Where a sample is needed, and how much.
struct Wanted {
  double hz, amount;
};

class Search {
 public:
  Search(const Responses& responses, const std::array<double, 2>& band)
      : responses_(responses), band_(band) {}

  BandSearch run() {
    for (int i = 0; i < kFirstSolves; ++i)
      sample(band_[0] * std::pow(band_[1] / band_[0], i / (kFirstSolves - 1.)));
    while (samples() < kMostSolves && !found_.undamped_hz) {
      std::vector<Wanted> wanted = look();
      const int before = samples();
      std::sort(wanted.begin(), wanted.end(),
                [](const Wanted& a, const Wanted& b) { return a.amount > b.amount; });
      for (std::size_t i = 0; i < wanted.size() && i < kAtOnce && !found_.undamped_hz; ++i)
        sample(wanted[i].hz);
      if (samples() == before) break;
    }
    for (std::size_t g = 0; g < found_.largest.size() && !found_.undamped_hz; ++g) {
      const Largest& top = found_.largest[g];
      const auto column = static_cast<Eigen::Index>(g);
      const double beside = size_of(responses_(top.hz * (1. - kNarrowest)).col(column));
      if (beside < .5 * top.size) found_.undamped_hz = top.hz;
    }
    found_.solves = samples();
    return found_;
  }

 private:
  int samples() const { return static_cast<int>(known_.size()); }

  void sample(double hz) {
    // A frequency next to a known one gives no new information.
    const auto next = known_.lower_bound(hz - kNarrowest * hz);
    if (next != known_.end() && next->first < hz + kNarrowest * hz) return;
    const Eigen::MatrixXcd values = responses_(hz);
    if (!values.allFinite()) {
      found_.undamped_hz = hz;
      return;
    }
    known_[hz] = values;
    found_.largest.resize(static_cast<std::size_t>(values.cols()));
    for (std::size_t g = 0; g < found_.largest.size(); ++g) {
      const double size = size_of(values.col(static_cast<Eigen::Index>(g)));
      if (size > found_.largest[g].size) found_.largest[g] = {hz, size};
    }
  }

  /// Fits all groups, and finds the gaps between samples that need more of them.
  std::vector<Wanted> look() {
    std::vector<double> hz;
    for (const auto& [at, values] : known_) hz.push_back(at);
    std::vector<Wanted> wanted(hz.size() - 1, {0., 0.});
    found_.unresolved = 0.;
    for (std::size_t g = 0; g < found_.largest.size(); ++g) look(g, hz, wanted);
    wanted.erase(std::remove_if(wanted.begin(), wanted.end(),
                                [](const Wanted& w) { return w.amount == 0.; }),
                 wanted.end());
    return wanted;
  }

  void look(std::size_t group, const std::vector<double>& hz, std::vector<Wanted>& wanted) {
    const auto column = static_cast<Eigen::Index>(group);
    Eigen::MatrixXcd values(known_.begin()->second.rows(), static_cast<Eigen::Index>(hz.size()));
    for (std::size_t i = 0; i < hz.size(); ++i)
      values.col(static_cast<Eigen::Index>(i)) = known_.at(hz[i]).col(column);
    const RationalFit one(hz, values, 0), other(hz, values, 1);
    const double largest = found_.largest[group].size;
    const double least = std::max(kAgree * kAgree * largest, kNoise * found_.largest.back().size);
    std::vector<double> places = {hz.front()}, sizes;  // where the fits are looked at
    for (std::size_t gap = 0; gap + 1 < hz.size(); ++gap)
      for (int i = 1; i <= kBetween; ++i)
        places.push_back(i == kBetween ? hz[gap + 1]
                                       : hz[gap] + (hz[gap + 1] - hz[gap]) * i / kBetween);
    for (const double at : places) {
      const Eigen::VectorXcd a = one.at(at);
      const double difference = (a - other.at(at)).cwiseAbs().maxCoeff();
      sizes.push_back(size_of(a));
      const double agree = std::max(kAgree * sizes.back(), least);
      found_.unresolved = std::max(found_.unresolved, difference / largest);
      if (difference <= agree) continue;
      const auto after = std::upper_bound(hz.begin() + 1, hz.end() - 1, at) - hz.begin();
      Wanted& gap = wanted[static_cast<std::size_t>(after - 1)];
      if (difference / agree > gap.amount) gap = {at, difference / agree};
    }
    for (std::size_t i = 1; i + 1 < places.size(); ++i) {
      if (sizes[i] < sizes[i - 1] || sizes[i] < sizes[i + 1]) continue;
      const Largest top = narrowed(one, places[i - 1], places[i + 1]);
      const double larger = top.size / largest - (1. + kMet);
      found_.unresolved = std::max(found_.unresolved, larger);
      if (larger > 0.) wanted.push_back({top.hz, larger / kAgree});
    }
  }

  const Responses& responses_;
  std::array<double, 2> band_;
  std::map<double, Eigen::MatrixXcd> known_;
  BandSearch found_;
};

}  // namespace

BandSearch largest_over(const Responses& responses, const std::array<double, 2>& band) {
  return Search(responses, band).run();
}

}  // namespace railstep
