#include <algorithm>
#include <cmath>

#include "offline/pack/pack.h"

namespace railstep {

namespace {

constexpr int kPairPoints = 4;  // intervals per element of tables between ports

/// Ports of each kind that a model has.
std::vector<int> ports_of(const Model& model, std::size_t kinds) {
  std::vector<int> count(kinds, 0);
  for (std::int32_t i = 0; i < model.loads; ++i)
    ++count[static_cast<std::size_t>(model.load[i].kind)];
  for (std::int32_t i = 0; i < 2 * model.wheelsets; ++i)
    ++count[static_cast<std::size_t>(model.wheelset[i / 2].kind[i % 2])];
  return count;
}

bool all_zero(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return v == 0.; });
}

void append(std::vector<double>& to, const std::vector<double>& values, double factor = 1.) {
  for (const double v : values) to.push_back(factor * v);
}

}  // namespace

void PackedModel::add_probes(const Track& track, const std::vector<Probe>& probes) {
  std::vector<std::int32_t> start = {0}, index;
  std::vector<double> value, rest;
  const auto entry = [&](std::int32_t at, double coefficient) {
    if (coefficient == 0.) return;
    index.push_back(at);
    value.push_back(coefficient);
  };
  for (const Probe& probe : probes) {
    for (std::size_t l = 0; l < lines_.size(); ++l) {
      const PackedLine& own = lines_[l];
      const std::int32_t first = model_.line[l].first, velocity = model_.unknowns + first;
      const Eigen::SparseVector<double> row = functional_row(track, own.line, probe.track);
      if (model_.condensed == 0) {
        for (Eigen::SparseVector<double>::InnerIterator it(row); it; ++it) {
          entry(first + static_cast<int>(it.index()), probe.displacement * it.value());
          entry(velocity + static_cast<int>(it.index()), probe.velocity * it.value());
        }
        continue;
      }
      // Re sum (displacement + velocity rate) shape z, z = u + i v
      const Eigen::VectorXd modal = own.basis.shapes.transpose() * Eigen::VectorXd(row);
      if (modal.isZero(0.)) continue;
      const Eigen::VectorXcd shape = own.modes.shape.transpose() * modal;
      for (Eigen::Index k = 0; k < shape.size(); ++k) {
        const std::complex<double> c =
            (probe.displacement + probe.velocity * own.modes.rate[k]) * shape[k];
        entry(first + static_cast<int>(k), c.real());
        entry(velocity + static_cast<int>(k), -c.imag());
      }
    }
    if (probe.wheelset >= 0) {
      const std::int32_t at = model_.wheelset[probe.wheelset].first + probe.coordinate;
      entry(at, probe.displacement);
      entry(model_.unknowns + at, probe.velocity);
    }
    start.push_back(static_cast<std::int32_t>(index.size()));
    rest.push_back(probe.rest);
  }
  model_.probe.count = static_cast<std::int32_t>(probes.size());
  model_.probe.table = keep(std::vector<std::int32_t>(probes.size(), -1));
  model_.probe.entries = start.back();
  model_.probe.start = keep(std::move(start));
  model_.probe.index = keep(std::move(index));
  model_.probe.value = keep(std::move(value));
  model_.probe.rest = keep(std::move(rest));
}

void PackedModel::add_residual(const Track& track, const std::vector<Probe>& probes, int points) {
  if (kinds_.empty()) return;
  std::vector<Line> lines;
  std::vector<Basis> bases;
  for (const PackedLine& own : lines_) {
    lines.push_back(own.line);
    if (model_.condensed != 0) bases.push_back(own.basis);
  }
  const ResidualFlexibility residual(track, lines, bases, points);
  std::vector<double> under, axis;
  for (const Port& port : kinds_) {
    append(under, residual.under(port));
    append(axis, residual.under(port, 0.));
  }
  // What a port cannot do is push the rail up under itself: W must stay positive.
  for (double& value : under) {
    clipped_ = std::max(clipped_, -value);
    value = std::max(value, 0.);
  }
  model_.residual.kinds = static_cast<std::int32_t>(kinds_.size());
  model_.residual.points = points;
  model_.residual.under = keep(std::move(under));
  model_.residual.axis = keep(std::move(axis));
  const std::vector<int> ports = ports_of(model_, kinds_.size());
  for (std::size_t a = 0; a < kinds_.size(); ++a)
    for (std::size_t b = 0; b < kinds_.size(); ++b) {
      if (a == b && ports[a] < 2) continue;
      PairTable pair = residual.between(kinds_[a], kinds_[b], kPairPoints);
      if (all_zero(pair.value)) continue;
      model_.residual.pair[a][b] = {pair.points, pair.reach, keep(std::move(pair.value))};
    }
  std::vector<std::int32_t> table;
  std::vector<double> values;
  std::int32_t tables = 0;
  for (const Probe& probe : probes) {
    std::vector<double> rows;
    if (probe.displacement != 0. && probe.wheelset < 0)
      for (const Port& port : kinds_)
        append(rows, residual.from(port, probe.track), probe.displacement);
    table.push_back(all_zero(rows) ? -1 : tables++);
    if (table.back() >= 0) append(values, rows);
  }
  if (tables == 0) return;
  model_.probe.tables = tables;
  model_.probe.table = keep(std::move(table));
  model_.probe.residual = keep(std::move(values));
}

}  // namespace railstep
