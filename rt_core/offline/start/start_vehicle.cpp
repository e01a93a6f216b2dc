#include "offline/start/start_vehicle.h"

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "offline/contact/hertz.h"
#include "offline/math/refuse.h"
#include "offline/start/static_lines.h"
#include "online/contact/wheel.h"
#include "online/model/progress.h"
#include "online/runner/body_force.h"
#include "online/track/travel.h"

namespace railstep {

namespace {

constexpr int kIterations = 50;  // of Newton's method; a few are enough if there is a solution
constexpr double kForceSettled = 1e-10;  // of the largest force; the error left is its square
constexpr double kLiftedOff = 1e-9;      // of the load of all wheels
constexpr double kSoftest = 1e6;         // N/m, least stiffness that scales the equations

using Rows =
    Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;

/// The matrices of all vehicles as one.
struct Together {
  Eigen::MatrixXd stiffness, row;  // [all][all], [wheels][all]
  Eigen::VectorXd weight;          // [all] N, less the forces upwards at the start
  double carried;                  // N, by all wheels together
  double stiff;                    // N/m: forces are divided by it, for pivots of one size
};

/// Load of the wheels: the weight along the motion in which all heights rise by the same amount,
/// which stretches no spring.
double carried(const Together& all) {
  const Eigen::Index n = all.weight.size(), wheels = all.row.rows();
  Eigen::MatrixXd A(n + wheels, n);
  A << all.stiffness / all.stiff, all.row;
  Eigen::VectorXd b = Eigen::VectorXd::Zero(n + wheels);
  b.tail(wheels).setOnes();
  return all.weight.dot(A.colPivHouseholderQr().solve(b));
}

Together together(const Model& model) {
  Eigen::Index n = 0;
  for (std::int32_t b = 0; b < model.vehicles; ++b) n += model.vehicle[b].size;
  Together all{Eigen::MatrixXd::Zero(n, n), Eigen::MatrixXd::Zero(model.vehicle_wheels, n),
               Eigen::VectorXd::Zero(n), 0., 0.};
  Eigen::VectorXd lift = Eigen::VectorXd::Zero(n);
  n = 0;
  for (std::int32_t b = 0; b < model.vehicles; ++b) {
    const SuspendedModel& v = model.vehicle[b];
    all.stiffness.block(n, n, v.size, v.size) = Rows(v.stiffness, v.size, v.size);
    for (std::int32_t i = 0; i < model.vehicle_wheels; ++i) {
      const ContactModel& wheel = model.contact[vehicle_contact(model, i)];
      if (wheel.bodies == b)
        all.row.row(i).segment(n, v.size) = Eigen::Map<const Eigen::RowVectorXd>(wheel.row, v.size);
    }
    all.weight.segment(n, v.size) = -Eigen::Map<const Eigen::VectorXd>(v.rest, v.size);
    add_forces(v, 0., nullptr, lift.data() + n);
    n += v.size;
  }
  all.stiff = std::max(all.stiffness.diagonal().maxCoeff(), kSoftest);
  all.carried = all.weight.sum();
  if (lift.isZero(0.)) return all;
  all.weight -= lift;
  all.carried = carried(all);
  return all;
}

const ContactLaw& law_of(const Model& model, Eigen::Index wheel) {
  return model.contact[vehicle_contact(model, static_cast<std::int32_t>(wheel))].law;
}

/// Penetration under a force, and its derivative by the force.
struct Depth {
  double value, slope;  // m, m/N
};
Depth depth_of(const ContactLaw& contact, double force) {
  const double value = contact_depth(contact, force);
  return {value, contact.hertz > 0. ? 2. / 3. * value / force : 1. / contact.stiffness};
}

}  // namespace

SettledVehicles settle_vehicles(const Model& model, const Eigen::MatrixXd& flexibility,
                                const Eigen::VectorXd& free) {
  const Together all = together(model);
  const Eigen::Index n = all.weight.size(), wheels = free.size();
  const double stiff = all.stiff;
  Eigen::VectorXd u = Eigen::VectorXd::Zero(n);
  Eigen::VectorXd force =
      Eigen::VectorXd::Constant(wheels, all.carried / static_cast<double>(wheels));
  for (Eigen::Index i = 0; i < wheels; ++i)
    if (law_of(model, i).hertz > 0. && !(force[i] > 0.))
      refuse("E-START-08",
             "no equilibrium: nothing presses a vehicle onto its rail; expected gravity, a force "
             "downwards, or step.start = \"released\"");
  bool settled = false, lifted_off = false;
  for (int iteration = 0; iteration < kIterations && !settled && !lifted_off; ++iteration) {
    Eigen::MatrixXd A(n + wheels, n + wheels);
    Eigen::VectorXd b(n + wheels);
    A.topLeftCorner(n, n) = all.stiffness / stiff;
    A.topRightCorner(n, wheels) = -all.row.transpose();
    A.bottomLeftCorner(wheels, n) = all.row;
    A.bottomRightCorner(wheels, wheels) = stiff * flexibility;
    b.head(n) = (all.row.transpose() * force - all.weight - all.stiffness * u) / stiff;
    b.tail(wheels) = free - all.row * u - flexibility * force;
    for (Eigen::Index i = 0; i < wheels; ++i) {
      const Depth depth = depth_of(law_of(model, i), force[i]);
      A(n + i, n + i) += stiff * depth.slope;
      b[n + i] -= depth.value;
    }
    const Eigen::FullPivLU<Eigen::MatrixXd> lu(A);
    if (!lu.isInvertible())
      refuse("E-START-09",
             "no equilibrium: the springs and wheels of a vehicle leave it a free motion; expected "
             "stiffnesses above 0");
    const Eigen::VectorXd change = lu.solve(b);
    u += change.head(n);
    settled = iteration > 0;
    for (Eigen::Index i = 0; i < wheels; ++i) {
      const double next = force[i] + stiff * change[n + i];
      // A wheel with a negative force gets a tenth of its last force and is iterated again.
      const bool lifted = law_of(model, i).hertz > 0. && !(next > 0.);
      const double taken = lifted ? .1 * force[i] : next;
      if (lifted || std::abs(taken - force[i]) > kForceSettled * force.cwiseAbs().maxCoeff())
        settled = false;
      force[i] = taken;
      if (taken < kLiftedOff * std::abs(all.carried) && lifted) lifted_off = true;
    }
  }
  if (!settled)
    refuse("E-START-10",
           "no equilibrium: a wheel of a vehicle lifts off the rail; expected a load that presses "
           "on each wheel, or step.start = \"released\"");
  SettledVehicles found{force, {}};
  for (Eigen::Index b = 0, at = 0; b < model.vehicles; at += model.vehicle[b].size, ++b)
    found.displacement.emplace_back(u.segment(at, model.vehicle[b].size));
  return found;
}

namespace {

/// Places of the vehicles' wheels, and the part of the rails under them that is not of the lines.
struct Wheels {
  std::vector<RailPoint> point;
  std::vector<RailForce> port;
  std::vector<bool> on_rail;
  Eigen::VectorXd uneven;    // irregularities and residual displacements by other forces, m
  Eigen::MatrixXd residual;  // flexibility between the wheels, m/N
  std::size_t count() const { return point.size(); }
};

Wheels wheels_of(const PackedModel& packed, const Track& track, double time, const Acting& acting) {
  const Model& model = packed.model();
  const auto count = static_cast<std::size_t>(model.vehicle_wheels);
  const Eigen::Index n = model.vehicle_wheels;
  Wheels w{std::vector<RailPoint>(count), std::vector<RailForce>(count), std::vector<bool>(count),
           Eigen::VectorXd(n), Eigen::MatrixXd::Zero(n, n)};
  for (std::size_t i = 0; i < count; ++i) {
    const ContactId contact = vehicle_contact(model, static_cast<std::int32_t>(i));
    const ContactModel& wheel = model.contact[contact];
    const double up[3] = {0., 0., 1.};
    const double rolled = travelled(bodies_of(model, contact).travel, 0.).speed * time;
    const double x = place_of(model, contact) + rolled;
    double& uneven = w.uneven[static_cast<Eigen::Index>(i)];
    w.on_rail[i] = x >= 0. && x <= track.length();
    uneven = signal_at(wheel.tread, rolled).value;
    if (!w.on_rail[i]) continue;
    w.point[i] = point_of(packed, wheel.load_point, x);
    w.port[i] = rail_force(model, wheel.load_point, x, 0.);
    uneven =
        irregularity(model, wheel.tread, wheel.rail, up, x + track_offset(model, 0), rolled).depth;
    for (const RailForce& f : acting.ports)
      uneven += f.force * residual_between(model, f, w.port[i]);
  }
  for (std::size_t j = 0; j < count; ++j)
    for (std::size_t i = 0; i < count; ++i)
      if (w.on_rail[i] && w.on_rail[j])
        w.residual(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
            i == j ? residual_under(model, w.port[i])
                   : residual_between(model, w.port[j], w.port[i]);
  return w;
}

/// Heights of the lines under the wheels as functions of the wheels' forces.
struct Under {
  const Statics& statics;
  const PackedModel& packed;
  double gravity;
  const Acting& others;
  const Wheels& wheels;

  /// @param force  [wheels] on the wheels, up, N
  Eigen::VectorXd heights(const Eigen::VectorXd& force) const {
    Acting all = others;
    for (std::size_t i = 0; i < wheels.count(); ++i)
      if (wheels.on_rail[i])
        all.forces.push_back({wheels.point[i], -force[static_cast<Eigen::Index>(i)]});
    return of(static_lines(packed, statics, all, gravity));
  }
  /// -d(heights)/d(force), m/N.
  Eigen::MatrixXd slopes(const Eigen::VectorXd& force, const Eigen::VectorXd& at) const {
    const bool linear = packed.model().fixed.count == 0;
    Eigen::MatrixXd G = Eigen::MatrixXd::Zero(force.size(), force.size());
    const double more = std::max(kPart * force.cwiseAbs().maxCoeff(), 1.);  // N
    for (std::size_t j = 0; j < wheels.count(); ++j) {
      const auto column = static_cast<Eigen::Index>(j);
      if (!wheels.on_rail[j]) continue;
      if (linear)
        G.col(column) = of(static_lines(packed, statics, {{{wheels.point[j], 1.}}, {}, {}}, 0.));
      else
        G.col(column) =
            (at - heights(force + more * Eigen::VectorXd::Unit(force.size(), column))) / more;
    }
    return G;
  }

 private:
  /// A part of the largest force. Rounding of heights is below 1e-8 of it, so that slopes are good
  /// to 1e-5.
  static constexpr double kPart = 1e-3;

  Eigen::VectorXd of(const std::vector<Eigen::VectorXd>& lines) const {
    Eigen::VectorXd height = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(wheels.count()));
    for (std::size_t i = 0; i < wheels.count(); ++i)
      if (wheels.on_rail[i])
        height[static_cast<Eigen::Index>(i)] =
            height_of(statics.track(), packed, lines, wheels.point[i]);
    return height;
  }
};

}  // namespace

SettledVehicles settle_on_track(const Statics& statics, const PackedModel& packed, double gravity,
                                double time, Acting& acting) {
  const Model& model = packed.model();
  const Wheels wheels = wheels_of(packed, statics.track(), time, acting);
  const Under under{statics, packed, gravity, acting, wheels};
  const Eigen::Index n = model.vehicle_wheels;
  const bool linear = model.fixed.count == 0;
  Eigen::VectorXd force = Eigen::VectorXd::Zero(n);
  if (!linear)  // forces on a level, rigid rail
    force = settle_vehicles(model, Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)).force;
  SettledVehicles settled;
  bool done = false;
  for (int iteration = 0; iteration < kIterations && !done; ++iteration) {
    const Eigen::VectorXd height = under.heights(force);
    const Eigen::MatrixXd slopes = under.slopes(force, height);
    settled =
        settle_vehicles(model, slopes + wheels.residual, wheels.uneven + height + slopes * force);
    // The remaining error is that of the slopes, times the last change.
    done = linear || (settled.force - force).cwiseAbs().maxCoeff() <=
                         1e-8 * settled.force.cwiseAbs().maxCoeff();
    force = settled.force;
  }
  if (!done)
    refuse("E-START-11",
           "no equilibrium of vehicles on supports that do not pull was found; expected step.start "
           "= \"released\"");
  for (std::size_t i = 0; i < wheels.count(); ++i) {
    if (!wheels.on_rail[i]) continue;
    RailForce port = wheels.port[i];
    port.force = -force[static_cast<Eigen::Index>(i)];
    acting.forces.push_back({wheels.point[i], port.force});
    acting.ports.push_back(port);
  }
  return settled;
}

}  // namespace railstep
