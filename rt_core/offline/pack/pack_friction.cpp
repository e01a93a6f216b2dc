#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "offline/math/refuse.h"
#include "offline/pack/pack.h"
#include "offline/pack/step_compliance.h"

namespace railstep {

namespace {

constexpr int kPoints = 4;  // intervals of an element at which rails are looked at

/// The mean normal force of a vehicle's wheels under its weight and its forces at t = 0, N.
double mean_load(const RunnerMatrices& loaded, std::int32_t wheelsets) {
  double sum = 0.;
  for (Eigen::Index z = index_of(BodyMotion::z); z < loaded.rest.size(); z += kMotions)
    sum -= loaded.rest[z];
  return std::max(sum, 0.) / (2. * wheelsets);
}

/// The largest slip of the contacts of a wheelset by forces of one unit along and across at both
/// wheels, m/s per N.
/// @param motions  displacements of the wheelset by forces, [6][6]
/// @param rate     of a motion by its change in a step, 1/s
/// @param rails    rates of the left and of the right rail across by a force, m/s per N
double largest_slip(const Eigen::MatrixXd& motions, double rate, double radius,
                    double half_distance, const double* rails) {
  Eigen::Matrix<double, kMotions, 4> rows;  // left along, across, right along, across
  rows << 1., 0., 1., 0.,                   //
      0., 1., 0., 1.,                       //
      0., 0., 0., 0.,                       //
      0., radius, 0., radius,               //
      -radius, 0., -radius, 0.,             //
      -half_distance, 0., half_distance, 0.;
  Eigen::Matrix4d slip = rate * (rows.transpose() * motions * rows);
  slip(1, 1) += rails[0];
  slip(3, 3) += rails[1];
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(slip).eigenvalues().maxCoeff();
}

}  // namespace

void PackedModel::refuse_steep_friction(const Track& track) const {
  const Scheme& s = model_.scheme;
  const bool condensed = model_.form == Form::condensed;
  for (std::int32_t r = 0; r < model_.runners; ++r) {
    const RunnerModel& runner = model_.runner[r];
    const RollingFriction& f = runner.contact.creep.friction;
    if (!falls(f)) continue;
    double rails[2] = {0., 0.};
    const StepCompliance lines(model_, lines_);
    for (int rail = 0; rail < 2 && model_.lines > 0; ++rail) {
      const LoadPoint head{rail, model_.head_z[rail], 0., 1};
      for (const double own : lines.table(head, kPoints, tabled_elements(track)))
        rails[rail] = std::max(rails[rail], own / (condensed ? s.theta * s.dt : s.dt));
    }
    const std::int32_t meets = interface_size(runner);
    const Eigen::Map<const Eigen::MatrixXd> all(runner.compliance, meets, meets);
    double slips = 0.;
    for (std::int32_t i = 0; i < runner.wheelsets; ++i)
      slips =
          std::max(slips, largest_slip(all.block(kMotions * i, kMotions * i, kMotions, kMotions),
                                       law_rate(model_), runner.wheelset[i].radius,
                                       runner.contact.half_distance, rails));
    const double load = mean_load(runners_[static_cast<std::size_t>(r)].matrices, runner.wheelsets);
    const double falling = 2. * load * std::max(f.rail[0], f.rail[1]) * (1. - f.kinetic) / f.half;
    if (slips * falling <= .5) continue;
    const auto whole = [](double value) { return std::to_string(std::lround(value)); };
    refuse("E-PACK-60",
           "friction falls over slip by " + whole(falling) +
               " N s/m under twice the mean wheel load; expected at most " + whole(.5 / slips) +
               " N s/m, half of what the inertia of wheelset and rails holds in a step: a "
               "larger half_slip_m_per_s or kinetic_part, or a shorter step");
  }
}

}  // namespace railstep
