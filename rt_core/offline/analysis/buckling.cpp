#include "offline/analysis/buckling.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "offline/analysis/rigid.h"
#include "offline/math/refuse.h"
#include "offline/track/fixed_port.h"

namespace railstep {

namespace {

using Factor = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>;

/// A pivot of 0 sharp, of one that nothing holds, is lifted by its rounding.
void factorise(const Eigen::SparseMatrix<double>& stiffness, Factor& factor) {
  factor.compute(stiffness);
  if (factor.info() == Eigen::Success) return;
  Eigen::SparseMatrix<double> lifted = stiffness;
  for (int i = 0; i < lifted.rows(); ++i) {
    double& entry = lifted.coeffRef(i, i);
    entry += 1e-12 * std::abs(entry) + 1e-300;
  }
  factor.compute(lifted);
}

/// Whether a stiffness has a direction of negative energy. A pivot within 1e-12 of its diagonal
/// belongs to a free rigid mode (as Statics counts them), which is refused elsewhere.
bool is_unstable(const Eigen::SparseMatrix<double>& stiffness) {
  Factor factor;
  factorise(stiffness, factor);
  const Eigen::VectorXd size =
      factor.permutationP() * Eigen::VectorXd(stiffness.diagonal().cwiseAbs());
  return (factor.vectorD().array() < -1e-12 * size.array()).any();
}

/// With both rails' forces `factor` times what they are.
Track compressed(Track track, double factor) {
  track.axial_force *= factor;
  if (track.right) track.right->axial_force *= factor;
  return track;
}

bool buckles(const Track& track, double factor) {
  for (const Line& line : assemble(compressed(track, factor)))
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

/// Place at which the buckled shape is largest, in words. The factor is the critical one, at which
/// inverse iteration finds the shape at once.
std::string place_of_buckling(const Track& given, double factor) {
  const Track track = compressed(given, factor);
  double most = -1., x = 0.;
  int at = 0;
  for (const Line& line : assemble(track)) {
    if (!is_unstable(line.stiffness)) continue;
    Factor inverse;
    factorise(line.stiffness, inverse);
    Eigen::VectorXd shape = start_block(line.unknowns(), 1);
    for (int iteration = 0; iteration < 3; ++iteration)
      shape = inverse.solve(shape).eval().normalized();
    for (int rail = 0; rail < track.rails; ++rail)
      for (int node = 0; node < track.nodes(); ++node)
        for (const int k : {1, 2}) {
          const int unknown = line.unknown(rail, node, k);
          if (unknown < 0 || line.rail_factor[static_cast<std::size_t>(rail)] == 0.) continue;
          if (std::abs(shape[unknown]) <= most * (1. + 1e-9)) continue;
          most = std::abs(shape[unknown]);
          x = .5 * node * track.element_length();
          at = rail;
        }
  }
  std::ostringstream words;
  words.precision(4);
  words << ", most at x = " << x << " m";
  if (track.rails == 2 && !is_symmetric(track))
    words << " of the " << (at == 0 ? "left" : "right") << " rail";
  return most < 0. ? "" : words.str();
}

}  // namespace

void refuse_buckled(const Track& given) {
  const Track track = linear_about_rest(given);
  const double left = track.axial_force, right = track.bar(1).axial_force;
  // The bisection's own width, so that the critical force itself is refused.
  if (!(std::min(left, right) < 0.) || !buckles(track, 1. + 1e-11)) return;
  std::ostringstream sentence;
  sentence.precision(7);
  const double most = critical_factor(track, 1. + 1e-11);
  if (left == right)
    sentence << "the rails carry a compression of " << -left << " N, and the track buckles at "
             << -left * most << " N";
  else
    sentence << "the rails carry compressions of " << -left << " N (left) and " << -right
             << " N (right), and the track buckles at " << most << " times these";
  sentence << place_of_buckling(track, most)
           << "; expected a lower compression by rail.axial_force_n and heat";
  refuse("E-TRACK-33", sentence.str());
}

}  // namespace railstep
