#include "offline/track/fixed_port.h"

#include <utility>

#include "offline/track/pad.h"
#include "offline/track/squeeze.h"

namespace railstep {

namespace {

/// Displacement of a rail towards its seat, y beside its middle.
Functional pad_closing(const Track& track, int rail, int seat, double y) {
  Functional closing;
  add_underside(track, rail, seat, pad_points(track, seat, 0.).front().x, y, -1., closing);
  add_sleeper_top(track, rail, seat, y, 1., closing);
  return closing;
}

void add_pad(const Track& track, int rail, int seat, std::vector<FixedPort>& ports) {
  const Support pad = track.seat(seat).pad[static_cast<std::size_t>(rail)];
  if (!pad.one_sided() || pad.stiffness[2] + pad.damping[2] == 0.) return;
  const int halves = pad.half_spread > 0. ? 2 : 1;
  const double left = part_of_pad(track, seat, rail);
  for (int half = 0; half < halves; ++half) {
    const double y = half == 0 ? pad.half_spread : -pad.half_spread;
    ports.push_back({.closing = pad_closing(track, rail, seat, y),
                     .stiffness = left * pad.stiffness[2] / halves,
                     .damping = left * left * pad.damping[2] / halves,
                     .gap = pad.gap,
                     .of = FixedPort::Of::pad,
                     .rail = rail,
                     .seat = seat});
  }
}

void add_ballast(const Track& track, int rail, int seat, std::vector<FixedPort>& ports) {
  const Seat there = track.seat(seat);
  const Ballast& ballast = there.ballast[static_cast<std::size_t>(rail)];
  if (!there.sleeper || !ballast.one_sided()) return;
  if (ballast.stiffness[2] + ballast.damping[2] == 0.) return;
  ports.push_back({.closing = {.rail = {}, .sleeper = {{rail, seat, 2, -1.}}},
                   .stiffness = ballast.stiffness[2],
                   .damping = ballast.damping[2],
                   .gap = ballast.gap,
                   .of = FixedPort::Of::ballast,
                   .rail = rail,
                   .seat = seat});
}

/// Displacement of the end behind a joint towards the end ahead.
Functional ends_closing(const Track& track, int rail, double x) {
  return {.rail = {{{rail, x - kBehind * track.element_length(), 0., 0., 0}, 1.},
                   {{rail, x, 0., 0., 0}, -1.}},
          .sleeper = {}};
}

void add_joints(const Track& track, std::vector<FixedPort>& ports) {
  if (!moves_sideways(track.unknowns)) return;
  for (std::size_t j = 0; j < track.joints.size(); ++j)
    for (int rail = 0; rail < track.rails; ++rail) {
      const RailJoint& joint = track.joints[j];
      const auto side = static_cast<std::size_t>(rail);
      if (!joint.rails[side] || joint.end_stiffness == 0.) continue;
      const double x = .5 * joint_node(track, joint) * track.element_length();
      ports.push_back({.closing = ends_closing(track, rail, x),
                       .stiffness = joint.end_stiffness,
                       .damping = joint.end_damping,
                       .gap = joint.gap[side],
                       .preload = joint.end_force[side],
                       .of = FixedPort::Of::joint,
                       .rail = rail,
                       .joint = static_cast<int>(j)});
    }
}

/// Applies `change` to the pad and the ballast of each side of each seat.
template <typename Change>
void change_sides(Track& track, const Change& change) {
  for (int border = 0; border <= track.bays; ++border) {
    const Seat before = track.seat(border);
    Seat after = before;
    for (const std::size_t side : {0u, 1u}) {
      change(after.pad[side]);
      change(after.ballast[side]);
    }
    if (!(after == before)) track.changed_seats[border] = after;
  }
}

}  // namespace

std::vector<FixedPort> fixed_ports(const Track& track) {
  std::vector<FixedPort> ports;
  for (int rail = 0; rail < track.rails; ++rail)
    for (int seat = 0; seat <= track.bays; ++seat) {
      add_pad(track, rail, seat, ports);
      add_ballast(track, rail, seat, ports);
    }
  for (std::size_t i = 0; i < track.stops.size(); ++i) {
    const Stop& stop = track.stops[i];
    if (stop.stiffness + stop.damping == 0.) continue;
    ports.push_back(
        {.closing = {.rail = {{{stop.rail, stop.x, 0., stop.z, stop.direction}, stop.side}},
                     .sleeper = {}},
         .stiffness = stop.stiffness,
         .damping = stop.damping,
         .gap = stop.gap,
         .of = FixedPort::Of::stop,
         .rail = stop.rail,
         .stop = static_cast<int>(i)});
  }
  add_joints(track, ports);
  return ports;
}

Eigen::SparseVector<double> closing_row(const Track& track, const Line& line,
                                        const FixedPort& port) {
  return functional_row(track, line, port.closing);
}

Eigen::VectorXd preload(const Track& track, const Line& line) {
  Eigen::VectorXd force = Eigen::VectorXd::Zero(line.unknowns());
  for (const FixedPort& port : fixed_ports(track))
    if (port.preload != 0.) force += port.preload * closing_row(track, line, port);
  return force;
}

Track linear_about_rest(Track track) {
  join_closed_ends(track);
  change_sides(track, [](auto& spring) {
    if (spring.gap == 0.) spring.unilateral = false;
  });
  track.stops.clear();
  return track;
}

bool is_closed_at_rest(const FixedPort& port) {
  if (port.of == FixedPort::Of::stop) return false;
  return port.of == FixedPort::Of::joint ? port.preload > 0. : port.gap == 0.;
}

Track all_open(Track track) {
  change_sides(track, [](auto& spring) {
    if (!spring.one_sided()) return;
    spring.stiffness[2] = spring.damping[2] = 0.;
  });
  for (RailJoint& joint : track.joints) {
    joint.end_stiffness = joint.end_damping = 0.;
    joint.gap = joint.end_force = {};
  }
  track.stops.clear();
  return track;
}

}  // namespace railstep
