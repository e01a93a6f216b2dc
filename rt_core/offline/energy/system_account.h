#pragma once
#include <functional>
#include <vector>

#include "offline/energy/energy_account.h"
#include "offline/system/pack_system.h"
#include "offline/system/system_energy.h"
#include "online/system/marker.h"

namespace railstep {

/// The balance of energy of a system of bodies and beams, step by step: stored energy (kinetic,
/// strain, springs, potential of weight) - stored energy at the start - work of forces and drives +
/// dissipation by dampers. With 0 and 1 for a step's ends:
///   force   (F0 + F1)/2 (x1 - x0),  moment (M0 + M1)/2 (w0 + w1)/2 dt
///   drive   of a row Phi(q, t) with multiplier lambda: lambda dPhi/dt at fixed q, trapezoidal in
///           the step; in energy-momentum lambda is the step's mean, times the mean of dPhi/dt
///   damper  c (d1 - d0)^2 / dt, d its length
/// The imbalance at the end is due to the scheme, the joints and these means.
class SystemAccount {
 public:
  /// @param model  of one step per frame
  SystemAccount(const Model& model, const State& start);

  /// Takes the state one step later.
  void follow(const State& now);

  /// Stored - stored at the start - work + dissipated, J.
  double imbalance() const { return last_.stored.total() - start_ - work_ + dissipated_; }
  const SystemEnergy& stored() const { return last_.stored; }
  /// Work of forces and drives since the start, J.
  double work() const { return work_; }
  /// Dissipation by dampers since the start, J.
  double dissipated() const { return dissipated_; }

 private:
  struct Standing {  // the part of a state that a step's means need
    SystemEnergy stored;
    std::vector<Eigen::Vector3d> force, point;   // [forces] N or N m; m, or rad/s of moments
    std::vector<double> multiplier, drive_rate;  // [joint rows] of driven ones, else 0
    std::vector<double> length;                  // [spring rows] m
  };
  Standing stand(const State& state) const;
  void add_forces(const Standing& now);
  void add_drives(const Standing& now);
  void add_dampers(const Standing& now);

  const Model& model_;
  Standing last_;
  double start_, work_ = 0., dissipated_ = 0.;
};

/// Steps a system's run again from its model's start, one step a frame, with an account of the
/// system and one of its track (EnergyAccount). The work of joints and springs on rails is in both,
/// with opposite signs, so that the sum balances: joints do no work, and springs store and take
/// energy by the motion of both their ends. The loss is the imbalance, so that its size is the
/// error. It is divided by the largest, over the steps, of: stored energy without that of weight,
/// the size of each kind of work (of the weight of parts and of the track, too), and dissipation.
/// @param after  called after every frame of the model with the number of frames done; may be empty
/// @param inputs  the inputs of the run
EnergyBalance balance_of(const PackedSystem& packed, std::int64_t frames,
                         const std::function<void(std::int64_t)>& after = {},
                         const FrameInputs& inputs = {});

}  // namespace railstep
