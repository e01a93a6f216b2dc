#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "offline/element/energy.h"
#include "offline/element/matrices.h"

namespace railstep {

/// The paper's double pendulum (Fig. 6): two links are released from rest along +x. The first is
/// pinned at the origin A, the second is hinged to its end B; C is the free end. The hinge shares
/// the position of the axis and leaves the sections free. Shear factors are 1; J has no effect in
/// the plane.
struct DoublePendulum {
  double link = .4, height = .02, width = .03;  // m
  Material material = {.young = 210e6, .poisson = .3, .density = 7900.};
  Eigen::Vector2d gravity = {0., -9.81};  // x and z, m/s2

  BeamSection section() const {
    return {.area = height * width,
            .inertia_y = width * std::pow(height, 3) / 12.,
            .inertia_z = height * std::pow(width, 3) / 12.,
            .torsion = .196 * width * std::pow(height, 3),
            .moments = rectangle_moments(height, width)};
  }
  double link_mass() const { return material.density * height * width * link; }  // kg
};

/// Places of B and C: x and z of B, x and z of C, m.
using HingeAndEnd = Eigen::Vector4d;

/// The path of B and C at equal steps from time 0.
struct PendulumPath {
  double step = 0.;  // s
  std::vector<HingeAndEnd> at;

  double end() const { return step * static_cast<double>(at.size() - 1); }
  /// Throws std::out_of_range after the end.
  const HingeAndEnd& when(double time) const {
    return at.at(static_cast<std::size_t>(std::lround(time / step)));
  }
};

/// Largest distances of B and of C between two paths, m, at the times of the one with the longer
/// steps, which are multiples of the other's.
inline Eigen::Vector2d apart(const PendulumPath& a, const PendulumPath& b, double until) {
  Eigen::Vector2d most(0., 0.);
  const double step = std::max(a.step, b.step);
  for (int i = 0; i <= std::lround(until / step); ++i) {
    const HingeAndEnd gap = a.when(i * step) - b.when(i * step);
    most = most.cwiseMax(Eigen::Vector2d(gap.head<2>().norm(), gap.tail<2>().norm()));
  }
  return most;
}

/// The first line of a file of paths.
inline constexpr char kPathColumns[] = "time_s,B.x_m,B.z_m,C.x_m,C.z_m";

/// Error of tests/data/double_pendulum.csv by its own mesh and steps, m.
inline constexpr double kPendulumKnown = 1e-7;

/// The path in such a file, which may begin with lines of remarks (#). The reference of the double
/// pendulum, every 50 ms up to 1 s, is RAILSTEP_SOURCE "/tests/data/double_pendulum.csv".
/// @throws std::runtime_error if the file is missing or not as expected
inline PendulumPath read_pendulum_path(const std::string& file) {
  const auto refuse = [&file](const char* why, const std::string& text) {
    throw std::runtime_error(std::string(file).append(why).append(text));
  };
  std::ifstream in(file);
  PendulumPath path;
  std::string line;
  bool titled = false;
  while (std::getline(in, line)) {
    if (line.starts_with('#')) continue;
    if (!titled) {
      if (line != kPathColumns) refuse(": unknown columns ", line);
      titled = true;
      continue;
    }
    std::istringstream row(line);
    double time = 0.;
    HingeAndEnd at;
    char comma = 0;
    row >> time;
    for (double& value : at) row >> comma >> value;
    if (!row) refuse(": not a row of five numbers: ", line);
    if (path.at.size() == 1) path.step = time;
    path.at.push_back(at);
  }
  if (path.at.size() < 2) refuse(": no path of the double pendulum", "");
  return path;
}

}  // namespace railstep
