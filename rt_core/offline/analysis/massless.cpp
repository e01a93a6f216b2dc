#include "offline/analysis/massless.h"

#include <Eigen/SparseCholesky>

#include "offline/math/refuse.h"
#include "offline/math/sparse.h"

namespace railstep {

Sparse picks(int unknowns, const std::vector<int>& chosen) {
  Sparse result(unknowns, static_cast<int>(chosen.size()));
  for (std::size_t j = 0; j < chosen.size(); ++j)
    result.insert(chosen[j], static_cast<int>(j)) = 1.;
  return result;
}

MassiveLine without_massless(const Line& line) {
  std::vector<int> massive, massless;
  for (int i = 0; i < line.unknowns(); ++i)
    (line.mass.coeff(i, i) > 0. ? massive : massless).push_back(i);
  const Sparse kept = picks(line.unknowns(), massive);
  if (massless.empty()) return {line.mass, line.stiffness, kept};
  const Sparse left = picks(line.unknowns(), massless);
  const Sparse held = left.transpose() * line.stiffness * left;
  const Eigen::SimplicialLDLT<Sparse> factor(held);
  if (factor.info() != Eigen::Success || !(factor.vectorD().array() > 0.).all())
    refuse("E-TRACK-36",
           "nothing holds a sleeper without mass; expected stiffness in its pad or ballast, or "
           "sleeper.mass_kg above 0");
  const Sparse coupled = left.transpose() * line.stiffness * kept;
  const Sparse following = factor.solve(coupled);
  MassiveLine result;
  result.follow = kept - Sparse(left * following);
  result.mass = kept.transpose() * line.mass * kept;
  const Sparse half = line.stiffness * result.follow;
  const Sparse product = result.follow.transpose() * half;
  result.stiffness = .5 * (product + Sparse(product.transpose()));  // symmetric to the last bit
  return result;
}

}  // namespace railstep
