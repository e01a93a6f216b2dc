#pragma once
#include <cmath>
#include <cstdint>

#include "online/model/caps.h"

namespace railstep {

/// Coordinates of one law: `size` of them from `first` on. Its forces depend on these alone.
struct LawBlock {
  int first, size;
};

enum class NewtonStatus : std::uint8_t {
  converged,    // residual within kNewtonTolerance
  cap_reached,  // the best iterate; the residual says how good it is
  weak_pivot,   // some steps were those of each coordinate by itself; the best iterate
  bad_input,    // a number is not finite, or n or the blocks are out of range: forces 0
};

struct NewtonResult {
  NewtonStatus status;
  int iterations;   // 0 to kNewtonSweeps
  double residual;  // largest |z - z_free - Y F| over the sum of the sizes of its terms
};

inline constexpr double kNewtonTolerance = 1e-12;

/// One point of the iteration.
struct NewtonPoint {
  double z[kMostNewton], force[kMostNewton];
  double slope[kMostNewton * kMostLaw];  // blocks [size][size], one after the other
  double missed[kMostNewton];            // z - z_free - Y F
  double residual;
};

/// A problem z = z_free + Y F(z) of n coordinates.
struct NewtonProblem {
  int n, blocks;
  const double* Y;  // [n][n] compliance of the linear parts, symmetric, positive semidefinite
  const LawBlock* block;
  const double* z_free;  // [n]
};

/// Whether all numbers are finite, and blocks follow each other and fill the n coordinates.
[[nodiscard]] bool is_usable(const NewtonProblem& p, const double* force) noexcept;
/// Finds z - z_free - Y F at a point whose forces are known.
void find_missed(const NewtonProblem& p, NewtonPoint& at) noexcept;
/// Newton's step (I - Y J) step = -missed, by elimination in the order of the coordinates.
/// @returns false where a pivot is not above 1e-12 of its row; the step is then
///   -missed / (1 - Y_ii J_ii) of each coordinate by itself
[[nodiscard]] bool newton_step(const NewtonProblem& p, const NewtonPoint& at,
                               double* step) noexcept;

/// Forces at a point.
template <typename Law>
void find_forces(const NewtonProblem& p, const Law& law, NewtonPoint& at) noexcept {
  double* slope = at.slope;
  for (int b = 0; b < p.blocks; ++b) {
    const LawBlock& own = p.block[b];
    law(b, at.z + own.first, at.force + own.first, slope);
    slope += own.size * own.size;
  }
  find_missed(p, at);
}

/// The point at a part of a step.
template <typename Law>
void go_part(const NewtonProblem& p, const Law& law, const NewtonPoint& from, const double* step,
             double part, NewtonPoint& to) noexcept {
  for (int i = 0; i < p.n; ++i) to.z[i] = from.z[i] + part * step[i];
  find_forces(p, law, to);
}

/// Laws of any kind at the interfaces of linear parts: z = z_free + Y F(z), by Newton's method with
/// the laws' own slopes. A step that does not lessen the residual is halved, at most twice. Laws
/// that are scalar, rising and without friction have a solver of their own, which cannot fail
/// (ports.h).
/// @param law    law(b, z, force, slope) of block b: its coordinates, [size]; its forces, [size];
/// and
///               their slopes, [size][size]. Finite for finite z.
/// @param force  [n] in: forces of the last step (a start); out: forces
/// @param z      [n] out
/// Work: at most kNewtonSweeps eliminations, and 1 + 3 kNewtonSweeps evaluations of all laws.
template <typename Law>
[[nodiscard]] NewtonResult solve_laws(const NewtonProblem& p, const Law& law, double* force,
                                      double* z) noexcept {
  if (!is_usable(p, force)) {
    for (int i = 0; i < p.n && i < kMostNewton; ++i) force[i] = z[i] = 0.;
    return {NewtonStatus::bad_input, 0, 0.};
  }
  NewtonPoint points[2];
  NewtonPoint *at = points, *next = points + 1;
  for (int i = 0; i < p.n; ++i) {
    at->z[i] = p.z_free[i];
    for (int j = 0; j < p.n; ++j) at->z[i] += p.Y[i * p.n + j] * force[j];
  }
  find_forces(p, law, *at);
  int iterations = 0;
  bool weak = false;
  // A step is taken only where it lessens the residual, so that the last point is the best one.
  for (bool better = true; better && at->residual > kNewtonTolerance && iterations < kNewtonSweeps;
       ++iterations) {
    double step[kMostNewton];
    if (!newton_step(p, *at, step)) weak = true;
    double part = 1.;
    better = false;
    for (int halving = 0; halving < 3 && !better; ++halving, part *= .5) {
      go_part(p, law, *at, step, part, *next);
      better = next->residual < at->residual;
    }
    if (!better) break;
    NewtonPoint* const last = at;
    at = next;
    next = last;
  }
  for (int i = 0; i < p.n; ++i) {
    force[i] = at->force[i];
    z[i] = at->z[i];
  }
  const bool done = at->residual <= kNewtonTolerance;
  return {done   ? NewtonStatus::converged
          : weak ? NewtonStatus::weak_pivot
                 : NewtonStatus::cap_reached,
          iterations, at->residual};
}

}  // namespace railstep
