#include <map>

#include "offline/condense/line_flexibility.h"
#include "offline/math/refuse.h"

namespace railstep {

ReducedLine::ReducedLine(const Track& track, const Line& line, const Basis& basis)
    : track_(track), line_(line), basis_(basis) {
  if (basis.shapes.rows() != line.unknowns() || basis.shapes.cols() != basis.omega.size())
    refuse("E-CONDENSE-19", "a basis has one row per unknown of its line, one omega per shape");
  if (basis.omega.size() > 0 && !(basis.omega.minCoeff() > 0.))
    refuse("E-CONDENSE-20", "a basis for residual flexibility has no free rigid mode");
}

/// The line's unknowns at each place of some elements of a rail that a port reads, and their part.
template <typename Take>
void ReducedLine::read_port(const Port& port, int points, Elements at, const Take& take) const {
  double own[9];
  height_row(track_.lean(port.rail), port.y, port.z, own);
  for (int e = at.first; e < at.last; ++e)
    for (int p = 0; p <= points; ++p) {
      const auto n = shape(2. * p / points - 1.);
      for (std::size_t i = 0; i < 3; ++i)
        for (const int k : {1, 2, 5, 7}) {
          const int unknown =
              line_.element_unknown(port.rail, shifted(track_, e, 0), static_cast<int>(i), k);
          const double factor = sign_of(line_, port.rail, k) * own[k];
          if (unknown >= 0 && factor != 0.)
            take((e - at.first) * (points + 1) + p, unknown, n[i] * factor);
        }
    }
}

Eigen::MatrixXd ReducedLine::port_shapes(const Port& port, int points, Elements at) const {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(at.count() * (points + 1), basis_.omega.size());
  std::map<int, Eigen::RowVectorXd> row;  // of unknowns, which neighbouring places share
  read_port(port, points, at, [&](int place, int unknown, double part) {
    const auto [own, is_new] = row.try_emplace(unknown);
    if (is_new) own->second = basis_.shapes.row(unknown).transpose();
    result.row(place) += part * own->second;
  });
  return result;
}

Eigen::VectorXd ReducedLine::under(const Port& port, const Port& seen, int points) const {
  const Elements tabled{0, tabled_elements(track_)};
  const Eigen::MatrixXd at = port_shapes(port, points, tabled),
                        read = port_shapes(seen, points, tabled);
  return read.cwiseProduct(basis_.give(at.transpose()).transpose()).rowwise().sum();
}

LineFlexibility::Strip ReducedLine::between(const Port& a, const Port& b, int points,
                                            int reach) const {
  const Elements tabled{0, tabled_elements(track_)};
  // On a ring the elements that its one bay can reach, on a line all.
  const Elements around =
      track_.ring ? Elements{tabled.first - reach, tabled.last + reach} : tabled;
  const Eigen::MatrixXd read = port_shapes(b, points, around);
  return [this, n = points + 1, reach, around, from = port_shapes(a, points, tabled),
          to = basis_.give(read.transpose())](int element) {
    Eigen::MatrixXd strip = Eigen::MatrixXd::Zero(n, (2 * reach + 1) * n);
    for (int shift = -reach; shift <= reach; ++shift)
      if (shifted(track_, element, shift) >= 0)
        strip.middleCols((shift + reach) * n, n) =
            from.middleRows(element * n, n) *
            to.middleCols((element + shift - around.first) * n, n);
    return strip;
  };
}

/// What of a displacement of the coordinates a port sees at the places of some elements.
Eigen::VectorXd ReducedLine::seen_by(const Port& port, int points, Elements at,
                                     const Eigen::VectorXd& y) const {
  const Eigen::VectorXd u = basis_.shapes.displacement(y);
  Eigen::VectorXd result = Eigen::VectorXd::Zero(at.count() * (points + 1));
  read_port(port, points, at,
            [&](int place, int unknown, double part) { result[place] += part * u[unknown]; });
  return result;
}

Eigen::VectorXd ReducedLine::from(const Port& port, const Functional& functional, int points,
                                  Elements at) const {
  const Eigen::VectorXd load(functional_row(track_, line_, functional));
  return seen_by(port, points, at, basis_.give(basis_.shapes.project(load)));
}

Eigen::VectorXd ReducedLine::at_once(const Port& port, const Functional& functional, int points,
                                     Elements at) const {
  const Eigen::VectorXd load(functional_row(track_, line_, functional));
  return seen_by(port, points, at, basis_.at_once * basis_.shapes.project(load));
}

Eigen::VectorXd ReducedLine::flexibility(const std::vector<Functional>& reads,
                                         const Functional& force) const {
  const auto part = [&](const Functional& one) -> Eigen::VectorXd {
    const Eigen::VectorXd row(functional_row(track_, line_, one));
    return basis_.shapes.project(row);
  };
  const Eigen::VectorXd acting = basis_.give(part(force));
  Eigen::VectorXd result(static_cast<Eigen::Index>(reads.size()));
  for (std::size_t i = 0; i < reads.size(); ++i)
    result[static_cast<Eigen::Index>(i)] = part(reads[i]).dot(acting);
  return result;
}

}  // namespace railstep
