#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "offline/pack/time_schemes.h"
#include "online/track/line.h"
#include "support/model_run.h"
#include "support/sections.h"

namespace railstep {

/// reference.md, "Integrators on a stiff linear track": a rail of section F on 12 bays of 0.6 m,
/// lateral seats of 1.4e9 N/m and 29e6 N s/m, 10 kN down and 2 kN sideways on its axis at 30 m/s,
/// ramped in 20 ms. Values that the row does not give are the paper's: 3e6 N/m and 3e4 N s/m along
/// and down; two elements per bay. The sideways force is that of a rail canted 1:5 under a vertical
/// one.
inline Track stiff_track() {
  Track t = paper_track();
  t.rails = 1;
  t.bays = 12;
  t.bay_length = .6;
  t.elements_per_bay = 2;
  t.cant = .2;
  return t;
}

inline MovingLoad stiff_load() {
  return {.start = .6,
          .speed = 30.,
          .stop = 7.2,
          .force = -10e3 * std::sqrt(1.04),
          .table = {0., 0., .02, 1.}};
}

inline constexpr double kStiffEnd = .2;      // s, when the load is 0.6 m before the far end
inline constexpr double kStiffFrame = 1e-3;  // s, at which schemes are compared

/// Results compared at every millisecond: the height of the rail's axis in the middle of bay 6,
/// along the rail's own z, and the lateral forces of the seats before and behind it.
struct StiffTrace {
  std::vector<double> height, force[2];  // m, N
};

/// Displacement or, by `rate`, velocity of unknown k of a rail's node, of banded or condensed
/// lines.
inline double of_node(const ModelRun& run, int node, int k, bool rate) {
  const Model& model = run.model();
  double sum = 0.;
  for (std::int32_t l = 0; l < model.lines; ++l) {
    const LineModel& line = model.line[l];
    const auto n = static_cast<std::size_t>(model.unknowns);
    std::vector<double> re(run.state.u, run.state.u + n), im(run.state.v, run.state.v + n);
    Configuration at{rate && model.form == Form::banded ? run.state.v : run.state.u,
                     {re.data(), im.data()}};
    for (std::int32_t i = 0; rate && model.form == Form::condensed && i < line.size; ++i) {
      const std::size_t j = static_cast<std::size_t>(line.first) + static_cast<std::size_t>(i);
      const double u = re[j], v = im[j];
      re[j] = line.modal.rate.re[i] * u - line.modal.rate.im[i] * v;
      im[j] = line.modal.rate.re[i] * v + line.modal.rate.im[i] * u;
    }
    sum += weight_of(line, 0, k) * nodal_value(line, 0, element_node(node), k, at);
  }
  return sum;
}

inline StiffTrace stiff_trace(const PackOptions& options) {
  constexpr int kLateral = 1, kVertical = 2, kPerBay = 4;  // unknowns; nodes of a bay
  const Track track = stiff_track();
  ModelRun run(track, {.loads = {stiff_load()}}, options);
  StiffTrace trace;
  const auto frames = std::llround(kStiffEnd / kStiffFrame);
  for (long long n = 0; n <= frames; ++n) {
    run.until(static_cast<double>(n) * kStiffFrame);
    trace.height.push_back(of_node(run, 5 * kPerBay + kPerBay / 2, kVertical, false));
    for (const int seat : {0, 1}) {
      const int node = (5 + seat) * kPerBay;
      trace.force[seat].push_back(track.support.stiffness[1] * of_node(run, node, kLateral, false) +
                                  track.support.damping[1] * of_node(run, node, kLateral, true));
    }
  }
  return trace;
}

inline StiffTrace stiff_trace(const Scheme& scheme) {
  return stiff_trace(PackOptions{.scheme = scheme, .residual_flexibility = false});
}

/// Trace of the exact exponential step with all modes of all lines.
inline StiffTrace stiff_exponential(double dt) {
  return stiff_trace(PackOptions{
      .scheme = held_force(dt, 1.),
      .residual_flexibility = false,
      .reduction = Reduction{.limit = {1'000'000, std::numeric_limits<double>::infinity()}}});
}

/// Largest error of the height over its peak, and root mean square error of the seats' lateral
/// forces over their peak.
struct StiffError {
  double height, force;
};
inline StiffError stiff_error(const StiffTrace& trace, const StiffTrace& reference) {
  double worst = 0., most = 0., squares = 0., peak = 0.;
  for (std::size_t i = 0; i < reference.height.size(); ++i) {
    worst = std::max(worst, std::abs(trace.height[i] - reference.height[i]));
    most = std::max(most, std::abs(reference.height[i]));
    for (const int seat : {0, 1}) {
      squares += std::pow(trace.force[seat][i] - reference.force[seat][i], 2);
      peak = std::max(peak, std::abs(reference.force[seat][i]));
    }
  }
  return {worst / most,
          std::sqrt(squares / (2. * static_cast<double>(reference.height.size()))) / peak};
}

struct NamedScheme {
  std::string name;
  Scheme (*scheme)(double dt);
};
inline std::vector<NamedScheme> named_schemes() {
  return {{"backward Euler", backward_euler},
          {"trapezoidal", [](double dt) { return newmark(dt); }},
          {"HHT -0.1", [](double dt) { return hilber_hughes_taylor(dt, -.1); }},
          {"generalised-alpha 0.6", [](double dt) { return generalised_alpha(dt, .6); }},
          {"generalised-alpha 0.5", [](double dt) { return generalised_alpha(dt, .5); }},
          {"generalised-alpha 0", [](double dt) { return generalised_alpha(dt, 0.); }},
          {"TR-BDF2", tr_bdf2}};
}

}  // namespace railstep
