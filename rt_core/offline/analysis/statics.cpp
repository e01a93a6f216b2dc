#include "offline/analysis/statics.h"

#include "offline/analysis/free_motion.h"
#include "offline/math/refuse.h"
#include "offline/track/functional.h"

namespace railstep {

Statics::Statics(const Track& track)
    : track_(track), lines_(assemble(track_)), ports_(fixed_ports(track_)) {
  if (!ports_.empty()) one_sided_ = std::make_unique<OneSided>(track_, lines_, ports_);
  factors_ = std::vector<Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>>(lines_.size());
  for (std::size_t i = 0; i < lines_.size() && ports_.empty(); ++i) {
    factors_[i].compute(lines_[i].stiffness);
    if (is_held(factors_[i], lines_[i].stiffness)) continue;
    refuse_free_modes(track_, lines_, {});  // by its name
    refuse("E-TRACK-37",
           "the stiffness of the track cannot be factored; expected stiffnesses that differ by "
           "fewer orders of magnitude");
  }
}

std::vector<Eigen::VectorXd> Statics::loads(const std::vector<PointForce>& forces,
                                            double gravity) const {
  std::vector<Eigen::VectorXd> result;
  for (const Line& line : lines_) {
    Eigen::VectorXd load = Eigen::VectorXd::Zero(line.unknowns());
    if (gravity != 0.) load += weight(track_, line, gravity);
    if (one_sided_) load += preload(track_, line);
    for (const PointForce& f : forces) load += f.force * point_row(track_, line, f.at);
    result.push_back(std::move(load));
  }
  return result;
}

std::vector<Eigen::VectorXd> Statics::solve(const std::vector<PointForce>& forces,
                                            double gravity) const {
  return under(loads(forces, gravity));
}

std::vector<Eigen::VectorXd> Statics::under(std::vector<Eigen::VectorXd> load) const {
  if (one_sided_) return one_sided_->solve(load);
  for (std::size_t i = 0; i < lines_.size(); ++i) load[i] = factors_[i].solve(load[i]).eval();
  return load;
}

std::vector<double> Statics::port_forces(const std::vector<Eigen::VectorXd>& displacement) const {
  return one_sided_ ? one_sided_->forces(displacement) : std::vector<double>{};
}

std::vector<Eigen::VectorXd> Statics::unbalanced(const std::vector<Eigen::VectorXd>& displacement,
                                                 const std::vector<PointForce>& forces,
                                                 double gravity) const {
  std::vector<Eigen::VectorXd> left = loads(forces, gravity);
  const std::vector<double> port_force = port_forces(displacement);
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    left[i] -= lines_[i].stiffness * displacement[i];
    for (std::size_t j = 0; j < ports_.size(); ++j)
      left[i] -= port_force[j] * closing_row(track_, lines_[i], ports_[j]);
  }
  return left;
}

double Statics::at(const std::vector<Eigen::VectorXd>& displacement, const RailPoint& point) const {
  double sum = 0.;
  for (std::size_t i = 0; i < lines_.size(); ++i)
    sum += point_row(track_, lines_[i], point).dot(displacement[i]);
  return sum;
}

double Statics::flexibility(const RailPoint& a, const RailPoint& b) const {
  return at(solve({{b, 1.}}), a);
}

double Statics::support_force(const std::vector<Eigen::VectorXd>& displacement, int rail,
                              int seat) const {
  if (track_.seat(seat).pad[static_cast<std::size_t>(rail)].one_sided()) {
    const std::vector<double> port_force = port_forces(displacement);
    double force = 0.;
    for (std::size_t j = 0; j < ports_.size(); ++j)
      if (ports_[j].of == FixedPort::Of::pad && ports_[j].rail == rail && ports_[j].seat == seat)
        force += port_force[j];
    return force;
  }
  const Functional gap = pad_gap(track_, rail, seat);
  double sum = 0.;
  for (std::size_t i = 0; i < lines_.size(); ++i)
    sum += functional_row(track_, lines_[i], gap).dot(displacement[i]);
  return -track_.seat(seat).pad[static_cast<std::size_t>(rail)].stiffness[2] * sum;
}

}  // namespace railstep
