#pragma once
// The parts of read_scene, one table each. Only scene*.cpp include this.
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "scene/scene.h"
#include "text/read.h"

namespace railstep {

/// Parses a scene and checks its schema. Throws InputError.
Table open_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides);
/// All keys that a scene may have at its root, of either kind of scene.
inline const Table::Names kSceneKeys = {"schema",
                                        "track",
                                        "rail",
                                        "rail_joint",
                                        "support",
                                        "sleeper",
                                        "ballast",
                                        "stop",
                                        "load",
                                        "under_sleeper_pad",
                                        "support_change",
                                        "wheelset",
                                        "vehicle",
                                        "contact",
                                        "coupler",
                                        "external_wheel",
                                        "irregularity",
                                        "defect",
                                        "sensor",
                                        "output",
                                        "step",
                                        "static",
                                        "condense",
                                        "system",
                                        "body",
                                        "beam",
                                        "joint",
                                        "joints",
                                        "spring",
                                        "force",
                                        "line"};
Scene read_track_scene(const Table& root);
/// The parts of a track's scene that were read without a refusal. A check that builds on another
/// part is kept back.
struct Intact {
  bool sections = true, spacing = true;  // of the rails
  bool seats = true;                     // sleepers and what is under them
  bool condensed = true;                 // [condense]
  bool traffic = true;                   // wheelsets, vehicles and external wheels
};
/// [track], [rail], [support], [sleeper] and [ballast].
Intact read_rails(const Table& root, Scene& scene);
/// The first key of bodies, beams and joints in a scene; null in one without.
const char* key_of_system(const Table& root);

/// Section, material and rule of [rail] or of a beam.
BarScene read_bar(const Table& bar);
RailScene read_rail(const Table& rail);

/// Rails that do not give way: [track], without end or of a length; and heads and cant by [rail].
/// Without that table they are upright and have the sizes of a rail 60E1.
TrackScene read_rigid_track(const Table& track);
RailScene read_rigid_rail(const Table& root);
/// [rail.right]; keys that it does not have are as in [rail].
RailScene read_right_rail(const Table& right, const RailScene& left);
/// [[support_change]], in the file's order.
std::vector<SeatChange> read_seat_changes(const Table& root, const Scene& scene);
std::vector<StopScene> read_stops(const Table& root, const Scene& scene);
/// [[rail_joint]] of a scene whose rails are read. Refuses axial force that a gap cannot carry.
void read_joints(const Table& root, const Table& rail, Scene& scene);
/// Distance of the rails' centres whose heads' inner faces are `gauge` apart, 14 mm below the
/// running surface, m. Throws InputError where a rail's section has no head.
double spacing_of_gauge(const Table& track, const Scene& scene, double gauge);
/// [condense].
CondenseScene read_condense(const Table& root, const TrackScene& track);
/// Residual flexibility of a track in full order beside bodies and beams, for its wheels alone.
void read_residual_beside(const Table& root, Scene& scene);
/// dt, frame and duration of [step]. The callers read the scheme and the start.
StepScene read_times(const Table& step);
/// [step] of a scene with a track. check_moving() and check_contact() compare it with the rest.
StepScene read_track_step(const Table& step);
/// The scheme of [step] and its numbers.
/// @param rho_inf    its default
/// @param of_bodies  whether the schemes are those of bodies and beams
void read_scheme(const Table& step, double rho_inf, bool of_bodies, StepScene& read);
/// Refuses a moving start on a track with ends, for a scene with a step.
void check_moving(const Table& root, const Scene& scene);
/// Refuses contact forces that [condense] does not go with, for a scene with a step.
void check_contact(const Table& root, const Scene& scene);
/// Refuses a run that is not a whole number of frames.
void check_frames(const Table& step, const StepScene& read);
/// Where a track's nodes lie in its section: key reference_line, the centroid by default.
ReferenceLine read_reference_line(const Table& t);
/// `name`, if it can stand in the trace's header. Throws InputError where it cannot.
std::string checked_name(const Table& t, std::string_view key, const std::string& name);
std::vector<LoadScene> read_loads(const Table& root, const Scene& scene);
/// @param inputs  the inputs of their forces are added to it
std::vector<WheelsetScene> read_wheelsets(const Table& root, const Scene& scene,
                                          std::vector<InputScene>& inputs);
/// [line], which only vehicles in space follow. All that runs must be read.
LineShape read_design_line(const Table& root, const Scene& scene);
std::optional<IrregularityScene> read_irregularity(const Table& root, const Scene& scene);
std::vector<DefectScene> read_defects(const Table& root, const Scene& scene);
/// [[wheelset.tread]] of a wheelset whose radius and speed are read.
std::vector<TreadScene> read_treads(const Table& t, const Scene& scene, const WheelsetScene& own);
/// [wheelset.flange].
Flange read_flange(const Table& t, const Scene& scene);
/// @param inputs  the inputs of their forces are added to it
/// @param rail_vehicles  out: those in space
std::vector<VehicleScene> read_vehicles(const Table& root, const Scene& scene,
                                        std::vector<InputScene>& inputs,
                                        std::vector<RailVehicleScene>& rail_vehicles);
/// Whether a [[vehicle]] is a rail vehicle in space, by its own type or that of its file.
bool is_rail_vehicle(const Table& t);
/// A [[vehicle]] that is one, and [contact].
/// @param inputs  the inputs of its forces are added to it
RailVehicleScene read_rail_vehicle(const Table& root, const Table& t, const Scene& scene,
                                   std::vector<InputScene>& inputs);
/// Bodies, wheelsets and elements of a rail vehicle, from its file or from its own table.
Runner read_runner(const Table& t);
/// The name of kGround where two bodies are named.
inline constexpr const char* kGroundName = "ground";
/// [[vehicle.actuator]] between two bodies of a vehicle in space.
RunnerForceElement read_actuator(const Table& t, const Runner& runner,
                                 std::vector<InputScene>& inputs);
/// [[coupler]] between vehicles in space, which are one afterwards, or between one and the ground.
void read_couplers(const Table& root, std::vector<RailVehicleScene>& vehicles);
/// [[vehicle.tread]] of a vehicle whose kind and speed are read.
std::vector<WheelTread> read_wheel_treads(const Table& t, const Scene& scene,
                                          const VehicleScene& own);
/// @returns kLeftRail or kRightRail
int read_side(const Table& t, const Scene& scene);
/// [[t_s, value], ...] with rising times from 0 on: t (s), value, t, value, ...
std::vector<double> read_time_table(const Table& t, std::string_view key, const Range& accepted);
/// speed_m_per_s, or speed_table in its place: speeds that do not turn around.
struct SpeedScene {
  double speed;                // m/s; with a table its first
  std::vector<double> speeds;  // t (s), m/s, t, m/s, ...; empty without a table
};
SpeedScene read_speed(const Table& t, std::optional<double> otherwise);
/// Refuses a path that leaves the rail before the end of the run, or before `stop`.
void check_path(const Table& t, const Scene& scene, double start, const SpeedScene& speed,
                const std::optional<double>& stop = std::nullopt);
std::vector<ExternalWheelScene> read_external_wheels(const Table& root, const Scene& scene);
/// Reads `input` and its limit. @param quantity  "force_n", with `limit_n`; "moment_n_m", and so on
/// @returns the index of the input
int read_input(const Table& t, std::string_view quantity, std::vector<InputScene>& inputs);
/// A force by `table`, [[t_s, N or N m], ...], or by an input of each frame.
OuterForce read_body_force(const Table& t, int direction, bool moment,
                           std::vector<InputScene>& inputs);
std::vector<std::string> body_names(const Runner& runner);
/// The body of a [[vehicle.force]], by its name among the vehicle's bodies.
std::size_t read_forced_body(const Table& t, const std::vector<std::string>& bodies);
std::vector<SensorScene> read_sensors(const Table& root, const Scene& scene);
/// On a rail, a sleeper, a wheelset or a vehicle.
SensorScene read_sensor(const Table& t, const Scene& scene);
/// Names that are used once, with the tables that gave them.
class NameBook {
 public:
  /// The key `name` of a table. Throws InputError where it is not a valid name, or is taken.
  std::string claim(const Table& t);
  /// A name of a table's key. Throws InputError where it is taken.
  void claim(const Table& t, std::string_view key, const std::string& name);

 private:
  std::map<std::string, std::string> owner_;  // name -> the table that gave it first
};

/// Claims all names of a track's trace. Refuses names that stand twice.
void claim_names(const Table& root, const Scene& scene, NameBook& names);
/// Reads all that runs on a track, and its irregularities. Its rails and its step must be read.
void read_traffic(const Table& root, Scene& scene, Intact& intact);

}  // namespace railstep
