#pragma once
#include <functional>
#include <vector>

#include "offline/energy/contact_energy.h"
#include "offline/energy/external_energy.h"
#include "offline/energy/frame_inputs.h"
#include "offline/energy/line_energy.h"
#include "offline/energy/runner_energy.h"

namespace railstep {

/// Energy stored in a state, J.
struct StoredEnergy {
  double kinetic = 0.;   // of lines, wheelsets and vehicles
  double strain = 0.;    // of lines and vehicles' springs
  double hertz = 0.;     // of wheels and flanges: sum 2/5 C d^2.5, of linear contacts k d^2 / 2
  double residual = 0.;  // F' G_res F / 2
  double ports = 0.;     // of one-sided springs, k max(0, d)^2 / 2
  double forward = 0.;   // part of kinetic by guided motion alone, m (v^2 - (v - speed)^2)/2
  double total() const { return kinetic + strain + hertz + residual + ports; }
};

/// Energy that has flowed since the start, J.
struct EnergyFlow {
  double loads = 0.;       // work of loads on the material points under them
  double weight = 0.;      // of the weight of track, wheelsets and vehicles
  double forces = 0.;      // of forces on wheelsets and vehicles
  double outside = 0.;     // of the forces of external wheels
  double guides = 0.;      // of guides and drives that keep the speed of all that runs
  double dissipated = 0.;  // by dampers and creep, trapezoidal in the step
  double carriers = 0.;    // on residual flexibility, see residual_work
  double loss = 0.;        // of the scheme, see EnergyAccount
  double work() const { return loads + weight + forces + outside + guides + carriers; }
};

/// The balance of energy of a run, step by step.
///
/// imbalance = change of stored energy - work + dissipation by dampers. Work is force times the
/// displacement of the material point under it, with means over a step: (F0 row0 + F1 row1)/2 du.
/// The carriers that move loads and wheels along supply the change of residual energy due to the
/// change of place (residual_work). A guide does the work that its wheelset's motion along x needs,
/// from the acceleration of the state, by any method:
///   m g dx - F dx, or d(m v^2 / 2) - F dx if the velocity is projected (not by Baumgarte),
/// F the other forces along x. Among these a contact does f da, a the approach, by the motion along
/// x alone. The multiplier is not used, because its round-off is the penalty times that of x. The
/// step's own normal is not used, because it differs by up to 1e-4 rad from that of a squeezed
/// railhead, and at the elements' borders. Yaw is held, so that gyroscopic forces do no work. The
/// carrier of a vehicle does f da by the vehicle's motion along x alone.
///
/// The loss is the energy that the scheme itself takes out (below 0: puts in), in closed form:
/// - banded lines: see LineEnergy::loss. Wheelsets and vehicles: the same, for wheelsets without C.
///   If forces are held over the step it is 0, except for the force of a table, which is held at
///   its value at the step's end;
/// - contacts, with U the energy of Hertz springs and residual flexibility: f da + residual_work
///   - dU, a the approach and f = (f0 + f1)/2, or the force held over the step. With W = 0 this is
///   (f0 + f1)/2 (d1 - d0) - V(d1) + V(d0), or V'(d_theta)(d1 - d0) - V(d1) + V(d0), d_theta =
///   theta d1 + (1 - theta) d0: the error of the discrete gradient;
/// - one-sided springs, by their forces and depths d as for contacts: f dd - d(V) - the damper's
///   energy. The damper's force is f - k max(0, d), its energy trapezoidal in f d', or
///   (f - V'(d_theta)) (d1 - d0) if forces are held over the step;
/// - the first step: du' (f - M g - C v - K u)/2 at the start, if the state does not satisfy the
///   equation of motion with the acceleration 0 (a load that appears suddenly, a moving start).
///
/// So imbalance plus loss is, in full order, the effect of the contacts' geometry, which a step
/// holds frozen at the expected places, and of rounding. For condensed lines, which are exact, the
/// trapezoidal quadrature of dissipation and of the loads' work is added.
class EnergyAccount {
 public:
  /// @param model  as stepped: that of `packed` or a copy of it from its block; one step per frame
  EnergyAccount(const PackedModel& packed, const Model& model, const State& start);

  /// Takes the state one step later.
  void follow(const State& now);

  const StoredEnergy& stored() const { return stored_; }
  const EnergyFlow& flow() const { return flow_; }
  /// stored - stored at the start - work + dissipated, J.
  double imbalance() const;
  /// Largest over the steps so far of: stored energy without `forward`, the size of each kind of
  /// work (of guides without that of `forward`), and dissipation; J.
  double turned_over() const { return turned_over_; }
  /// Largest |imbalance| over the steps so far, over turned_over(); 0 while turned_over() is 0.
  double balance_error() const;
  /// The loss of the largest size over the steps so far, over turned_over(), with its sign.
  double numerical_loss() const;

 private:
  struct Standing {  // a state and all quantities that the account needs
    std::vector<double> memory;
    State state;
    std::vector<LineMotion> lines;
    StandingContacts contacts;
    std::vector<StandingRunner> runners;
    std::vector<double> depth, speed;       // of one-sided springs, m, m/s
    std::vector<ExternalContact> external;  // as they acted in the step that ends here
  };
  Standing stand(const State& state) const;
  StoredEnergy stored(const Standing& at) const;
  void shift_bay(std::int64_t step);
  void add_lines(const Standing& now);
  void add_loads(const Standing& now);
  void add_contacts(const Standing& now);
  void add_port(const Standing& now, std::int32_t j);
  void add_wheelset(const Standing& now, std::int32_t b);
  void add_suspended(const SuspendedWork& work);
  void add_vehicles(const Standing& now);
  void add_runner(const Standing& now, std::size_t i);
  double vehicle_passage(const Standing& now) const;
  double wheel_force(const Standing& now, int wheel) const;
  double passage_work(const Standing& now, std::int32_t b) const;
  double guide_work(const Standing& now, std::int32_t b) const;
  /// Energy that the scheme takes out of the inertia of one coordinate of a wheelset on a banded
  /// track, J.
  double inertia_loss(const Standing& now, const WheelsetModel& w, int k) const;
  void add_start(const Standing& now);
  void note();

  const Model& model_;
  std::vector<LineEnergy> lines_;
  Standing last_;
  bool first_ = true;
  StoredEnergy stored_, start_;
  EnergyFlow flow_;
  double turned_over_ = 0., largest_ = 0., largest_loss_ = 0.;
};

/// Energy balance of a run at the ends of its steps, over the largest energy turned over.
struct EnergyBalance {
  double error;           // EnergyAccount::balance_error
  double numerical_loss;  // EnergyAccount::numerical_loss
  std::uint64_t hash;     // of the last state
};

/// Steps a run again from its model's start, one step a frame, with an account; the timed run stays
/// as it was. `frames` is at most the number of frames that were run.
/// @param after  called after every frame of the model with the number of frames done; may be empty
/// @param inputs  the inputs of the run
EnergyBalance balance_of(const PackedModel& packed, const Model& model, std::int64_t frames,
                         const std::function<void(std::int64_t)>& after = {},
                         const FrameInputs& inputs = {});

}  // namespace railstep
