#include "offline/condense/reduction.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "offline/condense/component.h"
#include "offline/condense/rational_krylov.h"
#include "offline/math/refuse.h"

namespace railstep {

namespace {

/// Up to this number of unknowns damped modes are those of the line itself. For a longer line they
/// are those of four times as many undamped modes and of its dampers.
constexpr int kWholeUnknowns = 600;
constexpr int kRichness = 4;

Eigen::MatrixXd beside(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  Eigen::MatrixXd both(a.rows(), a.cols() + b.cols());
  both << a, b;
  return both;
}

/// A basis with the static shapes of local forces.
Basis with_statics(const Line& line, const Eigen::MatrixXd& shapes, const Eigen::MatrixXd& forces) {
  if (forces.cols() == 0) return ritz_basis(line, shapes);
  const Eigen::MatrixXd own = shapes.cols() > 0 ? ritz_basis(line, shapes).shapes.dense() : shapes;
  return ritz_basis(line, beside(own, added_static_shapes(line, own, forces)));
}

/// Excess of a truncated model's compliance over the line's at some coordinate, over that of the
/// softest coordinate. One of two real modes that nearly share a shape is many times too soft
/// without the other.
double excess(const Basis& basis) {
  const Eigen::ArrayXd whole = basis.omega.array().square().inverse();
  return (basis.flexibility.diagonal().array() - whole).maxCoeff() / whole.maxCoeff();
}
constexpr double kMostExcess = 1e-2;

/// A damper on an unknown without mass makes a motion of first order, which undamped modes do not
/// contain.
void refuse_damped_massless(const Line& line) {
  for (int i = 0; i < line.unknowns(); ++i)
    if (!(line.mass.coeff(i, i) > 0.) && line.damping.coeff(i, i) > 0.)
      refuse("E-CONDENSE-21",
             "dampers hold a sleeper without mass, which cannot be condensed; expected "
             "sleeper.mass_kg above 0, no damping there, or condense.kind = \"full\"");
}

/// Shapes of the kinds that do not use modes of the whole line.
Eigen::MatrixXd own_shapes(const Track& track, const Line& line, const Reduction& reduction,
                           const ModalLimit& most) {
  if (reduction.kind == ReductionKind::krylov)
    return rational_krylov_shapes(track, line, reduction.expansion_hz, most.most);
  if (reduction.kind == ReductionKind::craig_bampton) {
    const double per_bay = static_cast<double>(reduction.limit.most) / track.bays;
    return craig_bampton_shapes(line, kept_unknowns(track, line, 1),
                                static_cast<int>(std::lround(per_bay)), most.highest_hz);
  }
  const std::vector<int> kept = kept_unknowns(track, line, reduction.nodes_per_bay);
  return reduction.kind == ReductionKind::irs ? irs_shapes(line, kept) : guyan_shapes(line, kept);
}

ReducedLineModel truncated(const Line& line, const ModalLimit& limit) {
  const int whole = line.unknowns() <= kWholeUnknowns ? line.unknowns() : kRichness * limit.most;
  const Basis rich = modal_basis(line, {whole, std::numeric_limits<double>::infinity()});
  ReducedLineModel made{rich, damped_modes(rich, line.damping)};
  const double fastest = 2. * M_PI * limit.highest_hz;
  const auto below = (made.modes.rate.cwiseAbs().array() <= fastest).count();
  const DampedModes all = made.modes;
  Eigen::Index most = std::min<Eigen::Index>(below, limit.most);
  do {
    made.modes = slowest(all, most);
    made.basis.flexibility = flexibility_of(made.modes);
    most = made.modes.rate.size() - 1;
  } while (most > 0 && excess(made.basis) > kMostExcess);
  if (made.modes.rate.size() == 0 || excess(made.basis) > kMostExcess)
    refuse("E-CONDENSE-22",
           "the chosen damped modes cannot stand for a line: none is left, or one is kept without "
           "its partner of near critical damping; expected more modes, or another condense.kind");
  made.basis.at_once = at_once_of(made.modes);
  return made;
}

}  // namespace

ModalLimit limit_of(const Line& line, const Reduction& reduction) {
  // A line with the unknowns of both rails keeps as many modes as two lines.
  const bool both = !line.mirrored && line.rail_factor[0] != 0. && line.rail_factor[1] != 0.;
  return {(both ? 2 : 1) * reduction.limit.most, reduction.limit.highest_hz};
}

int kept_coordinates(const Basis& basis, const ModeGroups& modes) {
  return static_cast<int>(basis.flexibility.size() > 0 ? modes.rate().size() : basis.omega.size());
}

ReducedLineModel reduce(const Track& track, const Line& line, const Reduction& reduction,
                        const Eigen::SparseMatrix<double>& rows) {
  if (line.unknowns() > kMostModalUnknowns)
    refuse("E-CONDENSE-16",
           "a line of " + std::to_string(line.unknowns()) +
               " unknowns cannot be condensed; expected at most " +
               std::to_string(kMostModalUnknowns) +
               ": use condense.kind = \"full\", a shorter track, or track.length = \"endless\"");
  refuse_damped_massless(line);
  const ModalLimit most = limit_of(line, reduction);
  if (reduction.kind == ReductionKind::complex_modes) {
    if (filled_columns(rows, line.unknowns()).cols() > 0)
      refuse("E-CONDENSE-24",
             "truncated damped modes do not represent one-sided supports, stops and gaps; expected "
             "another condense.kind for this track");
    return truncated(line, most);
  }
  Basis basis;
  if (reduction.kind == ReductionKind::modal)
    basis = modal_basis(line, most, rows);
  else
    basis = with_statics(line, own_shapes(track, line, reduction, most),
                         beside(damper_forces(line), filled_columns(rows, line.unknowns())));
  DampedModes modes = damped_modes(basis, line.damping);
  return {std::move(basis), std::move(modes)};
}

}  // namespace railstep
