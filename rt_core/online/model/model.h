#pragma once
#include <cstdint>

#include "online/math/band.h"
#include "online/math/complex_modes.h"
#include "online/math/diagonals.h"
#include "online/model/cant.h"
#include "online/model/caps.h"
#include "online/model/design_line.h"
#include "online/model/runner_model.h"
#include "online/model/scheme.h"
#include "online/model/signal.h"
#include "online/model/system.h"

namespace railstep {

inline constexpr int kMaxLines = 16;  // independent systems that a track splits into
inline constexpr int kMaxLoads = 32;
inline constexpr int kMaxWheelsets = 4;
inline constexpr int kMaxVehicles = 16;
inline constexpr int kMaxVehicleUnknowns = 16;  // of one vehicle
inline constexpr int kMaxInputs = 96;           // forces and places of each frame
inline constexpr int kMaxExternalWheels = 16;
inline constexpr int kMaxSignals = 32;    // irregularities and defects of the rails
inline constexpr int kPDeltaSeats = 6;    // around a wheel, half of them on each side of its bay
inline constexpr int kMaxLoadPoints = 4;  // rails and heights at which vertical forces act
inline constexpr int kNoLoadPoint = -1;   // without part in the residual flexibility

// Upper bounds of a model; a block that exceeds them is refused.
inline constexpr std::int64_t kMostElements = 100'000;
inline constexpr std::int64_t kMostUnknowns = 1 << 26;
inline constexpr std::int64_t kMostRows = 1 << 22;  // of tables, track sensors and shapes
inline constexpr std::int64_t kMostEntries = 1 << 28;
inline constexpr std::int64_t kMostPairPoints = 64;
inline constexpr std::int64_t kMostSamples = 1 << 26;  // of an irregularity
inline constexpr std::int64_t kMostGuideIterations = 1000;

/// Exact progress of the traffic of a track without end at a step. Fractions count in 2^-62 of a
/// bay: n steps are n / period times `bays` whole bays, and n % period steps of `advance`.
struct BayProgress {
  std::int64_t period;   // steps that take whole bays, or more steps than are made
  std::int64_t bays;     // whole bays in a period
  std::int64_t advance;  // of a step, below a bay
};

/// A track without end. All traffic has one speed. The model's elements stand still under it for a
/// bay; then their state is shifted by one bay to the rear.
struct Endless {
  std::int32_t bays;          // of the model's elements; 0: the track has ends
  std::int32_t bay_elements;  // elements of a bay
  double bay_length;          // m
  double origin;              // place along the elements at which x = 0 is at the start, m
  BayProgress progress;
};

/// Shift of a line by one bay: each unknown x[i] becomes own[i] x[i] + other[i] x[from[i]], in u,
/// v, a and g; in u `fill[i]` is added.
struct BayShift {
  const std::int32_t* from;  // [size]
  const double *own, *other, *fill;
};

/// A condensed line: complex modes z' = rate z + q, with q = shape' f for the forces f on it, and
/// displacement Re shape z (both without conjugation). They are stepped exactly:
///   z1 = keep z0 + old_force q0 + new_force q1   for q linear in time,
///   z1 = keep z0 + held_force q                  for q constant over the step.
struct Modal {
  std::int32_t count;  // of modes, padded with zeros to whole panels; 0: the line is banded
  Complex rate;        // [count] 1/s
  Complex keep;        // e^(rate dt)
  Complex old_force, new_force, held_force;  // s
  std::int32_t rows;
  const double* shape;  // [rows][2][count] real and imaginary parts, kg^-1/2
  /// Re shape held_force shape' between rows, [rows][rows] m/N, symmetric; null where the modes are
  /// summed in the step.
  const double* between;
};

/// The two forms of a track's lines in the step; all lines of a model have the same form.
enum class Form : std::int32_t { banded, condensed };

/// Real numbers for each unknown of a line: 1 in a banded line, 2 for the complex modes of a
/// condensed one.
constexpr std::int32_t parts(Form form) noexcept { return form == Form::condensed ? 2 : 1; }

/// One independent linear system of the track, banded or condensed; views into the model's block.
/// The state of a condensed line is Re z in u, Im z in v, and the last Re q and Im q in a and g.
struct LineModel {
  std::int32_t first, size;  // its unknowns among the state's, padded to whole panels
  std::int32_t twin;         // the first line that shares its matrices or modes; itself if none
  Band step;                 // factor of K + kv C + kg M, L D L'
  std::int32_t reach;        // panels behind a force's own to which L^-1 carries it
  Diagonals mass, damping;   // padded to whole panels
  Modal modal;
  BayShift shift;  // of a track without end
  /// For left and right rail, [elements][3][9]: unknown, or row of modal.shape; -1: not in the
  /// line. Both rails have one table if they are mirror images, or if the line has one rail.
  /// Elements share the unknowns of their border if the rail is not cut there.
  const std::int32_t* unknown_of[2];
  std::int32_t components;     // bit k is set if a node of these tables has an unknown k
  double rail_factor[2];       // weight of the line in left and right rail; 0: it lacks that rail
  std::int32_t mirrored;       // right rail: y components change sign
  std::int32_t rigid_section;  // a_z and b_y are one unknown, the roll a_z
};

/// A prescribed force that moves along a rail: force * table + amplitude sin(2 pi (frequency t +
/// phase)).
struct LoadModel {
  double row[9];  // of a node: position, y slope, z slope, along the rail's own axes:
  // height of the loaded point
  std::int32_t rail;   // 0 left, 1 right
  double start, stop;  // m; removed beyond stop; on a track without end `start` is along
  // the elements
  TravelModel travel;         // from start
  double force;               // N along z, up positive
  std::int32_t table_points;  // 0: constant
  const double* table;        // [table_points][2]  s, factor; linear between, constant outside
  double amplitude;           // N along z
  double frequency, phase;    // Hz, cycles
  std::int32_t load_point;    // rail and height at which its vertical force acts
};

/// Deviation of a railhead from its straight line over the place along it.
struct RailSignal {
  std::int32_t rail, direction;  // 0 left, 1 right; 1 y, 2 z
  SignalModel signal;
};

/// How a wheelset's guide holds its coordinates. Elimination prescribes them.
enum class Guide : std::int32_t { augmented_lagrangian, baumgarte, elimination };
/// Whether rates and accelerations of guided coordinates are set to those of the guide.
constexpr bool is_projected(Guide guide) noexcept { return guide != Guide::baumgarte; }
inline constexpr int kGuideRows = 2;                // coordinates that a wheelset's guide holds
inline constexpr int kGuided[kGuideRows] = {0, 5};  // x and yaw
/// Penalty of the augmented Lagrangian over the coordinate's inertia term kg m: each iteration
/// leaves 1/(1 + kGuidePenalty) of the violation.
inline constexpr double kGuidePenalty = 1e3;

/// A rigid wheelset on both rails. Coordinates are x, y, z of its centre from its start, then roll,
/// spin (beyond speed / radius) and yaw. Cylinders of one radius roll on circular railhead crowns
/// without friction. The guide holds x on its travel and yaw = 0.
///
/// As of SuspendedModel its origin is its centre at the start; on a track without end x counts the
/// way within a bay. `rest` has the weight of it and of what it carries. `inverse` is diagonal:
/// 0 where the guide prescribes a coordinate, and with the penalty where that is how it holds.
struct WheelsetModel : SuspendedModel {
  double radius, tread_half_width;
  double rest_z;  // height of the centre over the left rail's axis when it touches, m
  Guide guide;
  std::int32_t cap;    // iterations of the augmented Lagrangian
  double tolerance;    // m and rad
  double alpha, beta;  // of Baumgarte, 1/s
};

/// Law of a contact along its normal, d the penetration:
///   hertz d^1.5 for d > 0      for a Hertz contact (hertz > 0), else
///   stiffness d + damping d'   for d > 0, of a wheel for any d: it pulls too (bilateral).
struct ContactLaw {
  double hertz;               // N/m^1.5
  double stiffness, damping;  // N/m, N s/m
};

/// The flanges of a wheelset. Each face is straight across the rail and rotates with the wheelset.
/// The gauge face is a point of the rail's section, at which both are loaded.
struct FlangeModel {
  std::int32_t wheelset;
  double normal[2];    // of the left face at rest, from the rail to the wheel: y, z; right: -y, z
  double point[2][2];  // of left and right face, from the wheelset's centre: y, z, m
  double gauge[2][2];  // gauge face of left and right rail, from the rail's axis: y, z, m
  double tip;          // z of the flanges' tips from the centre, m: no contact with rails below it
};

/// Which part of bodies is in contact: the tread or a flange of a wheelset, or the upright wheel of
/// a vehicle.
enum class ContactKind : std::int32_t { tread, flange, wheel };

/// A contact with a rail. Beyond the rail's ends an upright wheel rolls on level, rigid ground in
/// line with the rail at rest.
struct ContactModel {
  ContactKind kind;
  std::int32_t bodies, rail;  // number of its wheelset or vehicle; 0 left, 1 right
  ContactLaw law;
  std::int32_t load_point;  // rail and height at which its vertical force acts
  SignalModel tread;        // deviation of its radius over the distance rolled
  double place;             // of an upright wheel from its vehicle's origin, m
  /// [size of its vehicle] for an upright wheel, else null: `row` gives its height over the
  /// vehicle's coordinates, and `moved` is how a unit force up moves these.
  const double *row, *moved;
};

/// Residual flexibility between ports of two kinds: the first in element e at point p, the second
/// in element e + shift at point q, -range <= shift <= range. It is zero beyond this range, which
/// on a track without end never happens.
struct PairModel {
  std::int32_t range;   // elements to either side
  const double* value;  // [elements][2 range + 1][pair_points + 1][pair_points + 1] m/N, or null
};

/// Residual flexibility of a seat between its rows; zz beyond that of the load point pressed.
enum class SeatResidual { yy, yz, yr, zz, zr, rr };
inline constexpr int kSeatResiduals = 6;

/// The part of the static deflection under forces on the rails that the model's unknowns miss,
/// tabled over elements at equal steps of xi. Null pointers: not modelled.
struct ResidualModel {
  std::int32_t load_points;  // rails and heights at which vertical forces act
  std::int32_t points;       // intervals per element
  std::int32_t elements;     // of the tables, which repeat then: the model's; of a ring a bay's
  const double* under;       // [load_points][elements][points + 1] m/N, of the force's own point
  const double* axis;        // the same for the rail's axis under it
  std::int32_t pair_points;  // intervals per element of all pairs; 0: there are none
  PairModel pair[kMaxLoadPoints][kMaxLoadPoints];  // [force][displacement]
  /// Displacements of each seat of the runners by unit forces along its own rows y, z and roll, in
  /// the order of SeatResidual. Null without runners.
  const double* seat;  // [runners][2 rails][elements][points + 1][kSeatResiduals] m/N, ...
};

/// Levers of a vertical force on a railhead at the seats around it, as many behind as ahead: the
/// share of the force that a seat carries, times the height of its pad above the axis (below 0 for
/// a foot). If the rail rolls over its seats, the force goes down. Null pointers: not modelled.
struct PDeltaModel {
  std::int32_t elements_per_bay;
  std::int32_t points;     // intervals per element
  const double* lever[2];  // of left and right rail, [elements][kPDeltaSeats][points + 1] m
};

/// Scalars of the track that a frame publishes: rest + row * [u, v] + residual * port forces.
struct TrackSensorModel {
  std::int32_t count;
  const std::int32_t* start;  // [count + 1] of each row among index and value
  std::int32_t entries;
  const std::int32_t* index;  // [entries] into the state's u, v, fixed ports' forces, then g
  const double* value;        // [entries] per m, per m/s, per N or per m/s2
  const double* rest;         // [count]
  const std::int32_t* along;  // [count] 1: a place along the rail that moves with the traffic
  const std::int32_t* table;  // [count] of its residual, -1: none
  /// Each table covers the elements where it is not 0.
  std::int32_t tables, elements;
  const std::int32_t* first;  // [tables] first element of the model in it
  const std::int32_t* ends;   // [tables + 1] ends in the row of their elements, from 0
  const double* residual;     // [tables][load_points][its elements][points + 1] per N, or null
};

/// One-sided springs and dampers at fixed places: supports that do not pull, gaps, stops. The row
/// of each gives its closing by the lines; its force acts on them along the negative row.
struct FixedPortModel {
  std::int32_t count;
  const double* stiffness;  // [count] N/m
  const double* damping;    // [count] N s/m
  const double* gap;        // [count] m
  /// For banded lines, over their unknowns.
  std::int32_t entries;
  const std::int32_t* start;  // [count + 1] of each row among index and value
  const std::int32_t* index;  // [entries]
  const double* value;        // [entries]
  /// For condensed lines: row' shape, real and imaginary parts; null otherwise.
  const double* shape;  // [count][2][line_unknowns] kg^-1/2
  /// Response of the lines to a unit force along the row. For condensed lines held_force shape,
  /// real and imaginary parts. For banded ones, S = L D L', halfway: L^-1 row and D^-1 L^-1 row, 0
  /// outside the panels of each line.
  const double* response;      // [count][2][line_unknowns]
  const std::int32_t* panels;  // [count][lines][2] first and end of banded ones; null otherwise
  const double* compliance;    // [count][count] theta row response, m/N
};

/// A wheel of a vehicle outside the model, which acts on a rail. Its place and force are inputs
/// from `input` on (external_input.h), and hold for the step, which is a frame.
struct ExternalWheelModel {
  std::int32_t rail, input;
  std::int32_t load_point;  // rail and height at which its vertical force acts
};

/// Results that the first frames of a model from a block must have on every machine: self_check.h.
struct CheckModel {
  std::int32_t frames;   // 0: no check
  std::int32_t columns;  // of `row`
  std::uint64_t hash;    // of the state
  const double* row;     // [columns] of the trace
};

/// Cost of a frame in the worst case: all loads act, contacts, ports and iterations at their caps.
struct Cost {
  std::int64_t
      flops;  // additions, subtractions, multiplications, divisions, square roots, each one
  std::int64_t bytes;  // of model, state and workspace: each kernel's operands and results, once
  std::int64_t instructions;
};

/// Everything a step needs; immutable, may be shared by threads.
struct Model {
  Scheme scheme;
  std::int32_t lines, loads, wheelsets, vehicles, signals, elements;
  std::int32_t vehicle_wheels;  // of all vehicles
  std::int32_t flanges;         // number of wheelsets with flanges
  std::int32_t unknowns;  // of all lines, padded, 8 per wheelset, of vehicles, and the system's
  Form form;              // of all lines
  std::int32_t line_unknowns;  // of all lines together: bodies and systems follow
  std::int32_t steps_per_frame;
  std::int32_t inputs;             // numbers of each frame
  double input_limit[kMaxInputs];  // N or N m, above 0: they saturate at both signs of it
  DesignLine design_line;          // which vehicles in space follow
  double element_length;           // m
  Endless endless;
  double rail_y[2];  // of the rails' axes, m
  double rail_z[2];  // of the rails' axes above the left one, m: heads are level
  Cant cant[2];
  double head_z[2];              // height of a railhead's middle above the axis in the section, m
  double crown_radius[2];        // m
  double head_half_width[2];     // m
  const double* constant_force;  // [parts(form)][unknowns] N, or null: the track's weight
  ResidualModel residual;
  PDeltaModel p_delta;
  TrackSensorModel track_sensor;
  FixedPortModel fixed;
  const double* start;  // [start_doubles] state at step 0
  std::int64_t steps;   // of the scene's run
  Cost cost;            // largest cost of a frame
  LineModel line[kMaxLines];
  LoadModel load[kMaxLoads];
  WheelsetModel wheelset[kMaxWheelsets];
  FlangeModel flange[kMaxWheelsets];  // by rising wheelset
  /// Vehicles that bounce and pitch over one rail. Their coordinates count from where the wheels
  /// touch a rail at rest without a force in any spring.
  SuspendedModel vehicle[kMaxVehicles];
  ContactModel contact[kMaxWheels];  // by ContactId
  RailSignal signal[kMaxSignals];
  std::int32_t runners, runner_wheelsets, runner_rods;  // the latter of all runners
  /// Force elements of all runners, their displacements, and the numbers that states keep of them.
  std::int32_t runner_force_elements, element_coordinates, element_memory;
  std::int32_t runner_traced;  // displacements of linear elements that are published
  RunnerModel runner[kMaxRunners];
  std::int32_t external_wheels;
  ExternalWheelModel external_wheel[kMaxExternalWheels];
  SystemModel system;
  CheckModel check;
  unsigned char sum[32];  // SHA-256 of the payload it was loaded from; zeros without one
};

/// Fraction of the step at which the equations of suspended bodies hold: 1, its end, with banded
/// lines; 1/2 with condensed ones, which hold forces over the step.
inline double held_fraction(const Model& model) noexcept {
  return model.form == Form::condensed ? .5 : 1.;
}

/// Rate of a motion by its change in the law of a wheelset's contacts, 1/s: its mean over the step
/// if forces are held over it, else that at the step's end.
inline double law_rate(const Model& model) noexcept {
  return model.form == Form::condensed ? mean_rate(model.scheme) : model.scheme.kv;
}

/// Number of unknowns of a state, from the first on, that are modes of condensed lines.
inline std::int32_t modal_unknowns(const Model& model) noexcept {
  return model.form == Form::condensed ? model.line_unknowns : 0;
}

}  // namespace railstep
