#pragma once
#include <Eigen/Dense>
#include <string>

#include "joints_run.h"

namespace railstep {

/// A scene on which constraint methods are compared. The first sensor is the point that is
/// compared.
struct JointScene {
  std::string name;
  System system;
  double until = 0.;            // s
  Eigen::Vector2d reference;    // x and z of the sensor at 1 s, m
  double reference_error = 0.;  // m
};

/// Solves y' = slope(y) by the classical Runge-Kutta method of order 4, in `steps` equal steps.
template <class Slope>
Eigen::VectorXd runge_kutta(const Slope& slope, Eigen::VectorXd y, double until, int steps) {
  const double h = until / steps;
  for (int k = 0; k < steps; ++k) {
    const Eigen::VectorXd a = slope(y), b = slope(y + .5 * h * a), c = slope(y + .5 * h * b);
    const Eigen::VectorXd d = slope(y + h * c);
    y += h / 6. * (a + 2. * b + 2. * c + d);
  }
  return y;
}

/// Sets a scene's reference from angles (and rates) at 1 s, and its error from half as many steps.
template <class Slope, class Place>
void set_reference(JointScene& scene, const Slope& slope, const Eigen::VectorXd& start,
                   const Place& place) {
  constexpr int kSteps = 100'000;
  scene.reference = place(runge_kutta(slope, start, 1., kSteps));
  scene.reference_error =
      (place(runge_kutta(slope, start, 1., kSteps / 2)) - scene.reference).norm();
}

inline Joint hinge(Part a, Part b, const Eigen::Vector3d& point) {
  return {.a = a, .b = b, .point = point, .axis = Eigen::Vector3d::UnitY()};
}

/// The paper's links (Fig. 6): 0.4 m, 20 mm high, 30 mm wide, from rest along x, A at the origin.
struct Links {
  double length = .4, height = .02, width = .03;  // m
  Material material = {.young = 210e6, .poisson = .3, .density = 7900.};

  double area() const { return height * width; }
  double inertia_y() const { return width * std::pow(height, 3) / 12.; }
  double mass() const { return material.density * area() * length; }
  Eigen::Vector3d joint(int link) const { return {link * length, 0., 0.}; }
};

/// Adds the hinges of both links, and the free end C as the sensor.
inline void hang(System& system, Part first, Part second) {
  const Links links;
  system.planar = true;
  system.joints = {hinge(ground(), first, links.joint(0)), hinge(first, second, links.joint(1))};
  system.sensors = {{second, links.joint(2)}};
}

inline JointScene rigid_pendulum() {
  const Links links;
  const double m = links.mass(), L = links.length;
  const double own = m * L * L / 12. + links.material.density * links.inertia_y() * L;
  JointScene scene{"rigid", {}, 10., {}, 0.};
  for (int i = 0; i < 2; ++i)
    scene.system.bodies.push_back({.mass = m,
                                   .inertia = own * Eigen::Matrix3d::Identity(),
                                   .position = .5 * (links.joint(i) + links.joint(i + 1))});
  hang(scene.system, body(0), body(1));
  // Angles from x to z and their rates; J c couples both links, with c the cosine between them.
  const double I2 = own + m * L * L / 4., I1 = I2 + m * L * L, J = .5 * m * L * L;
  const double w = .5 * m * 9.81 * L;
  const auto slope = [=](const Eigen::VectorXd& y) -> Eigen::VectorXd {
    const double c = std::cos(y[1] - y[0]), s = std::sin(y[1] - y[0]);
    const Eigen::Matrix2d M{{I1, J * c}, {J * c, I2}};
    const Eigen::Vector2d f(J * s * y[3] * y[3] - 3. * w * std::cos(y[0]),
                            -J * s * y[2] * y[2] - w * std::cos(y[1]));
    const Eigen::Vector2d a = M.inverse() * f;
    return Eigen::Vector4d(y[2], y[3], a[0], a[1]);
  };
  set_reference(scene, slope, Eigen::Vector4d::Zero(), [=](const Eigen::VectorXd& y) {
    return Eigen::Vector2d(L * (std::cos(y[0]) + std::cos(y[1])),
                           L * (std::sin(y[0]) + std::sin(y[1])));
  });
  return scene;
}

/// Place of the sensor at 1 s, by the direct method and generalised-alpha.
inline Eigen::Vector2d place_at_one_second(const System& system, double dt) {
  SystemOptions options;
  options.scheme = generalised_alpha(dt, .9);
  options.constraint_method = ConstraintMethod::direct;
  Rollout run(system, options);
  for (int k = 0; k < std::lround(1. / dt); ++k) (void)run.step();
  return run.place();
}

/// The reference is the same mesh with steps of 10 us, extrapolated with 20 us. Its error is the
/// distance of the result of 20 and 40 us.
inline JointScene flexible_pendulum() {
  const Links links;
  JointScene scene{"flexible", {}, 1., {}, 0.};
  const BeamSection section{.area = links.area(),
                            .inertia_y = links.inertia_y(),
                            .inertia_z = links.height * std::pow(links.width, 3) / 12.,
                            .torsion = .196 * links.width * std::pow(links.height, 3),
                            .moments = rectangle_moments(links.height, links.width)};
  for (int i = 0; i < 2; ++i)
    scene.system.beams.push_back({.section = section,
                                  .material = links.material,
                                  .elements = 4,
                                  .length = links.length,
                                  .half_height = .5 * links.height,
                                  .start = links.joint(i)});
  hang(scene.system, beam(0), beam(1));
  const Eigen::Vector2d fine = place_at_one_second(scene.system, 1e-5);
  const Eigen::Vector2d mid = place_at_one_second(scene.system, 2e-5);
  const Eigen::Vector2d coarse = place_at_one_second(scene.system, 4e-5);
  scene.reference = fine + (fine - mid) / 3.;
  scene.reference_error = (scene.reference - (mid + (mid - coarse) / 3.)).norm();
  return scene;
}

/// IFToMM's N-four-bar with two loops: three cranks and two couplers, rods of 1 m and 1 kg, from
/// upright at 1 rad/s. When the rods lie in one line, the rows lose rank. `doubled`: its first
/// coupler has both hinges twice.
inline JointScene four_bar(bool doubled) {
  JointScene scene{doubled ? "four_bar_doubled" : "four_bar", {}, 10., {}, 0.};
  System& s = scene.system;
  s.planar = true;
  using Eigen::Vector3d;
  const auto rod = [&](const Vector3d& middle, const Vector3d& velocity, double turn) {
    s.bodies.push_back({.mass = 1.,
                        .inertia = Eigen::Matrix3d::Identity() / 12.,
                        .position = middle,
                        .velocity = velocity,
                        .angular_velocity = Vector3d(0., turn, 0.)});
  };
  for (int i = 0; i < 3; ++i) rod({1. * i, 0., .5}, {.5, 0., 0.}, 1.);
  for (int i = 0; i < 2; ++i) rod({i + .5, 0., 1.}, {1., 0., 0.}, 0.);
  for (int i = 0; i < 3; ++i) s.joints.push_back(hinge(ground(), body(i), {1. * i, 0., 0.}));
  for (int i = 0; i < 2; ++i)
    for (int side = 0; side < 2; ++side)
      for (int times = 0; times < (doubled && i == 0 ? 2 : 1); ++times)
        s.joints.push_back(hinge(body(i + side), body(3 + i), {1. * (i + side), 0., 1.}));
  s.sensors = {{body(0), {0., 0., 1.}}};
  const auto slope = [](const Eigen::VectorXd& y) -> Eigen::VectorXd {
    return Eigen::Vector2d(y[1], -7. / 6. * 9.81 * std::cos(y[0]));
  };
  set_reference(scene, slope, Eigen::Vector2d(std::acos(0.), -1.), [](const Eigen::VectorXd& y) {
    return Eigen::Vector2d(std::cos(y[0]), std::sin(y[0]));
  });
  return scene;
}

}  // namespace railstep
