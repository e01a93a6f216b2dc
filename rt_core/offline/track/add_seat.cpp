#include <cmath>

#include "offline/element/shape.h"
#include "offline/track/assembly.h"
#include "offline/track/pad.h"
#include "offline/track/squeeze.h"

namespace railstep {

namespace {

/// A rigid sleeper of mass m, roll inertia I and rail spacing g in the scaled motions of Line: its
/// ends' mean height, times sqrt 2, moves m/2; half the difference of their heights, times sqrt 2,
/// which is g roll/sqrt 2, moves 2I/g^2. So do x and yaw; y and pitch are the mean of both ends. In
/// mirror coordinates of the rails, sqrt 2 times those of a symmetric (or antisymmetric) left rail,
/// the end under it moves by just that; in the rails' own by sqrt 1/2 of it, at the right one with
/// the other sign where the ends differ.
///
/// Pads stand in the axes of their rail. The sleeper's top under one, off the end's middle by the
/// pad's lean too, moves by its end's displacement and rises by the roll times that distance.
class SeatRows {
 public:
  SeatRows(const Track& track, const Assembly& part, int border, int rail)
      : line_(part.line),
        pad_(track.seat(border).pad[static_cast<std::size_t>(rail)]),
        sleeper_(part.line.sleeper_unknown_of[static_cast<std::size_t>(border)]),
        rail_(rail),
        cant_(track.lean(rail)),
        spacing_(track.rail_spacing),
        share_(part.rails.size() == 2 ? std::sqrt(.5) : 1.),
        side_(rail == 0 ? 1. : -1.) {}

  /// Strain of the pad along d at one of its points, y beside the middle of the rail.
  Row gap(const PadPoint& at, std::size_t d, double y) const {
    Row row = rail_moves(at, d, y);
    const double aside = cant_.cosine * y - cant_.sine * pad_.height_z;
    const double lever = side_ + 2. * aside / spacing_;
    if (d == 0) {
      push(row, sleeper_[kYaw], -share_ * lever);
      push(row, sleeper_[kAlongX], -share_);
      return row;
    }
    // The part along d of the sleeper's motion along y and z.
    const double across = d == 1 ? cant_.cosine : -cant_.sine;
    const double up = d == 2 ? cant_.cosine : cant_.sine;
    push(row, sleeper_[kRoll], -share_ * (lever * up));
    push(row, sleeper_[kPitch], share_ * (at.offset * up));
    push(row, sleeper_[kAlongY], -share_ * across);
    push(row, sleeper_[kAlongZ], -share_ * up);
    return row;
  }
  /// How far the pad rolls about x at one of its points.
  Row roll(const PadPoint& at) const {
    Row row;
    for_nodes(at, [&](int node, double shape) {
      push_node(row, at.element, node, 5, .5 * shape);
      push_node(row, at.element, node, 7, -.5 * shape);
    });
    push(row, sleeper_[kRoll], -share_ * 2. / spacing_);
    return row;
  }
  /// The sleeper's end on its ballast.
  Row end(std::size_t d) const {
    Row row;
    push(row, sleeper_[kMean[d]], share_);
    if (d == 0) push(row, sleeper_[kYaw], share_ * side_);
    if (d == 2) push(row, sleeper_[kRoll], share_ * side_);
    return row;
  }
  /// The turn of the sleeper's end about y.
  Row pitch() const {
    Row row;
    push(row, sleeper_[kPitch], share_);
    return row;
  }

 private:
  static constexpr std::array<std::size_t, 3> kMean = {kAlongX, kAlongY, kAlongZ};

  /// Nodes of the element that a point of the pad acts on; a pad that is a point stands on one.
  template <typename Visit>
  void for_nodes(const PadPoint& at, const Visit& visit) const {
    if (pad_.length == 0.) return visit(at.xi < 0. ? 0 : 2, 1.);
    const auto n = shape(at.xi);
    for (int i = 0; i < 3; ++i) visit(i, n[static_cast<std::size_t>(i)]);
  }
  /// In mirror coordinates the left rail's unknowns stand for both rails, so that no sign changes.
  void push_node(Row& row, int element, int node, int k, double coefficient) const {
    const int unknown = line_.element_unknown(rail_, element, node, k);
    push(row, unknown, sign_of(line_, 0, k) * coefficient);
  }
  Row rail_moves(const PadPoint& at, std::size_t d, double y) const {
    const int k = static_cast<int>(d);
    Row row;
    for_nodes(at, [&](int node, double shape) {
      push_node(row, at.element, node, k, shape);
      push_node(row, at.element, node, 3 + k, y * shape);
      push_node(row, at.element, node, 6 + k, pad_.height_z * shape);
    });
    return row;
  }

  const Line& line_;
  Support pad_;
  std::array<int, kSleeperMotions> sleeper_;
  int rail_;
  Cant cant_;
  double spacing_, share_, side_;
};

void add_pad(const Track& track, Assembly& part, int border, int rail, const SeatRows& rows,
             const Support& pad) {
  const double left = part_of_pad(track, border, rail);
  for (const PadPoint& at : pad_points(track, border, pad.length)) {
    for (const double side : {-1., 1.})
      for (std::size_t d = 0; d < 3; ++d) {
        const Row gap = rows.gap(at, d, side * pad.half_spread);
        if (d == 2 && pad.one_sided()) {
          Assembly::tie(part.stiffness, gap);
          continue;
        }
        Assembly::add(part.stiffness, gap, at.part * pad.stiffness[d] / 2.);
        Assembly::add(part.damping, gap, at.part * pad.damping[d] / 2.);
      }
    // The squeeze of the section acts on the mean, not on the rotation.
    if (left < 1. && !pad.one_sided()) {
      const Row mean = rows.gap(at, 2, 0.);
      Assembly::add(part.stiffness, mean, at.part * pad.stiffness[2] * (left - 1.));
      Assembly::add(part.damping, mean, at.part * pad.damping[2] * (left * left - 1.));
    }
    // Rails without roll unknowns leave the sleeper's roll alone; a rail whose end is held does
    // not.
    if (!moves_sideways(track.unknowns)) continue;
    const Row roll = rows.roll(at);
    Assembly::add(part.stiffness, roll, at.part * pad.roll_stiffness);
    Assembly::add(part.damping, roll, at.part * pad.roll_damping);
  }
}

/// Lets a part of the damper under `moves` act through a spring, whose compression e has no other
/// stiffness. Its small mass makes it a motion of second order, which condensed lines can hold.
void relax(Assembly& part, Row moves, int e, const Relaxing& own, double factor) {
  constexpr double kFastest = 3e6;  // 1/s
  if (e < 0) return;
  Assembly::add(part.stiffness, {{e, 1.}}, factor * own.stiffness);
  Assembly::add(part.mass, {{e, 1.}}, factor * own.damping / kFastest);
  Assembly::add(part.damping, moves, -factor * own.damping);
  push(moves, e, -1.);
  Assembly::add(part.damping, moves, factor * own.damping);
}

/// Springs and dampers under one end of the sleeper; spread over a length L they hold its pitch by
/// k L^2/12.
/// @param relaxing, relaxing_pitch  unknowns of the part that relaxes; -1 where nothing relaxes
void add_ballast(Assembly& part, const SeatRows& rows, const Ballast& ballast, int relaxing,
                 int relaxing_pitch) {
  for (std::size_t d = 0; d < 3; ++d) {
    const Row end = rows.end(d);
    if (d == 2 && ballast.one_sided()) {
      Assembly::tie(part.stiffness, end);
      continue;
    }
    Assembly::add(part.stiffness, end, ballast.stiffness[d]);
    Assembly::add(part.damping, end, ballast.damping[d]);
  }
  const double arm = ballast.length * ballast.length / 12.;
  Assembly::add(part.stiffness, rows.pitch(), ballast.stiffness[2] * arm);
  Assembly::add(part.damping, rows.pitch(), ballast.damping[2] * arm);
  relax(part, rows.end(2), relaxing, ballast.relaxing, 1.);
  relax(part, rows.pitch(), relaxing_pitch, ballast.relaxing, arm);
}

/// The sleeper's own inertia.
void add_body(const Track& track, Assembly& part, int border, const SleeperBody& body) {
  const double g = track.rail_spacing, rotary = 2. * body.roll_inertia / (g * g);
  const std::array<double, kSleeperMotions> inertia = {
      body.mass / 2., body.mass / 2., body.mass / 2., rotary, rotary, body.pitch_inertia / 2.};
  const auto& sleeper = part.line.sleeper_unknown_of[static_cast<std::size_t>(border)];
  for (std::size_t motion = 0; motion < inertia.size(); ++motion) {
    Row row;
    push(row, sleeper[motion], 1.);
    Assembly::add(part.mass, row, inertia[motion]);
  }
}

}  // namespace

void add_seat(const Track& track, Assembly& part, int border) {
  const Seat seat = track.seat(border);
  const auto& sleeper = part.line.sleeper_unknown_of[static_cast<std::size_t>(border)];
  for (const int rail : part.rails) {
    const auto side = static_cast<std::size_t>(rail);
    const SeatRows rows(track, part, border, rail);
    add_pad(track, part, border, rail, rows, seat.pad[side]);
    if (seat.sleeper)
      add_ballast(part, rows, seat.ballast[side], sleeper[kRelaxing + side],
                  sleeper[kRelaxingPitch + side]);
  }
  if (seat.sleeper) add_body(track, part, border, *seat.sleeper);
}

}  // namespace railstep
