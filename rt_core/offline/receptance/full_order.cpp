#include "offline/receptance/full_order.h"

#include <cmath>
#include <string>
#include <utility>

#include "offline/analysis/krylov.h"
#include "offline/math/complex.h"
#include "offline/math/refuse.h"
#include "offline/receptance/residual_statics.h"

namespace railstep {

Eigen::MatrixXd read_rows(const Track& track, const Line& line, const Transfer& transfer) {
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(transfer.reads.size()), line.unknowns());
  for (std::size_t i = 0; i < transfer.reads.size(); ++i)
    rows.row(static_cast<Eigen::Index>(i)) =
        Eigen::VectorXd(functional_row(track, line, transfer.reads[i])).transpose();
  return rows;
}

FullOrderReceptance::FullOrderReceptance(const Track& track, const Transfer& transfer,
                                         bool residual)
    : residual_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(transfer.reads.size()))) {
  for (Line& line : assemble(track)) {
    const Eigen::VectorXd force(functional_row(track, line, transfer.force));
    if (force.norm() == 0.) continue;
    auto part = std::make_unique<Part>();
    part->line = std::move(line);
    part->force = force.cast<ComplexNumber>();
    part->reads = read_rows(track, part->line, transfer);
    if (residual) residual_ += residual_statics(track, part->line, nullptr, transfer);
    // Every frequency has the same pattern.
    part->factor.analyzePattern(dynamic_stiffness(part->line, 1.));
    parts_.push_back(std::move(part));
  }
}

Eigen::VectorXcd FullOrderReceptance::at(double hz) {
  Eigen::VectorXcd sum = residual_.cast<ComplexNumber>();
  for (const std::unique_ptr<Part>& part : parts_) {
    part->factor.factorize(dynamic_stiffness(part->line, ComplexNumber(0., 2. * M_PI * hz)));
    if (part->factor.info() != Eigen::Success)
      fail("E-RECEPTANCE-13", "the track swings without damping at " + std::to_string(hz) +
                                  " Hz; expected dampers, or another frequency");
    const Eigen::VectorXcd moved = part->factor.solve(part->force);
    sum += part->reads.cast<ComplexNumber>() * moved;
  }
  return sum;
}

}  // namespace railstep
