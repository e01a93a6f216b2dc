#include "offline/track/buckling.h"

#include <Eigen/SparseCholesky>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <vector>

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

bool buckles(Track track, double compression) {
  track.axial_force = -compression;
  for (const Line& line : assemble(track))
    if (is_unstable(line.stiffness)) return true;
  return false;
}

}  // namespace

double critical_compression(const Track& track) {
  double stable = 0., unstable = track.material.young * track.section.area;
  if (!buckles(track, unstable)) return std::numeric_limits<double>::infinity();
  while (unstable - stable > 1e-12 * unstable) {
    const double middle = .5 * (stable + unstable);
    if (middle <= stable || middle >= unstable) break;
    (buckles(track, middle) ? unstable : stable) = middle;
  }
  return unstable;
}

void refuse_buckled(const Track& track) {
  // The bisection's own width, so that the critical force itself is refused.
  if (!(track.axial_force < 0.) || !buckles(track, -track.axial_force * (1. + 1e-11))) return;
  std::ostringstream sentence;
  sentence.precision(7);
  sentence << "the rails carry a compression of " << -track.axial_force
           << " N, and the track buckles at " << critical_compression(track) << " N";
  throw std::invalid_argument(sentence.str());
}

}  // namespace railstep
