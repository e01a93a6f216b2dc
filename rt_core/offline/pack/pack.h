#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "offline/condense/flexibility.h"
#include "offline/condense/floquet.h"
#include "offline/condense/reduction.h"
#include "offline/irregularity/spline.h"
#include "offline/math/constants.h"
#include "offline/runner/rolling_profiles.h"
#include "offline/runner/running.h"
#include "offline/track/fixed_port.h"
#include "offline/vehicle/vehicle.h"
#include "online/model/state.h"

namespace railstep {

/// A force that moves along a rail, as a scene gives it.
struct MovingLoad {
  int rail = 0;
  double start = 0., speed = 0.;    // m, m/s
  double stop = 0.;                 // m; the load is removed beyond it
  double force = 0.;                // N along z, up positive
  double z = 0.;                    // height of the load's point over the axis, m
  std::vector<double> table = {};   // t (s), factor, t, factor, ...; empty: constant
  std::vector<double> speeds = {};  // t (s), m/s, t, m/s, ...; empty: `speed`
  /// Added to `force`: amplitude sin(2 pi (frequency t + phase)); N, Hz, cycles.
  double amplitude = 0., frequency = 0., phase = 0.;
};

/// Speed of a load at t = 0, m/s.
double first_speed(const MovingLoad& load);

/// The flanges of a wheelset's wheels, as a scene gives them.
struct Flange {
  double clearance = 0.;                // m, of each wheel along y in the middle of the track
  double angle = 0.;                    // rad, of the faces to the horizontal
  double height = .028;                 // m, of the tips below the treads
  double corner_radius = 0.;            // m, of a gauge face in Hertz contact; 0: spring and damper
  double stiffness = 0., damping = 0.;  // N/m, N s/m
};

/// A force from outside on a wheelset or a vehicle.
struct OuterForce {
  int direction;  // 0 x, 1 y, 2 z of a wheelset; else the vehicle's coordinate: of one over one
                  // rail as first_coordinates(), in space kMotions times the body, and BodyMotion
  std::vector<double> table = {};  // t (s), N, t, N, ...; empty: an input
  int input = -1;                  // index among Traffic::input_limits, without a table
};

/// Force at t = 0, N or N m; 0 of an input.
double first_force(const OuterForce& force);

/// A rigid wheelset on both rails, as a scene gives it. Its treads are cylinders without friction.
struct Wheelset {
  double mass = 0., inertia_roll = 0., inertia_spin = 0., inertia_yaw = 0.;  // kg, kg m2
  double weight = 0.;                         // N, down; of the wheelset and what it carries
  double radius = kWheelRadius;               // m
  double tread_half_width = kTreadHalfWidth;  // m
  double start = 0., speed = 0.;              // m, m/s
  std::vector<double> speeds = {};            // t (s), m/s, ...; empty: `speed`
  Guide guide = Guide::augmented_lagrangian;
  int cap = 20;
  double tolerance = 1e-10;      // m, rad
  double alpha = 0., beta = 0.;  // of Baumgarte, 1/s
  std::vector<OuterForce> forces = {};
  std::array<Signal, 2> tread = {};  // of the left and right wheel, over the distance rolled
  std::optional<Flange> flange = std::nullopt;
};

/// How a vehicle falls onto an unloaded track: without force in its springs or wheels.
struct Falling {
  double height = 0.;  // of its wheels above the level rail, m
  double speed = 0.;   // down, m/s
};

/// A vehicle over one rail, as a scene gives it.
struct RunningVehicle {
  Vehicle vehicle = {};
  int rail = 0;
  double start = 0., speed = 0.;    // of its origin, m, m/s
  std::vector<double> speeds = {};  // t (s), m/s, ...; empty: `speed`
  double gravity = kGravity;        // m/s2
  WheelContactKind contact = WheelContactKind::hertz;
  double stiffness = 0., damping = 0.;  // of a linear contact, N/m, N s/m
  std::vector<Signal> tread = {};       // of each wheel, over the distance rolled; or empty
  std::vector<OuterForce> forces = {};
  std::optional<Falling> falling = std::nullopt;  // of a released start
};

/// A vehicle in space on both rails, as a scene gives it.
struct RailVehicle {
  Runner runner = {};
  RollingContact contact = {};
  std::shared_ptr<const ContactTables> tables = nullptr;  // to which its profiles point
  std::vector<double> friction = {};  // [places][3] RollingFriction::parts; empty: 1 everywhere
  double start = 0., speed = 0.;      // of its origin, m, m/s
  bool rolls_freely = false;          // from that speed on; has no `speeds`
  std::vector<double> speeds = {};    // t (s), m/s, ...; empty: `speed`
  double gravity = kGravity;          // m/s2
  std::vector<OuterForce> forces = {};
};

/// Stiffness of a bonded contact, N/m: it yields a millionth of what the stiffest rail does.
inline constexpr double kBonded = 1e15;

/// An irregularity or a defect of a rail.
struct RailIrregularity {
  int rail;       // 0 left, 1 right
  int direction;  // 1 y, 2 z
  Signal signal;
};

/// The railhead that wheels meet.
struct Railhead {
  double top_z = 0.;                   // of its middle above the axis, in the section, m
  double crown_radius = kCrownRadius;  // m
  double half_width = .035;            // m; a contact beyond it is off the rail
  double gauge_half_width = .035;      // m, at kGaugeDepth below the top
};

/// A sum over coordinates of a wheelset, or of a vehicle over one rail or in space.
struct RunnerSum {
  enum class Of { wheelset, vehicle, rail_vehicle };
  Of of;
  std::size_t index;  // among those of the traffic
  struct Part {
    int coordinate;  // as OuterForce::direction
    double factor;
  };
  std::vector<Part> parts;
};

/// A scalar that frames publish: rest + displacement * D(u) + velocity * D(v). D is a sum over the
/// track, or over a runner.
struct TrackSensor {
  double rest = 0.;
  double displacement = 0., velocity = 0.;  // factors
  double acceleration = 0.;                 // factor of D(a), of a vehicle
  Functional track = {};
  std::optional<RunnerSum> runner = std::nullopt;  // in place of `track`
  struct PortForce {
    int port;       // among fixed_ports() of the track
    double factor;  // of its force
  };
  std::vector<PortForce> ports = {};
  bool along = false;  // a place along the track, which moves with traffic without end
};

/// A wheel of a vehicle outside the model. Its place and force are inputs of the model.
struct ExternalWheel {
  int rail = 0;
  double limit = 0.;  // N, of each component of its force
};

/// The loads and vehicles on a track, and the sensors that are read from it.
struct Traffic {
  std::vector<MovingLoad> loads = {};
  std::vector<Wheelset> wheelsets = {};
  std::vector<RunningVehicle> vehicles = {};
  std::vector<RailVehicle> rail_vehicles = {};
  Railhead head = {};  // of both rails
  std::vector<TrackSensor> track_sensors = {};
  std::vector<RailIrregularity> irregularities = {};
  std::vector<double> input_limits = {};              // of each input, N or N m, above 0
  std::vector<ExternalWheel> external_wheels = {};    // their inputs follow all others
  std::vector<int> held = {};                         // rails that a multibody system is joined to
  std::optional<Railhead> right_head = std::nullopt;  // of the right rail if it differs
  LineShape design_line = {};                         // which vehicles in space follow
};

/// A track without end under traffic of one speed, at least 0. It is a ring if its lines are
/// condensed (Track::ring), and a window in full order. Places of loads and wheelsets count from
/// the bay border `behind`. All other places belong to bays as they are at the start, and follow
/// the traffic by whole bays.
struct EndlessTrack {
  int behind;  // number of bays before x = 0
};

/// A track without end as a window, for full order. Its front end is clamped: a bay that enters
/// there is at rest and meets a node at rest, so that it enters without strain (docs/endless.md).
Track window_of(Track track);

/// Writes limits of inputs into a model. Throws Refused if there are too many, or if a limit is not
/// a finite number above 0.
void take_inputs(const std::vector<double>& limits, Model& model);

struct PackOptions {
  Scheme scheme;  // of banded lines and bodies; condensed lines are stepped exactly
  int steps_per_frame = 1;
  bool residual_flexibility = true;
  int residual_points = 16;  // intervals per element
  double gravity = 0.;       // m/s2 on rails and sleepers; 0: they have no weight
  std::optional<Reduction> reduction = std::nullopt;  // of each line; empty: full order
  std::int64_t steps = 0;                             // of the scene's run; 0: one frame
  std::optional<EndlessTrack> endless = std::nullopt;
  /// Constant forces on the unknowns of each line that moves, beside weight; empty: none.
  std::vector<Eigen::VectorXd> line_forces = {};
};

/// A line of the track as the model carries it.
struct PackedLine {
  Line line;
  std::size_t index;                    // among those of assemble(track)
  Eigen::SparseMatrix<double> closing;  // [unknowns][fixed ports] of the track
  Basis basis;                          // of a condensed line
  ModeGroups modes;                     // of a condensed line
};

/// Matrices of a rail vehicle under its weight and its forces of tables at t = 0.
RunnerMatrices loaded_matrices(const RailVehicle& vehicle);

/// A rail vehicle as it was packed, with its loaded matrices.
struct PackedRunner {
  RailVehicle vehicle;
  RunnerMatrices matrices;
};

/// The matrices of bodies on a linear suspension: SuspendedModel.
struct SuspendedMatrices {
  Eigen::VectorXd mass, rest;
  Eigen::MatrixXd damping, stiffness;
  Eigen::MatrixXd held;          // [n][constraints] rows, as columns, that stay 0
  Eigen::VectorXd penalty = {};  // [n] on coordinates that penalties hold, N/m; empty: none
};

/// How bodies respond to forces in a step.
struct SuspendedResponse {
  Eigen::MatrixXd inverse;   // [n][n] of the coordinates, symmetric to the last bit
  Eigen::MatrixXd reaction;  // [constraints][n] of the constraints' forces along their rows
  Eigen::MatrixXd held;      // [constraints][constraints] their forces by displacements of the rows
};

/// Column by column.
inline std::vector<double> column_by_column(const Eigen::MatrixXd& A) {
  return {A.data(), A.data() + A.size()};
}

/// A model and the memory that its views look into. Not copied: views would look into the original.
///
/// Lines that no load, wheel, weight or one-sided support can move are left out. Lines with the
/// same matrices (two rails that share nothing) share their factor or modes.
class PackedModel {
 public:
  /// The start is set to rest, unloaded; set_start() gives another.
  PackedModel(const Track& track, const Traffic& traffic, const PackOptions& options);
  PackedModel(const PackedModel&) = delete;
  PackedModel& operator=(const PackedModel&) = delete;

  const Model& model() const { return model_; }
  const std::vector<PackedLine>& lines() const { return lines_; }
  /// Load points of all vertical forces.
  const std::vector<LoadPoint>& load_points() const { return load_points_; }
  const std::vector<PackedRunner>& runners() const { return runners_; }
  /// @param state  state_doubles() values, from start.h
  void set_start(std::vector<double> state);
  /// Largest amount by which G_res was raised under a wheel so that W stays positive, m/N.
  double clipped() const { return clipped_; }

 private:
  const double* keep(std::vector<double> values);
  const std::int32_t* keep(std::vector<std::int32_t> values);
  Diagonals keep_diagonals(const Eigen::SparseMatrix<double>& A, int padded);
  void add_lines(const Track& track, const Traffic& traffic, const PackOptions& options);
  void add_line(const Track& track, PackedLine packed, const PackOptions& options);
  void add_banded(const Track& track, const Line& line, LineModel& packed, double gravity);
  void add_condensed(const Track& track, PackedLine& own, LineModel& packed,
                     const Reduction& reduction);
  void add_endless(const Track& track, const Traffic& traffic, const PackOptions& options);
  BayShift ring_shift(const RingModes& ring, int padded);
  BayShift window_shift(const Track& track, const Line& line, int padded, double gravity);
  template <typename Number>
  void keep_tables(const Line& line, LineModel& packed, const Number& number);
  void add_load(const Track& track, const MovingLoad& load);
  SignalModel keep(const Signal& signal);
  /// @param force   [kMaxBodyForces] overwritten
  /// @param body  "wheelset" or "vehicle", for messages
  /// @returns number of forces
  std::int32_t keep(const std::vector<OuterForce>& forces, BodyForce* force, const char* body);
  void add_responses();
  void add_fixed_ports(const Track& track);
  void add_port_rows();
  void add_port_shapes();
  void add_irregularity(const Track& track, const RailIrregularity& irregularity);
  void add_wheelset(const Track& track, const Wheelset& wheelset,
                    const std::array<Railhead, 2>& heads);
  void add_external(const Track& track, const ExternalWheel& wheel);
  void add_flange(const Track& track, const Wheelset& wheelset,
                  const std::array<Railhead, 2>& heads);
  void add_vehicle(const Track& track, const RunningVehicle& vehicle,
                   const std::array<Railhead, 2>& heads);
  void add_runner(const Track& track, const RailVehicle& vehicle);
  void add_design_line(const Traffic& traffic);
  /// Adds the tables of the bodies' frames. @param step  the runner's response in a step
  void add_frames(const RailVehicle& vehicle, const RunnerMatrices& m,
                  const SuspendedResponse& step, RunnerModel& packed);
  /// Friction that falls over slip is a damper of negative rate. A step has one solution as long as
  /// the slip of contacts by a unit force, times the fall of the force by a unit of slip, is below
  /// 1. Above 1/2, under twice the mean wheel load, the friction is refused.
  void refuse_steep_friction(const Track& track) const;
  /// Takes the tables that a pair points to into the model's own memory.
  void keep_profiles(ProfilePair& pair);
  /// @param body  "wheelset" or "vehicle", for messages
  SuspendedResponse add_suspended(const SuspendedMatrices& m, const std::vector<OuterForce>& forces,
                                  SuspendedModel& packed, const char* body = "vehicle");
  [[noreturn]] void refuse_many_coordinates() const;
  TravelModel keep_travel(double speed, const std::vector<double>& speeds);
  void add_weight(const Track& track, const PackOptions& options);
  void add_track_sensors(const Track& track, const std::vector<TrackSensor>& track_sensors);
  /// The first coordinate among the state's unknowns.
  std::int32_t first_unknown(const RunnerSum& runner) const;
  void add_residual(const Track& track, const std::vector<TrackSensor>& track_sensors, int points);
  void add_track_sensor_tables(const ResidualFlexibility& residual,
                               const std::vector<TrackSensor>& track_sensors);
  void add_p_delta(const Track& track);
  void clip(int points, std::vector<double>& under);
  std::int32_t load_point_at(const LoadPoint& point);
  std::int32_t load_point_of_wheel(int rail);
  ContactModel& insert_contact(ContactId at);

  Model model_{};
  std::vector<PackedLine> lines_;
  std::vector<LoadPoint> load_points_;
  std::vector<PackedRunner> runners_;
  std::int32_t contacts_ = 0;
  double clipped_ = 0.;
  Elements met_{};            // elements that the traffic visits (ring), else all
  std::vector<bool> is_met_;  // each element; between parts of the traffic a ring has others
  bool moves_along_ = true;   // rows may have parts along x
  std::vector<std::unique_ptr<std::vector<FrameElement>>> frame_elements_;
  std::vector<std::unique_ptr<std::vector<TracedElement>>> traced_elements_;
  std::vector<std::unique_ptr<std::vector<double>>> reals_;
  std::vector<std::unique_ptr<std::vector<std::int32_t>>> integers_;
};

}  // namespace railstep
