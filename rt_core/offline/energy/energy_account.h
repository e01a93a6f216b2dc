#pragma once
#include <functional>
#include <vector>

#include "offline/energy/contact_energy.h"
#include "offline/energy/external_energy.h"
#include "offline/energy/frame_inputs.h"
#include "offline/energy/line_energy.h"

namespace railstep {

/// Energy that a state holds, J.
struct StoredEnergy {
  double kinetic = 0.;   // of lines, wheelsets and vehicles
  double strain = 0.;    // of lines and vehicles' springs
  double hertz = 0.;     // of wheels and flanges: sum 2/5 C d^2.5, of linear contacts k d^2 / 2
  double residual = 0.;  // F' G_res F / 2
  double ports = 0.;     // of one-sided springs, k max(0, d)^2 / 2
  double forward = 0.;  // of kinetic: what the guided motion alone makes, m (v^2 - (v - speed)^2)/2
  double total() const { return kinetic + strain + hertz + residual + ports; }
};

/// Energy that passed since the start, J.
struct EnergyFlow {
  double loads = 0.;       // work of loads, on the material points under them
  double weight = 0.;      // of the weight of track, wheelsets and vehicles
  double forces = 0.;      // of forces on wheelsets and vehicles
  double outside = 0.;     // of the forces of external wheels
  double guides = 0.;      // of what holds wheelsets and vehicles at their speed
  double dissipated = 0.;  // by the dampers, trapezoidal in the step
  double carriers = 0.;    // on the residual flexibility, see residual_work
  double loss = 0.;        // of the scheme, see EnergyAccount
  double work() const { return loads + weight + forces + outside + guides + carriers; }
};

/// The balance of energy of a run, step by step.
///
/// imbalance = change of stored energy - work + dissipation by dampers. Work is force times the
/// displacement of the material point under it, with means over a step: (F0 row0 + F1 row1)/2 du.
/// What moves loads and wheels along supplies what their change of place does to the residual
/// energy (residual_work). A guide's work is what its wheelset's motion along x takes, from the
/// acceleration of the state by either method:
///   m g dx - F dx, or d(m v^2 / 2) - F dx where the velocity is projected (augmented Lagrangian),
/// F the other forces along x. Of these a contact does f da, a the approach, by the way along x
/// alone; the multiplier would do as well but for its round-off, penalty times that of x, and the
/// step's own normal but for a railhead that is squeezed, which it leaves by up to 1e-4 rad, and
/// for the elements' borders. Yaw does not move; gyroscopic forces do no work while it is held.
/// What moves a vehicle along does f da by its way alone.
///
/// The loss is what the scheme itself takes out (below 0: puts in), in closed form:
/// - of banded lines see LineEnergy::loss; of wheelsets the same without C, and 0 where forces are
///   held over the step, but for a table's force, held at its value at the step's end; of vehicles
///   alike;
/// - of contacts, with U the energy of Hertz springs and residual flexibility: f da + residual_work
///   - dU, a the approach and f = (f0 + f1)/2, or the force held over the step. With W = 0 that is
///   (f0 + f1)/2 (d1 - d0) - V(d1) + V(d0), or V'(d_theta)(d1 - d0) - V(d1) + V(d0), d_theta =
///   theta d1 + (1 - theta) d0: the discrete gradient's miss;
/// - of one-sided springs, by their forces and depths d as those of contacts: f dd - d(V) - what
///   the damper took, with what of f is not k max(0, d) its force: trapezoidal in f d', or where
///   forces are held over the step (f - V'(d_theta)) (d1 - d0);
/// - of the first step, du' (f - M g - C v - K u)/2 at the start: a state that does not meet the
///   equation of motion (a load that appears suddenly, a moving start) with the acceleration 0.
///
/// So the imbalance plus the loss leaves, of full order, the contacts' geometry, which a step holds
/// frozen where it expects them, and rounding; of condensed lines also the trapezoidal quadrature
/// of dissipation and of the loads' work, as these lines themselves are exact.
class EnergyAccount {
 public:
  /// @param model  as stepped: that of `packed` or a copy of it from its block; one step per frame
  EnergyAccount(const PackedModel& packed, const Model& model, const State& start);

  /// The state one step on.
  void follow(const State& now);

  const StoredEnergy& stored() const { return stored_; }
  const EnergyFlow& flow() const { return flow_; }
  /// stored - stored at the start - work + dissipated, J.
  double imbalance() const;
  /// Largest over the run's steps so far of: stored energy without what the guided speed alone
  /// makes, work of each kind in size (of guides without that speed's), dissipation; J.
  double turned_over() const { return turned_over_; }
  /// Largest |imbalance| over the steps so far, over turned_over(); 0 while nothing was.
  double balance_error() const;
  /// The loss of the largest size over the steps so far, over turned_over(), with its sign.
  double numerical_loss() const;

 private:
  struct Standing {  // a state with all that is asked of it
    std::vector<double> memory;
    State state;
    std::vector<LineMotion> lines;
    StandingContacts contacts;
    std::vector<double> depth, speed;       // of one-sided springs, m, m/s
    std::vector<ExternalContact> external;  // as they acted in the step that ended here
  };
  Standing stand(const State& state) const;
  StoredEnergy stored(const Standing& at) const;
  void shift_bay(std::int64_t step);
  void add_lines(const Standing& now);
  void add_loads(const Standing& now);
  void add_contacts(const Standing& now);
  void add_port(const Standing& now, std::int32_t j);
  void add_wheelset(const Standing& now, std::int32_t b);
  void add_vehicle(const Standing& now, std::int32_t b);
  double vehicle_passage(const Standing& now, std::int32_t b) const;
  double wheel_force(const Standing& now, int wheel) const;
  double passage_work(const Standing& now, std::int32_t b) const;
  double guide_work(const Standing& now, std::int32_t b) const;
  double body_loss(const Standing& now, const WheelsetModel& w, int k) const;
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

/// Energies of a run: of its steps' ends, over the largest energy turned over.
struct EnergyBalance {
  double error;           // EnergyAccount::balance_error
  double numerical_loss;  // EnergyAccount::numerical_loss
  std::uint64_t hash;     // of the last state
};

/// Steps a run again from its model's start, one step a frame, with an account beside it; what is
/// timed elsewhere stays untouched. More steps than were made are not asked for.
/// @param after  called after every frame of the model with the number of frames done; may be empty
/// @param inputs  what the run was given
EnergyBalance balance_of(const PackedModel& packed, const Model& model, std::int64_t frames,
                         const std::function<void(std::int64_t)>& after = {},
                         const FrameInputs& inputs = {});

}  // namespace railstep
