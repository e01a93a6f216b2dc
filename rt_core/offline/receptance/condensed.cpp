#include "offline/receptance/condensed.h"

#include <cmath>

#include "offline/analysis/free_motion.h"
#include "offline/receptance/full_order.h"
#include "offline/receptance/residual_statics.h"

namespace railstep {

CondensedReceptance::CondensedReceptance(const Track& track, const Transfer& transfer,
                                         const Reduction& reduction, bool residual)
    : residual_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(transfer.reads.size()))) {
  for (const Line& line : assemble(track)) {
    const Eigen::VectorXd force(functional_row(track, line, transfer.force));
    if (force.norm() == 0.) continue;
    refuse_free_modes(track, {line}, {});
    const auto [basis, modes] = reduce(track, line, reduction);
    const Eigen::VectorXd acting = basis.shapes.project(force);
    const Eigen::MatrixXd read = read_rows(track, line, transfer) * basis.shapes.dense();
    const Eigen::VectorXcd taken = modes.shape.transpose() * acting;
    parts_.push_back(
        {modes.rate, (read * modes.shape) * taken.asDiagonal(), kept_coordinates(basis, modes)});
    if (residual) residual_ += residual_statics(track, line, &basis, transfer);
  }
}

Eigen::VectorXcd CondensedReceptance::at(double hz) {
  const std::complex<double> rate(0., 2. * M_PI * hz);
  Eigen::VectorXcd sum = residual_.cast<std::complex<double>>();
  for (const Part& part : parts_) {
    const Eigen::VectorXcd along = (rate - part.rate.array()).inverse();
    const Eigen::VectorXcd back = (rate - part.rate.conjugate().array()).inverse();
    sum += .5 * (part.gains * along + part.gains.conjugate() * back);
  }
  return sum;
}

int CondensedReceptance::kept() const {
  int sum = 0;
  for (const Part& part : parts_) sum += part.kept;
  return sum;
}

}  // namespace railstep
