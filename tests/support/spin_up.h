#pragma once
#include <cmath>
#include <ctime>
#include <functional>
#include <numeric>
#include <stdexcept>
#include <utility>
#include <vector>

#include "support/floating_frame.h"
#include "support/reissner_beam.h"
#include "support/rotating_beam.h"

namespace railstep {

inline constexpr double kSpinUpEnd = 20., kSample = .2;  // s

/// One spin-up, seen from the hub.
struct SpinUpRun {
  std::vector<Eigen::Vector2d> tip;  // along and across less the beam's length, m, every kSample
  int steps = 0, solves = 0;
  double seconds = 0.;  // of processor time: other programs do not count

  double microseconds_per_step() const { return seconds / steps * 1e6; }
};

inline double processor_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

using Tip = std::function<Eigen::Vector2d(const Moving&)>;

/// Runs from rest at the hub to kSpinUpEnd. A sample is a whole number of steps.
inline SpinUpRun spin_up(MovingBody& body, Moving m, const SpinUp& hub, double step,
                         const Tip& tip) {
  const int each = static_cast<int>(std::lround(kSample / step));
  if (std::abs(each * step - kSample) > 1e-12)
    throw std::invalid_argument("a sample of the spin-up is no whole number of steps");
  // rho_inf .8 damps the thickness modes of ANCF, which the step cannot follow.
  const GeneralisedAlpha scheme(step, .8);
  SpinUpRun run;
  run.tip.push_back(in_hub(tip(m), 0., kSpinUpLength));
  const double begin = processor_seconds();
  while (run.steps < std::lround(kSpinUpEnd / step)) {
    for (int i = 0; i < each; ++i) {
      m.time = run.steps++ * step;
      run.solves += scheme.advance(body, m, 1e-9);  // m
    }
    run.tip.push_back(in_hub(tip(m), hub.angle(m.time), kSpinUpLength));
  }
  run.seconds = processor_seconds() - begin;
  return run;
}

inline Tip tip_node(int place) {
  return [place](const Moving& m) { return Eigen::Vector2d(m.q[place], m.q[place + 2]); };
}

inline SpinUpRun spin_up_ancf(const SpinUp& hub, int elements, double step) {
  const PlanarBeam b = hubbed(spin_up_beam(elements), true);
  AncfBody body(b, drive_section(hub), Eigen::VectorXd::Zero(b.structure.unknowns()));
  return spin_up(body, at_rest(b.structure.rest), hub, step, tip_node(18 * elements));
}

inline SpinUpRun spin_up_linear(const SpinUp& hub, int elements, double step) {
  const PlanarBeam b = hubbed(spin_up_beam(elements), true);
  LinearBody body(b, drive_section(hub), Eigen::VectorXd::Zero(b.structure.unknowns()));
  return spin_up(body, at_rest(b.structure.rest), hub, step, tip_node(18 * elements));
}

/// Spin-up by modes of eight elements, in a frame tangent at the hub.
inline SpinUpRun spin_up_frame(const SpinUp& hub, int bending, int axial, bool stiffening,
                               double step) {
  const PlanarBeam b = hubbed(spin_up_beam(8), true);
  const Eigen::MatrixXd modes = planar_modes(b, bending, axial);
  std::vector<int> free(index_of(bending + axial));
  std::iota(free.begin(), free.end(), 3);
  FloatingBody body(floating_frame(b.structure, b.mass, modes, stiffening), free, drive_frame(hub));
  const FramePoint end = frame_point(b.structure, modes, 16, stiffening);
  return spin_up(body, at_rest(Eigen::VectorXd::Zero(3 + bending + axial)), hub, step,
                 [end](const Moving& m) { return position(end, m.q); });
}

inline SpinUpRun spin_up_reissner(const SpinUp& hub, int elements, double step) {
  ReissnerBody body(spin_up_beam(1), elements, hub);
  return spin_up(body, body.at_rest(), hub, step, [elements](const Moving& m) {
    return Eigen::Vector2d(m.q[6 * elements], m.q[6 * elements + 1]);
  });
}

/// Largest distance of two paths of the tip, m.
inline double apart(const std::vector<Eigen::Vector2d>& a, const std::vector<Eigen::Vector2d>& b) {
  double most = 0.;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, (a[i] - b[i]).norm());
  return most;
}

/// The geometrically exact beam, extrapolated to step 0, and its error.
struct SpinUpReference {
  std::vector<Eigen::Vector2d> tip;
  double largest_lag;  // m
  double own_error;    // of the tip, m: mesh and step halved

  double error(const SpinUpRun& run) const { return apart(run.tip, tip) / largest_lag; }
};

/// @param step  of the finer of the two runs, s
inline SpinUpReference spin_up_reference(const SpinUp& hub, int elements, double step) {
  const auto extrapolated = [&](int count, double h) {
    const SpinUpRun fine = spin_up_reissner(hub, count, h);
    std::vector<Eigen::Vector2d> tip = spin_up_reissner(hub, count, 2. * h).tip;
    for (std::size_t i = 0; i < tip.size(); ++i) tip[i] = (4. * fine.tip[i] - tip[i]) / 3.;
    return tip;
  };
  SpinUpReference r{extrapolated(elements, step), 0., 0.};
  for (const Eigen::Vector2d& t : r.tip) r.largest_lag = std::max(r.largest_lag, std::abs(t[1]));
  r.own_error = apart(extrapolated(elements / 2, step), r.tip) +
                apart(extrapolated(elements, 2. * step), r.tip);
  return r;
}

}  // namespace railstep
