#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <random>

#include "offline/system/pack_system.h"
#include "online/system/row.h"
#include "online/system/rows.h"
#include "support/pendulum_core.h"

using namespace railstep;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

/// Every kind of joint between two bodies, a body and a beam, two beams, and a part and the ground.
System all_joints(bool planar) {
  System s = pendulum_system({}, 2, planar);
  s.beams[0].ends[0] = BeamEnd::free;
  s.joints.clear();
  RigidBody block{.mass = 2.,
                  .inertia = Vector3d(.1, .2, .25).asDiagonal().toDenseMatrix(),
                  .position = {.3, 0., .2}};
  if (!planar) block.orientation = Eigen::Quaterniond(.5, .5, -.5, .5);
  s.bodies = {block, block};
  s.bodies[1].position = {.5, 0., -.3};
  const Vector3d x = Vector3d::UnitX(), y = Vector3d::UnitY(), z = Vector3d::UnitZ();
  const Vector3d slant = planar ? Vector3d(1., 0., 2.) : Vector3d(1., -.7, 2.);
  const std::vector<std::pair<JointKind, Vector3d>> kinds = {
      {JointKind::spherical, x},      {JointKind::revolute, planar ? y : slant},
      {JointKind::prismatic, slant},  {JointKind::cylindrical, slant},
      {JointKind::fixed, x},          {JointKind::point_on_line, slant},
      {JointKind::point_on_plane, z}, {JointKind::translation, slant},
      {JointKind::rotation, y},       {JointKind::distance, x}};
  const std::vector<std::pair<Part, Part>> pairs = {{ground(), body(0)},
                                                    {body(0), body(1)},
                                                    {beam(0), body(1)},
                                                    {body(0), beam(1)},
                                                    {beam(0), beam(1)}};
  for (const auto& [kind, axis] : kinds)
    for (const auto& [a, b] : pairs) {
      Joint j{.kind = kind, .a = a, .b = b, .point = {.4, 0., 0.}, .axis = axis};
      j.other_point = {.4, 0., .1};
      if (kind == JointKind::translation || kind == JointKind::rotation)
        j.motion.polynomial = {0., 0., .7};
      s.joints.push_back(j);
    }
  s.springs = {{.a = beam(0),
                .b = body(0),
                .point_a = {.15, 0., .01},
                .point_b = {.3, 0., .1},
                .stiffness = 10.}};
  return s;
}

/// Rows of a system in any state, by the step's own functions.
struct Rows {
  PackedSystem packed;
  Model model;
  std::vector<double> scratch, zero, quaternion;
  SystemWorkspace w;

  explicit Rows(const System& system,
                const SystemOptions& options = {.scheme = generalised_alpha(1e-3, .9)})
      : packed(system, options),
        model(packed.model()),
        scratch(static_cast<std::size_t>(system_workspace_doubles(model.system)), 0.),
        zero(static_cast<std::size_t>(model.unknowns), 0.),
        w(system_workspace_on(model.system, scratch.data(), nullptr)) {
    const double* q = model.start + 4L * model.unknowns;
    quaternion.assign(q, q + 4L * model.system.bodies);
    model.scheme.kv = model.scheme.kg = 0.;  // v and g are given
  }
  std::int32_t count() const { return system_rows(model.system); }
  void place(const VectorXd& x, const VectorXd& v) {
    const SystemStart start{zero.data(), v.data(), zero.data(), v.data(), quaternion.data()};
    std::copy(x.begin(), x.end(), w.x);
    place_start(model, start, w);
    place_parts(model, start, w);
  }
  VectorXd values(const VectorXd& x, double time) {
    place(x, VectorXd::Zero(x.size()));
    Model plain = model;
    plain.scheme.kv = 1.;  // then a spring has a slope
    set_rows(plain, time, true, w);
    return Eigen::Map<const VectorXd>(w.value, count());
  }
  /// A row of gradients or slopes as a vector over all unknowns.
  VectorXd over_unknowns(const double* ends, std::int32_t r) const {
    VectorXd unit = VectorXd::Zero(count()), g = VectorXd::Zero(model.unknowns);
    unit[r] = 1.;
    add_row_forces(model.system, ends, unit.data(), g.data());
    return g;
  }
  Jet jet(std::int32_t r, double time) const {
    const SystemModel& s = model.system;
    const RowModel& row = s.row[r];
    const Motions at{w.x, w.v, w.g, w.matrix};
    return row_jet(row, marker_jet(s, s.marker[row.a], at), marker_jet(s, s.marker[row.b], at),
                   row.motion >= 0 ? motion_at(s, row.motion, time) : Jet{row.offset, 0., 0.});
  }
  /// Random displacements of beams and bodies; bodies rotate only if `turns` is true.
  VectorXd random(double size, bool turns, unsigned seed) const {
    std::mt19937 engine(seed);
    std::uniform_real_distribution<double> any(-size, size);
    VectorXd x(model.unknowns);
    for (double& value : x) value = any(engine);
    for (std::int32_t b = 0; b < model.system.bodies && !turns; ++b)
      for (int c = 3; c < 6; ++c)
        if (const std::int32_t k = model.system.body[b].column[c]; k >= 0)
          x[model.system.body[b].first + k] = 0.;
    return x;
  }
};

constexpr double kTime = .7;  // s

/// Column i of a derivative, from differences of fourth order of the values at x + t e_i.
template <class Values>
VectorXd column(const VectorXd& x, Eigen::Index i, const Values& values) {
  const double h = 1e-3;
  const auto at = [&](double step) -> VectorXd {
    VectorXd moved = x;
    moved[i] += step;
    return values(moved);
  };
  return (8. * (at(h) - at(-h)) - (at(2. * h) - at(-2. * h))) / (12. * h);
}

}  // namespace

TEST_CASE("the gradients of all rows are those of their values", "[system][rows]") {
  Rows rows(all_joints(GENERATE(false, true)));
  const VectorXd x = rows.random(.1, false, 3);
  rows.values(x, kTime);
  std::vector<VectorXd> gradient(static_cast<std::size_t>(rows.count()));
  for (std::int32_t r = 0; r < rows.count(); ++r)
    gradient[static_cast<std::size_t>(r)] = rows.over_unknowns(rows.w.gradient, r);
  double worst = 0.;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const VectorXd slope = column(x, i, [&](const VectorXd& p) { return rows.values(p, kTime); });
    for (std::int32_t r = 0; r < rows.count(); ++r)
      worst = std::max(worst, std::abs(slope[r] - gradient[static_cast<std::size_t>(r)][i]));
  }
  // Fourth order: h^4 / 30 of fifth derivatives of order 1 (rotations; 1e4 of that in the spring
  // with lengths of .1 m), 1e-12 to 1e-9; round-off is 1e-16 / h.
  CHECK(worst < 1e-8);
}

TEST_CASE("energy-momentum's slopes are those of the rows' values at the end", "[system][rows]") {
  Rows rows(all_joints(GENERATE(false, true)),
            {.scheme = energy_momentum(1e-3), .energy_momentum = true});
  const VectorXd x = rows.random(.1, true, 3);  // bodies rotate in the step too
  rows.values(x, kTime);
  std::vector<VectorXd> slope;
  double mean = 0.;  // difference from the gradient at the mean, which gives the force
  for (std::int32_t r = 0; r < rows.count(); ++r) {
    slope.push_back(rows.over_unknowns(rows.w.slope, r));
    mean = std::max(mean,
                    (slope.back() - rows.over_unknowns(rows.w.gradient, r)).cwiseAbs().maxCoeff());
  }
  CHECK(mean > 1e-2);
  double worst = 0.;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const VectorXd known = column(x, i, [&](const VectorXd& p) { return rows.values(p, kTime); });
    for (std::int32_t r = 0; r < rows.count(); ++r)
      worst = std::max(worst, std::abs(known[r] - slope[static_cast<std::size_t>(r)][i]));
  }
  CHECK(worst < 1e-8);  // as above
}

namespace {

/// Errors of slopes [0] and gradients [1] relative to the derivative of Baumgarte's `wanted`, in
/// the plane.
Eigen::Vector2d baumgarte_errors(double dt) {
  Rows rows(all_joints(true), {.scheme = generalised_alpha(dt, .9),
                               .constraint_method = ConstraintMethod::baumgarte,
                               .alpha = 20.});
  rows.model.scheme = generalised_alpha(dt, .9);
  // u* and v* leave velocities and accelerations of order 1 at x.
  const VectorXd x = rows.random(.1, false, 5), v = rows.random(1., true, 7),
                 g = rows.random(1., true, 9);
  const double kv = rows.model.scheme.kv, kg = rows.model.scheme.kg;
  const VectorXd u_star = x - g / kg, v_star = v - kv * (x - u_star);
  const std::int32_t joints = rows.model.system.joint_rows;
  const auto wanted = [&](const VectorXd& at) -> VectorXd {
    const SystemStart start{rows.zero.data(), v.data(), u_star.data(), v_star.data(),
                            rows.quaternion.data()};
    std::copy(at.begin(), at.end(), rows.w.x);
    place_start(rows.model, start, rows.w);
    place_parts(rows.model, start, rows.w);
    set_rows(rows.model, kTime, true, rows.w);
    return Eigen::Map<const VectorXd>(rows.w.wanted, joints);
  };
  wanted(x);
  std::vector<VectorXd> slope, gradient;
  for (std::int32_t r = 0; r < joints; ++r) {
    slope.push_back(rows.over_unknowns(rows.w.slope, r));
    gradient.push_back(rows.over_unknowns(rows.w.gradient, r));
  }
  Eigen::Vector2d worst = Eigen::Vector2d::Zero();
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const VectorXd known = column(x, i, wanted);
    for (std::size_t r = 0; r < slope.size(); ++r) {
      const double own = known[static_cast<Eigen::Index>(r)];
      worst[0] = std::max(worst[0], std::abs(own - slope[r][i]));
      worst[1] = std::max(worst[1], std::abs(own - gradient[r][i]));
    }
  }
  return worst;
}

}  // namespace

TEST_CASE("Baumgarte's slopes are the derivatives of `wanted` to second order", "[system][rows]") {
  const Eigen::Vector2d coarse = baumgarte_errors(1e-3), fine = baumgarte_errors(5e-4);
  INFO(coarse.transpose() << " then " << fine.transpose());
  // They leave out terms of the step's square; the gradient at the end leaves out the step's.
  CHECK(std::log2(coarse[0] / fine[0]) > 1.8);
  CHECK(std::log2(coarse[1] / fine[1]) < 1.2);
  CHECK(coarse[0] < 1e-2 * coarse[1]);
}

TEST_CASE("first and second derivatives of all rows are right along a motion", "[system][rows]") {
  Rows rows(all_joints(GENERATE(false, true)));
  const VectorXd x = rows.random(.1, false, 5), v = rows.random(1., true, 7);
  // Positions after t at constant rates: a rotation about a body's axis continues as exp(t v).
  const auto at = [&](double t) { return rows.values(x + t * v, kTime + t); };
  const double h = 1e-3;
  const VectorXd rate = (8. * (at(h) - at(-h)) - (at(2. * h) - at(-2. * h))) / (12. * h);
  const VectorXd bend =
      (16. * (at(h) + at(-h)) - (at(2. * h) + at(-2. * h)) - 30. * at(0.)) / (12. * h * h);
  rows.place(x, v);
  for (std::int32_t r = 0; r < rows.count(); ++r) {
    const Jet phi = rows.jet(r, kTime);
    CAPTURE(r);
    CHECK(phi.x == Approx(at(0.)[r]).margin(1e-14));
    rows.place(x, v);
    // As above; the second difference rounds by 1e-16 / h^2 = 1e-10 of values below 10.
    CHECK(phi.v == Approx(rate[r]).margin(1e-8));
    if (r < rows.model.system.joint_rows) CHECK(phi.a == Approx(bend[r]).margin(1e-7));
  }
}

TEST_CASE("beams solved together with their rows' ends have the bits of separate solves",
          "[system][rows]") {
  const bool planar = GENERATE(false, true);
  const int ends = GENERATE(1, 3, 4, 6);  // four sides at a time: with places left, and none
  CAPTURE(planar, ends);
  System system = pendulum_system({}, 5, planar);
  system.joints.clear();
  for (int i = 0; i < ends; ++i)
    system.springs.push_back({.a = beam(0),
                              .b = ground(),
                              .point_a = {.06 * i, 0., .01},
                              .point_b = {.3, 0., .5},
                              .stiffness = 10.});
  Rows rows(system);
  const Model& model = rows.packed.model();
  const SystemModel& s = model.system;
  rows.values(rows.random(1e-5, false, 11), kTime);
  const VectorXd v = rows.random(1., true, 13);
  part_forces(model, {rows.w.x, v.data(), rows.w.x, v.data(), nullptr}, true, rows.w);
  std::copy(v.begin(), v.end(), rows.w.residual);

  using Bits = std::vector<double>;
  const auto change = [&] { return Bits(rows.w.change, rows.w.change + s.unknowns); };
  const auto solved = [&] {
    const std::int32_t sides = 4 * beam_groups(s, 0) * s.beam[0].unknowns;
    return Bits(rows.w.tangent.solved, rows.w.tangent.solved + sides);
  };
  solve_parts(model, rows.w);
  solve_ends(model, false, rows.w);
  const Bits parts_alone = change(), ends_alone = solved();
  REQUIRE(*std::max_element(parts_alone.begin(), parts_alone.end()) > 0.);
  REQUIRE(*std::max_element(ends_alone.begin(), ends_alone.end()) > 0.);
  std::fill_n(rows.w.change, s.unknowns, 0.);
  std::fill_n(rows.w.tangent.solved, ends_alone.size(), 1.);
  solve_ends(model, true, rows.w);
  CHECK(change() == parts_alone);
  CHECK(solved() == ends_alone);
}
