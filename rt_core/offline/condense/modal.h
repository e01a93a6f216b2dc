#pragma once
#include <complex>

#include "offline/condense/basis.h"
#include "offline/track/track.h"

namespace railstep {

/// How many undamped modes a condensed line keeps: the lower of both counts.
struct ModalLimit {
  int most;           // modes, 0 or more
  double highest_hz;  // Hz
};

/// The lowest undamped modes of a line, and the static shape K^-1 b of each of its damper rows b,
/// made orthogonal. The motion that the modes leave out strains the dampers, which would not see it
/// without those shapes (11 to 27 % of the deflection under a load with dampers of 29e6 N s/m). A
/// Galerkin basis makes no energy, whatever it leaves out. The static shapes of `rows` are kept
/// too, so that the model answers a force along a row, and any force there, with the line's own
/// statics.
/// @param rows  [unknowns][rows] where local forces act; may have no columns
/// Throws Refused on a free rigid mode and on lines of more than kMostModalUnknowns.
Basis modal_basis(const Line& line, const ModalLimit& limit,
                  const Eigen::SparseMatrix<double>& rows = {});

/// A dense solution takes some 10 n^3 flops and 16 n^2 bytes.
inline constexpr int kMostModalUnknowns = 4000;

/// Damped modes of y'' + D y' + Omega^2 y = f: y = Re shape z with z' = rate z + shape' f (plain
/// transpose), y' = Re shape (rate z).
///
/// One of each conjugate pair is kept, with shape' (2 rate + D) shape = 2; overdamped modes stand
/// alone with 1 instead of 2 (their shape may be imaginary). Then Re sum shape shape' = 0 and Re
/// sum rate shape shape' = I, which is checked. Where slow real rates cluster, as those of strong
/// dampers on alike seats, the shapes are corrected to these sums.
struct DampedModes {
  Eigen::VectorXcd rate;    // [modes] 1/s, slowest first
  Eigen::MatrixXcd shape;   // [kept][modes]
  Eigen::MatrixXd damping;  // [kept][kept] D, 1/s

  /// The z of the static y, Omega^2 y = force, and of y': each mode in equilibrium with its force.
  /// rate shape' y + shape' D y says the same, as a difference of far larger numbers where modes
  /// are fast and strongly damped.
  Eigen::VectorXcd from(const Eigen::VectorXd& force, const Eigen::VectorXd& velocity) const;
};

/// Throws Refused if the check above has an error over 1e-7, or a mode's equation one over 1e-6:
/// two modes at critical damping have one shape.
DampedModes damped_modes(const Basis& basis, const Eigen::SparseMatrix<double>& damping);

/// The slowest damped modes; modes of one |rate| are kept together or not at all. This is a
/// truncation and not a Galerkin basis: Re sum shape shape' of the kept modes is a velocity that a
/// force causes at once.
DampedModes slowest(const DampedModes& all, Eigen::Index most);

/// Statics of damped modes, -Re sum shape shape' / rate; [kept][kept]. With all modes it is
/// omega^-2.
Eigen::MatrixXd flexibility_of(const DampedModes& modes);
/// Re sum shape shape'; [kept][kept]. With all modes it is 0.
Eigen::MatrixXd at_once_of(const DampedModes& modes);

}  // namespace railstep
