#include "online/track/along_line.h"

#include <cmath>

#include "online/math/pi.h"
#include "online/math/search.h"
#include "online/math/sine.h"

namespace railstep {

namespace {

/// The part of the change between two rows at the part x of the way between them, its derivative
/// over x, and its integrals from 0.
struct Shape {
  double value, slope, once, twice;
};
Shape shape_at(Transition transition, double x) noexcept {
  const double square = x * x;
  switch (transition) {
    case Transition::bloss:
      return {square * (3. - 2. * x), 6. * x * (1. - x), square * x * (1. - .5 * x),
              square * square * (.25 - .1 * x)};
    case Transition::cosine: {
      const double sine = sine_of_turns(.5 * x), cosine = sine_of_turns(.5 * x + .25);
      return {.5 - .5 * cosine, .5 * kPi * sine, .5 * x - sine / (2. * kPi),
              .25 * square + (cosine - 1.) / (2. * kPi * kPi)};
    }
    case Transition::linear:
      break;
  }
  return {x, 1., .5 * square, square * x / 6.};
}

/// One piece of a table: from a row to the next, or what is before or behind all rows.
struct Piece {
  double start, length, value, change;  // length 0: constant
};
Piece piece_of(const LineTable& table, std::int32_t row) noexcept {
  const double* const at = table.value + std::ptrdiff_t{2} * (row < 0 ? 0 : row);
  if (row < 0 || row + 1 >= table.rows) return {at[0], 0., at[1], 0.};
  return {at[0], at[2] - at[0], at[1], at[3] - at[1]};
}
/// The row that a place follows; -1: it is before all of them.
std::int32_t row_of(const LineTable& table, double place) noexcept {
  return place < table.value[0] ? -1 : row_at(table.value, 2, table.rows, place);
}

LineIntegral over(const Piece& piece, Transition transition, double from, double to) noexcept {
  const double way = to - from;
  LineIntegral sum{piece.value * way, .5 * piece.value * way * way};
  if (piece.length == 0. || piece.change == 0.) return sum;
  const Shape a = shape_at(transition, (from - piece.start) / piece.length),
              b = shape_at(transition, (to - piece.start) / piece.length);
  sum.once += piece.change * piece.length * (b.once - a.once);
  sum.twice += piece.change * piece.length * (piece.length * (b.twice - a.twice) - a.once * way);
  return sum;
}

/// asin x by its series: within 1e-16 up to |x| = 0.25.
double arc_sine(double x) noexcept {
  constexpr int kTerms = 12;
  const double square = x * x;
  double sum = 1.;
  for (int n = kTerms; n > 0; --n) {
    const double odd = 2. * n - 1.;
    sum = 1. + odd * odd / (2. * n * (odd + 2.)) * square * sum;
  }
  return x * sum;
}

}  // namespace

LineValue value_at(const LineTable& table, Transition transition, double place) noexcept {
  if (table.rows == 0) return {0., 0.};
  const Piece piece = piece_of(table, row_of(table, place));
  if (piece.length == 0.) return {piece.value, 0.};
  const Shape at = shape_at(transition, (place - piece.start) / piece.length);
  return {piece.value + piece.change * at.value, piece.change / piece.length * at.slope};
}

LineIntegral integral(const LineTable& table, Transition transition, std::int32_t pieces,
                      double from, double to) noexcept {
  LineIntegral sum{0., 0.};
  if (table.rows == 0) return sum;
  const bool ahead = to >= from;
  std::int32_t row = row_of(table, from);
  double at = from;
  for (std::int32_t i = 0; i < pieces; ++i, row += ahead ? 1 : -1) {
    double end = to;
    if (ahead && row + 1 < table.rows) {
      const double border = table.value[std::ptrdiff_t{2} * (row + 1)];
      if (border < to) end = border;
    }
    if (!ahead && row >= 0) {
      const double border = table.value[std::ptrdiff_t{2} * row];
      if (border > to) end = border;
    }
    const LineIntegral own = over(piece_of(table, row), transition, at, end);
    sum.twice += sum.once * (end - at) + own.twice;
    sum.once += own.once;
    at = end;
    if (at == to) break;
  }
  return sum;
}

TrackRoll roll_at(const DesignLine& line, double place) noexcept {
  const LineValue sine = value_at(line.cant, line.transition, place);
  const double cosine = std::sqrt(1. - sine.value * sine.value);
  return {arc_sine(sine.value), sine.value, cosine, sine.slope / cosine};
}

FrameRotation rotation_at(const DesignLine& line, double place) noexcept {
  const TrackRoll roll = roll_at(line, place);
  const double level = value_at(line.curvature, line.transition, place).value;
  const LineValue rise = value_at(line.gradient, Transition::linear, place);
  return {roll.slope + level * rise.value, level * roll.sine - rise.slope * roll.cosine,
          level * roll.cosine + rise.slope * roll.sine};
}

FramePose pose_between(const DesignLine& line, double from, double to) noexcept {
  const double way = to - from;
  const TrackRoll own = roll_at(line, from), other = roll_at(line, to);
  LineIntegral level = integral(line.curvature, line.transition, line.pieces, from, to);
  level.twice *= 1. - level.once * level.once / 12.;  // of circles to fourth order
  const double level_from = value_at(line.curvature, line.transition, from).value,
               level_to = value_at(line.curvature, line.transition, to).value;
  const LineValue rise_from = value_at(line.gradient, Transition::linear, from),
                  rise_to = value_at(line.gradient, Transition::linear, to);
  const double risen = rise_to.value - rise_from.value,
               upright = integral(line.gradient, Transition::linear, line.pieces, from, to).once -
                         rise_from.value * way;
  // By a metre of way of both.
  const double level_way = level.once - way * level_from,
               upright_way = risen - way * rise_from.slope, level_change = level_to - level_from,
               upright_change = rise_to.slope - rise_from.slope;
  // A way is seen from the first frame, a rotation from halfway between both.
  const double s = own.sine, c = own.cosine, middle_s = .5 * (own.sine + other.sine),
               middle_c = .5 * (own.cosine + other.cosine),
               middle_rolls = .5 * (own.slope + other.slope);
  const double mean_rise = .5 * (rise_from.value + rise_to.value),
               mean_bend = .5 * (rise_from.slope + rise_to.slope);
  const double aside = c * level.twice + s * upright, above = c * upright - s * level.twice,
               pitch = middle_s * level.once - middle_c * risen,
               yaw = middle_c * level.once + middle_s * risen;
  // Along x a curve is shorter than its arc. A climbing curve is a helix, which rolls.
  return {{-(level.once * level.twice + risen * upright) / 3., aside, above,
           (other.angle - own.angle) + level.once * mean_rise, pitch, yaw},
          {0., (c * level_way + s * upright_way) + own.slope * above,
           (c * upright_way - s * level_way) - own.slope * aside,
           (other.slope - own.slope) + (level_change * mean_rise + level.once * mean_bend),
           (middle_s * level_change - middle_c * upright_change) + middle_rolls * yaw,
           (middle_c * level_change + middle_s * upright_change) - middle_rolls * pitch}};
}

FrameMotion frame_motion(const DesignLine& line, double place, double speed, double faster,
                         double span, double gravity) noexcept {
  const TrackRoll roll = roll_at(line, place);
  const double level = value_at(line.curvature, line.transition, place).value;
  const LineValue rise = value_at(line.gradient, Transition::linear, place);
  const double inwards = speed * speed * level, up = speed * speed * rise.slope;
  const double weight = gravity * std::sqrt(1. - rise.value * rise.value);  // across the line
  FrameMotion m{{gravity * rise.value, inwards * roll.cosine + (up + weight) * roll.sine,
                 (up + weight) * roll.cosine - inwards * roll.sine - gravity},
                {},
                {}};
  const FrameRotation rotation = rotation_at(line, place);
  const double by_way[3] = {rotation.x, rotation.y, rotation.z};
  double change[3] = {};
  if (span > 0.) {
    const double half = .5 * span * speed;
    const FrameRotation before = rotation_at(line, place - half),
                        after = rotation_at(line, place + half);
    change[0] = after.x - before.x;
    change[1] = after.y - before.y;
    change[2] = after.z - before.z;
  }
  for (int d = 0; d < 3; ++d) {
    m.rate[d] = speed * by_way[d];
    m.angular[d] = faster * by_way[d] + (span > 0. ? speed * change[d] / span : 0.);
  }
  return m;
}

}  // namespace railstep
