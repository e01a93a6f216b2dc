#include "offline/profile/smoothing.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <string>

#include "offline/math/refuse.h"
#include "offline/math/root.h"

namespace railstep {

namespace {

constexpr double kGap = 5e-3;   // m
constexpr double kKink = .35;   // rad
constexpr double kSwing = .5;   // rad, of a spline away from the chord of two points
constexpr double kFarOff = 8.;  // tolerances

using Sparse = Eigen::SparseMatrix<double>;

std::string place_of(const Point& p) { return std::to_string(1e3 * p[0]) + " mm"; }

void check_count(std::size_t points) {
  if (points < 4)
    refuse("E-POINTS-01", "there are " + std::to_string(points) + " points; expected at least 4");
}

void check_points(std::span<const Point> points) {
  check_count(points.size());
  std::vector<double> spacing;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!std::isfinite(points[i][0]) || !std::isfinite(points[i][1]))
      refuse("E-POINTS-02", "point " + std::to_string(i + 1) + " is not finite");
    if (i == 0) continue;
    spacing.push_back(distance(points[i - 1], points[i]));
    if (spacing.back() == 0.)
      refuse("E-POINTS-07", "point " + std::to_string(i + 1) + " at " + place_of(points[i]) +
                                " is the one before it again");
  }
  std::vector<double> sorted = spacing;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2),
                   sorted.end());
  const double middle = sorted[sorted.size() / 2];
  for (std::size_t i = 0; i < spacing.size(); ++i)
    if (spacing[i] > kGap && spacing[i] > 5. * middle)
      refuse("E-POINTS-04", "the points leave a gap from " + place_of(points[i]) + " to " +
                                place_of(points[i + 1]));
}

/// Turns of the chords at inner points, rad.
void check_kinks(std::span<const Point> points) {
  std::vector<double> kink(points.size(), 0.);
  const auto angle = [&](std::size_t i) {
    return std::atan2(points[i + 1][1] - points[i][1], points[i + 1][0] - points[i][0]);
  };
  for (std::size_t i = 1; i + 1 < points.size(); ++i) kink[i] = std::abs(angle(i) - angle(i - 1));
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const double beside = .5 * (kink[i - 1] + kink[i + 1]);
    if (kink[i] > kKink && kink[i] > 4. * beside)
      refuse("E-POINTS-05", "the points turn by " + std::to_string(kink[i]) + " rad at " +
                                place_of(points[i]) + "; expected a surface without a kink");
  }
}

/// Refuses a spline that swings between two of its points, as beside a step of steep sides: its
/// ends and its middle turn away from the chord.
void check_swing(const RunningSurface& spline) {
  for (const SurfacePiece& piece : spline.pieces()) {
    const double h = piece.to - piece.from;
    const auto& c = piece.coefficients;
    const double chord = std::atan(c[1] + h * (c[2] + h * c[3]));
    for (const double y : {0., .5 * h, h}) {
      const double swing = std::abs(std::atan(c[1] + y * (2. * c[2] + y * 3. * c[3])) - chord);
      if (swing > kSwing)
        refuse("E-POINTS-08", "between " + std::to_string(1e3 * piece.from) + " mm and " +
                                  std::to_string(1e3 * piece.to) + " mm the surface turns by " +
                                  std::to_string(swing) +
                                  " rad away from the line between its points; expected " +
                                  std::to_string(kSwing) + " rad at most");
    }
  }
}

/// The matrix that makes jumps of the chords' slopes of a cubic spline's second derivatives at its
/// inner points. @param h  spacings
Sparse over_spacings(const Eigen::VectorXd& h) {
  const Eigen::Index inner = h.size() - 1;
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index i = 0; i < inner; ++i) {
    entries.emplace_back(i, i, (h[i] + h[i + 1]) / 3.);
    if (i + 1 == inner) continue;
    entries.emplace_back(i, i + 1, h[i + 1] / 6.);
    entries.emplace_back(i + 1, i, h[i + 1] / 6.);
  }
  Sparse matrix(inner, inner);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// Reinsch's problem for both coordinates over the length of the chords: with values z, second
/// derivatives g at inner points and mean spacing 1,
///   (R + p Q'Q) g = Q' z,  f = z - p Q g.
class Reinsch {
 public:
  using Values = Eigen::Matrix<double, Eigen::Dynamic, 2>;

  explicit Reinsch(std::span<const Point> points)
      : count_(static_cast<int>(points.size())), z_(count_, 2), Q_(count_, count_ - 2) {
    Eigen::VectorXd h(count_ - 1);
    for (int i = 0; i < count_; ++i) {
      const auto k = static_cast<std::size_t>(i);
      z_.row(i) << points[k][0], points[k][1];
      if (i > 0) h[i - 1] = distance(points[k - 1], points[k]);
    }
    h /= h.mean();
    std::vector<Eigen::Triplet<double>> q;
    for (int i = 0; i + 2 < count_; ++i) {
      q.emplace_back(i, i, 1. / h[i]);
      q.emplace_back(i + 1, i, -1. / h[i] - 1. / h[i + 1]);
      q.emplace_back(i + 2, i, 1. / h[i + 1]);
    }
    Q_.setFromTriplets(q.begin(), q.end());
    R_ = over_spacings(h);
  }
  /// The smoothed points.
  [[nodiscard]] Values at(double p) const {
    const Sparse K = R_ + p * Sparse(Q_.transpose() * Q_);
    const Values bent = Q_.transpose() * z_;
    const Values g = Eigen::SimplicialLDLT<Sparse>(K).solve(bent);
    return z_ - p * (Q_ * g);
  }
  /// Distances from the points, m.
  [[nodiscard]] Eigen::VectorXd off(const Values& smooth) const {
    return (smooth - z_).rowwise().norm();
  }
  [[nodiscard]] double rms(const Values& smooth) const {
    return off(smooth).norm() / std::sqrt(static_cast<double>(count_));
  }
  /// The smoothed points with a root mean square of `tolerance`.
  [[nodiscard]] Values within(double tolerance) const {
    if (tolerance == 0.) return z_;
    const auto over = [&](double exponent) { return rms(at(std::pow(10., exponent))) - tolerance; };
    constexpr double kStiffest = 12., kSoftest = -12.;
    if (over(kStiffest) <= 0.) return at(std::pow(10., kStiffest));
    if (over(kSoftest) >= 0.) return z_;
    return at(std::pow(10., bracketed_root(over, kSoftest, kStiffest, 1e-9)));
  }

 private:
  int count_;
  Values z_;
  Sparse Q_, R_;
};

}  // namespace

RunningSurface through(std::span<const Point> points) {
  check_count(points.size());
  const auto count = static_cast<Eigen::Index>(points.size());
  Eigen::VectorXd y(count), z(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    y[i] = points[static_cast<std::size_t>(i)][0];
    z[i] = points[static_cast<std::size_t>(i)][1];
  }
  const Eigen::VectorXd h = y.tail(count - 1) - y.head(count - 1);
  for (Eigen::Index i = 0; i + 1 < count; ++i)
    if (!(h[i] > 0.))
      refuse("E-POINTS-03", "point " + std::to_string(i + 2) + " at " +
                                std::to_string(1e3 * y[i + 1]) +
                                " mm is not beyond the one before it; expected lateral places "
                                "that rise");
  const Eigen::VectorXd chord = (z.tail(count - 1) - z.head(count - 1)).cwiseQuotient(h);
  Eigen::VectorXd second = Eigen::VectorXd::Zero(count);
  second.segment(1, count - 2) =
      Eigen::SimplicialLDLT<Sparse>(over_spacings(h))
          .solve(Eigen::VectorXd(chord.tail(count - 2) - chord.head(count - 2)));
  std::vector<SurfacePiece> pieces;
  for (Eigen::Index i = 0; i + 1 < count; ++i) {
    const double a = second[i], b = second[i + 1];
    pieces.push_back({y[i],
                      y[i + 1],
                      y[i],
                      0.,
                      0.,
                      {z[i], chord[i] - h[i] * (2. * a + b) / 6., .5 * a, (b - a) / (6. * h[i])}});
  }
  RunningSurface spline(std::move(pieces));
  check_swing(spline);
  return spline;
}

SmoothedPoints smoothed(std::span<const Point> points, double tolerance) {
  check_points(points);
  check_kinks(points);
  const Reinsch problem(points);
  const Reinsch::Values smooth = problem.within(tolerance);
  const Eigen::VectorXd off = problem.off(smooth);
  Eigen::Index worst = 0;
  const double largest = off.maxCoeff(&worst);
  if (tolerance > 0. && largest > kFarOff * tolerance)
    refuse("E-POINTS-06", "the point at " + place_of(points[static_cast<std::size_t>(worst)]) +
                              " lies " + std::to_string(1e3 * largest) +
                              " mm off the smoothed surface; expected at most " +
                              std::to_string(1e3 * kFarOff * tolerance) + " mm, 8 tolerances");
  SmoothedPoints made{{}, problem.rms(smooth), largest};
  for (Eigen::Index i = 0; i < smooth.rows(); ++i)
    made.points.push_back({smooth(i, 0), smooth(i, 1)});
  return made;
}

}  // namespace railstep
