#include <algorithm>
#include <cmath>
#include <complex>

#include "offline/math/larger.h"
#include "offline/pack/pack.h"
#include "offline/pack/step_compliance.h"

namespace railstep {

namespace {

constexpr int kPairPoints = 4;  // intervals per element of tables between ports

/// Places at the start of all ports of each kind, m along the model's elements.
std::vector<std::vector<double>> ports_of(const Model& model, std::size_t kinds) {
  std::vector<std::vector<double>> places(kinds);
  const auto add = [&](std::int32_t kind, double place) {
    places[static_cast<std::size_t>(kind)].push_back(place);
  };
  for (std::int32_t i = 0; i < model.loads; ++i) add(model.load[i].kind, model.load[i].start);
  for (std::int32_t i = 0; i < 2 * model.wheelsets; ++i)
    add(wheel_kind(model, i), model.wheelset[i / 2].start);
  for (std::int32_t i = 0; i < model.vehicle_wheels; ++i) {
    const VehicleWheel& wheel = model.vehicle_wheel[i];
    add(wheel.kind, model.vehicle[wheel.vehicle].start + wheel.place);
  }
  for (std::int32_t i = 0; i < model.external_wheels; ++i)
    add(model.external_wheel[i].kind, 0.);  // where these are is not known before they run
  return places;
}

/// How many elements two ports of these places are apart at most: on a track without end they stay
/// as they are, within the element that a contact's search may find beside the wheel.
int farthest(const Model& model, const std::vector<double>& a, const std::vector<double>& b) {
  if (model.endless.bays == 0 || model.external_wheels > 0) return model.elements;
  double distance = 0.;
  for (const double x : a)
    for (const double y : b) distance = std::max(distance, std::abs(x - y));
  return static_cast<int>(distance / model.element_length) + 2;
}

bool all_zero(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return v == 0.; });
}

void append(std::vector<double>& to, const std::vector<double>& values) {
  to.insert(to.end(), values.begin(), values.end());
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
      const Eigen::VectorXd modal = own.basis.shapes.project(Eigen::VectorXd(row));
      if (modal.isZero(0.)) continue;
      const Eigen::VectorXcd shape = own.modes.project(modal);
      for (Eigen::Index k = 0; k < shape.size(); ++k) {
        const std::complex<double> c =
            (probe.displacement + probe.velocity * own.modes.rate()[k]) * shape[k];
        entry(first + static_cast<int>(k), c.real());
        entry(velocity + static_cast<int>(k), -c.imag());
      }
    }
    if (probe.wheelset >= 0) {
      const std::int32_t at = model_.wheelset[probe.wheelset].first + probe.coordinate;
      entry(at, probe.displacement);
      entry(model_.unknowns + at, probe.velocity);
    }
    for (const Probe::Press& press : probe.ports)
      entry(2 * model_.unknowns + press.port, press.factor);
    if (probe.vehicle >= 0) {
      const std::int32_t at = model_.vehicle[probe.vehicle].first + probe.coordinate;
      const std::int32_t g = 2 * model_.unknowns + model_.fixed.count;
      for (const int next : {0, 1}) {
        const double part = next == 0 ? 1. : probe.lever;
        entry(at + next, part * probe.displacement);
        entry(model_.unknowns + at + next, part * probe.velocity);
        entry(g + at + next, part * probe.acceleration);
      }
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
  std::vector<std::int32_t> along;
  along.reserve(probes.size());
  for (const Probe& probe : probes) along.push_back(probe.along ? 1 : 0);
  model_.probe.along = keep(std::move(along));
}

/// A contact needs a rail that gives way under it: where wheels stand, G_res takes no more than
/// half of what the lines give way within a step.
void PackedModel::clip(int points, std::vector<double>& under) {
  if (wheel_count(model_) == 0) return;
  const StepCompliance compliance(model_, lines_);
  const std::size_t places = under.size() / kinds_.size();
  for (std::int32_t wheel = 0; wheel < wheel_count(model_); ++wheel) {
    const auto kind = static_cast<std::size_t>(wheel_kind(model_, wheel));
    const std::vector<double> lines = compliance.table(kinds_[kind], points);
    for (std::size_t i = 0; i < places; ++i) {
      double& value = under[kind * places + i];
      const double lowest = lines[i] > 0. ? -.5 * lines[i] : -1.5 * lines[i];
      clipped_ = larger(clipped_, lowest - value);
      value = std::max(value, lowest);
    }
  }
}

namespace {

/// What a probe has of unit forces of ports beside the model's unknowns.
ResidualFlexibility::Near seen_at_once(const ResidualFlexibility& residual,
                                       const std::vector<Port>& ports, const Probe& probe,
                                       Elements met) {
  ResidualFlexibility::Near seen = residual.near(ports, probe.track, met);
  for (double& value : seen.value) value *= probe.displacement;
  if (probe.velocity == 0.) return seen;
  auto value = seen.value.begin();
  for (const Port& port : ports)
    for (const double speed : residual.at_once(port, probe.track, seen.at))
      *value++ += probe.velocity * speed;
  return seen;
}

}  // namespace

void PackedModel::add_residual(const Track& track, const std::vector<Probe>& probes, int points) {
  if (kinds_.empty()) return;
  // What is one-sided without a gap mostly presses: tables are those of the track in which it is a
  // spring. About it the model misses what is near a port alone, whatever then presses; about a
  // track that is open there it would miss what the whole of its rail bends between other seats.
  const Track reference = linear_about_rest(track);
  const std::vector<Line> all = assemble(reference);
  std::vector<Line> lines;
  std::vector<Basis> bases;
  for (const PackedLine& own : lines_) {
    lines.push_back(all[own.index]);
    if (model_.condensed != 0)
      bases.push_back(with_springs(own.basis, lines.back().stiffness - own.line.stiffness));
  }
  const ResidualFlexibility residual(reference, lines, bases, points);
  model_.residual.elements = tabled_elements(reference);
  std::vector<double> under, axis;
  for (const Port& port : kinds_) {
    append(under, residual.under(port));
    append(axis, residual.under(port, {port.rail, 0.}));
  }
  clip(points, under);
  model_.residual.kinds = static_cast<std::int32_t>(kinds_.size());
  model_.residual.points = points;
  model_.residual.under = keep(std::move(under));
  model_.residual.axis = keep(std::move(axis));
  const std::vector<std::vector<double>> ports = ports_of(model_, kinds_.size());
  for (std::size_t a = 0; a < kinds_.size(); ++a)
    for (std::size_t b = 0; b < kinds_.size(); ++b) {
      if (a == b && ports[a].size() < 2) continue;
      PairTable pair =
          residual.between(kinds_[a], kinds_[b], kPairPoints, farthest(model_, ports[a], ports[b]));
      if (all_zero(pair.value)) continue;
      model_.residual.pair[a][b] = {pair.points, pair.reach, keep(std::move(pair.value))};
    }
  add_probe_tables(residual, probes);
}

void PackedModel::add_probe_tables(const ResidualFlexibility& residual,
                                   const std::vector<Probe>& probes) {
  std::vector<std::int32_t> table, first, ends = {0};
  std::vector<double> values;
  for (const Probe& probe : probes) {
    table.push_back(-1);
    const bool of_track = probe.wheelset < 0 && probe.vehicle < 0;
    if (!of_track || (probe.displacement == 0. && probe.velocity == 0.)) continue;
    const ResidualFlexibility::Near seen = seen_at_once(residual, kinds_, probe, met_);
    if (all_zero(seen.value)) continue;
    table.back() = static_cast<std::int32_t>(first.size());
    first.push_back(seen.at.first);
    ends.push_back(ends.back() + seen.at.count());
    append(values, seen.value);
  }
  if (first.empty()) return;
  model_.probe.table = keep(std::move(table));
  model_.probe.tables = static_cast<std::int32_t>(first.size());
  model_.probe.first = keep(std::move(first));
  model_.probe.elements = ends.back();
  model_.probe.ends = keep(std::move(ends));
  model_.probe.residual = keep(std::move(values));
}

}  // namespace railstep
