#pragma once
#include <vector>

#include "offline/condense/mode_groups.h"

namespace railstep {

/// How a line is condensed; docs/condensation.md says what each keeps and where it fails.
enum class ReductionKind { modal, guyan, irs, craig_bampton, krylov, complex_modes };

/// A kind of reduction and the size that it keeps of a line with one rail. A line with both rails
/// keeps twice as much.
struct Reduction {
  ReductionKind kind = ReductionKind::modal;
  /// Limit of undamped modes (modal), of the modes of each rail's bays together (craig_bampton), of
  /// coordinates (krylov) or damped modes (complex_modes). Not used by guyan and irs.
  ModalLimit limit = {0, 0.};
  int nodes_per_bay = 1;                  // of guyan and irs
  std::vector<double> expansion_hz = {};  // of krylov
};

/// A line in few coordinates, and the modes in which it is stepped.
struct ReducedLineModel {
  Basis basis;
  DampedModes modes;
};

/// The limit for one line, which holds one rail or both.
ModalLimit limit_of(const Line& line, const Reduction& reduction);

/// Number of coordinates that a model keeps; for truncated damped modes the number of modes.
int kept_coordinates(const Basis& basis, const ModeGroups& modes);

/// All kinds except damped modes are Galerkin bases, and also keep the static shapes of every
/// damper and of `rows`.
/// @param rows  [unknowns][rows] where local forces act; may have no columns
/// Throws Refused as ritz_basis() and damped_modes() do, and on lines of more than
/// kMostModalUnknowns.
ReducedLineModel reduce(const Track& track, const Line& line, const Reduction& reduction,
                        const Eigen::SparseMatrix<double>& rows = {});

}  // namespace railstep
