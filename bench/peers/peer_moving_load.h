#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "offline/pack/pack.h"
#include "offline/pack/time_schemes.h"
#include "online/step/step.h"

// The peers' moving-load scene (reference.md, config/scenes/moving_load.toml), and railstep on it.

namespace railstep {

inline constexpr double kStep = 1e-3, kSpeed = 30., kBay = .6;  // s, m/s, m
inline constexpr double kLoad = -50e3;                          // N on each rail, up positive
inline constexpr double kRhoInf = .6;                           // of generalised-alpha
inline constexpr int kCompared = 300;  // steps compared with the reference at most: 0.3 s, 15 bays
inline constexpr int kStartUp = 50;    // steps while a sudden load rings, docs/peers.md

/// 0.2319 m by 0.0375 m rectangle on springs at every bay border, k = 0.8497.
inline Track moving_load_track(int bays, int elements_per_bay, int rails, Unknowns unknowns) {
  const double h = .2319, b = .0375;
  Track t;
  t.section = {.area = h * b,
               .inertia_y = b * h * h * h / 12.,
               .inertia_z = h * b * b * b / 12.,
               .torsion = h * b * b * b / 3. * (1. - .63 * b / h),
               .shear_factor_y = .8497,
               .shear_factor_z = .8497};
  t.unknowns = unknowns;
  t.rails = rails;
  t.bays = bays;
  t.bay_length = kBay;
  t.elements_per_bay = elements_per_bay;
  t.support.stiffness = {3e6, 3e7, 3e7};
  t.support.damping = {3e4, 3e4, 3e4};
  return t;
}

/// Place of the loads at a time, m.
inline double load_place(double time) { return .5 * kBay + kSpeed * time; }

/// Steps of 1 ms in a passage from the first mid-bay to the last.
inline int passage_steps(const Track& track) {
  return static_cast<int>(std::lround((track.length() - kBay) / (kSpeed * kStep)));
}

/// Options of railstep for the scene.
struct MovingLoadOptions {
  double dt = kStep;        // s
  int steps_per_frame = 1;  // a frame is 1 ms
  bool residual = true;     // residual flexibility
  std::optional<Reduction> reduction = {};
};

/// A run of 50 kN on every rail from the first mid-bay to the last, then again from rest.
class MovingLoadRun {
 public:
  MovingLoadRun(const Track& track, const MovingLoadOptions& options)
      : frames_(passage_steps(track)) {
    Traffic traffic;
    for (int rail = 0; rail < track.rails; ++rail)
      traffic.loads.push_back({.rail = rail,
                               .start = load_place(0.),
                               .speed = kSpeed,
                               .stop = track.length(),
                               .force = kLoad});
    const Scheme scheme = options.reduction ? held_force(options.dt, kRhoInf)
                                            : generalised_alpha(options.dt, kRhoInf);
    packed_ = std::make_unique<PackedModel>(track, traffic,
                                            PackOptions{.scheme = scheme,
                                                        .steps_per_frame = options.steps_per_frame,
                                                        .residual_flexibility = options.residual,
                                                        .reduction = options.reduction});
    memory_.resize(static_cast<std::size_t>(state_doubles(packed_->model())));
    scratch_.resize(static_cast<std::size_t>(workspace_doubles(packed_->model())));
    state_ = state_on(packed_->model(), memory_.data());
    workspace_ = workspace_on(packed_->model(), scratch_.data());
    restart();
  }

  /// Steps one frame and returns the deflection under the first load at its end, m. The reset at
  /// the track's end is part of the time, once per passage.
  double frame() {
    if (done_ == frames_) restart();
    ++done_;
    (void)advance_frame(packed_->model(), state_, workspace_, outputs_);
    return outputs_.load_deflection[0];
  }

  void restart() {
    reset(packed_->model(), state_);
    done_ = 0;
  }

  int frames() const { return frames_; }  // of a passage
  int unknowns() const { return packed_->model().unknowns; }
  /// Flops of the worst frame, as the model states them.
  double flops() const { return static_cast<double>(packed_->model().cost.flops); }
  double bytes() const { return static_cast<double>(packed_->model().cost.bytes); }

 private:
  int frames_, done_ = 0;
  std::unique_ptr<PackedModel> packed_;
  std::vector<double> memory_, scratch_;
  State state_;
  Workspace workspace_;
  Outputs outputs_{};
};

/// Deflections under the first load from rest, m, one every 1 ms.
template <class Run>
std::vector<double> deflections(Run& run) {
  run.restart();
  std::vector<double> z;
  z.reserve(static_cast<std::size_t>(kCompared));
  for (int i = 0; i < std::min(run.frames(), kCompared); ++i) z.push_back(run.frame());
  run.restart();
  return z;
}

/// Largest difference from step `first` on, over the peak of `reference` there.
inline double largest_error(const std::vector<double>& z, const std::vector<double>& reference,
                            std::size_t first) {
  double largest = 0., peak = 0.;
  for (std::size_t i = first; i < reference.size(); ++i) {
    largest = std::max(largest, std::abs(z[i] - reference[i]));
    peak = std::max(peak, std::abs(reference[i]));
  }
  return largest / peak;
}

struct PassageReference {
  std::vector<double> z;  // m, every 1 ms
  double own_error;       // after start-up, from halving mesh and step once more
};

/// Reference with eight elements per bay, 0.1 ms, and residual flexibility. Without that, the
/// missing kink under a load inside an element makes an error in proportion to the element's
/// length, 4e-4 of the peak with eight per bay. The rails share nothing, so one is enough.
inline const PassageReference& reference_for(int bays, Unknowns unknowns) {
  static std::map<std::pair<int, Unknowns>, PassageReference> made;
  auto [at, fresh] = made.try_emplace({bays, unknowns});
  if (fresh) {
    const auto refined = [&](int per_bay, int steps) {
      MovingLoadRun run(moving_load_track(bays, per_bay, 1, unknowns),
                        {.dt = kStep / steps, .steps_per_frame = steps});
      return deflections(run);
    };
    at->second.z = refined(8, 10);
    at->second.own_error = largest_error(at->second.z, refined(16, 20), kStartUp);
  }
  return at->second;
}

}  // namespace railstep
