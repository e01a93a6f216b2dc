#include "offline/system/pack_track_ports.h"

#include <Eigen/Dense>

#include "online/model/state.h"
#include "online/system/track_ports.h"
#include "online/track/line.h"

namespace railstep {

namespace {

using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// The displacement along one of a port's nine unknowns, which are along the track's axes.
RailRow row_of(const Cant& cant, const RailPortModel& port, int k) {
  RailRow row{port.rail, port.element, {}, 0, {}, {}};
  double of_track[3] = {}, own[3];
  of_track[k % 3] = 1.;
  to_rail(cant, of_track, own);
  for (int i = 0; i < 3; ++i)
    for (int c = 0; c < 3; ++c) row.coefficient[i][k - k % 3 + c] = port.value[i] * own[c];
  return row;
}

RailRow row_of(const Model& model, Eigen::Index i) {
  const RailPortModel& port = model.system.port[i / 9];
  return row_of(model.cant[port.rail], port, static_cast<int>(i % 9));
}

/// Motion of a line by a unit force along a row, over a step. @param re, im  of all lines
void move_line(const Model& model, const LineModel& line, const RailRow& row, double* re,
               double* im) {
  if (model.form == Form::banded) {
    spread(line, row, 1., re);
    solve_band(line.step, re + line.first);
    return;
  }
  const auto n = static_cast<std::size_t>(model.line_unknowns);
  std::vector<double> shape_re(n, 0.), shape_im(n, 0.);
  shape_row(line, row, shape_re.data(), shape_im.data());
  modes_multiply(line.modal.held_force,
                 {shape_re.data() + line.first, shape_im.data() + line.first}, re + line.first,
                 im + line.first, line.size);
}

/// Static flexibility between all ports that the modes of a line leave out, with its one-sided
/// springs closed.
Eigen::MatrixXd left_out(const PackedLine& own, const Model& model) {
  const SystemModel& s = model.system;
  Eigen::MatrixXd rows(own.line.unknowns(), 9 * s.ports);
  for (Eigen::Index i = 0; i < rows.cols(); ++i)
    rows.col(i) = contact_row(own.line, row_of(model, i), false);
  Eigen::SparseMatrix<double> K = own.line.stiffness;
  Eigen::MatrixXd reduced = own.basis.omega.cwiseAbs2().asDiagonal();
  Eigen::MatrixXd part(own.basis.omega.size(), rows.cols());
  for (Eigen::Index i = 0; i < rows.cols(); ++i)
    part.col(i) = own.basis.shapes.project(Eigen::VectorXd(rows.col(i)));
  for (std::int32_t j = 0; j < model.fixed.count; ++j) {
    const Eigen::SparseVector<double> closing = own.closing.col(j);
    const Eigen::VectorXd in_modes = own.basis.shapes.project(Eigen::VectorXd(closing));
    K += model.fixed.stiffness[j] * (closing * closing.transpose());
    reduced += model.fixed.stiffness[j] * in_modes * in_modes.transpose();
  }
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> exact(K);
  const Eigen::MatrixXd moved = exact.solve(rows), by_modes = reduced.ldlt().solve(part);
  return rows.transpose() * moved - part.transpose() * by_modes;
}

/// Adds the motion of the lines by the forces that move the ports: kg S^-1 B' f, where kg C f is
/// the difference of the ports' own values from those of the lines. @param g  rates of all unknowns
void add_port_motion(const Model& model, double* g) {
  const SystemModel& s = model.system;
  const Eigen::Index n = 9 * s.ports;
  const Eigen::MatrixXd C = Eigen::Map<const Square>(s.port_compliance, n, n);
  Eigen::VectorXd moved(n);
  read_ports(model, {g, {}}, moved.data());
  moved = Eigen::Map<const Eigen::VectorXd>(g + s.first + s.port[0].first, n) - moved;
  const Eigen::VectorXd f = C.completeOrthogonalDecomposition().solve(moved);
  for (Eigen::Index i = 0; i < n; ++i)
    for (std::int32_t k = 0; k < model.line_unknowns; ++k)
      g[k] += f[i] * s.port_shapes[Eigen::Index{model.line_unknowns} * i + k];
}

}  // namespace

TrackPorts track_ports(const Model& model, const PackedModel* track) {
  const SystemModel& s = model.system;
  const auto rows = std::size_t{9} * static_cast<std::size_t>(s.ports);
  const auto n =
      static_cast<std::size_t>(parts(model.form)) * static_cast<std::size_t>(model.line_unknowns);
  TrackPorts ports{std::vector<double>(rows * n, 0.), std::vector<double>(rows * rows, 0.)};
  std::vector<double> column(rows);
  for (std::size_t i = 0; i < rows; ++i) {
    double *const re = ports.shapes.data() + n * i, *const im = re + (n - n / 2);
    const RailRow row = row_of(model, static_cast<Eigen::Index>(i));
    for (std::int32_t l = 0; l < model.lines; ++l) move_line(model, model.line[l], row, re, im);
    read_ports(model, {re, {re, im}}, column.data());
    for (std::size_t k = 0; k < rows; ++k) ports.compliance[rows * k + i] = column[k];
  }
  if (model.form == Form::banded || rows == 0) return ports;
  const auto size = static_cast<Eigen::Index>(rows);
  Eigen::Map<Square> all(ports.compliance.data(), size, size);
  for (const PackedLine& own : track->lines()) all += left_out(own, model);
  return ports;
}

std::vector<ContactForce> forces_of_ports(const Model& model,
                                          const std::vector<RailPortModel>& ports,
                                          const std::vector<double>& force) {
  std::vector<ContactForce> all;
  for (std::size_t i = 0; i < force.size(); ++i)
    all.push_back(
        {row_of(model.cant[ports[i / 9].rail], ports[i / 9], static_cast<int>(i % 9)), -force[i]});
  return all;
}

void WidenedTrack::widen(std::int32_t own, Model& model) {
  const auto n = static_cast<std::size_t>(model.unknowns);
  if (model.constant_force != nullptr) {
    for (int part = 0; part < parts(model.form); ++part) {
      const double* from = model.constant_force + n * static_cast<std::size_t>(part);
      constant_force_.insert(constant_force_.end(), from, from + n);
      constant_force_.resize(constant_force_.size() + static_cast<std::size_t>(own), 0.);
    }
    model.constant_force = constant_force_.data();
  }
  TrackSensorModel& track_sensor = model.track_sensor;
  track_sensor_index_.assign(track_sensor.index, track_sensor.index + track_sensor.entries);
  for (std::int32_t& index : track_sensor_index_)  // into longer u and v, and what follows them
    index += index < model.unknowns ? 0 : index < 2 * model.unknowns ? own : 2 * own;
  track_sensor.index = track_sensor_index_.data();
}

void WidenedTrack::put_start(const Model& track, const Model& both,
                             std::vector<double>& start) const {
  std::vector<double> from(track.start, track.start + state_doubles(track));
  const State own = state_on(track, from.data());
  State all = state_on(both, start.data());
  const bool banded = track.form == Form::banded;
  for (std::int32_t i = 0; i < track.unknowns; ++i) {
    all.u[i] = own.u[i];
    all.v[i] = own.v[i];
    all.a[i] = banded ? own.g[i] : own.a[i];
    all.g[i] = own.g[i];
  }
  // The numbers behind these, up to those of the system, belong to the track alone.
  std::copy(own.contact_force, own.quaternion, all.contact_force);
  if (both.system.ports == 0 || !banded) return;
  for (double* rates : {all.v, all.a, all.g}) add_port_motion(both, rates);
  const std::int32_t at = both.system.first + both.system.port[0].first;
  for (double* values : {all.u, all.v, all.a, all.g}) read_ports(both, {values, {}}, values + at);
}

}  // namespace railstep
