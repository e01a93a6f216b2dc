#include "offline/start/static_lines.h"

#include <utility>

#include "offline/pack/static_ports.h"

namespace railstep {

namespace {

/// Row of a point for ports: rows of condensed lines leave out the section's own strain.
Eigen::SparseVector<double> row_of(const Track& track, const PackedModel& packed, const Line& line,
                                   const RailPoint& at) {
  return point_row(track, line, at, packed.model().form == Form::banded);
}

}  // namespace

Eigen::VectorXd contact_row(const Line& line, const RailRow& row, bool strains) {
  const double factor = line.rail_factor[static_cast<std::size_t>(row.rail)];
  Eigen::VectorXd result = Eigen::VectorXd::Zero(line.unknowns());
  const auto add = [&](int unknown, int k, double value) {
    if (unknown >= 0) result[unknown] += factor * sign_of(line, row.rail, k) * value;
  };
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 9; ++k)
      if (strains || (k != 4 && k != 8))
        add(line.element_unknown(row.rail, row.element, i, k), k, row.coefficient[i][k]);
  for (int s = 0; s < row.seats; ++s)
    for (const int k : {5, 7})
      add(line.unknown(row.rail, row.seat[s], k), k, (k == 5 ? .5 : -.5) * row.lever[s]);
  return result;
}

namespace {

/// Row of a contact, as the step applies it.
Eigen::VectorXd row_of(const PackedModel& packed, const Line& line, const RailRow& row) {
  return contact_row(line, row, packed.model().form == Form::banded);
}

/// Adds the displacements of each line of a condensed model under the forces of its fixed ports.
void apply_port_forces(const PackedModel& packed, std::vector<Eigen::VectorXd>& lines) {
  const FixedPortModel& fixed = packed.model().fixed;
  const Eigen::Index n = fixed.count;
  // Rows over the lines' coordinates, and displacements under unit forces on them: K = omega^2.
  std::vector<Eigen::MatrixXd> rows, moved;
  Eigen::MatrixXd W = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd free = -Eigen::Map<const Eigen::VectorXd>(fixed.gap, n);
  for (std::size_t l = 0; l < lines.size(); ++l) {
    const PackedLine& own = packed.lines()[l];
    Eigen::MatrixXd& row = rows.emplace_back(own.basis.omega.size(), n);
    for (Eigen::Index j = 0; j < n; ++j)
      row.col(j) = own.basis.shapes.project(Eigen::VectorXd(own.closing.col(j)));
    moved.push_back(own.basis.omega.cwiseAbs2().cwiseInverse().asDiagonal() * rows.back());
    W += rows.back().transpose() * own.basis.static_response(rows.back());
    free += rows.back().transpose() * own.basis.modelled(lines[l]);
  }
  const Eigen::VectorXd force =
      static_port_forces(W, Eigen::Map<const Eigen::VectorXd>(fixed.stiffness, n), free);
  for (std::size_t l = 0; l < lines.size(); ++l) lines[l] -= moved[l] * force;
}

}  // namespace

std::vector<Eigen::VectorXd> line_forces(const PackedModel& packed, const Track& track,
                                         const Acting& acting) {
  std::vector<Eigen::VectorXd> forces;
  for (const PackedLine& own : packed.lines()) {
    Eigen::VectorXd& load = forces.emplace_back(Eigen::VectorXd::Zero(own.line.unknowns()));
    for (const PointForce& f : acting.forces)
      load += f.force * row_of(track, packed, own.line, f.at);
    for (const ContactForce& f : acting.contacts) load += f.force * row_of(packed, own.line, f.row);
  }
  return forces;
}

std::vector<Eigen::VectorXd> open_lines(const PackedModel& packed, const Track& track,
                                        const Acting& acting, double gravity) {
  std::vector<Eigen::VectorXd> lines = line_forces(packed, track, acting);
  for (std::size_t l = 0; l < lines.size(); ++l) {
    const PackedLine& own = packed.lines()[l];
    if (gravity != 0.) lines[l] += weight(track, own.line, gravity);
    if (packed.model().fixed.count > 0) lines[l] += preload(track, own.line);
    lines[l] = own.basis.shapes.project(lines[l]).cwiseQuotient(
        Eigen::VectorXd(own.basis.omega.cwiseAbs2()));
  }
  return lines;
}

std::vector<Eigen::VectorXd> static_lines(const PackedModel& packed, const Statics& statics,
                                          const Acting& acting, double gravity) {
  std::vector<Eigen::VectorXd> lines;
  if (packed.model().form == Form::banded) {
    std::vector<Eigen::VectorXd> load = statics.loads(acting.forces, gravity);
    for (const PackedLine& own : packed.lines())
      for (const ContactForce& f : acting.contacts)
        load[own.index] += f.force * row_of(packed, own.line, f.row);
    const std::vector<Eigen::VectorXd> all = statics.under(std::move(load));
    for (const PackedLine& own : packed.lines()) lines.push_back(all[own.index]);
    return lines;
  }
  lines = open_lines(packed, statics.track(), acting, gravity);
  if (packed.model().fixed.count > 0) apply_port_forces(packed, lines);
  return lines;
}

double height_of(const Track& track, const PackedModel& packed,
                 const std::vector<Eigen::VectorXd>& lines, const RailPoint& at) {
  double sum = 0.;
  for (std::size_t l = 0; l < lines.size(); ++l) {
    const PackedLine& own = packed.lines()[l];
    const Eigen::SparseVector<double> row = row_of(track, packed, own.line, at);
    sum += packed.model().form == Form::banded
               ? row.dot(lines[l])
               : own.basis.shapes.project(Eigen::VectorXd(row)).dot(own.basis.modelled(lines[l]));
  }
  return sum;
}

RailPoint point_of(const PackedModel& packed, std::int32_t load_point, double x) {
  const LoadPoint& port = packed.load_points()[static_cast<std::size_t>(load_point)];
  return {port.rail, x, port.y, port.z, 2};
}

}  // namespace railstep
