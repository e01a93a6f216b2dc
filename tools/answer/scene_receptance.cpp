#include "answer/scene_receptance.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <utility>

#include "build/build.h"
#include "build/build_sensors.h"
#include "offline/receptance/condensed.h"
#include "offline/receptance/end_effect.h"
#include "offline/receptance/exact_rail.h"
#include "offline/receptance/full_order.h"
#include "offline/track/end_zone.h"
#include "offline/track/fixed_port.h"
#include "run/unit_note.h"

namespace railstep {
namespace {

constexpr double kValidVertical = 1500., kValidLateral = 300.;  // Hz, of the beam (README)
constexpr int kMostFrequencies = 100'000;

std::vector<double> frequencies(const ReceptanceRequest& r) {
  if (!(r.from_hz <= r.to_hz))
    throw InputError("E-RECEPTANCE-14",
                     fmt::format("--from {:g} is above --to-hz {:g}; expected a lower --from",
                                 r.from_hz, r.to_hz));
  if (r.from_hz == r.to_hz) return {r.from_hz};
  if (r.points == 1)
    throw InputError("E-RECEPTANCE-15",
                     fmt::format("--points 1 is one frequency, but --from {:g} and --to-hz {:g} "
                                 "differ; expected --from alone",
                                 r.from_hz, r.to_hz));
  const double span = r.to_hz - r.from_hz;
  if (r.step_hz && !(span / *r.step_hz < kMostFrequencies))
    throw InputError("E-RECEPTANCE-16",
                     fmt::format("--step-hz {:g} makes {:.3g} frequencies; expected fewer than {}",
                                 *r.step_hz, span / *r.step_hz, kMostFrequencies));
  const int last =
      r.step_hz ? static_cast<int>(std::ceil(span / *r.step_hz * (1. - 1e-9))) : r.points - 1;
  std::vector<double> hz;
  hz.reserve(static_cast<std::size_t>(last) + 1);
  for (int i = 0; i < last; ++i)
    hz.push_back(r.step_hz
                     ? r.from_hz + i * *r.step_hz
                     : r.from_hz * std::pow(r.to_hz / r.from_hz, static_cast<double>(i) / last));
  hz.push_back(r.to_hz);
  return hz;
}

/// A sensor with a direction, over the track.
struct Sensed {
  const SensorScene* sensor;
  int direction;
  Functional on;
};

std::string listed(const Scene& scene) {
  std::vector<std::string> names;
  for (const SensorScene& sensor : scene.sensors)
    if (std::holds_alternative<RailSensor>(sensor.on) ||
        std::holds_alternative<SleeperSensor>(sensor.on))
      names.push_back(sensor.name);
  if (names.empty()) return "a sensor on a rail or a sleeper, and the scene has none";
  return fmt::format("one of {}", fmt::join(names, ", "));
}

Sensed sensed(const Scene& scene, const Track& track, const std::string& name,
              const std::string& direction) {
  const auto refuse = [&](MessageId id, const std::string& sentence) {
    throw InputError(id, fmt::format("{}: {}", scene.file.string(), sentence));
  };
  const int d = direction == "y" ? 1 : 2;
  for (const SensorScene& sensor : scene.sensors) {
    if (sensor.name != name) continue;
    const std::optional<Functional> on = functional_of(sensor, scene, track, d);
    if (!on)
      refuse("E-RECEPTANCE-17",
             fmt::format("sensor '{}' is not on the track; expected {}", name, listed(scene)));
    double moved = 0.;
    for (const Line& line : assemble(track)) moved += functional_row(track, line, *on).norm();
    if (moved == 0. && d == 1 && track.unknowns == Unknowns::vertical)
      refuse("E-RECEPTANCE-22",
             "the track of this scene moves vertically alone; expected track.unknowns = \"full\" "
             "for direction y");
    if (moved == 0.)
      refuse("E-RECEPTANCE-23",
             fmt::format("sensor '{}' cannot move in {}; expected another sensor or direction",
                         name, direction));
    return {&sensor, d, *on};
  }
  refuse("E-RECEPTANCE-24",
         fmt::format("no sensor is named '{}'; expected {}", name, listed(scene)));
  return {};
}

/// The model that answers, by the name it has in a request.
std::unique_ptr<Receptance> model_of(const std::string& name, const Scene& scene,
                                     const Track& track, const Transfer& transfer) {
  if (name == "full") return std::make_unique<FullOrderReceptance>(track, transfer);
  if (name == "condensed")
    return std::make_unique<CondensedReceptance>(track, transfer, reduction_of(scene),
                                                 scene.condense.residual_flexibility);
  const bool endless = name == "endless";
  return std::make_unique<ExactRailReceptance>(
      track, transfer, endless ? BeamTheory::timoshenko : BeamTheory::euler_bernoulli, endless);
}

ReceptanceCurve curve_of(const std::string& name, Receptance& model,
                         const std::vector<double>& hz) {
  ReceptanceCurve curve{name, {}};
  for (const double f : hz) curve.value.push_back(model.at(f)[0]);
  return curve;
}

/// Stretches of frequency over which the ends are felt too much, in words.
std::string end_warning(const std::vector<double>& hz, const std::vector<double>& effect,
                        bool zones) {
  std::vector<std::string> bands;
  for (std::size_t i = 0; i < hz.size(); ++i) {
    if (!(effect[i] > kMostEndEffect)) continue;
    std::size_t last = i;
    while (last + 1 < hz.size() && effect[last + 1] > kMostEndEffect) ++last;
    bands.push_back(last > i ? fmt::format("{:.4g} to {:.4g} Hz", hz[i], hz[last])
                             : fmt::format("{:.4g} Hz", hz[i]));
    i = last;
  }
  const auto worst = std::max_element(effect.begin(), effect.end());
  if (bands.empty()) return {};
  const std::size_t said = std::min<std::size_t>(bands.size(), 3);
  return fmt::format(
      "the track is too short to stand for a long one at {}{}: its ends change the receptance by "
      "more than {:g} %, by {} % at {:.4g} Hz; use {}",
      fmt::join(bands.begin(), bands.begin() + static_cast<std::ptrdiff_t>(said), ", "),
      bands.size() > said ? fmt::format(" and {} more bands", bands.size() - said) : "",
      100. * kMostEndEffect, *worst > 1. ? "over 100" : fmt::format("up to {:.2g}", 100. * *worst),
      hz[static_cast<std::size_t>(worst - effect.begin())],
      zones ? "more bays and more end_zone_bays" : "more bays");
}

void warn(const std::vector<const Sensed*>& points, bool zones, ReceptanceAnswer& answer) {
  if (!answer.end_effect.empty()) {
    const std::string ends = end_warning(answer.hz, answer.end_effect, zones);
    if (!ends.empty()) answer.warnings.push_back({"W-RECEPTANCE-01", ends});
  }
  for (const Sensed* point : points) {
    const bool lateral = point->direction == 1;
    const double most = lateral ? kValidLateral : kValidVertical;
    if (answer.hz.back() <= most) continue;
    answer.warnings.push_back(
        {"W-RECEPTANCE-02", fmt::format("the beam does not warp and its web does not bend: {} "
                                        "motion is right up to about {:g} Hz",
                                        lateral ? "lateral" : "vertical", most)});
    return;
  }
}

/// The rail's point of a driving point, if there is one.
const RailPoint* rail_of(const Sensed& point) {
  return point.on.rail.empty() ? nullptr : &point.on.rail[0].at;
}

void add_decay(const ReceptanceRequest& request, const Scene& scene, const Track& track,
               const Sensed& force, ReceptanceAnswer& answer) {
  const RailPoint* at = rail_of(force);
  if (at == nullptr)
    throw InputError(
        "E-RECEPTANCE-18",
        fmt::format("{}: a decay rate is taken along a rail; expected a sensor on a rail for --at",
                    scene.file.string()));
  const std::vector<ThirdOctave> bands = third_octaves(request.from_hz, request.to_hz);
  if (bands.empty())
    throw InputError("E-RECEPTANCE-19",
                     "no one-third octave band from 100 to 5000 Hz lies between --from and "
                     "--to-hz; expected one for a decay rate");
  const bool back = at->x > track.length() - at->x;
  Transfer along{force.on, {}};
  answer.decay_distance = decay_distances(track, at->x);
  if (answer.decay_distance.size() < 2)
    throw InputError(
        "E-RECEPTANCE-20",
        "too little rail lies beside --at for a decay rate; expected a quarter of a bay or more");
  for (const double away : answer.decay_distance) {
    RailPoint there = *at;
    there.x = std::clamp(at->x + (back ? -away : away), 0., track.length());
    along.reads.push_back(rail_point(there));
  }
  answer.decay =
      decay_rates(*model_of(request.condensed ? "condensed" : "full", scene, track, along),
                  answer.decay_distance, bands);
  std::vector<int> short_of;
  for (const DecayRate& rate : answer.decay)
    if (!rate.suitable) short_of.push_back(rate.band.nominal_hz);
  if (!short_of.empty())
    answer.warnings.push_back(
        {"W-RECEPTANCE-03",
         fmt::format("the decay rates of the bands {} Hz are upper bounds: {:.3g} m of rail are "
                     "too short for them (EN 15461, 6.7 and 7)",
                     fmt::join(short_of, ", "), answer.decay_distance.back())});
}

/// Adds the reflection at the ends, for the line that the force moves most.
void add_reflection(const Track& track, const Sensed& force, ReceptanceAnswer& answer) {
  const std::vector<Line> lines = assemble(track);
  const Line* moved = nullptr;
  double most = 0.;
  for (const Line& line : lines) {
    const double size = functional_row(track, line, force.on).norm();
    if (size > most) moved = &line;
    most = std::max(most, size);
  }
  const EndReflection end(track, *moved, force.direction);
  for (const double f : answer.hz) answer.reflection.push_back(end.at(f));
}

void add_resonances(const Track& track, const RailPoint& at, Receptance& model,
                    ReceptanceAnswer& answer) {
  std::vector<double> magnitude;
  for (const std::complex<double>& value : answer.curve.value) magnitude.push_back(std::abs(value));
  std::vector<ExpectedResonance> expected = expected_resonances(track, at.x);
  std::erase_if(expected, [&](const ExpectedResonance& one) {
    return one.hz * one.within < answer.hz.front() || one.hz / one.within > answer.hz.back();
  });
  answer.resonances = name_resonances(expected, extrema(model, answer.hz, magnitude));
}

std::string label(const Sensed& point) {
  return fmt::format("{}.{}", point.sensor->name, point.direction == 1 ? "y" : "z");
}

ReceptanceAnswer solve(const ReceptanceRequest& request, const Scene& scene) {
  const Track track = linear_about_rest(track_of(scene));
  const Sensed force = sensed(scene, track, request.at, request.direction);
  const Sensed read =
      sensed(scene, track, request.to.empty() ? request.at : request.to,
             request.to_direction.empty() ? request.direction : request.to_direction);
  const Transfer transfer{force.on, {read.on}};
  ReceptanceAnswer answer;
  answer.force = label(force);
  answer.read = label(read);
  answer.hz = frequencies(request);
  const auto curve = [&](const std::string& name) {
    return curve_of(name, *model_of(name, scene, track, transfer), answer.hz);
  };
  const std::string name = request.condensed ? "condensed" : "full";
  const std::unique_ptr<Receptance> model = model_of(name, scene, track, transfer);
  answer.curve = curve_of(name, *model, answer.hz);
  for (const std::string& other : request.beside)
    if (other != name) answer.beside.push_back(curve(other));
  if (scene.support && !track.ring)  // a ring has no ends
    answer.end_effect = end_effect(track, transfer, answer.hz,
                                   request.condensed ? curve("full").value : answer.curve.value);
  const RailPoint* at = rail_of(force);
  const bool driving = read.sensor == force.sensor && read.direction == force.direction;
  // They are named by vertical bending alone.
  if (driving && at != nullptr && force.direction == 2 && track.cant == 0.)
    add_resonances(track, *at, *model, answer);
  if (request.reflection) add_reflection(track, force, answer);
  warn({&force, &read}, end_zones(track) > 0, answer);
  if (const auto note = lopsided_note(scene)) answer.warnings.push_back(*note);
  if (request.decay) add_decay(request, scene, track, force, answer);
  return answer;
}

}  // namespace

ReceptanceAnswer solve_receptance(const ReceptanceRequest& request) {
  Eigen::setCpuCacheSizes(32 << 10, 256 << 10, 2 << 20);  // the same bits on every processor
  const Scene scene = read_scene(request.scene, request.overrides);
  try {
    return solve(request, scene);
  } catch (const Refused& error) {
    throw InputError(request.scene, error);
  }
}

}  // namespace railstep
