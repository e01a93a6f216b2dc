#include <map>

#include "offline/condense/line_flexibility.h"
#include "offline/math/refuse.h"

namespace railstep {

ReducedLine::ReducedLine(const Track& track, const Line& line, const Basis& basis)
    : track_(track), line_(line), basis_(basis) {
  if (basis.shapes.rows() != line.unknowns() || basis.shapes.cols() != basis.omega.size())
    refuse("E-CONDENSE-19",
           "a basis does not fit its line; expected one row per unknown and one omega per shape");
  if (basis.omega.size() > 0 && !(basis.omega.minCoeff() > 0.))
    refuse("E-CONDENSE-20",
           "a basis for residual flexibility has a free rigid mode; expected omega above 0");
}

/// The line's unknowns at each place of some elements of a rail that a load point reads, and their
/// part.
template <typename Take>
void ReducedLine::read_load_point(const LoadPoint& load_point, int points, Elements at,
                                  const Take& take) const {
  double own[9];
  load_row(track_, load_point, own);
  for (int e = at.first; e < at.last; ++e)
    for (int p = 0; p <= points; ++p) {
      const auto n = shape(2. * p / points - 1.);
      for (std::size_t i = 0; i < 3; ++i)
        for (const int k : {1, 2, 5, 7}) {
          const int unknown =
              line_.element_unknown(load_point.rail, shifted(track_, e, 0), static_cast<int>(i), k);
          const double factor = sign_of(line_, load_point.rail, k) * own[k];
          if (unknown >= 0 && factor != 0.)
            take((e - at.first) * (points + 1) + p, unknown, n[i] * factor);
        }
    }
}

Eigen::MatrixXd ReducedLine::load_shapes(const LoadPoint& load_point, int points,
                                         Elements at) const {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(at.count() * (points + 1), basis_.omega.size());
  std::map<int, Eigen::RowVectorXd> row;  // of unknowns, which neighbouring places share
  read_load_point(load_point, points, at, [&](int place, int unknown, double part) {
    const auto [own, is_new] = row.try_emplace(unknown);
    if (is_new) own->second = basis_.shapes.row(unknown).transpose();
    result.row(place) += part * own->second;
  });
  return result;
}

Eigen::VectorXd ReducedLine::under(const LoadPoint& load_point, const LoadPoint& other,
                                   int points) const {
  const Elements tabled{0, tabled_elements(track_)};
  const Eigen::MatrixXd at = load_shapes(load_point, points, tabled),
                        read = load_shapes(other, points, tabled);
  return read.cwiseProduct(basis_.static_response(at.transpose()).transpose()).rowwise().sum();
}

LineFlexibility::Strip ReducedLine::between(const LoadPoint& a, const LoadPoint& b, int points,
                                            int range) const {
  const Elements tabled{0, tabled_elements(track_)};
  // On a ring the elements that its one bay can reach, on a line all.
  const Elements around =
      track_.ring ? Elements{tabled.first - range, tabled.last + range} : tabled;
  const Eigen::MatrixXd read = load_shapes(b, points, around);
  return [this, n = points + 1, range, around, from = load_shapes(a, points, tabled),
          to = basis_.static_response(read.transpose())](int element) {
    Eigen::MatrixXd strip = Eigen::MatrixXd::Zero(n, (2 * range + 1) * n);
    for (int shift = -range; shift <= range; ++shift)
      if (shifted(track_, element, shift) >= 0)
        strip.middleCols((shift + range) * n, n) =
            from.middleRows(element * n, n) *
            to.middleCols((element + shift - around.first) * n, n);
    return strip;
  };
}

/// Displacement of a load point at its places in some elements, for given coordinates.
Eigen::VectorXd ReducedLine::displacement_at(const LoadPoint& load_point, int points, Elements at,
                                             const Eigen::VectorXd& y) const {
  const Eigen::VectorXd u = basis_.shapes.displacement(y);
  Eigen::VectorXd result = Eigen::VectorXd::Zero(at.count() * (points + 1));
  read_load_point(load_point, points, at,
                  [&](int place, int unknown, double part) { result[place] += part * u[unknown]; });
  return result;
}

Eigen::VectorXd ReducedLine::from(const LoadPoint& load_point, const Functional& functional,
                                  int points, Elements at) const {
  const Eigen::VectorXd load(functional_row(track_, line_, functional));
  return displacement_at(load_point, points, at,
                         basis_.static_response(basis_.shapes.project(load)));
}

Eigen::VectorXd ReducedLine::at_once(const LoadPoint& load_point, const Functional& functional,
                                     int points, Elements at) const {
  const Eigen::VectorXd load(functional_row(track_, line_, functional));
  return displacement_at(load_point, points, at, basis_.at_once * basis_.shapes.project(load));
}

Eigen::VectorXd ReducedLine::flexibility(const std::vector<Functional>& reads,
                                         const Functional& force) const {
  const auto part = [&](const Functional& one) -> Eigen::VectorXd {
    const Eigen::VectorXd row(functional_row(track_, line_, one));
    return basis_.shapes.project(row);
  };
  const Eigen::VectorXd acting = basis_.static_response(part(force));
  Eigen::VectorXd result(static_cast<Eigen::Index>(reads.size()));
  for (std::size_t i = 0; i < reads.size(); ++i)
    result[static_cast<Eigen::Index>(i)] = part(reads[i]).dot(acting);
  return result;
}

}  // namespace railstep
