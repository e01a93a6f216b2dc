#pragma once
#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <numbers>

#include "offline/beam/equilibrium.h"
#include "offline/element/matrices.h"

namespace railstep {

using Eigen::Vector3d;

inline constexpr double kShear = 5. / 6.;  // shear factor of a rectangle

/// J of a rectangle by Saint-Venant's series (Timoshenko and Goodier, Theory of Elasticity, section
/// 109), to round-off: the terms left out are below 64/pi^5 (b/a) / (2 n)^4, n = 400.
inline double rectangle_torsion(double height, double width) {
  const double a = std::max(height, width), b = std::min(height, width);
  const double pi = std::numbers::pi;
  double sum = 0.;
  for (int n = 799; n > 0; n -= 2) sum += std::tanh(.5 * n * pi * a / b) / std::pow(n, 5);
  return a * b * b * b * (1. / 3. - 64. / std::pow(pi, 5) * b / a * sum);
}

/// A rectangle with its exact moments; `shear_factor` for both directions.
inline BeamSection rectangle_section(double height, double width, double shear_factor) {
  return {.area = height * width,
          .inertia_y = width * std::pow(height, 3) / 12.,
          .inertia_z = height * std::pow(width, 3) / 12.,
          .torsion = rectangle_torsion(height, width),
          .shear_factor_y = shear_factor,
          .shear_factor_z = shear_factor,
          .moments = rectangle_moments(height, width)};
}

/// Position and slopes of a node at rest.
struct NodeFrame {
  Vector3d r, a, b;
};

/// Elements along a curve, each with its own shape at rest; t from 0 to 1, nodes at equal steps.
inline Structure chain_along(const BeamLaw& law, int elements,
                             const std::function<NodeFrame(double)>& curve) {
  Structure s;
  s.rest.resize(9 * (2 * elements + 1));
  for (int n = 0; n <= 2 * elements; ++n) {
    const NodeFrame at = curve(n / (2. * elements));
    s.rest.segment<9>(9 * n) << at.r, at.a, at.b;
  }
  s.held.assign(static_cast<std::size_t>(s.unknowns()), false);
  s.elements = chain(elements);
  for (int e = 0; e < elements; ++e) {
    s.elements[static_cast<std::size_t>(e)].law = e;
    s.laws.push_back(beam_element(law, s.rest.segment<27>(18 * e)));
  }
  s.slope_length = std::sqrt(law.moments.of[0][2] / law.moments.area());
  return s;
}

/// Elements along x, from the origin.
inline Structure straight_chain(const BeamLaw& law, double length, int elements) {
  return chain_along(law, elements, [&](double t) {
    return NodeFrame{t * length * Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()};
  });
}

inline void hold(Structure& s, int node, std::initializer_list<int> unknowns) {
  for (const int i : unknowns) {
    const int unknown = 9 * node + i;
    s.held[static_cast<std::size_t>(unknown)] = true;
  }
}

/// Holds all nine unknowns of a node.
inline void clamp(Structure& s, int node) { hold(s, node, {0, 1, 2, 3, 4, 5, 6, 7, 8}); }

/// Holds position and directions of the slopes of a straight beam, not their lengths. The section
/// may swell and shrink, so a uniform state stays uniform up to the clamp.
inline void clamp_directions(Structure& s, int node) { hold(s, node, {0, 1, 2, 3, 5, 6, 7}); }

inline int last_node(const Structure& s) { return s.nodes() - 1; }

inline StructureLoad end_force(const Structure& s, const Vector3d& force) {
  StructureLoad load{Eigen::VectorXd::Zero(s.unknowns())};
  load.force.segment<3>(9 * last_node(s)) = force;
  return load;
}

inline StructureLoad end_moment(const Structure& s, const Vector3d& moment) {
  return {Eigen::VectorXd::Zero(s.unknowns()), {{last_node(s), moment}}};
}

/// Equilibrium; the test fails if it is not found.
inline Eigen::VectorXd solved(const Structure& s, const StructureLoad& load,
                              const Eigen::VectorXd* start = nullptr) {
  const Equilibrium found = equilibrium(s, load, {}, start);
  REQUIRE(found.converged);
  return found.q;
}

inline Vector3d end_position(const Structure& s, const Eigen::VectorXd& q) {
  return q.segment<3>(9 * last_node(s));
}

/// Exponent p of errors e ~ h^p of a mesh and of one with half its element size.
inline double observed_order(double coarse, double fine) {
  return std::log2(std::abs(coarse / fine));
}

}  // namespace railstep
