#pragma once
#include <Eigen/Core>
#include <complex>
#include <vector>

#include "offline/track/track.h"

namespace railstep {

/// Damped modes of a line that swing: (rate^2 M + rate C + K) shape = 0 with Im rate > 0.
struct Oscillations {
  Eigen::VectorXcd rate;   // [modes] 1/s, by |rate|, lowest first
  Eigen::MatrixXcd shape;  // [unknowns][modes], each of Euclidean norm 1
  bool all = false;        // the list holds all modes of the line or track
};

/// |Q(rate) shape| / (|rate^2 M shape| + |rate C shape| + |K shape|): the relative residual of the
/// forces.
double residual(const Line& line, std::complex<double> rate, const Eigen::VectorXcd& shape);

/// The modes with |rate| <= radius, 1/s. Arnoldi's method about the middle of this quarter disc
/// finds every rate in it: vectors are added until they bring no more rates. Inverse iteration
/// refines modes whose residual() is then above 1e-10. At the end it is at most 1e-8, or what
/// rounding of K x leaves for modes far below the highest (f under 1e-4 of it). Rigid motions are
/// left out. Throws Failed if not all modes were found.
Oscillations oscillations(const Line& line, double radius);

/// Natural modes of a whole track, lowest frequency first.
struct NaturalModes {
  std::vector<double> frequency;      // |rate|/(2 pi), Hz; free rigid modes first, as 0
  std::vector<double> damping_ratio;  // -Re rate/|rate|; 0 where undamped and of rigid modes
};

/// The lowest `count` modes of all lines of a track together, or as many as there are. Motions that
/// do not swing (over their critical damping) are left out. Throws Refused on an invalid track,
/// Failed if a line is too long or modes were not all found.
NaturalModes natural_modes(const Track& track, int count);

}  // namespace railstep
