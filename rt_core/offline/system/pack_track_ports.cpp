#include "offline/system/pack_track_ports.h"

#include <Eigen/Dense>

#include "online/model/state.h"
#include "online/system/track_ports.h"
#include "online/track/line.h"

namespace railstep {

namespace {

/// B' of one of a port's nine unknowns: a unit force along it on the lines' unknowns.
void add_unit_force(const Model& model, const RailPortModel& port, int k, double* force) {
  RailRow row{port.rail, port.element, {}, 0, {}, {}};
  for (int i = 0; i < 3; ++i) row.coefficient[i][k] = port.value[i];
  for (std::int32_t l = 0; l < model.lines; ++l) spread(model.line[l], row, 1., force);
}

/// Adds the motion of the lines by the forces that move the ports: kg S^-1 B' f, where kg C f is
/// the difference of the ports' own values from those of the lines. @param g  rates of all unknowns
void add_port_motion(const Model& model, double* g) {
  const SystemModel& s = model.system;
  const Eigen::Index n = 9 * s.ports;
  using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::MatrixXd C = Eigen::Map<const Square>(s.port_compliance, n, n);
  Eigen::VectorXd moved(n);
  read_ports(model, g, moved.data());
  moved = Eigen::Map<const Eigen::VectorXd>(g + s.first + s.port[0].first, n) - moved;
  const Eigen::VectorXd f = C.completeOrthogonalDecomposition().solve(moved);
  for (Eigen::Index i = 0; i < n; ++i)
    for (std::int32_t k = 0; k < model.line_unknowns; ++k)
      g[k] += f[i] * s.port_shapes[Eigen::Index{model.line_unknowns} * i + k];
}

}  // namespace

TrackPorts track_ports(const Model& model) {
  const SystemModel& s = model.system;
  const auto rows = std::size_t{9} * static_cast<std::size_t>(s.ports);
  const auto n = static_cast<std::size_t>(model.line_unknowns);
  TrackPorts ports{std::vector<double>(rows * n, 0.), std::vector<double>(rows * rows, 0.)};
  std::vector<double> column(rows);
  for (std::size_t i = 0; i < rows; ++i) {
    double* const shape = ports.shapes.data() + n * i;
    add_unit_force(model, s.port[i / 9], static_cast<int>(i % 9), shape);
    for (std::int32_t l = 0; l < model.lines; ++l)
      solve_band(model.line[l].step, shape + model.line[l].first);
    read_ports(model, shape, column.data());
    for (std::size_t k = 0; k < rows; ++k) ports.compliance[rows * k + i] = column[k];
  }
  return ports;
}

void WidenedTrack::widen(std::int32_t own, Model& model) {
  const auto n = static_cast<std::size_t>(model.unknowns);
  if (model.constant_force != nullptr) {
    constant_force_.assign(model.constant_force, model.constant_force + n);
    constant_force_.resize(n + static_cast<std::size_t>(own), 0.);
    model.constant_force = constant_force_.data();
  }
  TrackSensorModel& track_sensor = model.track_sensor;
  track_sensor_index_.assign(track_sensor.index, track_sensor.index + track_sensor.entries);
  for (std::int32_t& index : track_sensor_index_)
    if (index >= model.unknowns) index += own;  // into v, which follows a longer u
  track_sensor.index = track_sensor_index_.data();
}

void WidenedTrack::put_start(const Model& track, const Model& both,
                             std::vector<double>& start) const {
  std::vector<double> from(track.start, track.start + state_doubles(track));
  const State own = state_on(track, from.data());
  State all = state_on(both, start.data());
  for (std::int32_t i = 0; i < track.unknowns; ++i) {
    all.u[i] = own.u[i];
    all.v[i] = own.v[i];
    all.a[i] = all.g[i] = own.g[i];
  }
  if (both.system.ports == 0) return;
  for (double* rates : {all.v, all.a, all.g}) add_port_motion(both, rates);
  const std::int32_t at = both.system.first + both.system.port[0].first;
  for (double* values : {all.u, all.v, all.a, all.g}) read_ports(both, values, values + at);
}

}  // namespace railstep
