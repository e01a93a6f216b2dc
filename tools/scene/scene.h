#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "offline/beam/equilibrium.h"
#include "offline/pack/pack.h"
#include "offline/section/section.h"
#include "offline/track/track.h"
#include "offline/vehicle/kinds.h"
#include "online/model/model.h"
#include "scene/scene_irregularity.h"

namespace railstep {

enum class Height { axis, head, foot };  // where in the section a force acts or a sensor sits
enum class Side { left, right };         // left is +y
enum class TimeScheme { generalised_alpha, backward_euler, newmark, hht, tr_bdf2, energy_momentum };
enum class Start { equilibrium, released, moving };
enum class GuideMethod { augmented_lagrangian, baumgarte };
enum class RailModel { linearised, nonlinear, timoshenko };
enum class ReferenceLine { centroid, mid_height, foot, head };  // where the rails' nodes are

/// Three stacked rectangles from the foot up, m.
struct RectangleSizes {
  double foot_width, foot_height, web_width, web_height, head_width, head_height;
};
/// One rectangle, m; its shear factors are Cowper's unless [rail] overrides them.
struct RectangleSize {
  double height, width;
};
struct ProfileFile {
  std::filesystem::path path;  // an outline to be fitted with three rectangles,
  bool exact = false;          // or taken as it is
};
struct SectionFile {
  std::filesystem::path path;  // what `railstep fit --out` wrote
};
using SectionSource =
    std::variant<ProfileFile, SectionFile, Section, RectangleSizes, RectangleSize>;

/// Which rails there are and how they are cut up. x runs from 0 to length().
struct TrackScene {
  Unknowns unknowns;
  int rails;          // 1 (on y = 0) or 2 (left on y = +rail_spacing / 2)
  std::int64_t bays;  // per rail; supports stand at the bays + 1 bay borders
  bool endless;       // bays are those of the ring or window under the traffic
  double bay;         // m
  int elements_per_bay;
  double rail_spacing;  // between the rails' centres, m
  RailEnds ends;
  int end_zone_bays;  // damped bays before each non-reflecting end
  bool gravity;       // on the rails
  RailModel model;
  bool linearised_under_weight;  // the stiffness is taken where weight and preload leave the track
  ReferenceLine reference_line;
  [[nodiscard]] double length() const { return static_cast<double>(bays) * bay; }
};

/// Section, material and element rule of a bar: of a rail, or of a beam.
struct BarScene {
  SectionSource shape;
  double young, poisson, density;  // Pa, 1, kg/m3
  ElementRule rule;
  int section_points;  // Gauss points per rectangle and direction; 0: exact moments
  std::optional<double> shear_factor_y, shear_factor_z;  // replace the section's
};

struct RailScene : BarScene {
  double crown_radius;      // m
  double axial_force;       // N, tension positive, beside what the temperature makes
  double temperature_rise;  // K, over that without force
  double expansion;         // 1/K
  double cant;              // by how much both rails lean inwards, tangent
};

/// A spring and a damper in parallel.
struct Spring {
  double stiffness = 0.0;  // N/m, or N m/rad
  double damping = 0.0;    // N s/m, or N m s/rad
};

/// The pad at each bay border of each rail.
struct SupportScene {
  Spring x, y, z, roll;
  Height at;           // foot or axis
  double half_spread;  // m; over 0: half of each spring at y = -half_spread and +half_spread
  double length;       // m along x, over which it is evenly spread; 0: a point
  bool unilateral;     // z presses and does not pull
  double gap;          // of z, m
};

struct SleeperScene {
  double mass;           // both ends together, kg; one rail rests on half of it
  double roll_inertia;   // about x, kg m2
  double pitch_inertia;  // about y, kg m2
  double
      ballast_length;  // m along x, over which it is evenly spread; 0: the sleeper does not pitch
  Spring ballast_z;    // under each end
  std::optional<Spring> ballast_x, ballast_y;  // under each end; none: held in that direction
  bool ballast_unilateral;                     // ballast_z presses and does not pull
  double ballast_gap;                          // of ballast_z, m
};

/// What a change takes away of a seat.
enum class Missing { nothing, pad, ballast, sleeper };

/// A number of a seat that becomes another one, or a multiple of itself.
struct SeatValue {
  double& (*of)(Seat& seat, std::size_t side);
  double first, last;  // at the first and the last of the seats, linear between
  bool scales;         // it is a factor on what is there, else it stands in its place
};

/// Factors drawn evenly from 1 - width to 1 + width: one for each seat and side, on all of `of`.
struct SeatScatter {
  std::vector<double& (*)(Seat& seat, std::size_t side)> of;
  double width;
  std::uint64_t stream;  // tells draws of one seed apart
};

/// How some seats differ from [support], [sleeper] and [ballast]. Values, scatter, what is missing,
/// in this order.
struct SeatChange {
  std::vector<int> seats;
  std::array<bool, 2> sides;  // left, right
  std::vector<SeatValue> values;
  std::optional<bool> pad_unilateral, ballast_unilateral;
  std::vector<SeatScatter> scatter;
  std::uint64_t seed = 0;
  Missing missing = Missing::nothing;
};

/// Between the ends of rails at a joint.
struct JointGap {
  std::optional<double> cold;           // without heat, m; none: the ends never meet
  std::optional<double> end_stiffness;  // N/m; none: by the section
  double end_damping = 0.0;             // N s/m
  std::array<double, 2> grown{};        // what heat takes of it at left and right rail, m
};

/// What a rail's point meets and does not pull at.
struct StopScene {
  std::string name;
  Side rail;
  double position;  // m
  int direction;    // 1 y, 2 z
  double side;      // 1 or -1: met on the way along + or - of it
  Height at;
  double gap;  // m
  Spring spring;
};

/// A function of time: 0 before the first row, linear between rows, the last value after.
struct TimeTable {
  std::vector<double> time;   // s, rising
  std::vector<double> value;  // [time.size()]
  [[nodiscard]] double at(double t) const;
  [[nodiscard]] std::vector<double> rows() const;  // t, value, t, value, ...
};

/// A force on a rail at x = start + speed * t.
struct LoadScene {
  std::string name;
  Side rail;
  double start, speed, force_z;  // m, m/s, N (up positive)
  Height at;                     // axis or head
  std::optional<TimeTable> factor;
  std::optional<double> stop;                            // m; the load is taken off there
  bool may_leave_rail;                                   // then it is simply gone past the end
  std::optional<TimeTable> speeds;                       // m/s, constant outside its rows
  double amplitude = 0.0, frequency = 0.0, phase = 0.0;  // N, Hz, turns
};

struct GuideScene {
  GuideMethod method;
  int cap;             // iterations a step
  double tolerance;    // of the constraint, m
  double alpha, beta;  // Baumgarte, 1/s
};

/// A force from outside that is given frame by frame.
struct InputScene {
  std::string name;  // NAME.force_n or NAME.moment_n_m
  double limit;      // N or N m
};

/// A wheel of a vehicle outside the scene.
struct ExternalWheelScene {
  std::string name;
  Side rail;
  double limit;  // N
};

struct BodyForceScene {
  int direction;    // 0 x, 1 y, 2 z; of a vehicle its coordinate
  TimeTable force;  // N on the centre, or N m; empty of an input
  int input = -1;   // among Scene::inputs
};

/// Two wheels on one axle; needs two rails.
struct WheelsetScene {
  std::string name;
  std::array<std::string, 2> wheels;                     // names: left, right
  double mass, inertia_roll, inertia_spin, inertia_yaw;  // kg, kg m2
  double radius, tread_half_width;                       // m
  double start, speed;                                   // m, m/s
  std::optional<TimeTable> speeds;                       // m/s, constant outside its rows
  double carried_mass;                                   // kg: weight without inertia
  bool gravity, may_leave_rail;
  GuideScene guide;
  std::vector<BodyForceScene> forces;
  std::vector<TreadScene> treads;
  std::optional<Flange> flange;
};

/// The speed of the largest size that it has, m/s.
double fastest(const WheelsetScene& wheelset);

/// A vehicle over one rail.
struct VehicleScene {
  std::string name, table;  // in the trace, and that of its [[vehicle]]
  NamedVehicle kind;
  Side rail;
  double start, speed;              // of its origin, m, m/s
  std::optional<TimeTable> speeds;  // m/s, constant outside its rows
  WheelContactKind contact;
  double stiffness, damping;  // of a linear contact, N/m, N s/m
  bool gravity, may_leave_rail;
  std::optional<Falling> falling;  // on the unloaded track; none: it stands on it
  std::vector<WheelTread> treads;
  std::vector<BodyForceScene> forces;
};

double fastest(const VehicleScene& vehicle);

struct StepScene {
  double dt;  // s
  std::int64_t steps_per_frame;
  std::int64_t steps;  // of the whole run
  TimeScheme scheme;
  double rho_inf;                      // of generalised-alpha, and of held contact forces
  double newmark_gamma, newmark_beta;  // of Newmark
  double hht_alpha;                    // of Hilber, Hughes and Taylor
  bool mean_contact;                   // of condensed tracks: contact by the discrete gradient
  Start start;
};

struct CondenseScene {
  std::optional<ReductionKind> kind = {};  // none: full order
  std::optional<double> modes_per_bay = {}, highest_hz = {};
  int nodes_per_bay = 1;
  std::vector<double> expansion_hz = {};
  std::array<double, 2> band_hz = {20., 1500.};  // in which the model is to be right
  bool residual_flexibility = true;
};

struct RailSensor {
  Side rail;
  double position;  // m
  Height at;
  std::optional<double> gauge_length = {};  // of a strain gauge along the rail, m; none: no gauge
};
struct SleeperSensor {
  std::int64_t sleeper;      // from 0 along x
  std::optional<Side> rail;  // the end under that rail; none: its centre
};
struct WheelsetSensor {
  std::size_t wheelset;  // index into Scene::wheelsets; its centre
};
struct VehicleSensor {
  std::size_t vehicle, body;  // indices into Scene::vehicles and its bodies
  double ahead;               // of the body's middle, m
};
struct SensorScene {
  std::string name;
  std::variant<RailSensor, SleeperSensor, WheelsetSensor, VehicleSensor> on;
};

/// One scene of a track, every number checked and in SI. config/README.md, "Scenes", has it key by
/// key.
struct Scene {
  std::filesystem::path file;
  std::string sum;  // Table::sum() of it
  TrackScene track;
  RailScene rail;                       // of both rails
  std::optional<RailScene> right_rail;  // of the right one, where it differs
  std::optional<SupportScene> support;  // none: only the ends hold the rails, or nothing
  std::optional<SleeperScene> sleeper;
  std::vector<SeatChange> seat_changes;  // one after the other
  std::vector<StopScene> stops;
  std::vector<RailJoint> joints;     // without what their gaps do
  std::vector<JointGap> joint_gaps;  // [joints]
  std::vector<LoadScene> loads;
  std::vector<WheelsetScene> wheelsets;
  std::vector<InputScene> inputs;
  std::vector<ExternalWheelScene> external_wheels;
  std::vector<VehicleScene> vehicles;
  std::optional<IrregularityScene> irregularity;
  std::vector<DefectScene> defects;
  std::optional<StepScene> step;  // none: the scene is not run
  CondenseScene condense;
  NewtonOptions statics;
  std::vector<SensorScene> sensors;
  bool trace_supports;
  /// Of the run, s; 0 without one.
  [[nodiscard]] double duration() const {
    return step ? static_cast<double>(step->steps) * step->dt : 0.0;
  }
};

/// Whether a wheelset has flanges.
bool has_flanges(const Scene& scene);

/// Width of a railhead where the gauge is measured, m; none: the section says nothing of it.
std::optional<double> head_width(const BarScene& rail);

/// Reads and checks a scene of a track; nothing of its size is allocated. Throws InputError, also
/// at a scene of bodies and beams, which scene_system.h reads.
Scene read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});

}  // namespace railstep
