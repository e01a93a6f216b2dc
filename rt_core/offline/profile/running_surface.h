#pragma once
#include <vector>

namespace railstep {

/// A piece of a running surface: over `from` <= y <= `to` a polynomial, or an arc of a circle.
struct SurfacePiece {
  double from, to;  // m
  double middle;    // m, where the polynomial's powers are 0; of an arc's centre
  double height;    // m, of an arc's centre; of a polynomial nothing
  double radius;    // m: > 0 the upper half of the circle, < 0 its lower half, 0 a polynomial
  std::vector<double> coefficients;  // of powers of y - middle, m^(1-k); of an arc none
};

/// Height of a running surface at a place and its first two derivatives.
struct SurfacePoint {
  double height;     // m
  double slope;      // 1
  double curvature;  // second derivative, 1/m
};

/// The line along which a wheel or a railhead touches, as one height over each lateral place y: of
/// a rail upwards; of a wheel the growth of its radius (EN 13715), which is downwards.
class RunningSurface {
 public:
  static constexpr double kLargestStep = 1e-6;  // m, at a joint of two pieces
  static constexpr double kLargestKink = 1e-3;  // rad

  /// @param pieces  side by side, in the order of y
  /// Throws Refused for no pieces, for a piece that is empty, not finite or longer than its circle,
  /// and for two pieces with a gap, a step or a kink between them.
  explicit RunningSurface(std::vector<SurfacePiece> pieces);

  /// @param y  m, from first() to last(); beyond them the end piece goes on
  [[nodiscard]] SurfacePoint at(double y) const;
  [[nodiscard]] double first() const { return pieces_.front().from; }
  [[nodiscard]] double last() const { return pieces_.back().to; }
  [[nodiscard]] const std::vector<SurfacePiece>& pieces() const { return pieces_; }

 private:
  std::vector<SurfacePiece> pieces_;
};

}  // namespace railstep
