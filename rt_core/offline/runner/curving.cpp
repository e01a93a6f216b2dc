#include "offline/runner/curving.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "offline/math/refuse.h"

namespace railstep {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// The vehicle as its frames see it: axle boxes pitch with their frames.
Runner with_axle_boxes(Runner runner) {
  for (RunnerBody& body : runner.bodies) body.radius = 0.;
  return runner;
}
using Pair = std::array<int, 2>;

/// The pairs of bodies that elements join, each once.
std::vector<Pair> pairs_of(const Runner& runner) {
  std::vector<Pair> pairs;
  const auto add = [&](int a, int b) {
    const Pair pair{std::min(a, b), std::max(a, b)};
    if (pair[0] != kGround && std::find(pairs.begin(), pairs.end(), pair) == pairs.end())
      pairs.push_back(pair);
  };
  for (const RunnerElement& e : runner.elements) add(e.a, e.b);
  for (const RunnerForceElement& e : runner.force_elements)
    if (!e.is_brake()) add(e.a, e.b);
  return pairs;
}

/// The vehicle with the elements of one pair.
Runner with_elements_of(Runner runner, const Pair& pair) {
  std::erase_if(runner.elements, [&](const RunnerElement& e) {
    return std::min(e.a, e.b) != pair[0] || std::max(e.a, e.b) != pair[1];
  });
  runner.force_elements.clear();
  return runner;
}

/// Motions of a body by the pose of its frame.
Matrix6d motion_by_pose(const RunnerBody& body) {
  Matrix6d P = Matrix6d::Identity();
  const double y = body.centre[1], z = body.centre[2];
  // rotation x (0, y, z)
  P(0, 4) = z;
  P(0, 5) = -y;
  P(1, 3) = -z;
  P(2, 3) = y;
  return P;
}

/// Displacement of a row by the poses; 0 of a row that moves one body alone, against the ground.
Eigen::RowVectorXd by_poses(const VectorXd& row, const Runner& runner,
                            const std::vector<Pair>& pairs) {
  const auto moves = [&](int body) { return !row.segment<6>(6 * body).isZero(0.); };
  Eigen::RowVectorXd moved = Eigen::RowVectorXd::Zero(6 * static_cast<Index>(pairs.size()));
  for (std::size_t p = 0; p < pairs.size(); ++p)
    if (const auto [first, second] = pairs[p]; moves(first) && moves(second))
      moved.segment<6>(6 * static_cast<Index>(p)) =
          row.segment<6>(6 * second).transpose() *
          motion_by_pose(runner.bodies[static_cast<std::size_t>(second)]);
  return moved;
}

/// An element from the body of the lower number to the other one. A damper in series with a spring
/// is not in it: its force depends on what it has kept.
FrameElement frame_element(const Runner& runner, const RunnerElement& e) {
  const bool swapped = e.a > e.b;
  FrameElement made{};
  for (int k = 0; k < 2; ++k) {
    const bool of_a = (k == 0) != swapped;
    const auto body = static_cast<std::size_t>(of_a ? e.a : e.b);
    for (std::size_t d = 0; d < 3; ++d)
      made.arm[k][d] = (of_a ? e.point_a : e.point_b)[d] - runner.bodies[body].centre[d];
  }
  const bool along = e.kind != RunnerElement::Kind::mid_frame;
  for (std::size_t d = 0; along && d < 3; ++d)
    made.along_line = std::hypot(made.along_line, e.point_b[d] - e.point_a[d]);
  for (std::size_t k = 0; k < 6; ++k) {
    const bool is_rod = e.kind == RunnerElement::Kind::rod;
    made.stiffness[k] = is_rod || e.presses_only ? 0. : e.stiffness[k];
    made.damping[k] = is_rod || e.series[k] > 0. ? 0. : e.damping[k];
    made.preload[k] = swapped && !along ? -e.preload[k] : e.preload[k];
  }
  return made;
}

/// The rows of both bodies of a pair. @param A  [n] or [n][n]
MatrixXd of_pair(const Pair& pair, const MatrixXd& A) {
  const Index first = kMotions * Index{pair[0]}, second = kMotions * Index{pair[1]};
  MatrixXd rows(2 * kMotions, A.cols());
  rows << A.middleRows<kMotions>(first), A.middleRows<kMotions>(second);
  return rows;
}
void append(const MatrixXd& values, std::vector<double>& to) {
  to.insert(to.end(), values.data(), values.data() + values.size());
}

/// The frames of a runner's bodies, which point to the rest.
struct LineFrames {
  FrameMatrices matrices;
  std::vector<double> centre;
  RunnerFrames frames{};

  explicit LineFrames(const Runner& runner)
      : matrices(frame_matrices(runner)), centre(centres_of(runner)) {
    frames.centre = centre.data();
    set_pairs(matrices.pairs, frames);
    frames.stiffness = matrices.stiffness.data();
    frames.elements = static_cast<std::int32_t>(matrices.elements.size());
    frames.element = matrices.elements.data();
    frames.preload = matrices.preload.data();
  }
  LineFrames(const LineFrames&) = delete;
  LineFrames& operator=(const LineFrames&) = delete;
};

}  // namespace

double reach_of(const Runner& runner) {
  double most = 0.;
  const auto place = [&](int body) {
    return runner.bodies[static_cast<std::size_t>(body)].centre[0];
  };
  for (const auto& [first, second] : pairs_of(runner))
    most = std::max(most, std::fabs(place(second) - place(first)));
  return most;
}

FrameMatrices frame_matrices(const Runner& runner) {
  const Runner boxes = with_axle_boxes(runner);
  const RunnerMatrices all = runner_matrices(boxes, 0.);
  const std::vector<Pair> pairs = pairs_of(runner);
  FrameMatrices f;
  for (const Pair& pair : pairs) {
    const auto has_boxes = [&](int body) {
      return runner.bodies[static_cast<std::size_t>(body)].is_wheelset() ? 1 : 0;
    };
    const Runner own = with_elements_of(runner, pair);
    const RunnerMatrices m = runner_matrices(own, 0.);
    f.pairs.push_back({{pair[0], pair[1]}, {has_boxes(pair[0]), has_boxes(pair[1])}, 0});
    VectorXd load = m.rest;
    for (Index rod = 0; const RunnerElement& e : own.elements) {
      if (e.kind == RunnerElement::Kind::rod) load -= e.preload[0] * m.rods.col(rod++);
      f.elements.push_back(frame_element(runner, e));
      ++f.pairs.back().elements;
    }
    append(of_pair(pair, of_pair(pair, m.stiffness).transpose()), f.stiffness);
    append(of_pair(pair, load), f.preload);
  }
  const auto poses = kMotions * static_cast<Index>(pairs.size());
  f.series = MatrixXd::Zero(static_cast<Index>(all.series.size()), poses);
  f.rods = MatrixXd::Zero(all.rods.cols(), poses);
  for (std::size_t i = 0; i < all.series.size(); ++i)
    f.series.row(static_cast<Index>(i)) = by_poses(all.series[i].row, runner, pairs);
  std::vector<Eigen::RowVectorXd> moved;
  for (const RunnerMatrices::Element& e : all.force_elements) {
    moved.push_back(is_brake(e.law) ? Eigen::RowVectorXd::Zero(poses)
                                    : by_poses(e.row, runner, pairs));
    if (e.law.loaded != 0) moved.push_back(by_poses(e.load, runner, pairs));
  }
  f.elements_moved.resize(static_cast<Index>(moved.size()), poses);
  for (std::size_t i = 0; i < moved.size(); ++i)
    f.elements_moved.row(static_cast<Index>(i)) = moved[i];
  f.traced_moved.resize(static_cast<Index>(all.traced.size()), poses);
  for (std::size_t i = 0; i < all.traced.size(); ++i)
    f.traced_moved.row(static_cast<Index>(i)) = by_poses(all.traced[i].row, runner, pairs);
  for (Index i = 0; i < all.rods.cols(); ++i)
    f.rods.row(i) = by_poses(all.rods.col(i), runner, pairs);
  return f;
}

void set_pairs(const std::vector<FramePair>& pairs, RunnerFrames& frames) {
  if (pairs.size() > std::size_t{kMaxFramePairs})
    refuse("E-SUSPENSION-07", "elements join " + std::to_string(pairs.size()) +
                                  " pairs of bodies of the vehicle; on a design line expected at "
                                  "most " +
                                  std::to_string(kMaxFramePairs));
  for (const FramePair& pair : pairs) frames.pair[frames.pairs++] = pair;
}

std::vector<double> centres_of(const Runner& runner) {
  std::vector<double> centres;
  for (const RunnerBody& body : runner.bodies)
    centres.insert(centres.end(), body.centre.begin(), body.centre.end());
  return centres;
}

RunnerMatrices matrices_on(const DesignLine& line, const OnLine& at, const Runner& runner,
                           const RunnerMatrices& matrices, double gravity, const VectorXd& u) {
  RunnerMatrices m = matrices;
  const LineFrames own(runner);
  const FrameMatrices& f = own.matrices;
  const std::vector<double>& centre = own.centre;
  const RunnerFrames& frames = own.frames;
  const auto bodies = static_cast<std::int32_t>(runner.bodies.size());
  VectorXd pose = VectorXd::Zero(f.elements_moved.cols());
  find_poses(line, at, frames, pose.data());
  add_pair_forces(line, at, frames, u.data(), m.rest.data());
  add_frame_forces(line, at, {bodies, centre.data(), m.mass.data(), gravity}, 0., m.rest.data());
  for (std::size_t b = 0; b < runner.bodies.size(); ++b) {
    const RunnerBody& body = runner.bodies[b];
    if (!body.is_wheelset()) continue;
    const FrameRotation rotation = rotation_at(line, at.place + (centre[3 * b] - centre[0]));
    add_gyroscopic(rotation, at.speed, body.inertia[1] * at.speed / body.radius,
                   m.rest.data() + kMotions * static_cast<Index>(b));
  }
  for (std::size_t i = 0; i < m.series.size(); ++i)
    m.series[i].moved = f.series.row(static_cast<Index>(i)).dot(pose);
  for (Index row = 0; RunnerMatrices::Element & e : m.force_elements) {
    e.moved = f.elements_moved.row(row++).dot(pose);
    if (e.law.loaded != 0) e.load_moved = f.elements_moved.row(row++).dot(pose);
  }
  m.rods_moved = f.rods * pose;
  return m;
}

MatrixXd turned_stiffness(const DesignLine& line, const OnLine& at, const Runner& runner,
                          const VectorXd& u) {
  const LineFrames own(runner);
  constexpr double kStep = 1e-5;  // m, rad: forces are smooth over 1 m and 1 rad
  const Index n = u.size();
  MatrixXd K(n, n);
  VectorXd moved = u;
  for (Index k = 0; k < n; ++k) {
    VectorXd forces[2] = {VectorXd::Zero(n), VectorXd::Zero(n)};
    for (const int side : {0, 1}) {
      moved[k] = u[k] + (side == 0 ? -kStep : kStep);
      add_pair_forces(line, at, own.frames, moved.data(), forces[side].data());
    }
    moved[k] = u[k];
    K.col(k) = (forces[0] - forces[1]) / (2. * kStep);
  }
  return K;
}

void set_frame_rates(const DesignLine& line, const OnLine& at, const Runner& runner,
                     std::vector<RailsUnder>& rails) {
  std::size_t set = 0;
  for (const RunnerBody& body : runner.bodies) {
    if (!body.is_wheelset()) continue;
    if (set == rails.size()) rails.emplace_back();
    const FrameRotation rotation =
        rotation_at(line, at.place + (body.centre[0] - runner.bodies.front().centre[0]));
    rails[set].frame_pitch = at.speed * rotation.y;
    rails[set++].frame_yaw = at.speed * rotation.z;
  }
}

}  // namespace railstep
