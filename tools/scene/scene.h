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
#include "offline/pack/travel_rows.h"
#include "offline/runner/runner.h"
#include "offline/section/section.h"
#include "offline/track/track.h"
#include "offline/vehicle/kinds.h"
#include "online/model/model.h"
#include "scene/scene_irregularity.h"

namespace railstep {

enum class Height { axis, head, foot };  // where in the section a force acts or a sensor sits
enum class TimeScheme { generalised_alpha, backward_euler, newmark, hht, tr_bdf2, energy_momentum };
enum class Start { equilibrium, released, moving };
enum class RailModel { linearised, nonlinear, timoshenko };
enum class ReferenceLine { centroid, mid_height, foot, head };  // where the rails' nodes are

inline constexpr int kLeftRail = 0;  // on +y
inline constexpr int kRightRail = 1;

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

/// The rails and their mesh. x runs from 0 to length().
struct TrackScene {
  Unknowns unknowns;
  int rails;          // 1 (on y = 0) or 2 (left on y = +rail_spacing / 2)
  std::int64_t bays;  // per rail; supports stand at the bays + 1 bay borders
  bool rigid;         // the rails do not give way
  bool endless;       // `bays` then counts the ring or window under the traffic
  double bay;         // m
  int elements_per_bay;
  double rail_spacing;  // between the rails' centres, m
  RailEnds ends;
  int end_zone_bays;  // damped bays before each non-reflecting end
  bool gravity;       // on the rails
  RailModel model;
  bool linearised_under_weight;  // linearised in equilibrium under weight and preload
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
  double axial_force;       // N, tension positive, without the force by temperature
  double temperature_rise;  // K, over the temperature without force
  double expansion;         // 1/K
  double cant;              // tangent of the angle by which both rails lean inwards
};

/// The pad at each bay border of each rail. Its height_z follows from `at` and the section.
struct SupportScene : Support {
  Height at;  // foot or axis
};

/// The part that a change takes away from a seat.
enum class Missing { nothing, pad, ballast, sleeper };

/// A number of a seat that becomes another one, or a multiple of itself.
struct SeatValue {
  double& (*of)(Seat& seat, std::size_t side);
  double first, last;  // at the first and the last of the seats, linear between
  bool scales;         // a factor on the present value; else it replaces the value
};

/// Random factors, uniform from 1 - width to 1 + width: one for each seat and side, on all of `of`.
struct SeatScatter {
  std::vector<double& (*)(Seat& seat, std::size_t side)> of;
  double width;
  std::uint64_t stream;  // makes draws of one seed independent
};

/// How some seats differ from [support], [sleeper] and [ballast]. First the values are applied,
/// then the scatter, then the missing part.
struct SeatChange {
  std::vector<int> seats;
  std::array<bool, 2> sides;  // left, right
  std::vector<SeatValue> values;
  std::optional<bool> pad_unilateral, ballast_unilateral;
  std::vector<SeatScatter> scatter;
  std::uint64_t seed = 0;
  Missing missing = Missing::nothing;
};

/// The gap between the rail ends at a joint.
struct JointGap {
  std::optional<double> cold;           // gap without heat, m; nullopt: the ends never meet
  std::optional<double> end_stiffness;  // N/m; nullopt: found from the section
  double end_damping = 0.0;             // N s/m
  std::array<double, 2> grown{};        // growth of left and right rail into it by heat, m
};

/// A spring that a point of a rail meets and that does not pull. Its z follows from `at` and the
/// section.
struct StopScene : Stop {
  std::string name;
  Height at;
};

/// A force on a rail. Its z follows from `at` and the section.
struct LoadScene : MovingLoad {
  std::string name;
  Height at;            // axis or head
  bool may_leave_rail;  // its force is 0 past the end
};

/// A force that is given from outside, frame by frame.
struct InputScene {
  std::string name;  // NAME.force_n or NAME.moment_n_m
  double limit;      // N or N m
};

/// A wheel of a vehicle outside the scene.
struct ExternalWheelScene : ExternalWheel {
  std::string name;
};

/// Two wheels on one axle; needs two rails. The signals of its treads follow from `treads`.
struct WheelsetScene : Wheelset {
  std::string name;
  std::array<std::string, 2> wheels;  // names: left, right
  double carried_mass;                // kg: weight without inertia
  bool may_leave_rail;
  std::vector<TreadScene> treads;
};

/// A vehicle over one rail. The signals of its treads follow from `treads`.
struct VehicleScene : RunningVehicle {
  std::string name, table;          // in the trace, and that of its [[vehicle]]
  std::vector<std::string> bodies;  // names
  bool may_leave_rail;
  std::vector<WheelTread> treads;
};

/// A vehicle in space on both rails, or a train of several that are coupled.
struct RailVehicleScene : RailVehicle {
  std::string name;  // of the first
  struct Part {
    std::string name;           // of its [[vehicle]]
    std::size_t first, bodies;  // among those of the runner
  };
  std::vector<Part> parts;
  std::vector<std::string> wheelsets;  // NAME.BODY; their wheels are NAME.BODY_left and _right
  std::vector<std::string> rods;       // of rigid rods, in the order of the runner's elements
  std::vector<std::string> force_elements;
  std::vector<std::string> traced;  // of displacements that are published, by their elements
};

/// The speed of largest magnitude of a load, a wheelset or a vehicle, m/s.
template <typename Runner>
double fastest(const Runner& runner) {
  return travel_table(runner.speed, runner.speeds).speed;
}

struct StepScene {
  double dt;  // s
  std::int64_t steps_per_frame;
  std::int64_t steps;  // of the whole run
  TimeScheme scheme;
  double rho_inf;                      // of generalised-alpha and of held contact forces
  double newmark_gamma, newmark_beta;  // of Newmark
  double hht_alpha;                    // of Hilber, Hughes and Taylor
  bool mean_contact;                   // of condensed tracks: contact by the discrete gradient
  Start start;
};

struct CondenseScene {
  std::optional<ReductionKind> kind = {};  // nullopt: full order
  std::optional<double> modes_per_bay = {}, highest_hz = {};
  int nodes_per_bay = 1;
  std::vector<double> expansion_hz = {};
  std::array<double, 2> band_hz = {20., 1500.};  // the model has to be right in it
  bool residual_flexibility = true;
};

struct RailSensor {
  int rail;
  double position;  // m
  Height at;
  std::optional<double> gauge_length = {};  // of a strain gauge along the rail, m; else no gauge
};
struct SleeperSensor {
  std::int64_t sleeper;     // from 0 along x
  std::optional<int> rail;  // the end under that rail; nullopt: the centre
};
struct WheelsetSensor {
  std::size_t wheelset;  // index into Scene::wheelsets; its centre
};
struct VehicleSensor {
  std::size_t vehicle, body;  // indices into Scene::vehicles and its bodies
  double ahead;               // of the body's middle, m
};
struct RailVehicleSensor {
  std::size_t vehicle, body;    // indices into Scene::rail_vehicles and its bodies
  std::array<double, 3> point;  // from the body's centre at rest, m
};
struct SensorScene {
  std::string name;
  std::variant<RailSensor, SleeperSensor, WheelsetSensor, VehicleSensor, RailVehicleSensor> on;
};

/// One scene of a track, every number checked and in SI. config/README.md, "Scenes", has it key by
/// key.
struct Scene {
  std::filesystem::path file;
  std::string sum;  // Table::sum() of it
  TrackScene track;
  RailScene rail;                       // of both rails
  std::optional<RailScene> right_rail;  // of the right rail, where it differs
  std::optional<SupportScene> support;  // nullopt: only the ends can hold the rails
  std::optional<Sleeper> sleeper;
  std::vector<SeatChange> seat_changes;  // applied one after the other
  std::vector<StopScene> stops;
  std::vector<RailJoint> joints;     // without their gaps
  std::vector<JointGap> joint_gaps;  // [joints]
  std::vector<LoadScene> loads;
  std::vector<WheelsetScene> wheelsets;
  std::vector<InputScene> inputs;
  std::vector<ExternalWheelScene> external_wheels;
  std::vector<VehicleScene> vehicles;
  std::vector<RailVehicleScene> rail_vehicles;
  LineShape design_line;  // [line]; straight and level without it
  std::optional<IrregularityScene> irregularity;
  std::vector<DefectScene> defects;
  std::optional<StepScene> step;  // nullopt: the scene is not run
  CondenseScene condense;
  NewtonOptions statics;
  std::vector<SensorScene> sensors;
  bool trace_supports;
  /// Duration of the run, s; 0 without [step].
  [[nodiscard]] double duration() const {
    return step ? static_cast<double>(step->steps) * step->dt : 0.0;
  }
};

/// Whether anything has wheels that the model moves.
bool has_wheels(const Scene& scene);
/// The largest size of the speed of all that has such wheels, m/s.
double fastest_wheel(const Scene& scene);

/// Whether a wheelset has flanges.
bool has_flanges(const Scene& scene);

/// Width of a railhead where the gauge is measured, m; nullopt where the section has no shape.
std::optional<double> head_width(const BarScene& rail);

/// Reads and checks a scene of a track. It allocates nothing of the track's size. Throws
/// InputError; also for a scene of bodies and beams, which scene_system.h reads.
Scene read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});

}  // namespace railstep
