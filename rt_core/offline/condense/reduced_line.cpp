#include <stdexcept>

#include "offline/condense/line_flexibility.h"

namespace railstep {

ReducedLine::ReducedLine(const Track& track, const Line& line, const Basis& basis)
    : track_(track), line_(line), basis_(basis) {
  if (basis.shapes.rows() != line.unknowns() || basis.shapes.cols() != basis.omega.size())
    throw std::invalid_argument("a basis has one row per unknown of its line, one omega per shape");
  if (basis.omega.size() > 0 && !(basis.omega.minCoeff() > 0.))
    throw std::invalid_argument("a basis for residual flexibility has no free rigid mode");
}

Eigen::MatrixXd ReducedLine::port_shapes(const Port& port, int points) const {
  double own[9];
  height_row(track_.lean(port.rail), port.y, port.z, own);
  Eigen::MatrixXd result =
      Eigen::MatrixXd::Zero(track_.elements() * (points + 1), basis_.omega.size());
  for (int e = 0; e < track_.elements(); ++e)
    for (int p = 0; p <= points; ++p) {
      const auto n = shape(2. * p / points - 1.);
      for (std::size_t i = 0; i < 3; ++i)
        for (const int k : {1, 2, 5, 7}) {
          const int unknown = line_.element_unknown(port.rail, e, static_cast<int>(i), k);
          const double factor = sign_of(line_, port.rail, k) * own[k];
          if (unknown >= 0 && factor != 0.)
            result.row(e * (points + 1) + p) += (n[i] * factor) * basis_.shapes.row(unknown);
        }
    }
  return result;
}

Eigen::VectorXd ReducedLine::under(const Port& port, const Port& seen, int points) const {
  const Eigen::Index places = tabled_elements(track_) * (points + 1);
  const Eigen::MatrixXd at = port_shapes(port, points).topRows(places),
                        read = port_shapes(seen, points).topRows(places);
  return read.cwiseProduct(basis_.give(at.transpose()).transpose()).rowwise().sum();
}

LineFlexibility::Strip ReducedLine::between(const Port& a, const Port& b, int points,
                                            int reach) const {
  const Eigen::MatrixXd read = port_shapes(b, points);
  return [this, n = points + 1, reach, from = port_shapes(a, points),
          to = basis_.give(read.transpose())](int element) {
    Eigen::MatrixXd strip = Eigen::MatrixXd::Zero(n, (2 * reach + 1) * n);
    for (int shift = -reach; shift <= reach; ++shift)
      if (const int e2 = shifted(track_, element, shift); e2 >= 0)
        strip.middleCols((shift + reach) * n, n) =
            from.middleRows(element * n, n) * to.middleCols(e2 * n, n);
    return strip;
  };
}

Eigen::VectorXd ReducedLine::from(const Port& port, const Functional& functional, int points,
                                  Elements at) const {
  const Eigen::VectorXd load(functional_row(track_, line_, functional));
  return port_shapes(port, points).middleRows(at.first * (points + 1), at.count() * (points + 1)) *
         basis_.give(basis_.shapes.transpose() * load);
}

Eigen::VectorXd ReducedLine::at_once(const Port& port, const Functional& functional,
                                     int points) const {
  const Eigen::VectorXd load(functional_row(track_, line_, functional));
  return port_shapes(port, points) * (basis_.at_once * (basis_.shapes.transpose() * load));
}

Eigen::VectorXd ReducedLine::flexibility(const std::vector<Functional>& reads,
                                         const Functional& force) const {
  const auto part = [&](const Functional& one) -> Eigen::VectorXd {
    const Eigen::VectorXd row(functional_row(track_, line_, one));
    return basis_.shapes.transpose() * row;
  };
  const Eigen::VectorXd acting = basis_.give(part(force));
  Eigen::VectorXd result(static_cast<Eigen::Index>(reads.size()));
  for (std::size_t i = 0; i < reads.size(); ++i)
    result[static_cast<Eigen::Index>(i)] = part(reads[i]).dot(acting);
  return result;
}

}  // namespace railstep
