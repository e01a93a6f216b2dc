#pragma once
#include <cmath>
#include <cstdint>

namespace railstep {

inline constexpr int kNewtonSweeps = 8;  // most iterations of one solve
inline constexpr int kMostNewton = 128;  // coordinates
inline constexpr int kMostLaw = 12;      // of one law: a wheelset and the rails under its wheels

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
  int iterations;  // 0 to kNewtonSweeps
  /// Largest |z_i - z_free_i - (Y F)_i| over |z_i| + |z_free_i| + sqrt(Y_ii) max_k sqrt(Y_kk)
  /// |F_k|. The last term lends the size of the largest force to coordinates of any unit that are
  /// at rest.
  double residual;
};

inline constexpr double kNewtonTolerance = 1e-12;  // where a problem does not say another

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
  double* scratch;       // [n][n]
  double tolerance = kNewtonTolerance;
};

/// Whether all numbers are finite, and blocks follow each other and fill the n coordinates.
[[nodiscard]] bool is_usable(const NewtonProblem& p, const double* start) noexcept;
/// Square roots of the diagonal of Y. @param root  [n] out
void find_roots(const NewtonProblem& p, double* root) noexcept;
/// Finds z - z_free - Y F at a point whose forces are known.
void find_missed(const NewtonProblem& p, const double* root, NewtonPoint& at) noexcept;
/// Newton's step (I - Y J) step = -missed, by elimination with row exchanges. I - Y J has no pivots
/// of one sign, as J is not symmetric and Y couples the coordinates.
/// @returns false where a pivot is not above 1e-12 of the matrix; the step is then
///   -missed / (1 - Y_ii J_ii) of each coordinate by itself
[[nodiscard]] bool newton_step(const NewtonProblem& p, const double* root, const NewtonPoint& at,
                               double* step) noexcept;

/// Forces at a point, and their slopes on request.
template <typename Law>
void find_forces(const NewtonProblem& p, const Law& law, const double* root, bool slopes,
                 NewtonPoint& at) noexcept {
  double* slope = at.slope;
  for (int b = 0; b < p.blocks; ++b) {
    const LawBlock& own = p.block[b];
    law(b, at.z + own.first, at.force + own.first, slopes ? slope : nullptr);
    slope += own.size * own.size;
  }
  find_missed(p, root, at);
}

/// The point at a part of a step.
template <typename Law>
void go_part(const NewtonProblem& p, const Law& law, const double* root, const NewtonPoint& from,
             const double* step, double part, NewtonPoint& to) noexcept {
  for (int i = 0; i < p.n; ++i) to.z[i] = from.z[i] + part * step[i];
  find_forces(p, law, root, false, to);
}

/// Laws of any kind at the interfaces of linear parts: z = z_free + Y F(z), by Newton's method with
/// the laws' own slopes. A step that does not lessen the residual is halved, at most twice. Laws
/// that are scalar, rising and without friction have a solver of their own, which cannot fail
/// (ports.h).
/// @param law    law(b, z, force, slope) of block b: its coordinates, [size]; its forces, [size];
///               and unless slope is null their slopes, [size][size]. Finite for finite z.
/// @param force  [n] out
/// @param z      [n] in: a start; out: the solution
/// Work: at most kNewtonSweeps eliminations, as many evaluations of all laws with slopes, and
/// 1 + 3 kNewtonSweeps of the forces alone.
template <typename Law>
[[nodiscard]] NewtonResult solve_laws(const NewtonProblem& p, const Law& law, double* force,
                                      double* z) noexcept {
  if (!is_usable(p, z)) {
    for (int i = 0; i < p.n && i < kMostNewton; ++i) force[i] = z[i] = 0.;
    return {NewtonStatus::bad_input, 0, 0.};
  }
  NewtonPoint points[2];
  NewtonPoint *at = points, *next = points + 1;
  double root[kMostNewton];
  find_roots(p, root);
  for (int i = 0; i < p.n; ++i) at->z[i] = z[i];
  find_forces(p, law, root, true, *at);
  int iterations = 0;
  bool weak = false;
  // A step is taken only where it lessens the residual, so that the last point is the best one.
  for (bool better = true; better && at->residual > p.tolerance && iterations < kNewtonSweeps;
       ++iterations) {
    if (iterations > 0) find_forces(p, law, root, true, *at);
    double step[kMostNewton];
    if (!newton_step(p, root, *at, step)) weak = true;
    double part = 1.;
    better = false;
    for (int halving = 0; halving < 3 && !better; ++halving, part *= .5) {
      go_part(p, law, root, *at, step, part, *next);
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
  const bool done = at->residual <= p.tolerance;
  return {done   ? NewtonStatus::converged
          : weak ? NewtonStatus::weak_pivot
                 : NewtonStatus::cap_reached,
          iterations, at->residual};
}

}  // namespace railstep
