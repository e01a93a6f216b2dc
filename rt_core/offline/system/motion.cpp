#include "offline/system/motion.h"

#include <Eigen/Dense>
#include <cmath>

#include "offline/math/refuse.h"

namespace railstep {

namespace {

void add_piece(MotionPieces& pieces, double start, const std::vector<double>& coefficients) {
  pieces.start.push_back(start);
  for (std::size_t k = 0; k < static_cast<std::size_t>(kMotionCoefficients); ++k)
    pieces.coefficient.push_back(k < coefficients.size() ? coefficients[k] : 0.);
}

/// Second derivatives of the natural cubic spline at its knots.
Eigen::VectorXd bends(const std::vector<std::array<double, 2>>& table) {
  const auto n = static_cast<Eigen::Index>(table.size());
  Eigen::VectorXd diagonal = Eigen::VectorXd::Ones(n), beside = Eigen::VectorXd::Zero(n);
  Eigen::VectorXd m = Eigen::VectorXd::Zero(n);
  const auto at = [&](Eigen::Index i, std::size_t c) {
    return table[static_cast<std::size_t>(i)][c];
  };
  for (Eigen::Index i = 1; i + 1 < n; ++i) {
    const double left = at(i, 0) - at(i - 1, 0), right = at(i + 1, 0) - at(i, 0);
    diagonal[i] = 2. * (left + right);
    beside[i] = right;
    m[i] = 6. * ((at(i + 1, 1) - at(i, 1)) / right - (at(i, 1) - at(i - 1, 1)) / left);
    if (i == 1) continue;
    const double factor = left / diagonal[i - 1];
    diagonal[i] -= factor * beside[i - 1];
    m[i] -= factor * m[i - 1];
  }
  for (Eigen::Index i = n - 2; i > 0; --i) m[i] = (m[i] - beside[i] * m[i + 1]) / diagonal[i];
  return m;
}

void add_spline(MotionPieces& pieces, const std::vector<std::array<double, 2>>& table) {
  for (std::size_t i = 0; i < table.size(); ++i)
    if (!std::isfinite(table[i][0]) || !std::isfinite(table[i][1]) ||
        (i > 0 && !(table[i][0] > table[i - 1][0])))
      refuse("E-SYSTEM-27", "row " + std::to_string(i) +
                                " of the table of a motion is not finite or does not rise in time; "
                                "expected finite values at rising times");
  const Eigen::VectorXd m = bends(table);
  add_piece(pieces, table[0][0] - 1., {table[0][1]});
  for (std::size_t i = 0; i + 1 < table.size(); ++i) {
    const double h = table[i + 1][0] - table[i][0];
    const double m0 = m[static_cast<Eigen::Index>(i)], m1 = m[static_cast<Eigen::Index>(i + 1)];
    add_piece(pieces, table[i][0],
              {table[i][1], (table[i + 1][1] - table[i][1]) / h - h * (2. * m0 + m1) / 6., m0 / 2.,
               (m1 - m0) / (6. * h)});
  }
  add_piece(pieces, table.back()[0], {table.back()[1]});
}

}  // namespace

MotionPieces motion_pieces(const Motion& motion) {
  if (motion.polynomial.empty() == motion.table.empty())
    refuse("E-SYSTEM-28",
           "a motion has both a polynomial and a table, or neither of them; expected one of them");
  MotionPieces pieces;
  if (!motion.table.empty()) {
    if (motion.table.size() < 2)
      refuse("E-SYSTEM-29", "the table of a motion has one row; expected 2 or more");
    add_spline(pieces, motion.table);
    return pieces;
  }
  if (motion.polynomial.size() > static_cast<std::size_t>(kMotionCoefficients))
    refuse("E-SYSTEM-30",
           "the polynomial of a motion has " + std::to_string(motion.polynomial.size()) +
               " coefficients; expected at most " + std::to_string(kMotionCoefficients));
  for (const double c : motion.polynomial)
    if (!std::isfinite(c))
      refuse("E-SYSTEM-31",
             "the polynomial of a motion has a coefficient that is not finite; expected finite "
             "numbers");
  add_piece(pieces, 0., motion.polynomial);
  return pieces;
}

}  // namespace railstep
