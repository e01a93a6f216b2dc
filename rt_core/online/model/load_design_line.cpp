#include "online/model/load_design_line.h"

#include <cmath>
#include <initializer_list>

#include "online/math/finite.h"

namespace railstep {

namespace {

/// Whether rows rise, values are at most `most` in size, and change by at most `steepest` per
/// length.
bool line_table_is_valid(const LineTable& t, double most, double steepest) noexcept {
  constexpr double kRounded = 1. + 1e-9;
  if (t.rows > 0 && t.value == nullptr) return false;
  for (std::int32_t i = 0; i < t.rows; ++i) {
    const double* const row = t.value + std::ptrdiff_t{2} * i;
    if (!is_moderate(row[0]) || !(std::fabs(row[1]) <= kRounded * most)) return false;
    if (i == 0) continue;
    const double way = row[0] - row[-2];
    if (!(way > 0.) || !(std::fabs(row[1] - row[-1]) <= kRounded * steepest * way)) return false;
  }
  return true;
}

bool centres_are_moderate(const double* centre, std::int32_t bodies) noexcept {
  for (std::int32_t i = 0; i < 3 * bodies; ++i)
    if (!is_moderate(centre[i])) return false;
  return true;
}

/// Whether an element's numbers are moderate, and its ends are as far from each other as it is
/// long.
bool element_is_valid(const FrameElement& e, const double* first, const double* second) noexcept {
  double square = 0.;
  for (int k = 0; k < 6; ++k)
    for (const double x : {e.arm[k / 3][k % 3], e.stiffness[k], e.damping[k], e.preload[k]})
      if (!is_moderate(x)) return false;
  for (int d = 0; d < 3; ++d) {
    const double way = (first[d] + e.arm[0][d]) - (second[d] + e.arm[1][d]);
    square += way * way;
  }
  return e.along_line == 0. ||
         (e.along_line > 0. && std::fabs(std::sqrt(square) - e.along_line) <= 1e-6 * e.along_line);
}

/// Whether the pairs of frames are bodies of the runner with their elements, and no table of the
/// line has more pieces between them than stated.
bool pairs_are_valid(const DesignLine& l, const RunnerModel& r) noexcept {
  const RunnerFrames& f = r.frames;
  std::int32_t elements = 0;
  for (std::int32_t i = 0; i < f.pairs; ++i) {
    const FramePair& pair = f.pair[i];
    if (pair.body[0] >= pair.body[1] || pair.body[1] >= r.bodies) return false;
    const double *const first = f.centre + std::ptrdiff_t{3} * pair.body[0], *const second =
                                                                                 f.centre +
                                                                                 std::ptrdiff_t{3} *
                                                                                     pair.body[1];
    for (const LineTable* table : {&l.curvature, &l.gradient})
      if (pieces_within(*table, std::fabs(second[0] - first[0])) > l.pieces) return false;
    if (elements + pair.elements > f.elements) return false;
    for (std::int32_t e = 0; e < pair.elements; ++e)
      if (!element_is_valid(f.element[elements++], first, second)) return false;
  }
  return elements == f.elements;
}

}  // namespace

bool design_line_is_valid(const DesignLine& l) noexcept {
  constexpr double kAny = 1e300;
  return line_table_is_valid(l.curvature, kMostCurvature, kAny) &&
         line_table_is_valid(l.cant, kMostCant, kMostTwist) &&
         line_table_is_valid(l.gradient, kMostGradient, kMostVerticalCurvature);
}

bool frames_are_valid(const DesignLine& l, const RunnerModel& r) noexcept {
  const RunnerFrames& f = r.frames;
  if (!is_there(l)) return true;
  if (!f.centre || !centres_are_moderate(f.centre, r.bodies) || !(f.gravity >= 0.)) return false;
  if (f.pairs == 0) return f.elements == 0;
  if (!f.stiffness || !f.preload || (r.force_elements > 0 && !f.elements_moved)) return false;
  if (r.traced_elements > 0 && !f.traced_moved) return false;
  if (r.rods > 0 && (!f.rods || !f.rod_moved || !f.rod_reaction)) return false;
  return (f.elements == 0 || f.element) && pairs_are_valid(l, r);
}

}  // namespace railstep
