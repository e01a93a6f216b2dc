#include "offline/receptance/end_reflection.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <string>

#include "offline/condense/line_flexibility.h"
#include "offline/math/complex.h"
#include "offline/math/refuse.h"
#include "offline/track/end_zone.h"
#include "offline/track/pad.h"

namespace railstep {

namespace {

using Matrix = Eigen::MatrixXcd;

constexpr int kDoublings = 40;
constexpr double kFar = 8.;  // bays over which waves sort themselves

/// Eliminates the rows between the first and the last `d`, on which no force acts.
Matrix ends_of(const Matrix& chain, Eigen::Index d) {
  const Eigen::Index inner = chain.rows() - 2 * d;
  Matrix ends(2 * d, 2 * d), to(2 * d, inner);
  ends << chain.topLeftCorner(d, d), chain.topRightCorner(d, d), chain.bottomLeftCorner(d, d),
      chain.bottomRightCorner(d, d);
  to << chain.block(0, d, d, inner), chain.block(d + inner, d, d, inner);
  const Matrix within = chain.block(d, d, inner, inner);
  return ends - to * within.partialPivLu().solve(to.transpose());
}

/// Stiffness of a part at its first border if `beyond` follows its last one.
Matrix before(const Matrix& part, const Matrix& beyond) {
  const Eigen::Index d = beyond.rows();
  const Matrix across = part.topRightCorner(d, d);
  const Matrix last = part.bottomRightCorner(d, d) + beyond;
  return part.topLeftCorner(d, d) - across * last.partialPivLu().solve(across.transpose());
}

/// The same part repeated without end: doubled until the far end has no effect.
Matrix for_ever(Matrix part) {
  const Eigen::Index d = part.rows() / 2;
  for (int i = 0; i < kDoublings; ++i) {
    Matrix two = Matrix::Zero(3 * d, 3 * d);
    two.topLeftCorner(2 * d, 2 * d) += part;
    two.bottomRightCorner(2 * d, 2 * d) += part;
    const Matrix joined = ends_of(two, d);
    const double change = (joined - part).topLeftCorner(d, d).norm();
    part = joined;
    if (change < 1e-14 * part.topLeftCorner(d, d).norm()) return part.topLeftCorner(d, d);
  }
  fail("E-RECEPTANCE-02",
       "waves run without damping along a track without end; expected damping in its pads or "
       "ballast, or other frequencies");
}

void check(const Track& track) {
  if (track.cant != 0.)
    refuse("E-RECEPTANCE-03",
           "the reflection of an end is found for upright rails only; expected no cant");
  if (!track.changed_seats.empty() || track.right || has_long_pads(track) || track.state ||
      !track.joints.empty())
    refuse("E-RECEPTANCE-04",
           "the reflection of an end is found for a uniform track at rest only; expected equal "
           "seats and rails, no joints, and pads that are points");
  if (track.ends[1] != RailEnd::free && track.ends[1] != RailEnd::non_reflecting)
    refuse("E-RECEPTANCE-05",
           "the reflection of an end is not found for an end that is held; expected a free or "
           "non-reflecting far end");
  if (track.bays < 3)
    refuse("E-RECEPTANCE-06",
           "the track has " + std::to_string(track.bays) + " bays; expected 3 or more for a wave");
}

/// Sections that do not strain: b_y = -a_z.
void tie_roll(Matrix27& matrix) {
  for (int node = 0; node < 27; node += 9) matrix.col(node + 5) -= matrix.col(node + 7).eval();
  for (int node = 0; node < 27; node += 9) matrix.row(node + 5) -= matrix.row(node + 7).eval();
}

/// Entries of K + i omega C - omega^2 M at unknowns of a line.
Matrix dynamic_block(const Line& line, const std::vector<int>& unknowns, double omega) {
  const auto n = static_cast<Eigen::Index>(unknowns.size());
  Matrix block(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) {
      const int a = unknowns[static_cast<std::size_t>(i)],
                b = unknowns[static_cast<std::size_t>(j)];
      block(i, j) =
          ComplexNumber(line.stiffness.coeff(a, b) - omega * omega * line.mass.coeff(a, b),
                        omega * line.damping.coeff(a, b));
    }
  return block;
}

}  // namespace

EndReflection::EndReflection(const Track& track, const Line& line, int direction)
    : track_(track), line_(line) {
  check(track);
  const int rail = line.first_rail();
  carried_ = carried_unknowns(line, rail);
  const auto driven = std::find(carried_.begin(), carried_.end(), direction);
  if (driven == carried_.end())
    refuse("E-RECEPTANCE-07", "the line does not move in this direction");
  driven_ = driven - carried_.begin();
  mirror_.resize(static_cast<Eigen::Index>(carried_.size()));
  for (std::size_t i = 0; i < carried_.size(); ++i)
    mirror_[static_cast<Eigen::Index>(i)] = carried_[i] % 3 == 0 ? -1. : 1.;
  const BeamSection section = track.bar(rail).section;
  element_ = element_matrices(section, track.law(rail), track.element_length());
  if (line.rigid_section) {
    tie_roll(element_.stiffness);
    tie_roll(element_.mass);
  }
  zone_ = track.bays - (track.ends[1] == RailEnd::free ? 1 : track.end_zone_bays);
}

/// @param number  of the bay; below 0: one far from the ends
Matrix EndReflection::bay(double omega, int number) const {
  const auto d = static_cast<Eigen::Index>(carried_.size());
  const int n = track_.elements_per_bay;
  Matrix chain = Matrix::Zero((2 * n + 1) * d, (2 * n + 1) * d);
  for (int e = 0; e < n; ++e) {
    const double taken =
        number < 0 ? 0. : end_damping_rate(track_, line_.first_rail(), number * n + e);
    const ComplexNumber inertia(-omega * omega, omega * taken);
    for (Eigen::Index j = 0; j < 3 * d; ++j)
      for (Eigen::Index i = 0; i < 3 * d; ++i) {
        const auto at = static_cast<int>(9 * (i / d)) + carried_[static_cast<std::size_t>(i % d)];
        const auto to = static_cast<int>(9 * (j / d)) + carried_[static_cast<std::size_t>(j % d)];
        chain(2 * e * d + i, 2 * e * d + j) +=
            element_.stiffness(at, to) + inertia * element_.mass(at, to);
      }
  }
  return ends_of(chain, d);
}

/// Half of what the line has at a border far from the ends beyond the rail itself.
Matrix EndReflection::half_seat(double omega) const {
  const int border = track_.bays / 2, node = border * 2 * track_.elements_per_bay;
  const auto d = static_cast<Eigen::Index>(carried_.size());
  std::vector<int> unknowns;
  for (const int k : carried_) unknowns.push_back(line_.unknown(line_.first_rail(), node, k));
  for (const int u : line_.sleeper_unknown_of[static_cast<std::size_t>(border)])
    if (u >= 0) unknowns.push_back(u);
  Matrix seat = dynamic_block(line_, unknowns, omega);
  for (Eigen::Index i = 0; i < d; ++i)
    for (Eigen::Index j = 0; j < d; ++j)
      for (const int own : {0, 18}) {  // of the elements on both sides
        const int at = own + carried_[static_cast<std::size_t>(i)],
                  to = own + carried_[static_cast<std::size_t>(j)];
        seat(i, j) -= element_.stiffness(at, to) - omega * omega * element_.mass(at, to);
      }
  const Eigen::Index inner = seat.rows() - d;
  Matrix on_rail = seat.topLeftCorner(d, d);
  if (inner > 0) {
    const Matrix sleeper = seat.bottomRightCorner(inner, inner);
    on_rail -= seat.topRightCorner(d, inner) *
               sleeper.partialPivLu().solve(seat.bottomLeftCorner(inner, d));
  }
  return .5 * on_rail;
}

/// Stiffness of the zone and its end at the zone's first border.
Matrix EndReflection::end(double omega, const Matrix& half) const {
  const Eigen::Index d = half.rows();
  Matrix beyond = half;  // the last seat is a whole one
  for (int number = track_.bays - 1; number >= zone_; --number) {
    Matrix part = bay(omega, number);
    part.topLeftCorner(d, d) += half;
    part.bottomRightCorner(d, d) += half;
    beyond = before(part, beyond);
  }
  return beyond;
}

Reflection EndReflection::at(double hz) const {
  const double omega = 2. * M_PI * hz;
  const auto d = static_cast<Eigen::Index>(carried_.size());
  const Matrix half = half_seat(omega);
  Matrix part = bay(omega, -1);
  part.topLeftCorner(d, d) += half;
  part.bottomRightCorner(d, d) += half;
  const Matrix ahead = for_ever(part);
  const Eigen::MatrixXcd sign = mirror_.cast<ComplexNumber>().asDiagonal();
  const Matrix behind = sign * ahead * sign;
  const Matrix last = part.bottomRightCorner(d, d) + ahead;
  const Matrix next = -last.partialPivLu().solve(part.topRightCorner(d, d).transpose());
  const Eigen::ComplexEigenSolver<Matrix> waves(next);
  const Matrix& shapes = waves.eigenvectors();
  const Eigen::PartialPivLU<Matrix> split(shapes);
  const Eigen::VectorXcd sent =
      split.solve((ahead + behind).partialPivLu().solve(Eigen::VectorXcd::Unit(d, driven_)));
  Eigen::Index wave = 0;
  double farthest = 0.;
  for (Eigen::Index i = 0; i < d; ++i) {
    const double there =
        std::abs(sent[i] * shapes(driven_, i)) * std::pow(std::abs(waves.eigenvalues()[i]), kFar);
    if (there > farthest) wave = i;
    farthest = std::max(farthest, there);
  }
  const Matrix last_bays = end(omega, half);
  const Eigen::VectorXcd back =
      (last_bays + behind).partialPivLu().solve((ahead - last_bays) * shapes.col(wave));
  return {std::abs(waves.eigenvalues()[wave]), std::abs(split.solve(sign * back)[wave])};
}

}  // namespace railstep
