#pragma once
#include <cstddef>

#include "online/model/state.h"
#include "online/system/sensor.h"

namespace railstep {

// The columns of a trace after time_s. Only these tables and for_each_column() know their order:
// names, count and values follow from them.

/// A column of a load, a wheel or a flange: the end of its name, and its place in the outputs.
template <int most>
struct OutputColumn {
  const char* name;
  double (Outputs::*value)[most];
};
inline constexpr OutputColumn<kMaxLoads> kLoadColumns[] = {
    {"x_m", &Outputs::load_x}, {"deflection_z_m", &Outputs::load_deflection}};
inline constexpr OutputColumn<kMaxWheels> kWheelColumns[] = {
    {"force_z_n", &Outputs::contact_force},
    {"force_z_mean_n", &Outputs::contact_force_mean},
    {"force_z_peak_n", &Outputs::contact_force_peak},
    {"impulse_z_n_s", &Outputs::contact_impulse},
    {"gap_m", &Outputs::contact_gap},
    {"rail_z_m", &Outputs::contact_rail_z}};
inline constexpr OutputColumn<kMaxWheels> kFlangeColumns[] = {
    {"flange_force_n", &Outputs::contact_force},
    {"flange_force_peak_n", &Outputs::contact_force_peak},
    {"flange_impulse_n_s", &Outputs::contact_impulse},
    {"flange_gap_m", &Outputs::contact_gap}};

inline constexpr OutputColumn<2 * kMaxRunnerWheelsets> kRunnerWheelColumns[] = {
    {"q_n", &Outputs::wheel_q},
    {"y_n", &Outputs::wheel_y},
    {"y_over_q", &Outputs::wheel_y_over_q},
    {"t_gamma_n", &Outputs::wheel_t_gamma},
    {"contact_y_m", &Outputs::wheel_contact_y}};
inline constexpr OutputColumn<kMaxRunnerWheelsets> kRunnerWheelsetColumns[] = {
    {"sum_y_n", &Outputs::wheelset_sum_y},
    {"y_m", &Outputs::wheelset_y},
    {"yaw_rad", &Outputs::wheelset_yaw}};
inline constexpr OutputColumn<kMaxRunners> kRunnerColumns[] = {{"drive_n", &Outputs::drive_force}};
inline constexpr OutputColumn<kMaxRunners> kFreeRunnerColumns[] = {
    {"x_m", &Outputs::runner_way}, {"speed_m_per_s", &Outputs::runner_speed}};
inline constexpr OutputColumn<kMaxRunnerRods> kRodColumns[] = {{"force_n", &Outputs::rod_tension}};
inline constexpr OutputColumn<kMaxRunnerForceElements> kElementColumns[] = {
    {"force_n", &Outputs::element_force}, {"travel_m", &Outputs::element_travel}};
inline constexpr OutputColumn<kMaxRunnerForceElements> kBrakeColumns[] = {
    {"moment_n_m", &Outputs::element_force}};

/// By TracedElement::axis.
inline constexpr OutputColumn<kMaxRunnerTraced> kTracedColumns[kTracedLine + 1][2] = {
    {{"force_x_n", &Outputs::traced_force}, {"travel_x_m", &Outputs::traced_travel}},
    {{"force_y_n", &Outputs::traced_force}, {"travel_y_m", &Outputs::traced_travel}},
    {{"force_z_n", &Outputs::traced_force}, {"travel_z_m", &Outputs::traced_travel}},
    {{"moment_x_n_m", &Outputs::traced_force}, {"roll_rad", &Outputs::traced_travel}},
    {{"moment_y_n_m", &Outputs::traced_force}, {"pitch_rad", &Outputs::traced_travel}},
    {{"moment_z_n_m", &Outputs::traced_force}, {"yaw_rad", &Outputs::traced_travel}},
    {{"force_n", &Outputs::traced_force}, {"travel_m", &Outputs::traced_travel}}};

/// A column of the rail under an external wheel.
struct ExternalColumn {
  const char* name;
  double (Outputs::*value)[kMaxExternalWheels][3];
  int direction;
};
inline constexpr ExternalColumn kExternalColumns[] = {
    {"dx_m", &Outputs::external_displacement, 0},   {"dy_m", &Outputs::external_displacement, 1},
    {"dz_m", &Outputs::external_displacement, 2},   {"vx_m_per_s", &Outputs::external_velocity, 0},
    {"vy_m_per_s", &Outputs::external_velocity, 1}, {"vz_m_per_s", &Outputs::external_velocity, 2}};

/// A column of a sensor. Sensors on rails, sleepers and wheelsets are seven track sensors, one for
/// each of these columns.
enum class SensorQuantity { position, displacement, velocity };
struct SensorColumn {
  const char* name;
  SensorQuantity quantity;
  int direction;
};
inline constexpr SensorColumn kSensorColumns[] = {
    {"x_m", SensorQuantity::position, 0},       {"y_m", SensorQuantity::position, 1},
    {"z_m", SensorQuantity::position, 2},       {"dx_m", SensorQuantity::displacement, 0},
    {"dy_m", SensorQuantity::displacement, 1},  {"dz_m", SensorQuantity::displacement, 2},
    {"vz_m_per_s", SensorQuantity::velocity, 2}};

/// A column of a traced joint: its force or moment on part B at its point, ground axes.
struct JointColumn {
  const char* name;
  double (JointForce::*value)[3];
  int direction;
};
inline constexpr JointColumn kJointColumns[] = {
    {"force_x_n", &JointForce::force, 0},     {"force_y_n", &JointForce::force, 1},
    {"force_z_n", &JointForce::force, 2},     {"moment_x_n_m", &JointForce::moment, 0},
    {"moment_y_n_m", &JointForce::moment, 1}, {"moment_z_n_m", &JointForce::moment, 2}};

/// The column of a traced spring: its force, positive in tension.
struct SpringColumn {
  const char* name;
};
inline constexpr SpringColumn kSpringColumns[] = {{"force_n"}};

/// Owner of a column, other than track sensors, whose names are complete.
enum class ColumnOf {
  load,
  wheel,
  flange,
  runner_wheel,
  runner_wheelset,
  runner,
  rod,
  force_element,
  traced_element,
  external_wheel,
  sensor,
  joint,
  spring
};

/// Visits the columns in their order: visit(of, i, columns) for load, wheel, ... number i, with
/// the table of its columns, and visit(track sensors) once for the columns of all of them.
template <typename Visit>
void for_each_column(const Model& model, Visit& visit) {
  for (std::int32_t i = 0; i < model.loads; ++i) visit(ColumnOf::load, i, kLoadColumns);
  for (std::int32_t i = 0; i < wheel_count(model); ++i) visit(ColumnOf::wheel, i, kWheelColumns);
  for (std::int32_t i = 0; i < flange_count(model); ++i) visit(ColumnOf::flange, i, kFlangeColumns);
  for (std::int32_t i = 0; i < 2 * model.runner_wheelsets; ++i)
    visit(ColumnOf::runner_wheel, i, kRunnerWheelColumns);
  for (std::int32_t i = 0; i < model.runner_wheelsets; ++i)
    visit(ColumnOf::runner_wheelset, i, kRunnerWheelsetColumns);
  for (std::int32_t i = 0; i < model.runners; ++i)
    if (model.runner[i].rolls_freely != 0)
      visit(ColumnOf::runner, i, kFreeRunnerColumns);
    else
      visit(ColumnOf::runner, i, kRunnerColumns);
  for (std::int32_t i = 0; i < model.runner_rods; ++i) visit(ColumnOf::rod, i, kRodColumns);
  for (std::int32_t r = 0; r < model.runners; ++r)
    for (std::int32_t j = 0; j < model.runner[r].force_elements; ++j) {
      const std::int32_t i = model.runner[r].first_force_element + j;
      if (is_brake(model.runner[r].force_element[j]))
        visit(ColumnOf::force_element, i, kBrakeColumns);
      else
        visit(ColumnOf::force_element, i, kElementColumns);
    }
  for (std::int32_t r = 0; r < model.runners; ++r)
    for (std::int32_t j = 0; j < model.runner[r].traced_elements; ++j)
      visit(ColumnOf::traced_element, model.runner[r].first_traced + j,
            kTracedColumns[model.runner[r].traced[j].axis]);
  for (std::int32_t i = 0; i < model.external_wheels; ++i)
    visit(ColumnOf::external_wheel, i, kExternalColumns);
  visit(model.track_sensor);
  const SystemModel& s = model.system;
  for (std::int32_t i = 0; i < s.sensors; ++i) visit(ColumnOf::sensor, i, kSensorColumns);
  for (std::int32_t i = 0; i < s.traced_joints; ++i) visit(ColumnOf::joint, i, kJointColumns);
  for (std::int32_t i = 0; i < s.traced_springs; ++i) visit(ColumnOf::spring, i, kSpringColumns);
}

}  // namespace railstep
