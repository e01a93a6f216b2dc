#pragma once
#include <cstdint>

#include "online/math/newton.h"
#include "online/model/contact_id.h"
#include "online/model/status.h"
#include "online/model/system_workspace.h"

namespace railstep {

inline constexpr int kWheelForces = 6;  // kept of each wheel of a runner
inline constexpr int kSeatMotions = 6;  // kept of each seat

/// All numbers that a replay needs, and no others. The caller owns the memory, state_doubles() of
/// it. LineModel says what u, v, a and g of a condensed line are.
struct State {
  std::int64_t steps;     // time = steps * dt, so it never drifts
  double* numbers;        // [state_doubles] all of these arrays in one row
  double* u;              // [unknowns] displacement: m; slopes 1
  double* v;              // [unknowns] velocity
  double* a;              // [unknowns] the scheme's acceleration
  double* g;              // [unknowns] true acceleration
  double* contact_force;  // [contacts] N, of the last step: start of the contact solve
  double* port_force;     // [fixed ports] N, the same; 0: open
  double* wheel_force;    // [wheels of runners][kWheelForces] of the last step: N along x, y, z on
                          // the wheel, N m about x on the rail's section, W of
                          // creep, m of the contact (WheelForce::rail_y)
  /// [wheels of runners][kSeatMotions] on banded lines: y, z and roll of the seat under the wheel,
  /// m and rad, then the rates of the rail there.
  double* seat;
  /// [wheels of runners][3] creepages along, across and of spin (1/m) of the last step, if any
  /// runner rolls freely.
  double* creepage;
  double* element_memory;  // [element_memory] of force elements, memory_of()
  double* reaction;    // [runners + their rods] N, of the last step: of each runner the force ahead
                       // of its drive, then the tensions of its rods
  double* multiplier;  // [wheelsets][kGuideRows] of the guide along x, N, and about z, N m;
                       // the force on the wheelset is its negative
  double* quaternion;  // [system.bodies][4] body axes to ground
  double* row_force;   // [rows] of the system's joints and springs, N; the force on its parts is
                       // -G' of it, so a tensile force of a joint or spring is positive
  double* kept;        // Newton's matrix of the system if it is kept over steps, or null
  double* input;       // [inputs] N or N m: the last good ones
  Status latched;      // kLatched bits that were met since the reset
};

/// Status bits that stay set until reset(): a frame was lost or distorted.
inline constexpr Status kLatched =
    Status::nonfinite_input | Status::nonfinite_state | Status::force_saturated;

/// Coordinates of the solve that couples runners with the track, or of the largest one on rigid
/// rails.
inline std::int32_t newton_size(const Model& model) noexcept {
  if (model.lines > 0)
    return model.runner_wheelsets == 0
               ? 0
               : contact_count(model) + model.fixed.count +
                     (kMotions + 2 * kWheelSeatRows) * model.runner_wheelsets +
                     model.element_coordinates;
  std::int32_t most = 0;
  for (std::int32_t i = 0; i < model.runners; ++i)
    if (interface_size(model.runner[i]) > most) most = interface_size(model.runner[i]);
  return most;
}
/// Most scalars of the law of a wheelset, of `size` coordinates: patches of profiles appear and
/// vanish.
inline std::int64_t wheelset_ranks(const RunnerModel& runner, std::int64_t size) noexcept {
  return has_profiles(runner.contact) ? size : kWheelsetRank;
}
/// Numbers of Newton's method: Y of a track, and its scratch.
inline std::int64_t newton_doubles(const Model& model) noexcept {
  const std::int64_t n = newton_size(model), sets = model.runner_wheelsets;
  if (model.lines > 0) {
    constexpr std::int64_t size = kMotions + 2 * kWheelSeatRows;
    const std::int64_t scalars = n - size * sets;
    std::int64_t ranks = 0;
    for (std::int32_t i = 0; i < model.runners; ++i)
      ranks += wheelset_ranks(model.runner[i], size) * model.runner[i].wheelsets;
    return n * n + newton_scratch(n, scalars + ranks, scalars + ranks * size);
  }
  std::int64_t most = 0;
  for (std::int32_t i = 0; i < model.runners; ++i) {
    const RunnerModel& r = model.runner[i];
    const std::int64_t ranks = wheelset_ranks(r, kMotions) * r.wheelsets;
    const std::int64_t own = newton_scratch(interface_size(r), ranks + r.force_elements,
                                            ranks * kMotions + r.element_coordinates);
    if (own > most) most = own;
  }
  return most;
}
/// Numbers that hold where a wheel touches by its profile, a ProfileWheel (profile_contact.h).
inline constexpr std::int64_t kProfileWheelDoubles = 800;
/// Those of all wheels of rail vehicles; 0 where all treads are cones.
inline std::int64_t profile_doubles(const Model& model) noexcept {
  bool any = false;
  for (std::int32_t i = 0; i < model.runners; ++i)
    any = any || has_profiles(model.runner[i].contact);
  return any ? 2 * kProfileWheelDoubles * model.runner_wheelsets : 0;
}
/// Whether unit responses of the lines are kept; those of condensed lines with tables are not.
inline bool has_units(const Model& model) noexcept {
  bool any = false;
  for (std::int32_t l = 0; l < model.lines; ++l)
    any = any || model.line[l].modal.between == nullptr;
  return any;
}
/// Coordinates of the coupled solve of a track: its rows and one-sided springs.
inline std::int32_t port_count(const Model& model) noexcept {
  return track_row_count(model) + model.fixed.count;
}

/// Numbers that couple a system's ports on rails with other contacts, see
/// contact/system_coupling.h; those of one banded solve come last.
inline std::int64_t beside_doubles(const Model& model) noexcept {
  const std::int64_t rows = 9LL * model.system.ports, ports = port_count(model);
  if (rows == 0 || ports == 0) return 0;
  return rows * (4 + 2 * ports) + 2 * ports +
         (model.form == Form::banded ? model.line_unknowns : 0);
}

inline constexpr std::int64_t kElementStepDoubles = 4;
static_assert(sizeof(ElementStep) == kElementStepDoubles * sizeof(double));

/// Scratch, meaningless between steps. The caller owns the memory: workspace_doubles() of it.
struct Workspace {
  double* u_star;  // [unknowns]
  double* v_star;  // [unknowns]
  double* scaled;  // [unknowns]
  double* solved;  // [unknowns] right-hand side of the track without wheels; after the solve, the
                   // displacements. In a solve with wheels D^-1 L^-1 of banded lines'
  double* imaginary;  // the same for condensed lines; `solved` is the real part
  double* row;        // [track rows][2][unknowns] of condensed lines: shape of each row
  double* system;     // see system_workspace.h
  double* external;   // [state_doubles] of models with external wheels: a trial state
  double* start;      // [2][unknowns] of schemes of two stages: u and v at the step's start
  /// [track rows][unknowns] response of the lines to a unit force along each row: real and
  /// imaginary part of condensed ones; of banded ones L^-1 and D^-1 L^-1 of the row, in its panels
  /// alone.
  double *unit, *unit_second;
  double* compliance;         // [ports][ports] of the coupled solve, m/N
  double* newton;             // newton_doubles()
  double* beside;             // beside_doubles()
  double* profile;            // profile_doubles()
  ElementStep* element_step;  // [force elements of runners]
};

/// Value of an input; 0 if there is no state yet.
/// @param input  State::input, or null before there is a state
inline double held_input(const double* input, std::int32_t at) noexcept {
  return input == nullptr ? 0. : input[at];
}

/// Results that a frame publishes.
struct Outputs {
  Status status;
  std::int32_t first_bad_unknown;     // -1: all finite
  double load_x[kMaxLoads];           // m; where the load is, or was when it was removed
  double load_place[kMaxLoads];       // the same along the model's elements, m
  double load_deflection[kMaxLoads];  // of the loaded point, m, up positive
  double load_force[kMaxLoads];       // N, up positive
  /// By contact (contact_id.h), along its normal: of a wheel the force on it, up positive.
  double contact_force[kMaxWheels];       // N, at the frame's end
  double contact_force_mean[kMaxWheels];  // N, over the frame's steps
  double contact_force_peak[kMaxWheels];  // N
  double contact_impulse[kMaxWheels];     // N s
  double contact_gap[kMaxWheels];         // m, negative in contact; where the force was taken
  bool contact_on_rail[kMaxWheels];
  double contact_x[kMaxWheels];       // along the undeformed rail, m
  double contact_place[kMaxWheels];   // the same along the model's elements, m
  double contact_rail_z[kMaxWheels];  // of wheels: displacement of the rail's axis under it, m
  /// By wheel of rail vehicles at the frame's end, left and right of each wheelset in turn: forces
  /// on the rail in the track's axes, down and outwards, N; 0 where it is not touched.
  double wheel_q[2 * kMaxRunnerWheelsets], wheel_y[2 * kMaxRunnerWheelsets];
  double wheel_y_over_q[2 * kMaxRunnerWheelsets];  // 0 where q is 0
  /// Energy that creep turns to heat by a metre of way, N; 0 slower than 0.1 m/s.
  double wheel_t_gamma[2 * kMaxRunnerWheelsets];
  /// Contact on the rail, outwards from its highest point, m; of patches their mean by forces.
  double wheel_contact_y[2 * kMaxRunnerWheelsets];
  bool wheel_on_rail[2 * kMaxRunnerWheelsets];  // of the model's rails; never on rigid ones
  double wheel_place[2 * kMaxRunnerWheelsets];  // along the model's elements, m
  /// By wheelset: force on the track along y, N, then displacement, m, and yaw, rad.
  double wheelset_sum_y[kMaxRunnerWheelsets], wheelset_y[kMaxRunnerWheelsets];
  double wheelset_yaw[kMaxRunnerWheelsets];
  double drive_force[kMaxRunners];  // ahead on each rail vehicle, which keeps its speed, N
  /// The way of the first body of rail vehicles that roll freely, m, and its speed, m/s; else 0.
  double runner_way[kMaxRunners], runner_speed[kMaxRunners];
  double rod_tension[kMaxRunnerRods];  // N, of the rigid rods of rail vehicles
  /// N or N m, of their force elements on the first body; of lines how they push their ends apart.
  double element_force[kMaxRunnerForceElements];
  /// m or rad, how far the first body has moved over the second one; of lines their ends apart.
  double element_travel[kMaxRunnerForceElements];
  /// The same of those of linear elements that are published.
  double traced_force[kMaxRunnerTraced], traced_travel[kMaxRunnerTraced];
  /// The point of the rail under each external wheel at the frame's end.
  bool external_on_rail[kMaxExternalWheels];
  double external_place[kMaxExternalWheels];            // m along the model's elements
  double external_force[kMaxExternalWheels];            // N along z, up positive
  double external_displacement[kMaxExternalWheels][3];  // m
  double external_velocity[kMaxExternalWheels][3];      // m/s, of the rail's material
  double constraint_violation;                          // largest of the frame, m or rad
  std::int32_t iterations;      // largest of the frame, of contact, joint and Newton solves
  double force_residual;        // of the system: largest of the frame, over its largest force
  std::int32_t redundant_rows;  // of the system's joints, in the last step of the frame with any
  std::int32_t redundant_row[kMostNamedRows];  // the first of them, among the system's rows
};

/// Number of coordinates that guides hold, of all wheelsets.
inline std::int64_t guide_rows(const Model& model) noexcept {
  return std::int64_t{kGuideRows} * model.wheelsets;
}
/// The multipliers of a wheelset's guide, [kGuideRows].
inline double* guide_of(const State& state, std::int32_t wheelset) noexcept {
  return state.multiplier + std::ptrdiff_t{kGuideRows} * wheelset;
}

/// The forces of a wheel of a runner, [kWheelForces]. @param wheelset  among those of all runners
inline double* wheel_force_of(const State& state, std::int32_t wheelset,
                              std::int32_t side) noexcept {
  return state.wheel_force + std::ptrdiff_t{kWheelForces} * WheelId{wheelset, side}.number();
}

/// Whether states keep the motions of seats.
inline bool keeps_seats(const Model& model) noexcept {
  return model.form == Form::banded && model.lines > 0;
}
/// The motions of the seat under a wheel of a runner, [kSeatMotions], if states keep them.
inline double* seat_motion_of(const State& state, std::int32_t wheelset,
                              std::int32_t side) noexcept {
  return state.seat + std::ptrdiff_t{kSeatMotions} * WheelId{wheelset, side}.number();
}

/// Whether states keep the creepages of wheels.
inline bool keeps_creepage(const Model& model) noexcept {
  bool any = false;
  for (std::int32_t i = 0; i < model.runners; ++i) any = any || model.runner[i].rolls_freely != 0;
  return any;
}
inline constexpr int kWheelCreep = 4;
/// The creepages of a wheel of a runner, [kWheelCreep], if states keep them.
inline double* creepage_of(const State& state, std::int32_t wheelset, std::int32_t side) noexcept {
  return state.creepage + std::ptrdiff_t{kWheelCreep} * WheelId{wheelset, side}.number();
}

/// The forces of a runner's constraints, [constraint_count].
inline double* reactions_of(const Model& model, const State& state,
                            const RunnerModel& runner) noexcept {
  return state.reaction + (&runner - model.runner) + runner.first_rod;
}

/// Numbers of State::seat.
inline std::int64_t seat_doubles(const Model& model) noexcept {
  return keeps_seats(model) ? 2LL * kSeatMotions * model.runner_wheelsets : 0;
}
/// Numbers of State::wheel_force, State::seat, State::creepage and State::element_memory.
inline std::int64_t wheel_state_doubles(const Model& model) noexcept {
  return 2LL * (kWheelForces + (keeps_creepage(model) ? kWheelCreep : 0)) * model.runner_wheelsets +
         seat_doubles(model) + model.element_memory;
}
/// Numbers of these and of State::reaction.
inline std::int64_t runner_state_doubles(const Model& model) noexcept {
  return wheel_state_doubles(model) + model.runners + model.runner_rods;
}

inline std::int64_t state_doubles(const Model& model) noexcept {
  return 4LL * model.unknowns + contact_count(model) + model.fixed.count +
         runner_state_doubles(model) + guide_rows(model) + system_state_doubles(model.system) +
         model.inputs;
}
/// Size of the model's start: all of a state but Newton's matrix, which is not made yet.
inline std::int64_t start_doubles(const Model& model) noexcept {
  return 4LL * model.unknowns + contact_count(model) + model.fixed.count +
         runner_state_doubles(model) + guide_rows(model) + system_start_doubles(model.system);
}
inline std::int64_t workspace_doubles(const Model& model) noexcept {
  const std::int64_t rows = track_row_count(model), ports = port_count(model);
  const std::int64_t of_modes = model.form == Form::condensed ? 1 + 2 * rows : 0;
  const std::int64_t units = has_units(model) ? 2 * rows : 0;
  return (4 + units + of_modes) * model.unknowns + system_workspace_doubles(model.system) +
         ports * ports + newton_doubles(model) + beside_doubles(model) + profile_doubles(model) +
         kElementStepDoubles * model.runner_force_elements +
         (model.external_wheels > 0 ? state_doubles(model) : 0) +
         (model.scheme.stage_fraction > 0. ? 2LL * model.unknowns : 0);
}

/// Views over the caller's memory, which must be aligned to doubles.
inline State state_on(const Model& model, double* memory) noexcept {
  const std::int64_t n = model.unknowns;
  double* const wheels = memory + 4 * n;
  double* const ports = wheels + contact_count(model);
  double* const runners = ports + model.fixed.count;
  double* const seats = runners + 2LL * kWheelForces * model.runner_wheelsets;
  double* const creepages = seats + seat_doubles(model);
  double* const memories =
      creepages + (keeps_creepage(model) ? 2LL * kWheelCreep * model.runner_wheelsets : 0);
  double* const reactions = runners + wheel_state_doubles(model);
  double* const guides = runners + runner_state_doubles(model);
  double* const system = guides + guide_rows(model);
  double* const rows = system + 4LL * model.system.bodies;
  return {0,
          memory,
          memory,
          memory + n,
          memory + 2 * n,
          memory + 3 * n,
          wheels,
          ports,
          runners,
          seats,
          creepages,
          memories,
          reactions,
          guides,
          system,
          rows,
          model.system.renew == Renew::kept ? rows + system_rows(model.system) : nullptr,
          system + system_state_doubles(model.system),
          Status::ok};
}
inline Workspace workspace_on(const Model& model, double* memory) noexcept {
  const bool condensed = model.form == Form::condensed;
  const std::int64_t n = model.unknowns, rows = track_row_count(model) * n,
                     units = has_units(model) ? rows : 0, ports = port_count(model);
  double* const unit = memory + 4 * n;
  double* const imaginary = unit + 2 * units;
  double* const row = imaginary + (condensed ? n : 0);
  double* const system = row + (condensed ? 2 * rows : 0);
  double* const compliance = system + system_workspace_doubles(model.system);
  double* const of_newton = compliance + ports * ports;
  double* const beside = of_newton + newton_doubles(model);
  double* const profile = beside + beside_doubles(model);
  double* const element_step = profile + profile_doubles(model);
  double* const external = element_step + kElementStepDoubles * model.runner_force_elements;
  return {memory,
          memory + n,
          memory + 2 * n,
          memory + 3 * n,
          imaginary,
          row,
          system,
          external,
          external + (model.external_wheels > 0 ? state_doubles(model) : 0),
          unit,
          unit + units,
          compliance,
          of_newton,
          beside,
          profile,
          reinterpret_cast<ElementStep*>(element_step)};
}

/// Copies a state to other memory, without the latched status.
State copied_state(const Model& model, const State& from, double* memory) noexcept;

/// Puts the model's start into a state: step 0, with no matrix kept yet.
void reset(const Model& model, State& state) noexcept;

/// FNV-1a over the step count, the latched status and the bits of all fields: equal states have
/// equal hashes.
std::uint64_t state_hash(const Model& model, const State& state) noexcept;

}  // namespace railstep
