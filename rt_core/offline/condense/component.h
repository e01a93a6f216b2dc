#pragma once
#include "offline/condense/basis.h"

namespace railstep {

/// Unknowns of a line that a condensation keeps as they are: of each rail the nodes at equal steps,
/// those over seats among them, and all of the sleepers. Those without mass are left out; they
/// follow at once.
/// @param nodes_per_bay  a divisor of 2 elements_per_bay
/// Throws Refused otherwise.
std::vector<int> kept_unknowns(const Track& track, const Line& line, int nodes_per_bay);

/// Static condensation (Guyan 1965): all else follows the kept unknowns without inertia, T = [I;
/// -K_ss^-1 K_sm]. Exact under constant forces on the kept unknowns.
Eigen::MatrixXd guyan_shapes(const Line& line, const std::vector<int>& kept);

/// The improved reduced system (O'Callahan 1989): Guyan's shapes plus the effect of inertia, taken
/// from his model: T + S M T M_r^-1 K_r, S = K_ss^-1 on the unknowns that follow.
Eigen::MatrixXd irs_shapes(const Line& line, const std::vector<int>& kept);

/// Components' modes (Craig and Bampton 1968): Guyan's shapes of the interface, and of each part
/// of the line that the interface cuts out (a rail's bay between two seats) the lowest modes with
/// the interface held.
/// @param modes       of each part, at most
/// @param highest_hz  of them
/// Throws Refused if a part has over kMostPartUnknowns unknowns, because the seats do not cut the
/// line.
Eigen::MatrixXd craig_bampton_shapes(const Line& line, const std::vector<int>& interface, int modes,
                                     double highest_hz);

inline constexpr int kMostPartUnknowns = 2000;

}  // namespace railstep
