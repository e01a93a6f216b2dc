#include "answer/assessment.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "answer/assessed_signals.h"
#include "answer/track_sections.h"
#include "offline/pack/pack.h"
#include "offline/signal/filter.h"
#include "offline/signal/statistics.h"

namespace railstep {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr double kWindow = 2., kWindowStep = .5;             // m, of sliding means
constexpr double kHuntingWindow = 100., kHuntingStep = 10.;  // m
constexpr double kLeastHunting = 1., kMostHunting = 10.;     // Hz
constexpr double kHuntingBand = 2.;                          // Hz
constexpr double kLow = .0015, kHigh = .9985;                // percentiles
constexpr double kBlock = 5.;                                // s, of ride comfort

/// A number of the values within a section.
using Statistic = double (*)(const std::vector<double>& values);
double largest_size(const std::vector<double>& values) {
  return std::max(std::fabs(percentile(values, kLow)), std::fabs(percentile(values, kHigh)));
}
double high(const std::vector<double>& values) { return percentile(values, kHigh); }
double median_size(const std::vector<double>& values) { return std::fabs(percentile(values, .5)); }
double largest(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}

/// A signal of one wheel, wheelset or sensor that is assessed.
struct AssessedSignal {
  Assessed quantity;
  std::string where;
  Statistic statistic;
  OverWay over;
  double wheel_load = 0.;  // static, N, of wheels
};

/// The middles of windows and the means or roots in them.
OverWay windows(const OverWay& of, double length, double step,
                std::vector<double> (*each)(const std::vector<double>&, const std::vector<double>&,
                                            double, double)) {
  OverWay made{{}, each(of.distance, of.value, length, step)};
  for (std::size_t k = 0; k < made.value.size(); ++k)
    made.distance.push_back(of.distance.front() + .5 * length + step * static_cast<double>(k));
  return made;
}
OverWay mean_2m(const Way& way, const std::vector<double>& values) {
  return windows(over_way(way, values), kWindow, kWindowStep, sliding_mean);
}

void add_hunting(const std::string& wheelset, const std::vector<double>& sum_y, double dt,
                 const Way& way, std::vector<AssessedSignal>& signals) {
  const double hz = dominant_frequency(sum_y, dt, kLeastHunting, kMostHunting);
  if (!(hz > 0.)) return;
  const std::vector<double> band =
      filtered(band_pass(std::max(.5 * hz, hz - kHuntingBand), hz + kHuntingBand), sum_y, dt);
  signals.push_back({Assessed::unstable_sum_y, wheelset, largest,
                     windows(over_way(way, band), kHuntingWindow, kHuntingStep, sliding_rms)});
}

void add_wheel(const std::string& wheel, double static_load, const TraceRows& rows, const Way& way,
               std::vector<AssessedSignal>& signals) {
  const AnalogueFilter filter = low_pass(20.);
  const auto low = [&](const char* column) {
    return filtered(filter, rows.column(wheel + column), rows.interval());
  };
  const std::vector<double> q = low(".q_n"), y = low(".y_n");
  signals.push_back({Assessed::y_over_q, wheel, largest_size, mean_2m(way, low(".y_over_q"))});
  OverWay unloaded = mean_2m(way, q);
  for (double& value : unloaded.value) value = 1. - value / static_load;
  signals.push_back({Assessed::unloading, wheel, high, std::move(unloaded)});
  signals.push_back({Assessed::q, wheel, high, over_way(way, q)});
  signals.push_back({Assessed::y_quasistatic, wheel, median_size, over_way(way, y)});
  signals.push_back({Assessed::q_quasistatic, wheel, median_size, over_way(way, q)});
  signals.push_back(
      {Assessed::t_gamma, wheel, mean_of, over_way(way, rows.column(wheel + ".t_gamma_n"))});
}

void add_body(const std::string& sensor, const FeltAccelerations& felt, double dt, const Way& way,
              std::vector<AssessedSignal>& signals) {
  const AnalogueFilter band = band_pass(.4, 10.);
  const OverWay y = over_way(way, filtered(band, felt.y, dt)),
                z = over_way(way, filtered(band, felt.z, dt));
  signals.push_back({Assessed::body_y, sensor, largest_size, y});
  signals.push_back({Assessed::body_z, sensor, largest_size, z});
  signals.push_back({Assessed::body_y_rms, sensor, rms_of, y});
  signals.push_back({Assessed::body_z_rms, sensor, rms_of, z});
  signals.push_back({Assessed::body_y_quasistatic, sensor, median_size,
                     over_way(way, filtered(low_pass(20.), felt.y, dt))});
}

/// Sperling's index of comfort by the rms of a weighted acceleration: W_z of a harmonic is the
/// 0.3rd power of its weighted amplitude in cm/s2.
double ride_index(const AnalogueFilter& weighting, const std::vector<double>& felt, double dt) {
  return std::pow(100. * std::sqrt(2.) * rms_of(filtered(weighting, felt, dt)), .3);
}

RideComfort ride_at(const std::string& sensor, const FeltAccelerations& felt, double dt) {
  const std::vector<double> y = block_rms(filtered(comfort_lateral(), felt.y, dt), dt, kBlock),
                            z = block_rms(filtered(comfort_vertical(), felt.z, dt), dt, kBlock);
  RideComfort ride{sensor,
                   static_cast<int>(y.size()),
                   kUnknown,
                   percentile(y, .95),
                   percentile(z, .95),
                   ride_index(ride_index_lateral(), felt.y, dt),
                   ride_index(ride_index_vertical(), felt.z, dt)};
  ride.comfort = 6. * std::hypot(ride.weighted_y, ride.weighted_z);
  return ride;
}

/// Static loads of each wheelset's wheels on straight, level track, N.
std::vector<double> static_loads(const RailVehicleScene& vehicle, double speed) {
  const SteadyRunning steady =
      steady_running(vehicle.runner, loaded_matrices(vehicle), vehicle.contact, speed);
  std::vector<double> loads;
  for (const auto& [left, right] : wheel_forces(vehicle.runner, vehicle.contact, speed, steady))
    loads.push_back(.5 * (left.generalised[2] + right.generalised[2]));
  return loads;
}

/// Nadal's limit by the steepest flank of the wheel, on which its radius grows inwards, and the
/// larger friction of both rails.
double nadal_limit(const RollingContact& contact) {
  if (!has_profiles(contact) || contact.creep.law == CreepLaw::linear) return kUnknown;
  double steepest = 0.;
  for (int i = 0; i < kSearchStrips; ++i)
    steepest = std::max(steepest, -contact.profiles.pair.search_slope[i]);
  const double friction = std::max(contact.creep.friction.rail[0], contact.creep.friction.rail[1]);
  return (steepest - friction) / (1. + friction * steepest);
}

std::vector<double> within(const OverWay& over, double from, double to) {
  const auto begin = std::lower_bound(over.distance.begin(), over.distance.end(), from),
             end = std::upper_bound(begin, over.distance.end(), to);
  return {over.value.begin() + (begin - over.distance.begin()),
          over.value.begin() + (end - over.distance.begin())};
}

bool is_of_curves(Assessed quantity) {
  return quantity == Assessed::y_quasistatic || quantity == Assessed::q_quasistatic ||
         quantity == Assessed::body_y_quasistatic;
}

/// The largest of each quantity over its limit, of all that have it.
std::vector<AssessedValue> values_in(const std::vector<AssessedSignal>& signals, double from,
                                     double to, SectionKind kind, double speed) {
  std::map<Assessed, AssessedValue> found;
  for (const AssessedSignal& signal : signals) {
    if (is_of_curves(signal.quantity) && kind != SectionKind::curve) continue;
    const std::vector<double> values = within(signal.over, from, to);
    if (values.empty()) continue;
    const AssessedValue own{signal.quantity, signal.where, signal.statistic(values),
                            limit_of(signal.quantity, {speed, signal.wheel_load})};
    const auto [at, made] = found.try_emplace(signal.quantity, own);
    if (!made && against_limit(own) > against_limit(at->second)) at->second = own;
  }
  std::vector<AssessedValue> values;
  values.reserve(found.size());
  for (auto& [quantity, value] : found) values.push_back(std::move(value));
  return values;
}

/// Sections whose values belong together; null of transitions and of short sections.
const char* track_of(const TrackSection& section) {
  if (section.to - section.from < .8 * nominal_length(section)) return nullptr;
  const double radius = std::fabs(section.radius);
  switch (section.kind) {
    case SectionKind::straight:
      return "straight";
    case SectionKind::transition:
      return nullptr;
    case SectionKind::curve:
      break;
  }
  return radius >= 600.   ? "curves from 600 m on"
         : radius >= 400. ? "curves from 400 to 600 m"
                          : "curves below 400 m";
}

struct ExpectedGroup {
  const char* track;
  std::vector<double> values;
  double limit;
};

/// The largest values to expect of like sections.
std::vector<EstimatedValue> estimates_of(const std::vector<AssessedSection>& sections) {
  std::map<std::pair<std::string, Assessed>, ExpectedGroup> groups;
  for (const AssessedSection& section : sections) {
    const char* const track = track_of(section);
    if (track == nullptr) continue;
    for (const AssessedValue& value : section.values) {
      ExpectedGroup& group = groups[{track, value.quantity}];
      group.track = track;
      group.limit = group.values.empty() ? value.limit : std::min(group.limit, value.limit);
      group.values.push_back(value.value);
    }
  }
  std::vector<EstimatedValue> estimates;
  for (const auto& [of, group] : groups) {
    const double part = text_of(of.second).deviations;
    if (part == 0. || group.values.size() < 2) continue;
    const double middle = mean_of(group.values);
    double square = 0.;
    for (const double value : group.values) square += (value - middle) * (value - middle);
    const double deviation = std::sqrt(square / static_cast<double>(group.values.size() - 1));
    estimates.push_back({group.track, of.second, static_cast<int>(group.values.size()),
                         middle + part * deviation, group.limit});
  }
  return estimates;
}

/// Means over the rows within a part of the way.
void add_running(const Way& way, const DesignLine& line, double gravity, double from, double to,
                 AssessedSection& section) {
  std::vector<double> speeds, across;
  const auto begin = std::lower_bound(way.distance.begin(), way.distance.end(), from),
             end = std::upper_bound(begin, way.distance.end(), to);
  for (auto row = begin; row != end; ++row) {
    const OnLine& at = way.at[static_cast<std::size_t>(row - way.distance.begin())];
    speeds.push_back(std::fabs(at.speed));
    across.push_back(
        frame_motion(line, at.place, at.speed, at.faster, 0., gravity).acceleration[1]);
  }
  section.speed = mean_of(speeds);
  section.across = mean_of(across);
}

bool is_plotted(Assessed quantity) {
  return quantity == Assessed::sum_y || quantity == Assessed::y_over_q || quantity == Assessed::q ||
         quantity == Assessed::body_y || quantity == Assessed::body_z;
}

AssessedCurve curve_of(const AssessedSignal& signal, const Way& way) {
  AssessedCurve curve{signal.quantity, signal.where, {}, signal.over.value};
  for (const double distance : signal.over.distance)
    curve.place.push_back(way.at.front().place + way.direction * distance);
  return curve;
}

/// Signals are kept over the way of the place where they are, `ahead` of the first body.
void move_ahead(double ahead, const Way& way, std::vector<AssessedSignal>& signals,
                std::size_t first) {
  for (std::size_t i = first; i < signals.size(); ++i)
    for (double& distance : signals[i].over.distance) distance += way.direction * ahead;
}

/// The bodies on which ride is assessed: the first of each vehicle.
bool carries(const RailVehicleScene& vehicle, std::size_t body) {
  return std::any_of(vehicle.parts.begin(), vehicle.parts.end(),
                     [&](const RailVehicleScene::Part& part) { return part.first == body; });
}

void add_wheelsets(const RailVehicleScene& vehicle, const TraceRows& rows, const Way& way,
                   std::vector<AssessedSignal>& signals) {
  const std::vector<double> loads = static_loads(vehicle, way.at.front().speed);
  const double dt = rows.interval(), origin = vehicle.runner.bodies.front().centre[0];
  std::size_t set = 0;
  for (const RunnerBody& body : vehicle.runner.bodies) {
    if (!body.is_wheelset()) continue;
    const std::string& name = vehicle.wheelsets[set];
    const std::size_t first = signals.size();
    const std::vector<double> sum_y = rows.column(name + ".sum_y_n");
    signals.push_back(
        {Assessed::sum_y, name, largest_size, mean_2m(way, filtered(low_pass(20.), sum_y, dt))});
    add_hunting(name, sum_y, dt, way, signals);
    for (const char* side : {"_left", "_right"})
      add_wheel(name + side, loads[set], rows, way, signals);
    for (std::size_t i = first; i < signals.size(); ++i) signals[i].wheel_load = loads[set];
    move_ahead(body.centre[0] - origin, way, signals, first);
    ++set;
  }
}

AssessedVehicle assess_vehicle(const Scene& scene, std::size_t index, const Simulation& run,
                               const TraceRows& rows) {
  const RailVehicleScene& vehicle = scene.rail_vehicles[index];
  const double dt = rows.interval();
  AssessedVehicle made{vehicle.name, nadal_limit(vehicle.contact), {}, {}, {}, {}};
  const Way way = way_of(run, rows, index, vehicle);
  std::vector<AssessedSignal> signals;
  add_wheelsets(vehicle, rows, way, signals);
  for (const SensorScene& sensor : scene.sensors) {
    const auto* const on = std::get_if<RailVehicleSensor>(&sensor.on);
    if (on == nullptr || on->vehicle != index || !carries(vehicle, on->body)) continue;
    const FeltAccelerations felt = felt_at(run, rows, way, vehicle, *on, sensor.name);
    const std::size_t first = signals.size();
    add_body(sensor.name, felt, dt, way, signals);
    const auto& bodies = vehicle.runner.bodies;
    move_ahead(bodies[on->body].centre[0] + on->point[0] - bodies.front().centre[0], way, signals,
               first);
    if (dt * static_cast<double>(rows.rows()) >= kBlock)
      made.ride.push_back(ride_at(sensor.name, felt, dt));
  }
  if (way.length() < kWindow) return made;
  const double start = way.at.front().place, end = start + way.direction * way.length();
  for (const TrackSection& part :
       sections_between(scene.design_line, std::min(start, end), std::max(start, end))) {
    AssessedSection section{part, 0., 0., {}};
    const double a = way.direction * (part.from - start), b = way.direction * (part.to - start);
    const double from = std::min(a, b), to = std::max(a, b);
    add_running(way, run.model().design_line, vehicle.gravity, from, to, section);
    section.values = values_in(signals, from, to, part.kind, section.speed);
    made.sections.push_back(std::move(section));
  }
  made.estimates = estimates_of(made.sections);
  for (const AssessedSignal& signal : signals)
    if (is_plotted(signal.quantity)) made.curves.push_back(curve_of(signal, way));
  return made;
}

}  // namespace

double against_limit(const AssessedValue& value) {
  return std::isnan(value.limit) ? value.value : value.value / value.limit;
}

std::vector<AssessedVehicle> assess(const Scene& scene, const Simulation& run,
                                    const RunRecord& record) {
  const TraceRows rows(run, record);
  std::vector<AssessedVehicle> all;
  for (std::size_t i = 0; i < scene.rail_vehicles.size(); ++i)
    all.push_back(assess_vehicle(scene, i, run, rows));
  return all;
}

}  // namespace railstep
