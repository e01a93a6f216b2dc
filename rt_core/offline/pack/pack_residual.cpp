#include <algorithm>
#include <cmath>
#include <complex>

#include "offline/math/larger.h"
#include "offline/pack/pack.h"
#include "offline/pack/seat_residual.h"
#include "offline/pack/step_compliance.h"

namespace railstep {

namespace {

constexpr int kPairPoints = 4;  // intervals per element of tables between load points

/// Places of all forces at the start, by load point, m along the model's elements.
std::vector<std::vector<double>> places_of(const Model& model, std::size_t load_points) {
  std::vector<std::vector<double>> places(load_points);
  const auto add = [&](std::int32_t load_point, double place) {
    places[static_cast<std::size_t>(load_point)].push_back(place);
  };
  for (std::int32_t i = 0; i < model.loads; ++i) add(model.load[i].load_point, model.load[i].start);
  for (const ContactId i : wheels(model)) add(model.contact[i].load_point, place_of(model, i));
  for (std::int32_t i = 0; i < model.external_wheels; ++i)
    add(model.external_wheel[i].load_point, 0.);  // their places are not known in advance
  return places;
}

/// Largest distance of two forces at these places, in elements. On a track without end distances
/// stay as they are, but for the element beside the wheel that a contact's search may find.
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

std::int32_t PackedModel::first_unknown(const RunnerSum& runner) const {
  switch (runner.of) {
    case RunnerSum::Of::wheelset:
      return model_.wheelset[runner.index].first;
    case RunnerSum::Of::vehicle:
      return model_.vehicle[runner.index].first;
    default:
      return model_.runner[runner.index].first;
  }
}

void PackedModel::add_track_sensors(const Track& track,
                                    const std::vector<TrackSensor>& track_sensors) {
  std::vector<std::int32_t> start = {0}, index;
  std::vector<double> value, rest;
  const auto entry = [&](std::int32_t at, double coefficient) {
    if (coefficient == 0.) return;
    index.push_back(at);
    value.push_back(coefficient);
  };
  for (const TrackSensor& track_sensor : track_sensors) {
    for (std::size_t l = 0; l < lines_.size(); ++l) {
      const PackedLine& own = lines_[l];
      const std::int32_t first = model_.line[l].first, velocity = model_.unknowns + first;
      const Eigen::SparseVector<double> row = functional_row(track, own.line, track_sensor.track);
      if (model_.form == Form::banded) {
        for (Eigen::SparseVector<double>::InnerIterator it(row); it; ++it) {
          entry(first + static_cast<int>(it.index()), track_sensor.displacement * it.value());
          entry(velocity + static_cast<int>(it.index()), track_sensor.velocity * it.value());
        }
        continue;
      }
      // Re sum (displacement + velocity rate) shape z, z = u + i v
      const Eigen::VectorXd modal = own.basis.shapes.project(Eigen::VectorXd(row));
      if (modal.isZero(0.)) continue;
      const Eigen::VectorXcd shape = own.modes.project(modal);
      for (Eigen::Index k = 0; k < shape.size(); ++k) {
        const std::complex<double> c =
            (track_sensor.displacement + track_sensor.velocity * own.modes.rate()[k]) * shape[k];
        entry(first + static_cast<int>(k), c.real());
        entry(velocity + static_cast<int>(k), -c.imag());
      }
    }
    for (const TrackSensor::PortForce& force : track_sensor.ports)
      entry(2 * model_.unknowns + force.port, force.factor);
    if (track_sensor.runner)
      for (const RunnerSum::Part& part : track_sensor.runner->parts) {
        const std::int32_t at = first_unknown(*track_sensor.runner) + part.coordinate;
        entry(at, part.factor * track_sensor.displacement);
        entry(model_.unknowns + at, part.factor * track_sensor.velocity);
        entry(2 * model_.unknowns + model_.fixed.count + at,
              part.factor * track_sensor.acceleration);
      }
    start.push_back(static_cast<std::int32_t>(index.size()));
    rest.push_back(track_sensor.rest);
  }
  model_.track_sensor.count = static_cast<std::int32_t>(track_sensors.size());
  model_.track_sensor.table = keep(std::vector<std::int32_t>(track_sensors.size(), -1));
  model_.track_sensor.entries = start.back();
  model_.track_sensor.start = keep(std::move(start));
  model_.track_sensor.index = keep(std::move(index));
  model_.track_sensor.value = keep(std::move(value));
  model_.track_sensor.rest = keep(std::move(rest));
  std::vector<std::int32_t> along;
  along.reserve(track_sensors.size());
  for (const TrackSensor& track_sensor : track_sensors) along.push_back(track_sensor.along ? 1 : 0);
  model_.track_sensor.along = keep(std::move(along));
}

/// A contact needs a rail that yields under it: at wheels, a negative G_res takes away at most half
/// of the compliance of the lines within a step.
void PackedModel::clip(int points, std::vector<double>& under) {
  if (wheel_count(model_) == 0) return;
  const StepCompliance compliance(model_, lines_);
  const std::size_t places = under.size() / load_points_.size();
  for (const ContactId wheel : wheels(model_)) {
    const auto point = static_cast<std::size_t>(model_.contact[wheel].load_point);
    const std::vector<double> lines =
        compliance.table(load_points_[point], points, model_.residual.elements);
    for (std::size_t i = 0; i < places; ++i) {
      double& value = under[point * places + i];
      const double lowest = lines[i] > 0. ? -.5 * lines[i] : -1.5 * lines[i];
      clipped_ = larger(clipped_, lowest - value);
      value = std::max(value, lowest);
    }
  }
}

namespace {

/// The part of a track sensor's response to unit forces at load points that the model's unknowns
/// leave out.
ResidualFlexibility::Near near_at_once(const ResidualFlexibility& residual,
                                       const std::vector<LoadPoint>& load_points,
                                       const TrackSensor& track_sensor, Elements met) {
  ResidualFlexibility::Near near = residual.near(load_points, track_sensor.track, met);
  for (double& value : near.value) value *= track_sensor.displacement;
  if (track_sensor.velocity == 0.) return near;
  auto value = near.value.begin();
  for (const LoadPoint& point : load_points)
    for (const double speed : residual.at_once(point, track_sensor.track, near.at))
      *value++ += track_sensor.velocity * speed;
  return near;
}

}  // namespace

void PackedModel::add_residual(const Track& track, const std::vector<TrackSensor>& track_sensors,
                               int points) {
  if (load_points_.empty()) return;
  // A one-sided support without a gap is mostly closed: tables belong to the track in which it is a
  // spring. About this track the model misses only what is near a force, whatever closes later.
  // About a track that is open there it would miss how the whole rail bends between other seats.
  const Track reference = linear_about_rest(track);
  const std::vector<Line> all = assemble(reference);
  std::vector<Line> lines;
  std::vector<Basis> bases;
  for (const PackedLine& own : lines_) {
    lines.push_back(all[own.index]);
    if (model_.form == Form::condensed)
      bases.push_back(with_springs(own.basis, lines.back().stiffness - own.line.stiffness));
  }
  const ResidualFlexibility residual(reference, lines, bases, points, model_.runners > 0);
  model_.residual.elements = tabled_elements(reference);
  std::vector<double> under, axis;
  for (const LoadPoint& point : load_points_) {
    append(under, residual.under(point));
    append(axis, residual.under(point, {point.rail, 0.}));
  }
  clip(points, under);
  model_.residual.load_points = static_cast<std::int32_t>(load_points_.size());
  model_.residual.points = points;
  model_.residual.under = keep(std::move(under));
  model_.residual.axis = keep(std::move(axis));
  const std::vector<std::vector<double>> places = places_of(model_, load_points_.size());
  for (std::size_t a = 0; a < load_points_.size(); ++a)
    for (std::size_t b = 0; b < load_points_.size(); ++b) {
      if (a == b && places[a].size() < 2) continue;
      PairTable pair = residual.between(load_points_[a], load_points_[b], kPairPoints,
                                        farthest(model_, places[a], places[b]));
      if (all_zero(pair.value)) continue;
      model_.residual.pair_points = pair.points;
      model_.residual.pair[a][b] = {pair.range, keep(std::move(pair.value))};
    }
  if (model_.runners > 0)
    model_.residual.seat = keep(seat_residual(residual, model_, load_points_));
  add_track_sensor_tables(residual, track_sensors);
}

void PackedModel::add_track_sensor_tables(const ResidualFlexibility& residual,
                                          const std::vector<TrackSensor>& track_sensors) {
  std::vector<std::int32_t> table, first, ends = {0};
  std::vector<double> values;
  for (const TrackSensor& track_sensor : track_sensors) {
    table.push_back(-1);
    if (track_sensor.runner || (track_sensor.displacement == 0. && track_sensor.velocity == 0.))
      continue;
    const ResidualFlexibility::Near near = near_at_once(residual, load_points_, track_sensor, met_);
    if (all_zero(near.value)) continue;
    table.back() = static_cast<std::int32_t>(first.size());
    first.push_back(near.at.first);
    ends.push_back(ends.back() + near.at.count());
    append(values, near.value);
  }
  if (first.empty()) return;
  model_.track_sensor.table = keep(std::move(table));
  model_.track_sensor.tables = static_cast<std::int32_t>(first.size());
  model_.track_sensor.first = keep(std::move(first));
  model_.track_sensor.elements = ends.back();
  model_.track_sensor.ends = keep(std::move(ends));
  model_.track_sensor.residual = keep(std::move(values));
}

}  // namespace railstep
