#include "build/build_irregularity.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "offline/irregularity/defect.h"
#include "offline/irregularity/rails.h"
#include "scene/irregularity_file.h"
#include "text/read.h"

namespace railstep {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// A record's shortest wave is two of its steps.
void check_record(const Scene& scene, const IrregularityScene& own, const RailSignals& rails) {
  double step = 0.;
  for (const auto* pair : {&rails.y, &rails.z})
    for (const Signal& signal : *pair)
      if (!signal.coefficient.empty()) step = signal.step;
  const double speed = fastest_wheel(scene);
  if (2. * step >= 8. * speed * scene.step->dt * (1. - 1e-12)) return;
  throw InputError(
      "E-SCENE-36",
      fmt::format("{}: rows {:.6g} m apart hold waves of {:.6g} m, which are passed at "
                  "{:.6g} m/s in {:.3g} steps of dt_s = {:.6g}; expected 8 steps or more, "
                  "by a shorter step.dt_s",
                  own.file.string(), step, 2. * step, speed, 2. * step / (speed * scene.step->dt),
                  scene.step->dt));
}

/// Refuses a record that covers no place of the track: chainage is not a scene's x.
void check_place(const Scene& scene, const IrregularityScene& own, const RailSignals& rails) {
  const double length = scene.track.length();
  for (const auto* pair : {&rails.y, &rails.z})
    for (const Signal& signal : *pair) {
      if (signal.coefficient.empty()) continue;
      const double last =
          signal.start + signal.step * static_cast<double>(signal.coefficient.size() - 3);
      if (last >= 0. && (scene.track.endless || signal.start <= length)) continue;
      throw InputError(
          "E-SCENE-37",
          fmt::format("{}: the record and the run-out at its ends go from distance {:.6g} m to "
                      "{:.6g} m, but the track from 0 to {:.6g} m; expected a record of places "
                      "on the track",
                      own.file.string(), signal.start, last, length));
    }
}

RailSignals recorded(const Scene& scene, const IrregularityScene& own) {
  RailSignals rails = read_irregularities(own.file);
  check_place(scene, own, rails);
  check_record(scene, own, rails);
  for (auto* pair : {&rails.y, &rails.z})
    for (Signal& signal : *pair) signal = averaged(signal, own.options.patch);
  return rails;
}

RailSignals generated(const IrregularityScene& own) {
  const TrackSpectra* spectra = find_spectra(own.spectrum);
  std::array<Signal, kGeometries> geometry;
  for (const Geometry g : own.geometries) {
    const auto i = static_cast<std::size_t>(g);
    geometry[i] = generate(spectra->of[i], own.options, i);
  }
  return rails_of(geometry);
}

Signal signal_of(const DefectScene& d) {
  return d.kind == DefectKind::dipped_joint
             ? dipped_joint(d.at, d.depth, d.ramp, defect_grid(d.patch, d.ramp))
             : corrugation(d.from, d.to, d.length, d.amplitude, defect_grid(d.patch, d.length));
}

Signal signal_of(const TreadScene& d, double radius) {
  switch (d.kind) {
    case TreadKind::fresh_flat:
      return fresh_flat(radius, d.length, defect_grid(d.patch, d.length));
    case TreadKind::rounded_flat:
      return rounded_flat(radius, d.length, d.depth, defect_grid(d.patch, d.length));
    default:
      return out_of_round(radius, d.order, d.amplitude,
                          defect_grid(d.patch, 2. * kPi * radius / d.order));
  }
}

Signal signal_of_wheel(const TreadScene& d, double radius) {
  Signal signal = signal_of(d, radius);
  signal.start = d.first - kPi * radius;  // its middle is half a turn on
  return signal;
}

}  // namespace

std::vector<RailIrregularity> irregularities_of(const Scene& scene) {
  std::vector<RailIrregularity> all;
  const auto add = [&](int rail, int direction, Signal signal) {
    if (!signal.coefficient.empty() && rail < scene.track.rails)
      all.push_back({rail, direction, std::move(signal)});
  };
  if (scene.irregularity) {
    const RailSignals rails = scene.irregularity->file.empty()
                                  ? generated(*scene.irregularity)
                                  : recorded(scene, *scene.irregularity);
    for (const int rail : {0, 1}) {
      add(rail, 1, rails.y[static_cast<std::size_t>(rail)]);
      add(rail, 2, rails.z[static_cast<std::size_t>(rail)]);
    }
  }
  for (const DefectScene& defect : scene.defects)
    for (const int rail : {0, 1})
      if (defect.on[static_cast<std::size_t>(rail)]) add(rail, 2, signal_of(defect));
  return all;
}

std::array<Signal, 2> treads_of(const WheelsetScene& wheelset) {
  std::array<Signal, 2> treads;
  for (const TreadScene& d : wheelset.treads)
    for (std::size_t side = 0; side < 2; ++side) {
      if (!d.on[side]) continue;
      treads[side] = signal_of_wheel(d, wheelset.radius);
    }
  return treads;
}

std::vector<Signal> treads_of(const VehicleScene& vehicle) {
  if (vehicle.treads.empty()) return {};
  std::vector<Signal> treads(vehicle.vehicle.wheels.size());
  for (const WheelTread& d : vehicle.treads) treads[d.wheel] = signal_of_wheel(d.shape, d.radius);
  return treads;
}

}  // namespace railstep
