#pragma once
#include <array>
#include <string>
#include <vector>

#include "offline/beam/equilibrium.h"
#include "scene/scene.h"

namespace railstep {

/// A named place or a point of a rail's neutral axis: where it rests and how far it moved, m.
struct StaticPoint {
  std::string name;
  std::array<double, 3> rest, displacement;  // x, y, z
};

/// Equilibrium of a scene at t = 0.
struct StaticSolution {
  bool converged;
  int iterations;   // of Newton; 1 for a linear model
  int load_steps;   // that converged
  double residual;  // over the load; the last one where nothing converged
  std::vector<NewtonStep> history;
  std::vector<StaticPoint> points;  // rail and sleeper sensors; none where nothing converged
  std::vector<StaticPoint> axis;    // quarters of every element, rail after rail
  bool stable = true;  // of a nonlinear rail: no pivot of its tangent there is negative
};

/// Statics of a scene under its loads at t = 0, the weight of rails and sleepers where
/// track.gravity says so, and half of each wheelset's weight on each railhead at start_m. By
/// Newton's method, by one linear solution, or by Timoshenko's beam, as track.model says.
/// Throws InputError, in one sentence, for a free rigid mode and for what the model does not hold.
StaticSolution solve_static(const Scene& scene);

}  // namespace railstep
