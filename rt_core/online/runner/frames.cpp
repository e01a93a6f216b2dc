#include "online/runner/frames.h"

#include <cmath>

namespace railstep {

namespace {

/// Place of the frame of a body.
double place_of(const OnLine& at, const RunnerFrames& frames, std::int32_t body) noexcept {
  return at.place + (frames.centre[std::ptrdiff_t{3} * body] - frames.centre[0]);
}
FramePose pose_of(const DesignLine& line, const OnLine& at, const RunnerFrames& frames,
                  const FramePair& pair) noexcept {
  return pose_between(line, place_of(at, frames, pair.body[0]), place_of(at, frames, pair.body[1]));
}

constexpr int kOfPair = 2 * kMotions;

/// y += A x. @param A  [kOfPair][kOfPair] symmetric
void multiply_add(const double* A, const double* x, double* y) noexcept {
  for (int j = 0; j < kOfPair; ++j) {
    const double own = x[j];
#pragma omp simd
    for (int i = 0; i < kOfPair; ++i) y[i] += A[kOfPair * j + i] * own;
  }
}

/// to += factor a x b
void add_cross(double factor, const double* a, const double* b, double* to) noexcept {
  for (int d = 0; d < 3; ++d) {
    const int next = (d + 1) % 3, last = (d + 2) % 3;
    to[d] += factor * (a[next] * b[last] - a[last] * b[next]);
  }
}

/// A rotation by a vector, to sixth order in its length.
struct Rotation {
  double at[3][3];
  explicit Rotation(const double* w) noexcept {
    const double square = w[0] * w[0] + w[1] * w[1] + w[2] * w[2];
    const double sine = 1. - square / 6. * (1. - square / 20.),
                 versine = .5 - square / 24. * (1. - square / 30.);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        at[i][j] = versine * (w[i] * w[j] - (i == j ? square : 0.)) + (i == j ? 1. : 0.);
    for (int d = 0; d < 3; ++d) {
      const int next = (d + 1) % 3, last = (d + 2) % 3;
      at[last][next] += sine * w[d];
      at[next][last] -= sine * w[d];
    }
  }
  Rotation(const Rotation& a, const Rotation& b) noexcept {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        at[i][j] = 0.;
        for (int k = 0; k < 3; ++k) at[i][j] += a.at[i][k] * b.at[k][j];
      }
  }
  void rotate(const double* x, double* rotated) const noexcept {
    for (int i = 0; i < 3; ++i) rotated[i] = at[i][0] * x[0] + at[i][1] * x[1] + at[i][2] * x[2];
  }
  void rotate_back(const double* x, double* rotated) const noexcept {
    for (int i = 0; i < 3; ++i) rotated[i] = at[0][i] * x[0] + at[1][i] * x[1] + at[2][i] * x[2];
  }
};
/// Entry of b' a.
double entry(const Rotation& b, const Rotation& a, int i, int j) noexcept {
  return b.at[0][i] * a.at[0][j] + b.at[1][i] * a.at[1][j] + b.at[2][i] * a.at[2][j];
}

/// A body of a pair in the frame halfway between those of both.
struct BodyBetween {
  Rotation frame, body;
  double centre[3];            // from the origin of its frame, m
  double rate[3], angular[3];  // by its frame alone, m/s and rad/s
  double force[3], moment[3];  // on it, about its centre
  /// @param rotation  of its frame, rad
  /// @param of_frame  its angular rate, rad/s
  /// @param yz        [2] its centre at rest
  /// @param own       [6] its motions
  BodyBetween(const double* rotation, const double* of_frame, const double* yz,
              const double* own) noexcept
      : frame(rotation), body(frame, Rotation(own + 3)), rate(), angular(), force(), moment() {
    const double at[3] = {own[0], own[1] + yz[0], own[2] + yz[1]};
    frame.rotate(at, centre);
    for (int d = 0; d < 3; ++d) angular[d] = of_frame[d];
    add_cross(1., angular, centre, rate);
  }
};

/// Two ends of an element, from the second one to the first one, and the arms of both.
struct Ends {
  double arm[2][3], across[3], rate[3];
  Ends(const FrameElement& e, const BodyBetween& a, const BodyBetween& b) noexcept {
    a.body.rotate(e.arm[0], arm[0]);
    b.body.rotate(e.arm[1], arm[1]);
    for (int d = 0; d < 3; ++d) {
      across[d] = (a.centre[d] + arm[0][d]) - (b.centre[d] + arm[1][d]);
      rate[d] = a.rate[d] - b.rate[d];
    }
    add_cross(1., a.angular, arm[0], rate);
    add_cross(-1., b.angular, arm[1], rate);
  }
};

/// Force on the first body along the line between both ends.
void line_force(const FrameElement& e, const Ends& ends, double* force) noexcept {
  double square = 0., along = 0.;
  for (int d = 0; d < 3; ++d) {
    square += ends.across[d] * ends.across[d];
    along += ends.across[d] * ends.rate[d];
  }
  const double length = std::sqrt(square);
  const double tension =
      e.preload[0] + e.stiffness[0] * (length - e.along_line) + e.damping[0] * along / length;
  for (int d = 0; d < 3; ++d) force[d] = -tension * ends.across[d] / length;
}

/// Force and moment on the first body by springs along and about the axes halfway.
void spring_force(const FrameElement& e, const Ends& ends, const BodyBetween& a,
                  const BodyBetween& b, double* force, double* moment) noexcept {
  double angle[3], half[3], angular[3], between[3], rate[3];
  for (int d = 0; d < 3; ++d) {
    const int next = (d + 1) % 3, last = (d + 2) % 3;
    angle[d] = .5 * (entry(b.body, a.body, last, next) - entry(b.body, a.body, next, last));
    half[d] = .5 * angle[d];
    angular[d] = .5 * (a.angular[d] + b.angular[d]);
    between[d] = a.angular[d] - b.angular[d];
    rate[d] = ends.rate[d];
  }
  const Rotation axes(b.body, Rotation(half));
  add_cross(-1., angular, ends.across, rate);
  double along[3], rate_along[3], about[3], own[3], own_moment[3];
  axes.rotate_back(ends.across, along);
  axes.rotate_back(rate, rate_along);
  axes.rotate_back(between, about);
  for (int d = 0; d < 3; ++d) {
    own[d] = e.preload[d] - (e.stiffness[d] * along[d] + e.damping[d] * rate_along[d]);
    own_moment[d] =
        e.preload[3 + d] - (e.stiffness[3 + d] * angle[d] + e.damping[3 + d] * about[d]);
  }
  axes.rotate(own, force);
  axes.rotate(own_moment, moment);
}

/// Adds the force of one element to those on both bodies.
void add_element(const FrameElement& e, BodyBetween& a, BodyBetween& b) noexcept {
  const Ends ends(e, a, b);
  const bool along_line = e.along_line > 0.;
  double force[3], moment[3] = {};
  if (along_line)
    line_force(e, ends, force);
  else
    spring_force(e, ends, a, b, force, moment);
  double to_a[3], to_b[3];
  for (int d = 0; d < 3; ++d) {
    const double middle = along_line ? 0. : .5 * ends.across[d];
    to_a[d] = ends.arm[0][d] - middle;
    to_b[d] = ends.arm[1][d] + middle;
    a.force[d] += force[d];
    b.force[d] -= force[d];
    a.moment[d] += moment[d];
    b.moment[d] -= moment[d];
  }
  add_cross(1., to_a, force, a.moment);
  add_cross(-1., to_b, force, b.moment);
}

/// Forces on a body over its motions. Moments act along its rotation vector; those of a wheelset
/// about the level axis across its axle, and about z.
void generalise(const BodyBetween& of, bool boxes, const double* own, double* force) noexcept {
  of.frame.rotate_back(of.force, force);
  double moment[3];
  of.frame.rotate_back(of.moment, moment);
  for (int d = 0; d < 3; ++d) force[3 + d] = moment[d];
  if (!boxes) return add_cross(-.5, own + 3, moment, force + 3);
  const double yaw = own[index_of(BodyMotion::yaw)];
  force[index_of(BodyMotion::roll)] += yaw * moment[1] - .5 * yaw * yaw * moment[0];
  force[index_of(BodyMotion::pitch)] = 0.;
}

/// The motions of both bodies of a pair in their frames, and their centres at rest.
struct PairMotions {
  double own[kOfPair];
  const double* centre[2];
  PairMotions(const RunnerFrames& frames, const FramePair& pair, const double* u) noexcept {
    for (int k = 0; k < 2; ++k) {
      double* const motions = own + kMotions * k;
      for (int m = 0; m < kMotions; ++m) motions[m] = u[kMotions * pair.body[k] + m];
      motions[0] -= u[0];
      // A wheelset yaws and then rolls; its boxes do not spin.
      if (pair.boxes[k] != 0) motions[4] = .5 * motions[3] * motions[5];
      centre[k] = frames.centre + std::ptrdiff_t{3} * pair.body[k];
    }
  }
};

/// Rotations of both frames of a pair in the one halfway between them.
struct PairRotation {
  FramePose pose;
  double speed, half[2][3], rate[2][3];  // m/s, rad, rad/s
  PairRotation(const FramePose& of, double along) noexcept : pose(of), speed(along) {
    for (int d = 0; d < 3; ++d) {
      half[1][d] = .5 * pose.pose[3 + d];
      half[0][d] = -half[1][d];
      rate[1][d] = .5 * speed * pose.per_way[3 + d];
      rate[0][d] = -rate[1][d];
    }
  }
  /// Moves the second body to its place beyond the first frame's origin. @param ahead  at rest, m
  void move(double ahead, const BodyBetween& a, BodyBetween& b) const noexcept {
    const double way[3] = {ahead + pose.pose[0], pose.pose[1], pose.pose[2]};
    double moved[3], moving[3] = {};
    a.frame.rotate(way, moved);
    add_cross(1., rate[0], moved, moving);
    for (int d = 0; d < 3; ++d) {
      b.centre[d] += moved[d];
      b.rate[d] += moving[d] + speed * pose.per_way[d];
    }
  }
};

}  // namespace

void find_poses(const DesignLine& line, const OnLine& at, const RunnerFrames& frames,
                double* pose) noexcept {
  for (std::int32_t p = 0; p < frames.pairs; ++p) {
    const FramePose own = pose_of(line, at, frames, frames.pair[p]);
    for (int k = 0; k < kMotions; ++k) pose[kMotions * p + k] = own.pose[k];
  }
}

void add_pair_forces(const DesignLine& line, const OnLine& at, const RunnerFrames& frames,
                     const double* u, double* force) noexcept {
  const FrameElement* element = frames.element;
  for (std::int32_t p = 0; p < frames.pairs; ++p) {
    const FramePair& pair = frames.pair[p];
    const PairMotions motions(frames, pair, u);
    const PairRotation rotation(pose_of(line, at, frames, pair), at.speed);
    BodyBetween a(rotation.half[0], rotation.rate[0], motions.centre[0] + 1, motions.own),
        b(rotation.half[1], rotation.rate[1], motions.centre[1] + 1, motions.own + kMotions);
    rotation.move(motions.centre[1][0] - motions.centre[0][0], a, b);
    for (std::int32_t e = 0; e < pair.elements; ++e) add_element(*element++, a, b);
    double linear[kOfPair], exact[kOfPair];
    generalise(a, pair.boxes[0] != 0, motions.own, exact);
    generalise(b, pair.boxes[1] != 0, motions.own + kMotions, exact + kMotions);
    const double* const preload = frames.preload + std::ptrdiff_t{kOfPair} * p;
    for (int k = 0; k < kOfPair; ++k) linear[k] = -preload[k];
    multiply_add(frames.stiffness + std::ptrdiff_t{kOfPair * kOfPair} * p, motions.own, linear);
    for (int k = 0; k < 2; ++k)
      for (int m = 0; m < kMotions; ++m)
        force[kMotions * pair.body[k] + m] += exact[kMotions * k + m] + linear[kMotions * k + m];
  }
}

void add_frame_forces(const DesignLine& line, const OnLine& at, const LineBodies& bodies,
                      double span, double* force) noexcept {
  for (std::int32_t b = 0; b < bodies.count; ++b) {
    const double* const centre = bodies.centre + std::ptrdiff_t{3} * b;
    const FrameMotion m = frame_motion(line, at.place + (centre[0] - bodies.centre[0]), at.speed,
                                       at.faster, span, bodies.gravity);
    const double y = centre[1], z = centre[2];
    const double *w = m.rate, *alpha = m.angular, *mass = bodies.mass + kMotions * b;
    // a + alpha x r + w x (w x r), r = (0, y, z)
    const double along = w[1] * y + w[2] * z, square = w[0] * w[0] + w[1] * w[1] + w[2] * w[2];
    const double a[3] = {m.acceleration[0] + (alpha[1] * z - alpha[2] * y) + w[0] * along,
                         (m.acceleration[1] - alpha[0] * z) + (w[1] * along - square * y),
                         (m.acceleration[2] + alpha[0] * y) + (w[2] * along - square * z)};
    double* const own = force + kMotions * b;
    for (int d = 0; d < 3; ++d) {
      const int next = (d + 1) % 3, last = (d + 2) % 3;
      own[d] -= mass[d] * a[d];
      own[3 + d] -= mass[3 + d] * alpha[d] + (mass[3 + last] - mass[3 + next]) * w[next] * w[last];
    }
  }
}

void add_gyroscopic(const FrameRotation& rotation, double speed, double momentum,
                    double* force) noexcept {
  force[index_of(BodyMotion::roll)] += momentum * (speed * rotation.z);
  force[index_of(BodyMotion::yaw)] -= momentum * (speed * rotation.x);
}

}  // namespace railstep
