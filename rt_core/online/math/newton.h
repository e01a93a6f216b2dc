#pragma once
#include <cmath>
#include <cstdint>

namespace railstep {

inline constexpr int kNewtonSweeps = 8;  // most iterations of one solve
inline constexpr int kMostNewton = 128;  // coordinates
inline constexpr int kMostLaw = 12;      // of one law: a wheelset and the rails under its wheels

/// Coordinates of one law: `size` of them from `first` on. Its forces on these depend on them
/// alone, mostly by `rank` scalars, such as the normal force and the creep forces of a wheel.
struct LawBlock {
  int first, size, rank;  // 1 <= rank <= size
};

/// Slopes of the forces on a law's coordinates as a product of two factors, spread * slope.
struct LawSlopes {
  double* spread;  // [size][rank] forces on the coordinates by a unit of each scalar
  double* slope;   // [rank][size] of the scalars
};

inline constexpr int kChangePasses = 2;  // by which a step takes changes of slopes

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
  double missed[kMostNewton];  // z - z_free - Y F
  double steep[kMostNewton];   // of each scalar: its slope here, in any unit of its own
  double residual;
};

/// A problem z = z_free + Y F(z) of n coordinates.
struct NewtonProblem {
  int n, blocks;
  const double* Y;  // [n][n] compliance of the linear parts, symmetric, positive semidefinite
  const LawBlock* block;
  const double* z_free;  // [n]
  double* scratch;       // newton_scratch() of the sizes
  double tolerance = kNewtonTolerance;
  /// [n] what lends sizes in place of Y's diagonal, m/N; null: that
  const double* diagonal = nullptr;
};

/// Whether all numbers are finite, and blocks follow each other and fill the n coordinates.
[[nodiscard]] bool is_usable(const NewtonProblem& p, const double* start) noexcept;
/// Square roots of the diagonal of Y. @param root  [n] out
void find_roots(const NewtonProblem& p, double* root) noexcept;
/// Finds z - z_free - Y F at a point whose forces are known.
void find_missed(const NewtonProblem& p, const double* root, NewtonPoint& at) noexcept;
/// The slopes of all laws at one point, and the matrix of the scalars, which has fewer rows than
/// that of the coordinates: with J = B S a step dz = -missed + Y B t has t of
/// (I - S Y B) t = -S missed. Normal forces and creep forces have steep slopes in their own
/// directions; the matrix's leading minors are then positive, or nearly so.
struct NewtonSlopes {
  double *spread, *slope;     // blocks, one by one
  double* moved;              // [ranks][n] Y B, column by column
  double* factor;             // [ranks][ranks]
  double steep[kMostNewton];  // NewtonPoint::steep where they were found
  int exchange[kMostNewton];
  int ranks;
  bool solvable;
};
/// Numbers of NewtonProblem::scratch. @param blocks  sum of size times rank of all laws
constexpr std::int64_t newton_scratch(std::int64_t n, std::int64_t ranks,
                                      std::int64_t blocks) noexcept {
  return 2 * blocks + n * ranks + ranks * ranks;
}
/// Places the slopes in the scratch.
void place_slopes(const NewtonProblem& p, NewtonSlopes& slopes) noexcept;
/// Factors I - S Y B by elimination with row exchanges; not solvable where a pivot is not above
/// 1e-12 of the matrix. The laws' slopes must be known.
void factor_slopes(const NewtonProblem& p, NewtonSlopes& slopes) noexcept;
/// Step from a point by slopes that may be those of another point; NewtonPoint::steep says how far
/// they changed. If the slopes are not solvable, the step is -missed / (1 - Y_ii J_ii) of each
/// coordinate by itself.
void newton_step(const NewtonProblem& p, const NewtonSlopes& slopes, const NewtonPoint& at,
                 double* step) noexcept;

/// Forces at a point, and their slopes on request.
template <typename Law>
void find_forces(const NewtonProblem& p, const Law& law, const double* root, NewtonSlopes* slopes,
                 NewtonPoint& at) noexcept {
  std::ptrdiff_t passed = 0;
  double* steep = at.steep;
  for (int b = 0; b < p.blocks; ++b) {
    const LawBlock& own = p.block[b];
    LawSlopes of_law{};
    if (slopes != nullptr) of_law = {slopes->spread + passed, slopes->slope + passed};
    for (int k = 0; k < own.rank; ++k) steep[k] = 1.;
    law(b, at.z + own.first, at.force + own.first, slopes == nullptr ? nullptr : &of_law, steep);
    passed += std::ptrdiff_t{own.size} * own.rank;
    steep += own.rank;
  }
  for (int k = 0; slopes != nullptr && k < slopes->ranks; ++k) slopes->steep[k] = at.steep[k];
  find_missed(p, root, at);
}

/// The point at a part of a step.
template <typename Law>
void go_part(const NewtonProblem& p, const Law& law, const double* root, const NewtonPoint& from,
             const double* step, double part, NewtonPoint& to) noexcept {
  for (int i = 0; i < p.n; ++i) to.z[i] = from.z[i] + part * step[i];
  find_forces(p, law, root, nullptr, to);
}

inline constexpr double kSlowStep = .03;
/// Whether the slopes have to be found again: a step by the present ones left more than kSlowStep
/// of the residual, or as many such steps as there may still be would not end the iteration.
inline bool is_slow(double residual, double before, double tolerance, int steps_left) noexcept {
  if (!(residual <= kSlowStep * before)) return true;
  const double part = residual / before;
  for (int i = 0; i < steps_left; ++i) residual *= part;
  return residual > tolerance;
}

/// Laws of any kind at the interfaces of linear parts: z = z_free + Y F(z), by Newton's method with
/// the laws' own slopes, which are kept as long as steps by them lessen the residual fast. A step
/// that does not lessen it is halved, at most twice. Laws that are scalar, rising and without
/// friction have a solver of their own, which cannot fail (ports.h).
/// @param law    law(b, z, force, slopes, steep) of block b: its coordinates, [size]; its forces,
///               [size]; unless `slopes` is null, where the factors of their slopes go; and [rank],
///               each scalar's slope in a unit of its own, which a law may leave at 1 where it
///               does not change. Finite for finite z.
/// @param force  [n] out
/// @param z      [n] in: a start; out: the solution
/// Work: at most kNewtonSweeps eliminations, as many evaluations of all laws with slopes, and
/// 3 kNewtonSweeps of the forces alone.
template <typename Law>
[[nodiscard]] NewtonResult solve_laws(const NewtonProblem& p, const Law& law, double* force,
                                      double* z) noexcept {
  if (!is_usable(p, z)) {
    for (int i = 0; i < p.n && i < kMostNewton; ++i) force[i] = z[i] = 0.;
    return {NewtonStatus::bad_input, 0, 0.};
  }
  NewtonPoint points[2];
  NewtonPoint *at = points, *next = points + 1;
  NewtonSlopes slopes;
  place_slopes(p, slopes);
  double root[kMostNewton];
  find_roots(p, root);
  for (int i = 0; i < p.n; ++i) at->z[i] = z[i];
  find_forces(p, law, root, &slopes, *at);
  int iterations = 0;
  bool weak = false, renew = true, better = true;
  // A step is taken only where it lessens the residual, so that the last point is the best one.
  for (; at->residual > p.tolerance && iterations < kNewtonSweeps; ++iterations) {
    if (renew) {
      if (iterations > 0) find_forces(p, law, root, &slopes, *at);
      factor_slopes(p, slopes);
      if (!slopes.solvable) weak = true;
    }
    double step[kMostNewton];
    newton_step(p, slopes, *at, step);
    double part = 1.;
    better = false;
    for (int halving = 0; halving < 3 && !better; ++halving, part *= .5) {
      go_part(p, law, root, *at, step, part, *next);
      better = next->residual < at->residual;
    }
    if (!better && renew) break;
    renew = !better ||
            is_slow(next->residual, at->residual, p.tolerance, kNewtonSweeps - 1 - iterations);
    if (!better) continue;
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
