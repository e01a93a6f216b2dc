#include "offline/profile/running_surface.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "offline/math/refuse.h"

namespace railstep {

namespace {

std::string millimetres(double metres) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g mm", 1e3 * metres);
  return text;
}

SurfacePoint at_arc(const SurfacePiece& arc, double y) {
  const double across = y - arc.middle;
  const double up = std::sqrt(std::max(arc.radius * arc.radius - across * across, 0.));
  const double sign = arc.radius > 0. ? 1. : -1.;
  return {arc.height + sign * up, -sign * across / up,
          -sign * arc.radius * arc.radius / (up * up * up)};
}

SurfacePoint at_polynomial(const SurfacePiece& piece, double y) {
  SurfacePoint p{0., 0., 0.};
  const double x = y - piece.middle;
  for (std::size_t k = piece.coefficients.size(); k-- > 0;) {
    p.curvature = p.curvature * x + 2. * p.slope;
    p.slope = p.slope * x + p.height;
    p.height = p.height * x + piece.coefficients[k];
  }
  return p;
}

SurfacePoint at_piece(const SurfacePiece& piece, double y) {
  return piece.radius == 0. ? at_polynomial(piece, y) : at_arc(piece, y);
}

void check_piece(const SurfacePiece& piece) {
  if (!(piece.to > piece.from))
    refuse("E-SURFACE-02", "the piece from " + millimetres(piece.from) + " to " +
                               millimetres(piece.to) +
                               " is empty; expected its end beyond its "
                               "start");
  const double reach =
      std::max(std::abs(piece.from - piece.middle), std::abs(piece.to - piece.middle));
  if (piece.radius != 0. && !(reach <= std::abs(piece.radius)))
    refuse("E-SURFACE-03", "the arc from " + millimetres(piece.from) + " to " +
                               millimetres(piece.to) + " leaves its circle of radius " +
                               millimetres(std::abs(piece.radius)) + " about " +
                               millimetres(piece.middle));
  for (const double y : {piece.from, piece.to})
    if (!std::isfinite(at_piece(piece, y).height))
      refuse("E-SURFACE-04", "the height at " + millimetres(y) + " is not a finite number");
}

void check_joint(const SurfacePiece& left, const SurfacePiece& right) {
  const std::string place = "at " + millimetres(right.from);
  if (left.to != right.from)
    refuse("E-SURFACE-05", "the piece that begins " + place + " follows one that ends at " +
                               millimetres(left.to) + "; expected no gap and no overlap");
  const SurfacePoint a = at_piece(left, left.to), b = at_piece(right, right.from);
  if (std::abs(a.height - b.height) > RunningSurface::kLargestStep)
    refuse("E-SURFACE-06", "the surface has a step of " + millimetres(b.height - a.height) + " " +
                               place + "; expected at most 0.001 mm");
  if (std::abs(std::atan(a.slope) - std::atan(b.slope)) > RunningSurface::kLargestKink)
    refuse("E-SURFACE-07", "the surface has a kink " + place + ", from slope " +
                               std::to_string(a.slope) + " to " + std::to_string(b.slope) +
                               "; expected at most 0.001 rad");
}

}  // namespace

RunningSurface::RunningSurface(std::vector<SurfacePiece> pieces) : pieces_(std::move(pieces)) {
  if (pieces_.empty()) refuse("E-SURFACE-01", "the surface has no piece; expected at least one");
  for (const SurfacePiece& piece : pieces_) check_piece(piece);
  for (std::size_t i = 1; i < pieces_.size(); ++i) check_joint(pieces_[i - 1], pieces_[i]);
}

SurfacePoint RunningSurface::at(double y) const {
  const auto beyond =
      std::upper_bound(pieces_.begin() + 1, pieces_.end(), y,
                       [](double place, const SurfacePiece& piece) { return place < piece.from; });
  return at_piece(*(beyond - 1), y);
}

}  // namespace railstep
