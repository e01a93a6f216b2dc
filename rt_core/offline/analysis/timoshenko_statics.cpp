#include "offline/analysis/timoshenko_statics.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "offline/analysis/free_motion.h"
#include "offline/element/timoshenko.h"
#include "offline/math/refuse.h"
#include "offline/math/sparse.h"
#include "offline/track/fixed_port.h"
#include "offline/track/pad.h"

namespace railstep {
namespace {

constexpr double kSamePlace = 1e-9;  // of the rail's length

void check(const Track& track) {
  const auto refuse = [](bool wrong, MessageId id, const char* what) {
    if (wrong) railstep::refuse(id, std::string("a Timoshenko beam ") + what);
  };
  refuse(track.rails != 1, "E-TIMOSHENKO-01", "is one rail; expected track.rails = 1");
  refuse(track.cant != 0., "E-TIMOSHENKO-02", "stands upright; expected no cant");
  refuse(!track.joints.empty(), "E-TIMOSHENKO-03",
         "has no joints; expected track.model = \"linearised\"");
  refuse(has_sleepers(track), "E-TIMOSHENKO-04", "has no sleepers; expected no [sleeper]");
  refuse(has_long_pads(track), "E-TIMOSHENKO-05",
         "stands on points; expected support.length_m = 0");
  refuse(!fixed_ports(track).empty(), "E-TIMOSHENKO-06",
         "stands on seats that press and pull; expected no gap_m, unilateral and [[stop]]");
  refuse(track.axial_force != 0., "E-TIMOSHENKO-07",
         "has no axial force; expected no rail.axial_force_n and no heat");
  refuse(track.axis_z != 0., "E-TIMOSHENKO-08",
         "has its nodes on the centroid; expected track.reference_line = \"centroid\"");
  const ElementRule& rule = track.rule;
  refuse(rule.axial_points != 2 || (rule.coupling_points != 0 && rule.coupling_points != 2) ||
             rule.coupling != Coupling::centroid || rule.shear != Shear::twist,
         "E-TIMOSHENKO-09", "is integrated exactly; expected no [rail.rule]");
}

/// Element borders and further places, rising, each once.
std::vector<double> nodes_of(const Track& track, const std::vector<double>& places) {
  std::vector<double> x = places;
  for (int e = 0; e <= track.elements(); ++e) x.push_back(e * track.element_length());
  std::sort(x.begin(), x.end());
  const double same = kSamePlace * track.length();
  x.erase(std::unique(x.begin(), x.end(), [&](double a, double b) { return b - a <= same; }),
          x.end());
  if (x.front() < -same || x.back() > track.length() + same)
    refuse("E-TRACK-05", "a point is off the rail; expected x from 0 to " +
                             std::to_string(track.length()) + " m");
  return x;
}

/// Whether an end holds coordinate k of its node: displacements and rotations about x, y, z.
bool holds_coordinate(RailEnd end, int k) {
  return end == RailEnd::clamped || (end == RailEnd::pinned && k <= 3);
}

}  // namespace

TimoshenkoStatics::TimoshenkoStatics(const Track& track, const std::vector<double>& places)
    : track_(track) {
  check(track);
  x_ = nodes_of(track, places);
  assemble(number_unknowns());
  factorise();
}

int TimoshenkoStatics::number_unknowns() {
  int count = 0;
  for (std::size_t node = 0; node < x_.size(); ++node)
    for (int k = 0; k < 6; ++k) {
      const RailEnd end = node == 0               ? track_.ends[0]
                          : node + 1 == x_.size() ? track_.ends[1]
                                                  : RailEnd::free;
      const bool carried = track_.unknowns != Unknowns::vertical || k == 2 || k == 4;
      number_.push_back(carried && !holds_coordinate(end, k) ? count++ : -1);
    }
  return count;
}

/// Coefficients of u + theta x (0, y, z) at the node nearest to the point.
Eigen::SparseVector<double> TimoshenkoStatics::row(const RailPoint& point) const {
  const auto nearest = std::min_element(x_.begin(), x_.end(), [&](double a, double b) {
    return std::abs(a - point.x) < std::abs(b - point.x);
  });
  if (!(std::abs(*nearest - point.x) <= 2. * kSamePlace * track_.length()))
    refuse("E-TIMOSHENKO-10", "the beam has no node at x = " + std::to_string(point.x) +
                                  " m; expected a place given to its constructor");
  const auto first = static_cast<std::size_t>(6 * (nearest - x_.begin()));
  Eigen::SparseVector<double> row(stiffness_.rows());
  const auto add = [&](std::size_t k, double factor) {
    if (number_[first + k] >= 0 && factor != 0.) row.coeffRef(number_[first + k]) += factor;
  };
  add(static_cast<std::size_t>(point.direction), 1.);
  if (point.direction == 0) {
    add(4, point.z);
    add(5, -point.y);
  }
  if (point.direction == 1) add(3, -point.z);
  if (point.direction == 2) add(3, point.y);
  return row;
}

void TimoshenkoStatics::assemble(int unknowns) {
  stiffness_.resize(unknowns, unknowns);
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t node = 0; node + 1 < x_.size(); ++node) {
    const Matrix12 K =
        timoshenko_stiffness(track_.section, track_.material, x_[node + 1] - x_[node]);
    for (int j = 0; j < 12; ++j)
      for (int i = 0; i < 12; ++i) {
        const int r = number_[6 * node + static_cast<std::size_t>(i)];
        const int c = number_[6 * node + static_cast<std::size_t>(j)];
        if (r >= 0 && c >= 0) entries.emplace_back(r, c, K(i, j));
      }
  }
  stiffness_.setFromTriplets(entries.begin(), entries.end());
  const auto add = [&](const Eigen::SparseVector<double>& spring, double k) {
    if (k > 0. && spring.nonZeros() > 0) stiffness_ += k * Sparse(spring * spring.transpose());
  };
  for (int seat = 0; seat <= track_.bays; ++seat) {
    const Support support = track_.seat(seat).pad[0];
    const double x = seat * track_.bay_length, z = support.height_z;
    for (const double side : {-.5, .5})
      for (int d = 0; d < 3; ++d)
        add(row({0, x, 2. * side * support.half_spread, z, d}),
            support.stiffness[static_cast<std::size_t>(d)] / 2.);
    // The roll about x is the height of a point one metre aside, less the axis's own.
    add(row({0, x, 1., 0., 2}) - row({0, x, 0., 0., 2}), support.roll_stiffness);
  }
}

void TimoshenkoStatics::factorise() {
  factor_.compute(stiffness_);
  if (is_held(factor_, stiffness_)) return;
  refuse_free_modes(track_, railstep::assemble(track_), {});  // by its name
  refuse("E-TRACK-35",
         "the track has a free rigid mode: its ends and pads do not hold it; expected a stiffness "
         "in every direction, or ends that are held");
}

Eigen::VectorXd TimoshenkoStatics::load(const std::vector<PointForce>& forces,
                                        double gravity) const {
  Eigen::VectorXd f = Eigen::VectorXd::Zero(stiffness_.rows());
  for (const PointForce& force : forces) f += force.force * row(force.at);
  const double weight = track_.material.density * track_.section.area * gravity;
  for (std::size_t node = 0; node + 1 < x_.size() && gravity != 0.; ++node) {
    const Vector12 own = timoshenko_line_load(x_[node + 1] - x_[node]);
    for (int i = 0; i < 12; ++i) {
      const int unknown = number_[6 * node + static_cast<std::size_t>(i)];
      if (unknown >= 0) f[unknown] -= weight * own[i];
    }
  }
  return f;
}

Eigen::VectorXd TimoshenkoStatics::solve(const std::vector<PointForce>& forces,
                                         double gravity) const {
  return factor_.solve(load(forces, gravity));
}

double TimoshenkoStatics::at(const Eigen::VectorXd& displacement, const RailPoint& point) const {
  return row(point).dot(displacement);
}

double TimoshenkoStatics::residual(const Eigen::VectorXd& displacement,
                                   const std::vector<PointForce>& forces, double gravity,
                                   double lever) const {
  Eigen::VectorXd scale = Eigen::VectorXd::Ones(stiffness_.rows());
  for (std::size_t i = 0; i < number_.size(); ++i)
    if (number_[i] >= 0 && i % 6 >= 3) scale[number_[i]] = 1. / lever;
  const Eigen::VectorXd f = load(forces, gravity);
  const double size = f.cwiseProduct(scale).norm();
  const double left = (f - stiffness_ * displacement).cwiseProduct(scale).norm();
  return size > 0. ? left / size : left;
}

}  // namespace railstep
