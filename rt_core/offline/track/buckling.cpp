#include "offline/track/buckling.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "offline/track/fixed_port.h"

namespace railstep {

namespace {

using Factor = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>;

/// Whether a stiffness has a direction of negative energy. A pivot within 1e-12 of its diagonal is
/// that of a free rigid mode (as Statics counts them), which is for others to refuse.
bool is_unstable(const Eigen::SparseMatrix<double>& stiffness) {
  Factor factor(stiffness);
  if (factor.info() != Eigen::Success) {  // a pivot of 0 sharp: one that nothing holds
    Eigen::SparseMatrix<double> lifted = stiffness;
    for (int i = 0; i < lifted.rows(); ++i) {
      double& entry = lifted.coeffRef(i, i);
      entry += 1e-12 * std::abs(entry) + 1e-300;
    }
    factor.compute(lifted);
  }
  const Eigen::VectorXd size =
      factor.permutationP() * Eigen::VectorXd(stiffness.diagonal().cwiseAbs());
  return (factor.vectorD().array() < -1e-12 * size.array()).any();
}

/// With both rails' forces `factor` times what they are.
bool buckles(Track track, double factor) {
  track.axial_force *= factor;
  if (track.right) track.right->axial_force *= factor;
  for (const Line& line : assemble(track))
    if (is_unstable(line.stiffness)) return true;
  return false;
}

/// The factor on both rails' forces at which the track buckles, by bisection up to `unstable`.
double critical_factor(const Track& track, double unstable) {
  double stable = 0.;
  while (unstable - stable > 1e-12 * unstable) {
    const double middle = .5 * (stable + unstable);
    if (middle <= stable || middle >= unstable) break;
    (buckles(track, middle) ? unstable : stable) = middle;
  }
  return unstable;
}

}  // namespace

double critical_compression(const Track& track) {
  Track pressed = track;
  pressed.axial_force = -1.;
  if (pressed.right) pressed.right->axial_force = -1.;
  const double crushing = track.material.young * track.section.area;
  if (!buckles(pressed, crushing)) return std::numeric_limits<double>::infinity();
  return critical_factor(pressed, crushing);
}

void refuse_buckled(const Track& given) {
  const Track track = linear_about_rest(given);
  const double left = track.axial_force, right = track.bar(1).axial_force;
  // The bisection's own width, so that the critical force itself is refused.
  if (!(std::min(left, right) < 0.) || !buckles(track, 1. + 1e-11)) return;
  std::ostringstream sentence;
  sentence.precision(7);
  if (left == right)
    sentence << "the rails carry a compression of " << -left << " N, and the track buckles at "
             << critical_compression(track)
             << " N; accepted are rail.axial_force_n and heat that press less";
  else
    sentence << "the rails carry compressions of " << -left << " N (left) and " << -right
             << " N (right), and the track buckles at " << critical_factor(track, 1. + 1e-11)
             << " times these; accepted are rail.axial_force_n and heat that press less";
  throw std::invalid_argument(sentence.str());
}

}  // namespace railstep
