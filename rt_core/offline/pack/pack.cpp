#include "offline/pack/pack.h"

#include <map>
#include <stdexcept>
#include <utility>

#include "offline/condense/flexibility.h"
#include "offline/contact/hertz.h"
#include "offline/pack/band_factor.h"

namespace railstep {

const double* PackedModel::keep(std::vector<double> values) {
  return reals_.emplace_back(std::make_unique<std::vector<double>>(std::move(values)))->data();
}

const std::int32_t* PackedModel::keep(std::vector<std::int32_t> values) {
  return integers_.emplace_back(std::make_unique<std::vector<std::int32_t>>(std::move(values)))
      ->data();
}

Diagonals PackedModel::keep_diagonals(const Eigen::SparseMatrix<double>& A, int padded) {
  std::map<std::int32_t, std::vector<double>> found;  // offset -> values by row
  for (int j = 0; j < A.outerSize(); ++j)
    for (Eigen::SparseMatrix<double>::InnerIterator entry(A, j); entry; ++entry) {
      auto& values = found[static_cast<std::int32_t>(j - entry.row())];
      values.resize(static_cast<std::size_t>(padded), 0.);
      values[static_cast<std::size_t>(entry.row())] = entry.value();
    }
  std::vector<std::int32_t> offsets;
  std::vector<double> values;
  for (const auto& [offset, diagonal] : found) {
    offsets.push_back(offset);
    values.insert(values.end(), diagonal.begin(), diagonal.end());
  }
  const int count = static_cast<int>(offsets.size());
  return {padded, count, keep(std::move(offsets)), keep(std::move(values))};
}

void PackedModel::add_line(const Track& track, const Line& line) {
  if (model_.lines == kMaxLines) throw std::invalid_argument("the track falls into too many lines");
  const Scheme& s = model_.scheme;
  BandFactor factor = factor_band(
      Eigen::SparseMatrix<double>(line.stiffness + s.kv * line.damping + s.kg * line.mass));
  const int padded = 8 * factor.panels;
  LineModel& packed = model_.line[model_.lines++];
  packed.first = model_.unknowns;
  packed.step = {factor.panels, factor.left, keep(std::move(factor.forward)),
                 keep(std::move(factor.inverse)), keep(std::move(factor.backward))};
  packed.mass = keep_diagonals(line.mass, padded);
  packed.damping = keep_diagonals(line.damping, padded);
  std::vector<std::int32_t> unknowns;
  for (const auto& node : line.unknown_of)
    unknowns.insert(unknowns.end(), node.begin(), node.end());
  packed.unknown_of = keep(std::move(unknowns));
  for (int rail = 0; rail < 2; ++rail)
    packed.rail_factor[rail] =
        rail < track.rails ? line.rail_factor[static_cast<std::size_t>(rail)] : 0.;
  packed.mirrored = line.mirrored ? 1 : 0;
  model_.unknowns += padded;
}

void PackedModel::add_load(const Track& track, const ResidualFlexibility* residual,
                           const MovingLoad& load) {
  if (model_.loads == kMaxLoads) throw std::invalid_argument("more than 32 loads");
  if (load.rail < 0 || load.rail >= track.rails)
    throw std::invalid_argument("a load stands on a rail that the track does not have");
  for (int i = 0; i < model_.loads; ++i)
    if (residual != nullptr && model_.load[i].rail == load.rail)
      throw std::invalid_argument(
          "residual flexibility acts under one load per rail; for several on one rail set "
          "residual_flexibility = false");
  LoadModel& packed = model_.load[model_.loads++];
  packed.row[2] = 1.;
  packed.row[8] = load.z;
  packed.rail = load.rail;
  packed.start = load.start;
  packed.speed = load.speed;
  packed.stop = load.stop;
  packed.force = load.force;
  packed.table_points = static_cast<std::int32_t>(load.table.size() / 2);
  packed.table = keep(load.table);
  if (residual != nullptr) packed.residual = keep(residual->under({load.rail, load.z}));
}

void PackedModel::add_wheelset(const Track& track, const ResidualFlexibility* residual,
                               const Wheelset& wheelset, const Railhead& head) {
  if (track.rails != 2) throw std::invalid_argument("a wheelset stands on two rails");
  if (model_.wheelsets == kMaxWheelsets) throw std::invalid_argument("more than 4 wheelsets");
  if (residual != nullptr && (model_.wheelsets > 0 || model_.loads > 0))
    throw std::invalid_argument(
        "residual flexibility acts under one load or wheelset per rail; for several set "
        "residual_flexibility = false");
  if (wheelset.forces.size() > static_cast<std::size_t>(kMaxBodyForces))
    throw std::invalid_argument("more than 4 forces on one wheelset");
  for (const double inertia : {wheelset.mass, wheelset.inertia_roll, wheelset.inertia_spin,
                               wheelset.inertia_yaw, wheelset.radius})
    if (!(inertia > 0.))
      throw std::invalid_argument("a wheelset's mass, inertias and radius are above zero");
  WheelsetModel& packed = model_.wheelset[model_.wheelsets++];
  packed.first = model_.unknowns;
  model_.unknowns += 8;
  const double m = wheelset.mass;
  const double masses[6] = {
      m, m, m, wheelset.inertia_roll, wheelset.inertia_spin, wheelset.inertia_yaw};
  for (int k = 0; k < 6; ++k) packed.mass[k] = masses[k];
  packed.weight = wheelset.weight;
  packed.radius = wheelset.radius;
  packed.tread_half_width = wheelset.tread_half_width;
  packed.start = wheelset.start;
  packed.speed = wheelset.speed;
  packed.rest_z = head.top_z + wheelset.radius;
  packed.hertz = hertz_contact(wheelset.radius, head.crown_radius, track.material.young,
                               track.material.poisson, 1e3)
                     .constant;
  packed.guide = wheelset.guide;
  packed.cap = wheelset.cap;
  packed.tolerance = wheelset.tolerance;
  packed.alpha = wheelset.alpha;
  packed.beta = wheelset.beta;
  for (const Wheelset::Force& force : wheelset.forces)
    packed.force[packed.forces++] = {
        force.direction, static_cast<std::int32_t>(force.table.size() / 2), keep(force.table)};
  if (residual == nullptr) return;
  for (int rail = 0; rail < 2; ++rail)
    packed.residual[rail] = keep(residual->under({rail, head.top_z}));
}

PackedModel::PackedModel(const Track& track, const std::vector<MovingLoad>& loads,
                         const PackOptions& options)
    : PackedModel(track, loads, {}, {}, options) {}

PackedModel::PackedModel(const Track& track, const std::vector<MovingLoad>& loads,
                         const std::vector<Wheelset>& wheelsets, const Railhead& head,
                         const PackOptions& options) {
  if (options.steps_per_frame < 1) throw std::invalid_argument("a frame has one step or more");
  model_.scheme = options.scheme;
  model_.steps_per_frame = options.steps_per_frame;
  model_.residual_points = options.residual_points;
  model_.elements = track.elements();
  model_.element_length = track.element_length();
  model_.rail_y[0] = track.rails == 2 ? track.rail_spacing / 2. : 0.;
  model_.rail_y[1] = -model_.rail_y[0];
  model_.head_z = head.top_z;
  model_.crown_radius = head.crown_radius;
  model_.head_half_width = head.half_width;
  const std::vector<Line> lines = assemble(track);
  for (const Line& line : lines) add_line(track, line);
  std::unique_ptr<ResidualFlexibility> residual;
  if (options.residual_flexibility && loads.size() + wheelsets.size() > 0)
    residual = std::make_unique<ResidualFlexibility>(track, lines, std::vector<Basis>{},
                                                     options.residual_points);
  for (const MovingLoad& load : loads) add_load(track, residual.get(), load);
  for (const Wheelset& wheelset : wheelsets) add_wheelset(track, residual.get(), wheelset, head);
  if (options.gravity == 0.) return;
  std::vector<double> force(static_cast<std::size_t>(model_.unknowns), 0.);
  for (std::size_t l = 0; l < lines.size(); ++l) {
    const Eigen::VectorXd own = weight(track, lines[l], options.gravity);
    for (Eigen::Index i = 0; i < own.size(); ++i)
      force[static_cast<std::size_t>(model_.line[l].first + i)] = own[i];
  }
  model_.constant_force = keep(std::move(force));
}

}  // namespace railstep
